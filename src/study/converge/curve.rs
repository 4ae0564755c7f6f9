//! Curves as data.

use crate::metrics::Point;
use crate::stats::Estimate;

/// What is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Metric {
    /// Eq. 7 of GSG90.
    Rms,
    /// The same over the 1 % of patches that the last edit changes most.
    Top1,
}

impl Metric {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Rms, Self::Top1];

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rms => "rms",
            Self::Top1 => "top1",
        }
    }
}

/// What an error is held against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// Shots since the edit.
    Shots,
    /// Rays since the edit.
    Rays,
    /// Seconds of computing since the edit.
    Seconds,
}

impl Axis {
    /// All, in order of display.
    pub const ALL: [Self; 3] = [Self::Shots, Self::Rays, Self::Seconds];

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shots => "shots",
            Self::Rays => "rays",
            Self::Seconds => "seconds",
        }
    }

    /// True if it depends on the machine.
    pub fn is_clock(self) -> bool {
        self == Self::Seconds
    }
}

/// One snapshot, judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// Since the beginning of the series.
    pub shots: u64,
    /// Since the beginning of the series.
    pub rays: u64,
    /// Since the beginning of the series.
    pub seconds: f64,
    /// Since the last snapshot of the state before; as above where there is none.
    pub shots_since_edit: u64,
    /// Likewise.
    pub rays_since_edit: u64,
    /// Likewise.
    pub seconds_since_edit: f64,
    /// Eq. 7; `None` where the reference is dark.
    pub rms: Option<Estimate>,
    /// Top 1 %; `None` before the first edit, or where what changes is dark.
    pub top1: Option<Estimate>,
    /// What a perfect solution would read by eq. 7; `None` where the reference states no noise.
    pub noise_floor: Option<f64>,
    /// The same over the top 1 %.
    pub top1_noise_floor: Option<f64>,
}

impl CurvePoint {
    /// Cost since the edit.
    pub fn cost(&self, axis: Axis) -> f64 {
        match axis {
            Axis::Shots => self.shots_since_edit as f64,
            Axis::Rays => self.rays_since_edit as f64,
            Axis::Seconds => self.seconds_since_edit,
        }
    }

    /// The error, where there is one.
    pub fn error(&self, metric: Metric) -> Option<Estimate> {
        match metric {
            Metric::Rms => self.rms,
            Metric::Top1 => self.top1,
        }
    }

    /// The noise floor of that error.
    pub fn floor(&self, metric: Metric) -> Option<f64> {
        match metric {
            Metric::Rms => self.noise_floor,
            Metric::Top1 => self.top1_noise_floor,
        }
    }
}

/// One method in one state of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// What the method is called.
    pub method: String,
    /// Number of edits applied.
    pub edit: usize,
    /// In the order in which they were taken.
    pub points: Vec<CurvePoint>,
}

impl Curve {
    /// The points of one metric against one cost; those without an error left out.
    pub fn against(&self, metric: Metric, axis: Axis) -> Vec<Point> {
        let point =
            |p: &CurvePoint| p.error(metric).map(|error| Point { x: p.cost(axis), error, floor: p.floor(metric) });
        self.points.iter().filter_map(point).collect()
    }

    /// True if the method spends anything on this axis.
    pub fn spends(&self, axis: Axis) -> bool {
        self.points.iter().any(|p| p.cost(axis) > 0.0)
    }
}

/// Curves of equal method and state put together, in order of first appearance: one run per parameter value becomes
/// one curve.
pub fn join(curves: Vec<Curve>) -> Vec<Curve> {
    let mut out: Vec<Curve> = Vec::new();
    for curve in curves {
        match out.iter_mut().find(|c| c.method == curve.method && c.edit == curve.edit) {
            Some(same) => same.points.extend(curve.points),
            None => out.push(curve),
        }
    }
    out
}
