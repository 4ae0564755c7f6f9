//! Charts over sizes: of the cube, of the table, of the hybrid's reach, of maps turned into other layouts and back.

use super::{axis, chart, columns, dot, errors, exact_dot, limit, line, percent_cell};
use crate::report::chart::{Chart, Dot, Rule, Series, Unit};
use crate::report::format::{count, percent, significant};
use crate::report::number::number;
use crate::study::envmap::{AtReach, AtSize, EnvmapRecord, RoundTripRow};

fn table_line(name: &str, all: &[AtSize], place: &dyn Fn(u32) -> String) -> Series {
    let of = |a: &AtSize| Some(dot(f64::from(a.size), a.table.as_ref()?, &place(a.size)));
    line(name, 0, all.iter().filter_map(of).collect())
}

/// Against the edge of the cube's faces.
pub(super) fn cubes(record: &EnvmapRecord) -> Option<Chart> {
    let place = |size: u32| format!("with faces of {} texels", count(size as usize));
    let convolved = |a: &AtSize| Some(dot(f64::from(a.size), a.convolved.as_ref()?, &place(a.size)));
    let [w, h] = record.table;
    let mut all = vec![table_line(&format!("through the table of {w} \u{d7} {h}"), &record.sizes, &place)];
    all.push(line("convolved for each normal", 1, record.sizes.iter().filter_map(convolved).collect()));
    all.retain(|s| !s.dots.is_empty());
    let caption = "The map's own part, against what arrives at its centre: parallax and object take no part.".into();
    let x = axis("edge of the cube's faces, texels", "size", Unit::Count);
    chart("cube-size", "Error against the size of the cube", caption, [x, errors()], all)
}

/// Against the width of the diffuse map; harmonics across.
pub(super) fn tables(record: &EnvmapRecord) -> Option<Chart> {
    let place = |size: u32| format!("through a table {} wide", count(size as usize));
    let harmonics = number(record.harmonics.as_ref());
    let caption = format!(
        "The same of the cube above, through tables of other sizes, half as high as wide. Nine spherical harmonics \
         instead: {}.",
        harmonics.in_line()
    );
    let x = axis("width of the table", "width", Unit::Count);
    let all = vec![table_line("", &record.tables, &place)];
    let mut chart = chart("table-size", "Error against the size of the diffuse map", caption, [x, errors()], all)?;
    // 0 has no place on a logarithmic axis.
    let rule = record.harmonics.filter(|e| e.value > 0.0);
    chart.rules.extend(rule.map(|e| Rule { value: e.value, name: format!("harmonics {}", percent(e.value)) }));
    Some(chart)
}

/// Against the reach of the hybrid's rays; at 0 there is only the map.
pub(super) fn hybrid(record: &EnvmapRecord) -> Option<Chart> {
    let place = |x: f64| match x {
        0.0 => "with the map alone".to_string(),
        x => format!("with rays up to {} m", significant(x, 3)),
    };
    let of = |h: &AtReach| Some(dot(h.reach, h.total.as_ref()?, &place(h.reach)));
    let all = vec![line("", 0, record.hybrid.iter().filter_map(of).collect())];
    let caption =
        "Rays from the surface as far as the reach, the map as a backdrop beyond. At 0 there is only the map.";
    let x = axis("reach of the rays, m", "reach", Unit::Plain);
    let title = "Error of the hybrid against its reach";
    let mut chart = chart("hybrid", title, caption.into(), [x, errors()], all)?;
    chart.rules = limit(record.limit);
    Some(chart)
}

/// A cube turned into another layout and back.
pub(super) fn round_trips(record: &EnvmapRecord) -> Option<Chart> {
    let mut all: Vec<Series> = Vec::new();
    let of = |r: &RoundTripRow| {
        let place = format!("with faces of {} texels", count(r.size as usize));
        Dot { more: vec![percent_cell(Some(r.energy))], ..exact_dot(f64::from(r.size), r.rms, &place) }
    };
    for r in &record.round_trips {
        match all.iter_mut().find(|s| s.name == r.layout) {
            Some(s) => s.dots.push(of(r)),
            None => all.push(line(r.layout, all.len(), vec![of(r)])),
        }
    }
    let caption =
        "The cube turned into another layout of about as many texels and back, against itself: the change over the \
                   radiance, as root mean squares."
            .into();
    let x = axis("edge of the cube's faces, texels", "size", Unit::Count);
    let mut y = errors();
    y.title = "change, root mean square".into();
    let mut chart = chart("round-trip", "There and back, against size", caption, [x, y], all)?;
    chart.more = columns(&[("energy", "change of the mean radiance")]);
    Some(chart)
}
