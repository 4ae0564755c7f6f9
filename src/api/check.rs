//! The answer of the judge.

use crate::metrics::{Comparison, Decision, Verdict};
use std::fmt;

/// Patches named where a verdict is printed.
const NAMED: usize = 5;

/// Metrics and verdict of one solution. Prints itself in a few lines.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Check {
    /// All metrics with their intervals.
    pub comparison: Comparison,
    /// What became of each limit.
    pub decision: Decision,
}

impl Check {
    pub(super) fn new(comparison: Comparison, decision: Decision) -> Self {
        Self { comparison, decision }
    }

    /// Pass, fail or inconclusive.
    pub fn verdict(&self) -> Verdict {
        self.decision.verdict
    }
}

impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", word(self.verdict()))?;
        for l in &self.decision.limits {
            let e = &l.estimate;
            write!(f, "\n  {} {:.3e} in [{:.3e}, {:.3e}], ", l.metric, e.value, e.low, e.high)?;
            write!(f, "limit {:.3e}: {}", l.limit, word(l.verdict))?;
            match l.rays_factor {
                Some(factor) => write!(f, " (about {factor} times the rays would decide)")?,
                None if l.verdict == Verdict::Inconclusive => write!(f, " (rays alone may never decide)")?,
                None => {}
            }
        }
        for w in self.comparison.worst.iter().take(NAMED) {
            let error = w.std_err.map_or(String::new(), |e| format!(" ± {e:.1e}"));
            write!(f, "\n  patch {} (\"{}\"): ", w.patch, w.surface)?;
            write!(f, "{:.4e} against {:.4e}{error}, difference {:+.1e}", w.solution, w.reference, w.difference)?;
        }
        Ok(())
    }
}

fn word(v: Verdict) -> &'static str {
    match v {
        Verdict::Pass => "pass",
        Verdict::Fail => "fail",
        Verdict::Inconclusive => "inconclusive",
    }
}
