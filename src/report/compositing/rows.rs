//! Tables as the template draws them, cell by cell.

use crate::report::format::{count, percent, significant};
use crate::report::html::context::minus;
use crate::report::number::{Number, UNKNOWN, number};
use crate::stats::Estimate;
use crate::study::compositing::Rms;
use serde::Serialize;

/// A table with what is said of it.
#[derive(Debug, Serialize)]
pub(super) struct Table {
    pub title: &'static str,
    pub lead: &'static str,
    /// Heads of its columns, and whether they hold numbers.
    pub head: Vec<(&'static str, bool)>,
    pub rows: Vec<Vec<Cell>>,
}

/// What stands in a table.
#[derive(Debug, Default, Serialize)]
pub(super) struct Cell {
    pub text: String,
    /// Below it.
    pub small: Option<String>,
    /// Class of its column.
    pub class: &'static str,
    /// Class of a chip around it.
    pub chip: Option<&'static str>,
    /// From the clock: in a marked block of its own.
    pub clock: bool,
}

/// A name; what it is stands below.
pub(super) fn name(text: &str, small: Option<&str>) -> Cell {
    Cell { text: text.into(), small: small.map(String::from), class: "name", ..Cell::default() }
}

pub(super) fn num(text: String) -> Cell {
    Cell { text, class: "num", ..Cell::default() }
}

pub(super) fn counted(n: usize) -> Cell {
    num(count(n))
}

pub(super) fn share(x: f64) -> Cell {
    num(minus(&percent(x)))
}

pub(super) fn dash() -> Cell {
    num(UNKNOWN.into())
}

/// Three figures of `x`, which the clock told; a dash where it told nothing.
pub(super) fn clock(x: Option<f64>, unit: &str) -> Cell {
    let text = x.filter(|x| x.is_finite()).map_or(UNKNOWN.into(), |x| format!("{}{unit}", significant(x, 3)));
    Cell { clock: true, ..num(text) }
}

pub(super) fn yes_or_no(is_well: bool) -> Cell {
    let (text, chip) = if is_well { ("yes", "pass") } else { ("no", "fail") };
    Cell { text: text.into(), chip: Some(chip), class: "label", ..Cell::default() }
}

/// An error with its interval below.
pub(super) fn error(e: &Rms) -> Cell {
    let Number { value, interval } = number(Some(&estimate(e)));
    Cell { small: interval, class: "num big", ..num(value) }
}

/// As all errors of pages are shown.
pub(super) fn estimate(e: &Rms) -> Estimate {
    Estimate { value: e.value, std_err: None, low: e.interval[0], high: e.interval[1] }
}
