//! The error of every form factor of a hemi-cube, split by cause.
//!
//! With `F_pt` the exact value at the hemi-cube's centre, `F` the area average, and a ring for "nothing between":
//!
//! - aliasing = F_cube - F_pt: pixels stand for areas;
//! - proximity = F_pt° - F°: one point stands for the patch;
//! - visibility = (F_pt - F_pt°) - (F - F°): one point stands for what the patch sees past others.
//!
//! They add up to F_cube - F. Of a pair that is wholly hidden, from the centre and from the whole patch, "nothing
//! between" says nothing: all its error is aliasing. The names are those of Baum, Rushmeier and Winget 1989.

/// Rounding of closed forms, absolute and relative: what they are tested to.
pub(super) const ROUNDING: (f64, f64) = (3e-14, 5e-12);

/// Why a form factor of a hemi-cube is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Cause {
    /// A pixel shows one thing and stands for an area.
    Aliasing,
    /// The centre stands for the patch: too near, too large.
    Proximity,
    /// What the centre sees past others stands for what the patch sees.
    Visibility,
}

impl Cause {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Aliasing, Self::Proximity, Self::Visibility];

    /// The one with the largest of some sizes, in the order of [`Cause::ALL`].
    pub fn largest(sizes: &[f64; 3]) -> Self {
        let largest = (0..3).max_by(|a, b| sizes[*a].total_cmp(&sizes[*b]));
        Self::ALL[largest.unwrap_or(0)]
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Aliasing => "aliasing",
            Self::Proximity => "proximity",
            Self::Visibility => "visibility",
        }
    }
}

/// One pair, taken apart.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pair {
    /// As the hemi-cube has it.
    pub cube: f64,
    /// From the centre, exact: what a hemi-cube of infinite resolution would find.
    pub point: f64,
    /// From the centre with nothing between.
    pub open_point: f64,
    /// The area average: the truth.
    pub mean: f64,
    /// Its standard error.
    pub mean_error: f64,
    /// The area average with nothing between.
    pub open_mean: f64,
}

impl Pair {
    /// Hemi-cube minus truth.
    pub fn error(&self) -> f64 {
        self.cube - self.mean
    }

    /// The part that a cause has in it. The three add up to [`Pair::error`].
    pub fn part(&self, cause: Cause) -> f64 {
        match cause {
            Cause::Aliasing => self.cube - self.point,
            Cause::Proximity => self.open_point - self.open_mean,
            Cause::Visibility => (self.point - self.open_point) - (self.mean - self.open_mean),
        }
    }

    /// Standard error of that part.
    pub fn std_err(&self, cause: Cause) -> f64 {
        let rounding = |f: f64| ROUNDING.0 + ROUNDING.1 * f;
        match cause {
            Cause::Aliasing => rounding(self.point),
            Cause::Proximity => rounding(self.open_point).max(rounding(self.open_mean)),
            Cause::Visibility if self.open_point == self.point && self.open_mean == self.mean => {
                rounding(self.open_point)
            }
            Cause::Visibility => self.mean_error.max(rounding(self.open_mean)),
        }
    }

    pub(super) fn scaled(self, by: f64) -> Self {
        Self {
            cube: self.cube * by,
            point: self.point * by,
            open_point: self.open_point * by,
            mean: self.mean * by,
            mean_error: self.mean_error * by,
            open_mean: self.open_mean * by,
        }
    }
}
