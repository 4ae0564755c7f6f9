//! What the page's script draws.

use super::paint::MARKS;
use super::svg::ends;
use super::{Chart, Scale, Series, Shape, is_finite};
use serde_json::{Value, json};

impl Chart {
    /// The chart as JSON that may stand in a script element of any page: nothing in it ends the element.
    pub(in crate::report) fn data(&self) -> String {
        let ends = ends(self);
        let axis = |a: &super::Axis, log: Option<(f64, f64)>| {
            let (is_log, linear, names) = match &a.scale {
                Scale::Log => (true, None, None),
                Scale::Linear { low, high, .. } => (false, Some([*low, *high]), None),
                Scale::Names(names) => (false, Some([-0.6, names.len() as f64 - 0.4]), Some(names)),
            };
            json!({
                "title": a.title,
                "unit": a.unit.name(),
                "is_log": is_log,
                "log": log.map(|(a, b)| [a, b]),
                "linear": linear,
                "names": names,
            })
        };
        let rules: Vec<Value> = self.rules.iter().map(|r| json!({ "y": r.value, "name": r.name })).collect();
        let all = json!({
            "title": self.title,
            "x": axis(&self.x, ends.as_ref().and_then(|e| e.x_log)),
            "y": axis(&self.y, ends.as_ref().and_then(|e| e.y_log)),
            "series": self.series.iter().map(series).collect::<Vec<_>>(),
            "rules": rules,
        });
        // Neither the end of the element nor a comment can be written without it.
        all.to_string().replace('<', "\\u003c")
    }
}

fn series(s: &Series) -> Value {
    let shape = match s.shape {
        Shape::Line => "line",
        Shape::Dots => "dots",
        Shape::Bars => "bars",
        Shape::Steps => "steps",
    };
    let known = |x: f64| is_finite(x).then_some(x);
    let of = |value: &dyn Fn(&super::Dot) -> Option<f64>| s.dots.iter().map(value).collect::<Vec<_>>();
    let has_interval = s.dots.iter().any(|d| d.interval.is_some());
    let has_width = s.dots.iter().any(|d| d.width > 0.0);
    let has_label = s.dots.iter().any(|d| d.label.is_some());
    json!({
        "name": s.name,
        "paint": s.paint.variable(),
        "mark": MARKS[s.paint.mark()],
        "dash": if s.dashed { "dash" } else if s.paint.is_again() { "dot" } else { "solid" },
        "shape": shape,
        "x": of(&|d| known(d.x)),
        "y": of(&|d| known(d.y)),
        "low": has_interval.then(|| of(&|d| d.interval.and_then(|i| known(i.0)))),
        "high": has_interval.then(|| of(&|d| d.interval.and_then(|i| known(i.1)))),
        "width": has_width.then(|| of(&|d| known(d.width))),
        "label": has_label.then(|| s.dots.iter().map(|d| d.label.clone()).collect::<Vec<_>>()),
        "text": s.dots.iter().map(|d| d.hint.as_str()).collect::<Vec<_>>(),
        "fit": s.fit.as_ref().map(|f| json!({
            "x": [f.ends[0].0, f.ends[1].0],
            "y": [f.ends[0].1, f.ends[1].1],
            "text": f.text,
        })),
    })
}
