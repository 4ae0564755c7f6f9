//! Charts of an error and its parts: against distance, cone angle and number of centres.

use super::super::parts::{errors as parts_of, shares};
use super::{axis, bias, chart, columns, count_cell, dot, errors, limit, line, linear, percent_cell};
use crate::report::chart::{Axis, Chart, Rule, Series, Unit};
use crate::report::format::{count, percent_exact, round_number, significant};
use crate::report::number::UNKNOWN;
use crate::study::envmap::{At, EnvmapRecord, Range};

/// Names and colours: the whole first, then as in [`parts_of`].
const NAMES: [(&str, usize, usize); 4] = [("total", 0, 3), ("map", 1, 0), ("parallax", 2, 1), ("object", 3, 2)];

/// The whole and its parts, each with points, share of the squared error, and bias in further columns. A part of which
/// nothing is known has no point.
fn series(all: &[At], place: &dyn Fn(f64) -> String) -> Vec<Series> {
    let one = |(name, paint, which): (&str, usize, usize)| {
        let of = |a: &At| {
            let mut dot = dot(a.x, parts_of(&a.parts)[which]?, &place(a.x));
            let share = shares(&a.parts).get(which).copied().flatten();
            let bias = if which == 3 { bias(&a.parts) } else { None };
            dot.more = vec![count_cell(a.parts.points), percent_cell(share), percent_cell(bias)];
            Some(dot)
        };
        line(name, paint, all.iter().filter_map(of).collect())
    };
    NAMES.into_iter().map(one).filter(|s| !s.dots.is_empty()).collect()
}

fn parts(
    [stem, title]: [&str; 2],
    caption: String,
    x: Axis,
    all: &[At],
    place: &dyn Fn(f64) -> String,
) -> Option<Chart> {
    let mut chart = chart(stem, title, caption, [x, errors()], series(all, place))?;
    chart.more = columns(&[("points", "points"), ("share", "share of the squared error"), ("bias", "bias")]);
    Some(chart)
}

fn metres(x: f64) -> String {
    format!("at {} m", significant(x, 3))
}

/// How far the error stays below the stated one; a dash where no error is known.
pub(in crate::report::envmap) fn reach(r: &Range) -> String {
    let Some(last) = r.curve.last().map(|a| a.x).filter(|_| r.curve.iter().any(|a| a.parts.total.is_some())) else {
        return UNKNOWN.into();
    };
    let metres = |x: f64| format!("{} m", significant(x, 3));
    let surely = r.between[0].map_or("nowhere".into(), metres);
    let at_most = r.between[1].map_or("nowhere".into(), |x| {
        let farther = if x >= last { " or farther" } else { "" };
        format!("{}{farther}", metres(x))
    });
    let between = format!("surely {surely}, at most {at_most}");
    match r.within {
        Some(x) if x >= last => format!("{} or farther, the farthest tried ({between})", metres(x)),
        Some(x) => format!("{} from the centre ({between})", metres(x)),
        None => format!("nowhere: exceeded from the first distance on ({between})"),
    }
}

/// In the open, against the distance from the centre.
pub(super) fn range(record: &EnvmapRecord) -> Option<Chart> {
    let r = &record.range;
    let caption = format!(
        "In the open, around the first centre, over all directions and normals. Within {}: {}.",
        percent_exact(r.stated),
        reach(r)
    );
    let x = axis("distance from the centre, m", "distance", Unit::Plain);
    let mut chart = parts(["range", "Error against distance from the centre"], caption, x, &r.curve, &metres)?;
    chart.rules = vec![Rule { value: r.stated, name: format!("stated error {}", percent_exact(r.stated)) }];
    Some(chart)
}

/// Over the object, in bands of as many points each.
pub(super) fn bands(record: &EnvmapRecord) -> Option<Chart> {
    let all = &record.by_distance;
    let ends = all.iter().map(|a| a.x).fold((f64::INFINITY, 0.0f64), |(a, b), x| (a.min(x), b.max(x)));
    let mut x = axis("mean distance from the centre that serves the points, m", "distance", Unit::Plain);
    x.scale = linear(ends.0, ends.1);
    let caption = "The same points in bands by distance, and what their errors are made of.".into();
    parts(["by-distance", "Error over the object, by distance"], caption, x, all, &metres)
}

/// Mirror and gloss.
pub(super) fn reflection(record: &EnvmapRecord) -> Option<Chart> {
    let place = |x: f64| format!("in cones of {} degrees", round_number(x));
    let caption =
        "Light in the cone about the mirror direction, from the points that face the camera. Narrow cones are \
                   mirrors; wide ones are gloss."
            .into();
    let x = axis("full opening angle of the cone, degrees", "degrees", Unit::Plain);
    parts(["reflection", "Error of reflections against the cone's angle"], caption, x, &record.reflection, &place)
}

/// Against the number of centres.
pub(super) fn several(record: &EnvmapRecord) -> Option<Chart> {
    let place = |x: f64| format!("with {} {}", count(x as usize), if x == 1.0 { "centre" } else { "centres" });
    let caption = "Centres spread over the object, each point served by the nearest; their maps may have fewer texels \
                   than the one above."
        .into();
    let x = axis("centres", "centres", Unit::Count);
    let mut chart = parts(["centres", "Error against the number of centres"], caption, x, &record.several, &place)?;
    chart.rules = limit(record.limit);
    Some(chart)
}
