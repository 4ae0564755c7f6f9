//! Markdown, for comments on changes and job summaries.

use super::asked::Level;
use super::format::printable;
use super::headline::{headline, verdict_word, warnings};
use super::lines::{MetricLine, WorstLine, metric_lines, worst_lines, worst_title};
use super::split::{READING, budget_lines, noise_sentence};
use super::thumbnail::thumbnail;
use super::{Artifact, Exporter, Extras, ReportError};
use crate::metrics::Verdict;
use crate::study::Record;
use std::fmt::Write;

/// GitHub-flavoured Markdown: verdict, limits drawn, metrics, worst patches, command; and a small picture beside it where
/// the extras have a view.
#[derive(Debug, Clone)]
pub struct Markdown {
    /// File name of the picture, which lies beside the text.
    pub picture: String,
}

impl Default for Markdown {
    fn default() -> Self {
        Self { picture: "summary.png".into() }
    }
}

impl Exporter for Markdown {
    fn export(&self, record: &Record, extras: &Extras) -> Result<Vec<Artifact>, ReportError> {
        let picture = thumbnail(record, extras.views, &self.picture)?;
        let text = markdown(record, picture.as_ref().map(|p| p.name.as_str()));
        Ok(std::iter::once(Artifact::new("summary.md", text)).chain(picture).collect())
    }
}

fn markdown(record: &Record, picture: Option<&str>) -> String {
    let head = headline(record);
    let mut out = format!("### {} {}: {}\n\n", icon(head.verdict), head.word, escape(&record.stage.name));
    let mut push = |text: &str| {
        out.push_str(text);
        out.push_str("\n\n");
    };
    push(&escape(&head.sentence));
    for (title, text) in warnings(record) {
        push(&format!("> **{}.** {}", escape(&title), escape(&text)));
    }
    let lines = metric_lines(record);
    let longest = lines.iter().filter(|l| l.limit_value.is_some()).map(|l| key(&l.key).chars().count()).max();
    let drawn: Vec<String> = lines.iter().filter_map(|l| bar(l, longest.unwrap_or(0))).collect();
    if !drawn.is_empty() {
        push(&format!("```text\n{}\n```", drawn.join("\n")));
    }
    if let Some(name) = picture {
        push(&format!("![Reference, solution and signed difference]({})", name.replace(' ', "%20")));
    }
    push(&metrics(&lines));
    if let Some(text) = budget(record) {
        push(&text);
    }
    let worst = worst_lines(record);
    if !worst.is_empty() {
        push(&folded(&worst_title(record), &worst_table(&worst, Level::of(record).noun())));
    }
    if !record.notices.is_empty() {
        let list: Vec<String> = record.notices.iter().map(|n| format!("- {}", escape(n))).collect();
        push(&folded("Notices", &list.join("\n")));
    }
    let _ = writeln!(out, "Replay: {}", code(&record.replay));
    out
}

/// Cells of a drawn limit.
const CELLS: usize = 48;

/// An interval against its limit, drawn in text, its name filled up to `longest` letters: it shows also where pictures do not. `None` without a limit.
fn bar(line: &MetricLine, longest: usize) -> Option<String> {
    let (e, limit) = (line.estimate?, line.limit_value?);
    let (least, most) = (e.low.min(0.0), e.high.max(limit) * 1.05);
    let cell = |x: f64| (((x - least) / (most - least) * (CELLS - 1) as f64).round() as usize).min(CELLS - 1);
    if most <= least || !most.is_finite() {
        return None;
    }
    let mut cells = [' '; CELLS];
    cells[cell(e.low)..=cell(e.high)].fill('\u{2500}');
    cells[cell(limit)] = '\u{2503}';
    cells[cell(e.value)] = '\u{25cf}';
    let cells: String = cells.iter().collect();
    let limit = line.limit.as_deref().unwrap_or_default();
    Some(format!("{:<longest$} |{cells}| {}, limit {limit}", key(&line.key), line.value))
}

fn icon(verdict: Option<Verdict>) -> &'static str {
    match verdict {
        Some(Verdict::Pass) => "\u{2705}",
        Some(Verdict::Fail) => "\u{274c}",
        Some(Verdict::Inconclusive) => "\u{2754}",
        None => "\u{2139}\u{fe0f}",
    }
}

fn metrics(lines: &[MetricLine]) -> String {
    let mut rows = vec!["| metric | value | interval | limit | |".to_string(), "|---|---:|---:|---:|---|".to_string()];
    rows.extend(lines.iter().map(|l| {
        let cell = |o: &Option<String>| o.clone().unwrap_or_default();
        let verdict = l.verdict.map_or("", verdict_word);
        let (interval, limit) = (cell(&l.interval), cell(&l.limit));
        format!("| {} (`{}`) | {} | {interval} | {limit} | {verdict} |", escape(&l.name), key(&l.key), l.value)
    }));
    rows.join("\n")
}

/// Where the error comes from, part by part with its interval; `None` where it was not split.
fn budget(record: &Record) -> Option<String> {
    let lines = budget_lines(record);
    if lines.is_empty() {
        return None;
    }
    let mut rows = vec![
        "**Where the error comes from**\n".to_string(),
        "| part | value | interval | bias | worst |".into(),
        "|---|---:|---:|---:|---|".into(),
    ];
    rows.extend(lines.iter().map(|[name, value, interval, bias, worst]| {
        let bias = bias.trim_start_matches("bias ");
        format!("| {name} | {value} | {interval} | {bias} | {} |", escape(worst.trim_start_matches("worst ")))
    }));
    rows.push(format!("\n{}", noise_sentence(record).as_deref().unwrap_or(READING)));
    Some(rows.join("\n"))
}

/// A key holds the name of a band, which may be anything.
fn key(text: &str) -> String {
    printable(text).replace(['`', '|'], "_")
}

fn worst_table(lines: &[WorstLine], noun: &str) -> String {
    let mut rows = vec![
        format!("| {noun} | surface | reference | solution | difference | relative | in standard errors |"),
        "|---:|---|---:|---:|---:|---:|---:|".to_string(),
    ];
    rows.extend(lines.iter().map(|w| {
        let cell = |o: &Option<String>| o.clone().unwrap_or_default();
        let (surface, relative, errors) = (escape(&w.surface), cell(&w.relative), cell(&w.in_std_errs));
        format!(
            "| {} | {surface} | {} | {} | {} | {relative} | {errors} |",
            w.number, w.reference, w.solution, w.difference
        )
    }));
    rows.join("\n")
}

fn folded(title: &str, body: &str) -> String {
    format!("<details><summary>{title}</summary>\n\n{body}\n\n</details>")
}

/// Text that no Markdown reader takes for markup, a mention or a link.
fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in printable(text).chars() {
        match c {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            // A word joiner nobody sees keeps a name from being called, an address from becoming a link.
            '@' => out.push_str("@\u{2060}"),
            ':' if out.ends_with("http") || out.ends_with("https") => out.push_str("&#58;"),
            '\\' | '`' | '*' | '_' | '[' | ']' | '|' | '#' | '~' | '$' | '!' => {
                out.push('\\');
                out.push(c);
            }
            _ => out.push(c),
        }
    }
    out
}

/// A code span, or a block where the text is long; its fence is longer than any run of backticks inside.
fn code(text: &str) -> String {
    let text = printable(text);
    let longest = text.split(|c| c != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat((longest + 1).max(3));
    format!("\n\n{fence}sh\n{text}\n{fence}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::testing::{with_split, with_verdict};

    #[test]
    fn a_split_has_a_table_with_intervals_and_the_noise() {
        let mut r = with_split();
        r.split.as_mut().expect("a split").solver.as_mut().expect("a part").worst.as_mut().expect("a patch").surface =
            "a|b <i>".into();
        let text = markdown(&r, None);
        assert!(text.contains("| form factors | 1.10 % | 1.00 to 1.20 % | +0.400 % | patch "), "{text}");
        assert!(text.contains("on a\\|b &lt;i&gt; |") && text.contains("of the squared difference"), "{text}");
        assert!(!markdown(&with_verdict(Verdict::Fail), None).contains("Where the error comes from"));
    }

    #[test]
    fn a_failure_reads_well() {
        insta::assert_snapshot!(markdown(&with_verdict(Verdict::Fail), None));
    }

    #[test]
    fn names_stay_text() {
        let mut r = with_verdict(Verdict::Fail);
        r.stage.name = "<script>alert(1)</script> | [x](http://y) @somebody `z`".into();
        r.replay = "etalon check ```x```".into();
        let text = markdown(&r, Some("a b.png"));
        assert!(text.contains("](a%20b.png)"), "{text}");
        assert!(!text.contains("<script>") && !text.contains("@somebody") && !text.contains("http://"), "{text}");
        assert!(text.contains("\\[x\\]") && text.contains("\\|"), "{text}");
        assert!(text.contains("````sh\netalon check ```x```\n````"), "{text}");
    }
}
