//! A little chart for the tests.

use super::{Axis, Cell, Chart, Dot, Fit, Library, Paint, Rule, Scale, Series, Shape, Unit};

/// Four points, one of them at no cost, whose error falls as 0.5 / x.
pub(in crate::report) fn chart(name: &str) -> Chart {
    let dot = |(x, y): (f64, f64)| Dot {
        x,
        y,
        std_err: Some(0.02 * y),
        interval: Some((0.95 * y, 1.05 * y)),
        hint: format!("{y} at {x}"),
        more: vec![Cell::Number(Some(64.0 * x), Unit::Count)],
        ..Dot::default()
    };
    let axis = |title: &str, unit| Axis { title: title.into(), column: title.into(), unit, scale: Scale::Log };
    Chart {
        stem: "rms-shots".into(),
        title: "After edit 1".into(),
        caption: "of -2 %".into(),
        x: axis("shots", Unit::Count),
        y: axis("rms", Unit::Percent),
        series: vec![Series {
            name: name.into(),
            paint: Paint::Method(1),
            dashed: false,
            shape: Shape::Line,
            dots: [(0.0, 0.9), (1.0, 0.5), (10.0, 0.05), (100.0, 0.005)].map(dot).to_vec(),
            fit: Some(Fit { ends: [(1.0, 0.5), (100.0, 0.005)], text: "slope \u{2212}1.00".into() }),
        }],
        rules: vec![Rule { value: 1e-3, name: "noise of the reference: 0.100 %".into() }],
        more: vec![("rays".into(), "rays")],
    }
}

/// A page without the library that it carries: what we wrote ourselves.
pub(in crate::report) fn without_library(page: &str) -> String {
    let library = Library::for_charts(true).expect("a library");
    page.replace(library.plotly, "").replace(library.notice, "").replace("http://www.w3.org/2000/svg", "")
}
