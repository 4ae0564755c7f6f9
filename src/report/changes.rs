//! What a solution changed against a baseline, as a table.

use super::format::percent_estimate;
use super::text::table;
use crate::metrics::Change;

/// One line for each metric: before, after, change with its standard error, and how many of these it is.
pub fn change_lines(changes: &[Change]) -> String {
    let head = ["", "before", "after", "change", "in standard errors"].map(String::from);
    let rows = changes.iter().map(|c| {
        let signed = c.metric == "energy";
        let change = c.change.as_ref().map_or(String::new(), |e| match e.std_err {
            Some(_) => {
                let shown = percent_estimate(e, true);
                shown.interval.map_or(shown.value.clone(), |i| format!("{} ({i})", shown.value))
            }
            None => percent_estimate(e, true).value,
        });
        let sigmas = match (c.sigmas, &c.change) {
            (Some(s), _) => format!("{s:+.1}"),
            (None, Some(e)) if e.value == 0.0 => "0".into(),
            (None, _) => "none stated".into(),
        };
        let shown = |e| percent_estimate(e, signed).value;
        [c.metric.clone(), shown(&c.before), shown(&c.after), change, sigmas]
    });
    table(&std::iter::once(head).chain(rows).collect::<Vec<_>>(), [false, true, true, true, true])
}
