//! What lights the worst patches, as one card each.

use super::context::minus;
use crate::report::asked::Level;
use crate::report::format::{column, column_error, count, percent, places, significant, with_error};
use crate::stats::Estimate;
use crate::study::{Contributions, Record, Source};
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(super) struct Card {
    pub rank: usize,
    pub noun: &'static str,
    pub number: usize,
    pub surface: String,
    /// Where its error is made, in a sentence.
    pub sentence: String,
    pub rows: Vec<SourceRow>,
    pub sum: Term,
    pub reference: Term,
    pub rays: String,
}

#[derive(Debug, Serialize)]
pub(super) struct SourceRow {
    pub name: String,
    pub light: Term,
    /// Share of the sum in words, and as a length in percent.
    pub share: Option<(String, String)>,
    /// Error that it hands on; `None` for its own emission.
    pub handed_on: Option<String>,
}

/// A number with its standard error.
#[derive(Debug, Serialize)]
pub(super) struct Term {
    pub value: String,
    pub std_err: Option<String>,
}

/// One card for each receiver that was explained.
pub(super) fn cards(record: &Record) -> Vec<Card> {
    let noun = Level::of(record).noun();
    record.contributions.iter().enumerate().map(|(k, c)| card(k + 1, noun, c)).collect()
}

fn card(rank: usize, noun: &'static str, c: &Contributions) -> Card {
    let sources: Vec<&Source> = c.sources.iter().chain(&c.others).collect();
    let mut lights: Vec<f64> = sources.iter().map(|s| s.luminance.value).collect();
    lights.extend([c.emission, c.sum.value, c.reference.value]);
    let place = places(&lights);
    let lights = column(&lights, place, false);
    let mut handed: Vec<f64> = sources.iter().map(|s| s.handed_on.value).collect();
    handed.push(c.difference);
    let handed = column(&handed, places(&handed), true);
    let error = |e: &Estimate| e.std_err.filter(|e| *e > 0.0).map(|e| column_error(e, place));
    let term = |k: usize, e: &Estimate| Term { value: minus(&lights[k]), std_err: error(e) };
    let share = |part: Option<f64>| part.map(|p| (minus(&percent(p)), format!("{:.1}", 100.0 * p.clamp(0.0, 1.0))));
    let row = |(k, s): (usize, &&Source)| SourceRow {
        name: match (s.surface.as_str(), s.surfaces) {
            ("", 1) => "1 more surface".into(),
            ("", n) => format!("{n} more surfaces"),
            (name, _) => name.into(),
        },
        light: term(k, &s.luminance),
        share: share(s.share),
        handed_on: Some(minus(&handed[k])),
    };
    let mut rows: Vec<SourceRow> = sources.iter().enumerate().map(row).collect();
    let n = sources.len();
    if c.emission > 0.0 {
        let light = Term { value: lights[n].clone(), std_err: None };
        let part = share((c.sum.value > 0.0).then(|| c.emission / c.sum.value));
        rows.insert(0, SourceRow { name: "its own emission".into(), light, share: part, handed_on: None });
    }
    Card {
        rank,
        noun,
        number: c.receiver,
        surface: c.surface.clone(),
        sentence: minus(&sentence(noun, c)),
        rows,
        sum: term(n + 1, &c.sum),
        reference: term(n + 2, &c.reference),
        rays: count(c.rays as usize),
    }
}

fn sentence(noun: &str, c: &Contributions) -> String {
    let way = if c.difference < 0.0 { "dark" } else { "bright" };
    format!(
        "Too {way} by {}: {} of it is made at this {noun} itself, by its form factors or by the solver; {} is handed on \
         by what it sees.",
        significant(c.difference.abs(), 3),
        with_error(c.own.value, c.own.std_err),
        with_error(c.handed_on.value, c.handed_on.std_err)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::testing::record;

    #[test]
    fn a_card_adds_up_and_says_where_the_error_is_made() {
        let all = cards(&record());
        let card = &all[0];
        assert_eq!((card.rank, card.rows.len()), (1, 3));
        assert_eq!(
            card.sentence,
            "Too bright by 0.0500: +0.0400 \u{b1} 0.0020 of it is made at this patch itself, by its \
             form factors or by the solver; +0.0100 \u{b1} 0.0010 is handed on by what it sees."
        );
        let names: Vec<&str> = card.rows.iter().map(|r| r.name.as_str()).collect();
        assert_eq!(names, ["lamp", "red wall", "3 more surfaces"]);
        let sum: f64 = card.rows.iter().map(|r| r.light.value.parse::<f64>().expect("a number")).sum();
        assert_eq!(card.sum.value, format!("{sum:.3}"));
    }
}
