//! The object point by point: how wrong the map is, against the distance from the centre that serves the point.

use super::{axis, chart, columns, linear, series};
use crate::report::chart::{Cell, Chart, Dot, Paint, Rule, Series, Shape, Unit};
use crate::report::format::{count, percent_exact, significant, with_error};
use crate::study::envmap::{EnvmapRecord, PointRow};

/// Points more wrong than this stand at the upper end.
const TOP: f64 = 2.0;
/// Colours for so many centres.
const CENTRES: usize = 6;

/// Map less truth over truth.
fn off(p: &PointRow) -> f64 {
    (p.map - p.truth) / p.truth
}

fn drawn(p: &PointRow) -> Dot {
    let [at_centre, without, truth] = p.std_err;
    let number = |x: f64| Cell::Number(Some(x), Unit::Plain);
    let off = off(p);
    let hint = format!(
        "{} % at {} m: patch {}, map {} W/m\u{b2}, truth {} W/m\u{b2}",
        with_error(100.0 * off, None),
        significant(p.distance, 3),
        p.patch,
        significant(p.map, 3),
        with_error(p.truth, Some(truth)).trim_start_matches('+')
    );
    let more = vec![
        Cell::Text(p.patch.to_string()),
        Cell::Text((p.centre + 1).to_string()),
        Cell::Number(Some(off), Unit::Percent),
        number(p.map),
        number(p.at_centre),
        number(at_centre),
        number(p.without),
        number(without),
        number(p.truth),
        number(truth),
    ];
    Dot { x: p.distance, y: off.min(TOP), hint, more, ..Dot::default() }
}

/// One colour for each centre, where there are several but not many.
fn by_centre(record: &EnvmapRecord, lit: &[&PointRow]) -> Vec<Series> {
    let centres = record.centres.len();
    let many = lit.iter().any(|p| p.centre >= centres) || !(2..=CENTRES).contains(&centres);
    let cloud = |name: &str, k, of: &dyn Fn(&PointRow) -> bool| {
        let dots = lit.iter().filter(|p| of(p)).map(|p| drawn(p)).collect();
        series(name, Paint::Method(k), Shape::Dots, dots)
    };
    if many {
        return vec![cloud("", 0, &|_| true)];
    }
    (0..centres).map(|k| cloud(&format!("centre {}", k + 1), k, &|p| p.centre == k)).collect()
}

/// Map against truth at every point of the object.
pub(super) fn points(record: &EnvmapRecord) -> Option<Chart> {
    let lit: Vec<&PointRow> = record.points.iter().filter(|p| p.truth > 0.0 && off(p).is_finite()).collect();
    let (above, dark) = (lit.iter().filter(|p| off(p) > TOP).count(), record.points.len() - lit.len());
    let ends = |of: &dyn Fn(&PointRow) -> f64| {
        lit.iter().map(|p| of(p)).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)))
    };
    let mut caption = String::from(
        "Map less truth over truth, one dot a point: above 0 the map is too bright, below 0 too dark. Standard errors of \
         what rays brought stand in the table.",
    );
    if above > 0 {
        caption += &format!(" {} beyond {} stand at the upper end.", count(above), percent_exact(TOP));
    }
    if dark > 0 {
        caption += &format!(" {} without any light are left out.", count(dark));
    }
    let (near, far) = ends(&|p| p.distance);
    let mut x = axis("distance from the centre that serves the point, m", "distance", Unit::Plain);
    x.scale = linear(near, far);
    let (low, high) = ends(&|p| off(p).min(TOP));
    let mut y = axis("(map \u{2212} truth) / truth", "drawn_relative_error", Unit::Percent);
    y.scale = linear(low.min(0.0), high.max(0.0));
    let title = "Error over the object, point by point";
    let mut chart = chart("point-by-point", title, caption, [x, y], by_centre(record, &lit))?;
    chart.rules = vec![Rule { value: 0.0, name: String::new() }];
    chart.more = columns(&[
        ("patch", "patch"),
        ("centre", "centre"),
        ("relative_error", "(map \u{2212} truth) / truth"),
        ("map", "map, W/m\u{b2}"),
        ("at_centre", "at the centre, W/m\u{b2}"),
        ("at_centre_std_err", "its standard error"),
        ("without_object", "without the object, W/m\u{b2}"),
        ("without_object_std_err", "its standard error"),
        ("truth", "truth, W/m\u{b2}"),
        ("truth_std_err", "its standard error"),
    ]);
    Some(chart)
}
