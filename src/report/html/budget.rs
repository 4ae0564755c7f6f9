//! Where the error comes from, as a table and a chart.

use super::context::minus;
use crate::report::chart::Block;
use crate::report::split::{READING, budget_chart, budget_lines, noise_sentence};
use crate::study::Record;
use serde::Serialize;

/// The budget of an error.
#[derive(Debug, Serialize)]
pub(super) struct Budget {
    pub reading: &'static str,
    /// What share is noise of the reference.
    pub noise: Option<String>,
    pub rows: Vec<BudgetRow>,
    pub chart: Option<Block>,
}

/// A part, or the whole.
#[derive(Debug, Serialize)]
pub(super) struct BudgetRow {
    pub name: String,
    pub value: String,
    pub interval: String,
    pub bias: String,
    pub worst: String,
    pub is_whole: bool,
}

/// `None` where the error was not split.
pub(super) fn budget(record: &Record) -> Option<Budget> {
    let lines = budget_lines(record);
    let row = |[name, value, interval, bias, worst]: [String; 5]| BudgetRow {
        is_whole: name == "the whole error",
        value: minus(&value),
        interval: minus(&interval),
        bias: minus(bias.trim_start_matches("bias ")),
        worst: worst.trim_start_matches("worst ").into(),
        name,
    };
    (!lines.is_empty()).then(|| Budget {
        reading: READING,
        noise: noise_sentence(record).map(|n| minus(&n)),
        rows: lines.into_iter().map(row).collect(),
        chart: budget_chart(record).as_ref().and_then(Block::of),
    })
}
