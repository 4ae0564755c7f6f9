//! What an audit of environment maps means, in sentences.

use super::record::{EnvmapRecord, FilterRow, Parts};
use crate::stats::Estimate;

/// What the parts are called.
const PARTS: [&str; 3] = [
    "the map itself (texels, filter, table)",
    "parallax (the light at the centre is not the light at the surface)",
    "the object itself, which the map does not hold (what it hides, and the light it sends)",
];

pub(super) fn findings(record: &EnvmapRecord) -> Vec<String> {
    let mut out = vec![over(record), range(record)];
    out.extend(reflection(record));
    out.extend(several(record));
    out.extend(hybrid(record));
    out.extend(filters(&record.filters));
    out.extend(harmonics(record));
    out
}

fn over(record: &EnvmapRecord) -> String {
    let p = &record.irradiance;
    let main = (0..3).max_by(|a, b| p.shares[*a].total_cmp(&p.shares[*b])).filter(|k| p.shares[*k] > 0.5);
    let most = main.map_or(String::new(), |k| format!(" Most of it is {}.", PARTS[k]));
    format!(
        "Irradiance over \"{}\" is wrong by {} (map {}, parallax {}, object {}), on the whole {:+.1} %.{most}",
        record.object,
        shown(p.total.as_ref()),
        shown(p.map.as_ref()),
        shown(p.parallax.as_ref()),
        shown(p.occlusion.as_ref()),
        100.0 * p.bias
    )
}

fn range(record: &EnvmapRecord) -> String {
    let r = &record.range;
    let stated = percent(r.stated);
    let farthest = r.curve.last().map_or(0.0, |a| a.x);
    let metres = |x: Option<f64>| match x {
        Some(x) if x >= farthest => format!("{x:.3} m or farther"),
        Some(x) => format!("{x:.3} m"),
        None => "nowhere".to_string(),
    };
    let between = format!("surely {}, at most {}", metres(r.between[0]), metres(r.between[1]));
    match (r.within, r.curve.first()) {
        (Some(x), _) if r.open => {
            format!(
                "In the open the map's irradiance stays within {stated} up to {x:.3} m, the farthest tried ({between})."
            )
        }
        (Some(x), _) => {
            format!(
                "In the open the map's irradiance stays within {stated} up to {x:.3} m from the centre ({between})."
            )
        }
        (None, Some(first)) if first.parts.total.is_some() => format!(
            "In the open the map's irradiance is beyond {stated} at {:.4} m from its centre already: wrong by {} (map {}, \
             parallax {}).",
            first.x,
            shown(first.parts.total.as_ref()),
            shown(first.parts.map.as_ref()),
            shown(first.parts.parallax.as_ref())
        ),
        (None, _) => "How far from its centre the map can be used is not known: too little light arrives there.".into(),
    }
}

fn reflection(record: &EnvmapRecord) -> Option<String> {
    let (first, last) = (record.reflection.first()?, record.reflection.last()?);
    let of = |p: &Parts| shown(p.total.as_ref());
    Some(format!(
        "Reflections: as a mirror ({} degrees) wrong by {}, of which parallax {}; over a cone of {} degrees by {}.",
        first.x,
        of(&first.parts),
        shown(first.parts.parallax.as_ref()),
        last.x,
        of(&last.parts)
    ))
}

fn several(record: &EnvmapRecord) -> Option<String> {
    let (first, last) = (record.several.first()?, record.several.last()?);
    (last.x > first.x).then(|| {
        format!(
            "With centres in the middles of the parts of its surface, each point served by the nearest: one is wrong by {}, \
             {} are by {}.",
            shown(first.parts.total.as_ref()),
            last.x,
            shown(last.parts.total.as_ref())
        )
    })
}

fn hybrid(record: &EnvmapRecord) -> Option<String> {
    let all: Vec<(f64, &Estimate)> = record.hybrid.iter().filter_map(|h| Some((h.reach, h.total.as_ref()?))).collect();
    let (first, last) = (all.first()?, all.last()?);
    let enough = all.iter().find(|(_, e)| e.value <= record.range.stated);
    let enough = enough.map_or(format!("rays up to {:.3} m do not bring it below", last.0), |(reach, e)| {
        format!("with rays up to {reach:.3} m it is wrong by {}, below", shown(Some(e)))
    });
    Some(format!(
        "The hybrid, rays near by and the map beyond: without rays wrong by {}; {enough} {}.",
        shown(Some(first.1)),
        percent(record.range.stated)
    ))
}

/// The paper's two claims about filters, as they came out here.
fn filters(rows: &[FilterRow]) -> Vec<String> {
    let mean = |of: &dyn Fn(&FilterRow) -> bool, what: fn(&FilterRow) -> Option<f64>| {
        let chosen: Vec<f64> = rows.iter().filter(|r| of(r)).filter_map(what).collect();
        let known = !chosen.is_empty();
        known.then(|| (chosen.iter().map(|x| x * x).sum::<f64>() / chosen.len() as f64).sqrt())
    };
    let told = |x: Option<f64>| x.map_or("unknown".into(), percent);
    if rows.is_empty() {
        return Vec::new();
    }
    let one = |filter: &'static str| {
        let cube = mean(&|r| r.filter == filter && r.layout == "cube", |r| Some(r.error));
        let other = mean(&|r| r.filter == filter && r.layout == "lat-long", |r| Some(r.error));
        let poles = mean(&|r| r.filter == filter && r.layout == "lat-long", |r| r.near_poles);
        format!(
            "By the {} filter, cones of 1 to 16 degrees are wrong by {} in the cube and {} in latitude-longitude ({} near \
             the poles), against exact filtering of the same map.",
            if filter == "box" { "box" } else { "elliptical weighted average" },
            told(cube),
            told(other),
            told(poles)
        )
    };
    vec![one("box"), one("ewa")]
}

fn harmonics(record: &EnvmapRecord) -> Option<String> {
    let table = record.tables.iter().find(|t| t.size == record.table[0]).or(record.tables.last())?;
    Some(format!(
        "Nine spherical harmonics are wrong by {} where a table of {} x {} is wrong by {}: at the centre, without parallax.",
        shown(record.harmonics.as_ref()),
        table.size,
        table.size / 2,
        shown(table.table.as_ref())
    ))
}

fn percent(x: f64) -> String {
    format!("{} %", figures(100.0 * x))
}

fn shown(e: Option<&Estimate>) -> String {
    e.map_or("nothing known".into(), |e| {
        format!("{} % ({} to {})", figures(100.0 * e.value), figures(100.0 * e.low), figures(100.0 * e.high))
    })
}

/// Three significant figures, plain.
fn figures(x: f64) -> String {
    let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    rounded.to_string()
}
