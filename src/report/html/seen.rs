//! What an eye would see of the error.

use super::context::minus;
use crate::report::asked::Level;
use crate::report::format::{percent, percent_estimate, significant};
use crate::study::Record;
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(super) struct Seen {
    /// How much of the picture is visibly wrong, and where most.
    pub found: String,
    /// How accurate a solution would have to be.
    pub needed: Option<String>,
}

pub(super) fn seen(record: &Record) -> Option<Seen> {
    let s = record.as_seen.as_ref()?;
    let noun = Level::of(record).noun();
    let share = percent_estimate(&s.share, false);
    let interval = share.interval.map_or(String::new(), |i| format!(" ({i})"));
    let signed = |x: f64| format!("{}{}", if x > 0.0 { "+" } else { "" }, significant(x, 3));
    let worst = s.worst.as_ref().map_or(String::new(), |w| {
        format!(" Worst is {noun} {}: {} steps of the display, {} brils.", w.patch, signed(w.steps), signed(w.brils))
    });
    let found = format!(
        "Off by more than one step of the display, of 255, in {}{interval} of the picture.{worst}",
        share.value
    );
    let needed = s.needed.as_ref().map(|n| {
        format!(
            "How accurate does a solution of this scene have to be? For nothing to be seen on this display, its luminance has \
             to be within {} everywhere in sight ({noun} {} is the strictest); half of the picture forgives {}.",
            percent(n.everywhere),
            n.patch,
            percent(n.median)
        )
    });
    Some(Seen { found: minus(&found), needed: needed.map(|n| minus(&n)) })
}
