//! The settings in force, with what differs from the default.

use crate::study::{Part, Record, Setting};
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(super) struct SettingGroup {
    pub title: &'static str,
    pub rows: Vec<SettingRow>,
}

#[derive(Debug, Serialize)]
pub(super) struct SettingRow {
    pub name: String,
    pub value: String,
    /// The default, where the value is another.
    pub instead_of: Option<String>,
}

/// Settings by whose they are.
pub(super) fn settings(record: &Record) -> Vec<SettingGroup> {
    let row = |s: &Setting| SettingRow {
        name: s.name.clone(),
        value: s.value.clone(),
        instead_of: s.default.clone().filter(|_| s.differs()),
    };
    let group =
        |(of, title)| SettingGroup { title, rows: record.settings.iter().filter(|s| s.of == of).map(row).collect() };
    let all = [(Part::Judgement, "Judgement"), (Part::Reference, "Reference"), (Part::Solution, "Solution")];
    all.into_iter().map(group).filter(|g| !g.rows.is_empty()).collect()
}
