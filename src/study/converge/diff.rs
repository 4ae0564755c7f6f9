//! Two runs against each other: cost at equal error, error at equal cost.

use super::{Axis, Curve, LEVELS, Metric};
use crate::metrics::Point;

/// Costs at which errors are compared, over the range that both curves cover.
const PLACES: usize = 5;

/// Where two curves are compared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum At {
    /// Costs at this error.
    Error(f64),
    /// Errors at this cost.
    Cost(f64),
}

/// What one curve has there, read between its points on logarithmic axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Side {
    /// Cost or error, as asked.
    pub value: f64,
    /// The same of the lower ends of the errors' intervals; `None` if that is not known.
    pub low: Option<f64>,
    /// The same of the upper ends.
    pub high: Option<f64>,
}

/// Whether the noise of the references may be all there is between two sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Noise {
    /// The intervals lie apart.
    Apart,
    /// The intervals overlap, or one has no end.
    Within,
}

impl Noise {
    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Apart => "apart",
            Self::Within => "within-noise",
        }
    }
}

/// One line of the comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Which method.
    pub method: String,
    /// Number of edits applied.
    pub edit: usize,
    /// Which error.
    pub metric: Metric,
    /// Which cost.
    pub axis: Axis,
    /// Where.
    pub at: At,
    /// Of the first run; `None` where it does not come that far.
    pub first: Option<Side>,
    /// Of the second.
    pub second: Option<Side>,
}

impl Difference {
    /// Second over first.
    pub fn ratio(&self) -> Option<f64> {
        let (first, second) = (self.first?.value, self.second?.value);
        (first > 0.0).then(|| second / first)
    }

    /// What may be said about it; `None` where a side is missing.
    pub fn noise(&self) -> Option<Noise> {
        let (a, b) = (self.first?, self.second?);
        let below = |x: Side, y: Side| matches!((x.high, y.low), (Some(h), Some(l)) if h < l);
        Some(if below(a, b) || below(b, a) { Noise::Apart } else { Noise::Within })
    }
}

/// Compares curves of equal method and state.
pub fn diff(first: &[Curve], second: &[Curve]) -> Vec<Difference> {
    let mut out = Vec::new();
    for a in first {
        let Some(b) = second.iter().find(|b| b.method == a.method && b.edit == a.edit) else { continue };
        for metric in Metric::ALL {
            for axis in Axis::ALL.into_iter().filter(|axis| a.spends(*axis) && b.spends(*axis)) {
                let lines = (Line::new(&a.against(metric, axis)), Line::new(&b.against(metric, axis)));
                let places = common_places(&lines.0, &lines.1).map(At::Cost);
                for at in LEVELS.map(At::Error).into_iter().chain(places) {
                    let side = |line: &Line| line.read(at);
                    let (first, second) = (side(&lines.0), side(&lines.1));
                    if first.is_some() || second.is_some() {
                        let method = a.method.clone();
                        out.push(Difference { method, edit: a.edit, metric, axis, at, first, second });
                    }
                }
            }
        }
    }
    out
}

/// Costs spread evenly, on a logarithmic axis, over what both curves cover; none where they have nothing in common.
fn common_places(a: &Line, b: &Line) -> impl Iterator<Item = f64> + use<> {
    let ends = |l: &Line| l.0.first().zip(l.0.last()).map(|(f, t)| (f.x.ln(), t.x.ln()));
    let range = ends(a).zip(ends(b)).map(|(a, b)| (a.0.max(b.0), a.1.min(b.1))).filter(|(from, to)| from < to);
    let place = |(from, to): (f64, f64)| {
        let step = (to - from) / (PLACES - 1) as f64;
        (0..PLACES).map(move |k| (from + step * k as f64).exp())
    };
    range.map(place).into_iter().flatten()
}

/// A curve on logarithmic axes, by rising cost; points at no cost have no place there.
struct Line(Vec<Point>);

impl Line {
    fn new(points: &[Point]) -> Self {
        let mut points: Vec<Point> = points.iter().copied().filter(|p| p.x > 0.0).collect();
        points.sort_by(|a, b| a.x.total_cmp(&b.x));
        Self(points)
    }

    fn read(&self, at: At) -> Option<Side> {
        let ends: [fn(&Point) -> f64; 3] = [|p| p.error.value, |p| p.error.low, |p| p.error.high];
        let [value, low, high] = ends.map(|of| match at {
            At::Error(level) => self.cost_of(level, of),
            At::Cost(x) => self.error_at(x, of),
        });
        Some(Side { value: value?, low, high })
    }

    /// Error at a cost; `None` beyond the ends.
    fn error_at(&self, x: f64, of: fn(&Point) -> f64) -> Option<f64> {
        // A cost that went through a logarithm and back may miss an end by its last digit.
        let near = |p: &Point| (p.x / x - 1.0).abs() < 1e-12;
        if let Some(p) = self.0.iter().find(|p| near(p)) {
            return Some(of(p));
        }
        let (a, b) = self.0.iter().zip(self.0.iter().skip(1)).find(|(a, b)| a.x <= x && x <= b.x)?;
        let share = (x / a.x).ln() / (b.x / a.x).ln();
        let (from, to) = (of(a), of(b));
        (from > 0.0 && to > 0.0).then(|| from * (to / from).powf(share))
    }

    /// Cost from which on the error stays at or below a level; `None` if it never does, or does from the first
    /// point on: where it came from is not known then.
    fn cost_of(&self, level: f64, of: fn(&Point) -> f64) -> Option<f64> {
        let above = self.0.iter().rposition(|p| of(p) > level)?;
        let (a, b) = (&self.0[above], self.0.get(above + 1)?);
        let (from, to) = (of(a), of(b));
        if to <= 0.0 {
            return Some(b.x);
        }
        Some(a.x * (b.x / a.x).powf((level / from).ln() / (to / from).ln()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Estimate;
    use crate::study::converge::CurvePoint;

    /// error = scale / shots, with 1 % of noise.
    fn curve(scale: f64) -> Curve {
        let point = |k: u32| {
            let shots = 10u64 << k;
            let value = scale / shots as f64;
            let rms = Estimate { value, std_err: Some(0.005 * value), low: 0.99 * value, high: 1.01 * value };
            CurvePoint {
                shots,
                rays: 0,
                seconds: 0.0,
                shots_since_edit: shots,
                rays_since_edit: 0,
                seconds_since_edit: 0.0,
                rms: Some(rms),
                top1: None,
                noise_floor: Some(1e-6),
                top1_noise_floor: None,
            }
        };
        Curve { method: "m".into(), edit: 0, points: (0..8).map(point).collect() }
    }

    #[test]
    fn a_curve_of_twice_the_error_needs_twice_the_shots() {
        let found = diff(&[curve(2.0)], &[curve(4.0)]);
        assert_eq!(found.len(), LEVELS.len() + PLACES);
        for d in &found {
            if d.first.is_none() || d.second.is_none() {
                continue;
            }
            assert!((d.ratio().expect("both") - 2.0).abs() < 1e-9, "{d:?}");
            assert_eq!(d.noise(), Some(Noise::Apart), "{d:?}");
        }
        let at_3 = found.iter().find(|d| d.at == At::Error(0.03)).expect("a line");
        assert!((at_3.first.expect("reached").value - 2.0 / 0.03).abs() < 1e-9);
    }

    #[test]
    fn what_noise_may_have_done_is_told_from_what_it_has_not() {
        let same = diff(&[curve(2.0)], &[curve(2.01)]);
        assert!(same.iter().all(|d| d.noise() == Some(Noise::Within)), "{same:?}");
        let apart = diff(&[curve(2.0)], &[curve(2.1)]);
        assert!(apart.iter().all(|d| d.noise() == Some(Noise::Apart)));
    }

    #[test]
    fn a_level_that_one_run_never_reaches_has_no_ratio() {
        let found = diff(&[curve(2.0)], &[curve(40.0)]);
        let at_1 = found.iter().find(|d| d.at == At::Error(0.01)).expect("a line");
        assert!(at_1.first.is_some() && at_1.second.is_none() && at_1.ratio().is_none() && at_1.noise().is_none());
        assert!(diff(&[curve(2.0)], &[Curve { edit: 1, ..curve(2.0) }]).is_empty());
    }
}
