//! The summary a terminal shows.

use super::asked::Level;
use super::format::printable;
use super::headline::{headline, verdict_word, warnings};
use super::lines::{metric_lines, worst_lines, worst_title};
use super::split::split_lines;
use super::{Artifact, Exporter, Extras, ReportError};
use crate::metrics::Verdict;
use crate::study::Record;

/// Plain text without colour.
#[derive(Debug, Clone, Copy, Default)]
pub struct Text;

impl Exporter for Text {
    fn export(&self, record: &Record, _: &Extras) -> Result<Vec<Artifact>, ReportError> {
        Ok(vec![Artifact::new("summary.txt", text_summary(record, false))])
    }
}

/// The one line a log needs: verdict, solution, what it rests on.
pub fn one_line(record: &Record) -> String {
    let head = headline(record);
    let cause = record.causes.first().map_or(String::new(), |c| format!(" Likely cause: {}", c.sentence));
    format!("{} {}{}", head.word, printable(&head.sentence), printable(&cause))
}

/// Verdict, metrics and worst patches; `colour` only paints the verdict and dims what is secondary.
pub fn text_summary(record: &Record, colour: bool) -> String {
    let head = headline(record);
    let mut out = format!("{}  {}\n\n", paint(head.word, hue(head.verdict), colour), printable(&head.sentence));
    let metrics = metric_lines(record).into_iter().map(|l| {
        let limit = l.limit.map(|limit| format!("limit {limit}"));
        let verdict = l.verdict.map(|v| verdict_word(v).to_lowercase());
        [
            printable(&l.key),
            l.value,
            l.interval.unwrap_or_default(),
            limit.unwrap_or_default(),
            verdict.unwrap_or_default(),
        ]
    });
    out += &table(&metrics.collect::<Vec<_>>(), [false, true, false, false, false]);
    for (title, text) in warnings(record) {
        out += &format!("\n{}: {}\n", paint("warning", YELLOW, colour), printable(&format!("{title}. {text}")));
    }
    let parts = split_lines(record);
    if !parts.is_empty() {
        out +=
            &format!("\n{}\n", paint("Where the error comes from (signed parts; their norms do not add)", DIM, colour));
        let parts: Vec<_> = parts.into_iter().map(|p| p.map(|cell| printable(&cell))).collect();
        out += &table(&parts, [false, true, false, false, false]);
    }
    let worst = worst_lines(record);
    if !worst.is_empty() {
        let noun = Level::of(record).noun();
        let columns = [noun, "surface", "reference", "solution", "difference", "in std errs"].map(String::from);
        let rows = worst.into_iter().map(|w| {
            let errors = w.in_std_errs.unwrap_or_default();
            [w.number.to_string(), printable(&w.surface), w.reference, w.solution, w.difference, errors]
        });
        out += &format!("\n{}\n", paint(&worst_title(record), DIM, colour));
        let all: Vec<_> = std::iter::once(columns).chain(rows).collect();
        out += &table(&all, [true, false, true, true, true, true]);
    }
    for notice in &record.notices {
        out += &format!("\n{}: {}\n", paint("note", DIM, colour), printable(notice));
    }
    out
}

const DIM: &str = "2";
const YELLOW: &str = "33";

fn hue(verdict: Option<Verdict>) -> &'static str {
    match verdict {
        Some(Verdict::Pass) => "1;32",
        Some(Verdict::Fail) => "1;31",
        Some(Verdict::Inconclusive) => "1;33",
        None => "1",
    }
}

fn paint(text: &str, code: &str, colour: bool) -> String {
    if colour { format!("\u{1b}[{code}m{text}\u{1b}[0m") } else { text.into() }
}

/// Columns wide enough for their widest cell; those marked flush right.
pub(super) fn table<const N: usize>(rows: &[[String; N]], right: [bool; N]) -> String {
    let wide = |c: usize| rows.iter().map(|r| r[c].chars().count()).max().unwrap_or(0);
    let widths: [usize; N] = std::array::from_fn(wide);
    let cell = |row: &[String; N], c: usize| {
        let (text, w) = (&row[c], widths[c]);
        if right[c] { format!("{text:>w$}") } else { format!("{text:<w$}") }
    };
    let line = |row: &[String; N]| (0..N).map(|c| cell(row, c)).collect::<Vec<_>>().join("  ");
    rows.iter().map(|r| format!("  {}\n", line(r).trim_end())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::testing::with_verdict;

    #[test]
    fn the_summary_is_compact_and_aligned() {
        insta::assert_snapshot!(text_summary(&with_verdict(Verdict::Inconclusive), false));
    }

    #[test]
    fn colour_is_only_added_and_names_bring_none() {
        let mut r = with_verdict(Verdict::Fail);
        r.comparison.worst[0].surface = "\u{1b}[2Jwall".into();
        let plain = text_summary(&r, false);
        assert!(!plain.contains('\u{1b}'));
        assert!(text_summary(&r, true).starts_with("\u{1b}[1;31mFAIL\u{1b}[0m"));
    }
}
