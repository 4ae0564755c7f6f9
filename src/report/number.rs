//! A fraction with its interval, as pages show it.

use super::format::percent_estimate;
use super::html::context::minus;
use crate::stats::Estimate;
use serde::Serialize;

/// Where nothing is known.
pub(super) const UNKNOWN: &str = "\u{2013}";

/// A number with its interval.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(super) struct Number {
    pub value: String,
    pub interval: Option<String>,
}

/// An error in percent; a dash where there is none.
pub(super) fn number(e: Option<&Estimate>) -> Number {
    let shown = e.map(|e| percent_estimate(e, false));
    shown.map_or(Number::unknown(), |s| Number { value: minus(&s.value), interval: s.interval.map(|i| minus(&i)) })
}

impl Number {
    pub(super) fn unknown() -> Self {
        Self { value: UNKNOWN.into(), interval: None }
    }

    /// In one line: `1.34 % (1.29 to 1.39 %)`.
    pub(super) fn in_line(&self) -> String {
        self.interval.as_ref().map_or(self.value.clone(), |i| format!("{} ({i})", self.value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_a_dash_and_what_is_exact_has_no_interval() {
        assert_eq!(number(None), Number { value: "\u{2013}".into(), interval: None });
        assert_eq!(number(Some(&Estimate::exact(0.05))).in_line(), "5.00\u{202f}%");
        let e = Estimate { value: 0.013412, std_err: None, low: 0.012911, high: 0.013913 };
        assert_eq!(number(Some(&e)).in_line(), "1.341\u{202f}% (1.291 to 1.391\u{202f}%)");
    }
}
