//! Where an error comes from, as lines of a table.

use super::format::percent_estimate;
use crate::metrics::Part;
use crate::stats::Estimate;
use crate::study::Record;

/// (part, share of the light, interval, signed bias, worst patch) of every part that could be told apart.
pub(super) fn split_lines(record: &Record) -> Vec<[String; 5]> {
    let Some(split) = &record.split else { return Vec::new() };
    let parts = [
        ("solver", &split.solver),
        ("form factors", &split.form_factor),
        ("solver and form factors", &split.solver_and_form_factor),
        ("division into patches", &split.discretisation),
        ("form factors and division", &split.form_factor_and_discretisation),
    ];
    parts.into_iter().filter_map(|(name, part)| Some(line(name, part.as_ref()?))).collect()
}

fn line(name: &str, part: &Part) -> [String; 5] {
    let rms = percent_estimate(&part.rms, false);
    let bias = percent_estimate(&Estimate::exact(part.bias), true).value;
    let worst = part.worst.as_ref().map_or(String::new(), |w| format!("worst patch {} on {}", w.patch, w.surface));
    [name.into(), rms.value, rms.interval.unwrap_or_default(), format!("bias {bias}"), worst]
}
