//! Who hears the hypotheses and decides.

use super::Cause;
use super::case::Case;
use super::words::percent;

/// A hypothesis with nothing to fit is named from this share of the squared error on, one with fitted numbers and one that
/// is only partly so from these: what can be bent explains more by chance.
const EXPLAINED: f64 = 0.7;
const EXPLAINED_FITTED: f64 = 0.8;
const EXPLAINED_PARTLY: f64 = 0.9;

/// A mistake counts as made in part below this amount.
const WHOLE: f64 = 0.95;
/// Below this amount of a mistake nothing is said.
const LEAST: f64 = 1e-4;

/// Two hypotheses explain alike if one leaves no more than twice what the other leaves, and this share.
const ALIKE: (f64, f64) = (2.0, 0.02);
/// Two changes closer than this share of the squared error are the same in effect.
const SAME: f64 = 0.05;
/// Causes told.
const TOLD: usize = 3;

/// One alternative world.
pub(super) struct Hypothesis {
    /// Hypotheses of one family at one place are variants of each other, no rivals.
    pub family: &'static str,
    pub kind: &'static str,
    pub place: Option<String>,
    /// Numbers fitted.
    pub parameters: usize,
    pub sentence: String,
    /// True if the mistake may be made in part, which is then fitted.
    pub partly: bool,
}

/// A hypothesis that explains enough.
struct Found {
    family: &'static str,
    parameters: usize,
    /// Share of the squared error of all bands that is left.
    left: f64,
    change: Vec<f64>,
    cause: Cause,
}

/// Hears hypotheses and keeps those that explain enough.
pub(super) struct Jury<'a> {
    pub case: &'a Case<'a>,
    found: Vec<Found>,
}

impl<'a> Jury<'a> {
    pub fn new(case: &'a Case<'a>) -> Self {
        Self { case, found: Vec::new() }
    }

    /// Hears one hypothesis: `change` is what it makes of the truth, patches x bands.
    pub fn hear(&mut self, hypothesis: Hypothesis, change: Vec<f64>) {
        let amount = if hypothesis.partly { self.case.amount(&change) } else { 1.0 };
        let needed = if hypothesis.parameters == 0 { EXPLAINED } else { EXPLAINED_FITTED };
        if self.keep(&hypothesis, needed, &change, None) || !(LEAST..WHOLE).contains(&amount) {
            return;
        }
        let part: Vec<f64> = change.iter().map(|d| amount * d).collect();
        self.keep(&hypothesis, EXPLAINED_PARTLY, &part, Some(amount));
    }

    /// Keeps a hypothesis if it explains what is needed.
    fn keep(&mut self, hypothesis: &Hypothesis, needed: f64, change: &[f64], amount: Option<f64>) -> bool {
        let left = self.case.left(change);
        if left.luminance.max(left.bands) > 1.0 - needed {
            return false;
        }
        let sentence = match amount {
            None => hypothesis.sentence.clone(),
            Some(t) => format!("{}, to {}", hypothesis.sentence, percent(t)),
        };
        let cause = Cause {
            kind: hypothesis.kind.to_string(),
            sentence,
            place: hypothesis.place.clone(),
            explains: 1.0 - left.luminance,
            left: self.case.rms_of(left.luminance),
        };
        let parameters = hypothesis.parameters + usize::from(amount.is_some());
        let family = hypothesis.family;
        self.found.push(Found { family, parameters, left: left.bands, change: change.to_vec(), cause });
        true
    }

    /// The least share of the squared error that a hypothesis has left so far.
    pub fn least_left(&self) -> f64 {
        self.found.iter().map(|f| f.left).fold(1.0, f64::min)
    }

    /// The causes, best first; none where the best ones contradict each other.
    pub fn verdict(mut self) -> Vec<Cause> {
        // Of those that leave alike the one with fewer numbers fitted, and of those the one that leaves least.
        let alike = ALIKE.0 * self.least_left() + ALIKE.1;
        let rank = |f: &Found| if f.left <= alike { f.parameters } else { usize::MAX };
        self.found.sort_by(|a, b| rank(a).cmp(&rank(b)).then(a.left.total_cmp(&b.left)));
        let Some(first) = self.found.first() else { return Vec::new() };
        let rival = |f: &Found| {
            let other = f.family != first.family || f.cause.place != first.cause.place;
            rank(f) == first.parameters && other && self.case.apart(&f.change, &first.change) > SAME
        };
        if self.found.iter().any(rival) {
            return Vec::new();
        }
        let mut told: Vec<Cause> = Vec::new();
        for f in self.found {
            let again = told.iter().any(|c| c.kind == f.cause.kind && c.place == f.cause.place);
            if !again && told.len() < TOLD {
                told.push(f.cause);
            }
        }
        told
    }
}
