//! What an audit of environment maps has found: data only, ready to be stored, shown and put into words.
//!
//! Errors are relative: `sqrt(sum (map - truth)^2 / sum truth^2)` of luminance over points of equal weight, the noise of
//! the truth taken out, with an interval.

use crate::metrics::Verdict;
use crate::stats::Estimate;
use serde::Serialize;

/// An error and what it is made of. The parts are differences of four quantities in a row, so they add up to the whole
/// at every point; their squares add up only where they are not related.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Parts {
    /// Points it was found over.
    pub points: usize,
    /// Map against truth. `None` where no light arrives.
    pub total: Option<Estimate>,
    /// Of texels, filter and table: map against what arrives at its centre.
    pub map: Option<Estimate>,
    /// Of the place: what arrives at the centre against what arrives at the point, the object taken away.
    pub parallax: Option<Estimate>,
    /// Of the object itself: what it hides from the point, less what it sends there.
    pub occlusion: Option<Estimate>,
    /// Shares of the squared whole that map, parallax and occlusion bring; they add up to 1.
    pub shares: [f64; 3],
    /// Mean of map less truth over the mean of the truth, signed.
    pub bias: f64,
}

/// One point of the object.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PointRow {
    /// Its patch.
    pub patch: u32,
    /// Where, metres.
    pub place: [f64; 3],
    /// Unit normal.
    pub normal: [f64; 3],
    /// From the centre that serves it, metres.
    pub distance: f64,
    /// That centre.
    pub centre: usize,
    /// Irradiance by the map, luminance-weighted, W/m^2.
    pub map: f64,
    /// What arrives at the centre over the same normal.
    pub at_centre: f64,
    /// What arrives at the point with the object taken away.
    pub without: f64,
    /// What arrives at the point: the truth.
    pub truth: f64,
    /// Standard errors of the last three.
    pub std_err: [f64; 3],
}

/// Errors at one value of something.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct At {
    /// Metres, degrees, texels, centres: as the curve says.
    pub x: f64,
    /// The errors there.
    #[serde(flatten)]
    pub parts: Parts,
}

/// How far around the centre the map can be used.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Range {
    /// Error against the distance from the centre, in the open, over all directions and normals; metres.
    pub curve: Vec<At>,
    /// The error that the distance is stated for.
    pub stated: f64,
    /// Distance, metres, within which the error stays below it; `None` where it is exceeded from the first.
    pub within: Option<f64>,
    /// The same of the upper and of the lower ends of the intervals: surely below, not surely above.
    pub between: [Option<f64>; 2],
    /// True where the curve never rises above the stated error: the distance is the longest one tried.
    pub open: bool,
}

/// A fast filter against the exact one in the same map.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FilterRow {
    /// `cube`, `lat-long` (cast in that layout), `lat-long from cube`.
    pub layout: &'static str,
    /// `box` or `ewa`.
    pub filter: &'static str,
    /// Full opening angle of the cone across its shorter axis, degrees.
    pub width: f64,
    /// Longer over shorter axis.
    pub stretch: f64,
    /// Relative error against the exact filter over all directions.
    pub error: f64,
    /// The same of the directions within 30 degrees of the poles; `None` where none was.
    pub near_poles: Option<f64>,
    /// Largest error at any direction, over the root mean square.
    pub worst: f64,
    /// Seconds of one look-up, one thread.
    pub seconds: f64,
    /// Seconds of an exact one.
    pub exact_seconds: f64,
}

/// Error of the map part alone against the size of something.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AtSize {
    /// Edge of the faces, or width of the table.
    pub size: u32,
    /// Through the table, against what arrives at the centre.
    pub table: Option<Estimate>,
    /// Convolved for each normal by itself.
    pub convolved: Option<Estimate>,
}

/// A layout turned into another and back.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RoundTripRow {
    /// Edge of the faces.
    pub size: u32,
    /// The layout in between.
    pub layout: &'static str,
    /// Root mean square over the root mean square radiance.
    pub rms: f64,
    /// Change of the mean radiance.
    pub energy: f64,
}

/// The hybrid: rays up to a reach, the map beyond.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AtReach {
    /// Metres.
    pub reach: f64,
    /// Error of the irradiance.
    pub total: Option<Estimate>,
}

/// Seconds of the parts, and what was done in them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Speed {
    /// What: `cube`, `pyramid`, `diffuse map`.
    pub name: &'static str,
    /// Texels, or look-ups.
    pub count: u64,
    /// Wall clock.
    pub seconds: f64,
}

/// A finished audit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EnvmapRecord {
    /// Scene, as it was named.
    pub scene: String,
    /// The object.
    pub object: String,
    /// World centres, metres.
    pub centres: Vec<[f64; 3]>,
    /// Edge of the cube's faces, texels.
    pub size: u32,
    /// Width and height of the diffuse map.
    pub table: [u32; 2],
    /// What is believed, and how it was come by.
    pub truth: String,
    /// Rays of the truth at each point.
    pub rays: u64,
    /// Confidence of the intervals.
    pub confidence: f64,
    /// Limit on the error of the irradiance over the object.
    pub limit: Option<f64>,
    /// The verdict.
    pub verdict: Option<Verdict>,
    /// Irradiance over the object.
    pub irradiance: Parts,
    /// The same by distance from the centre.
    pub by_distance: Vec<At>,
    /// Point by point.
    pub points: Vec<PointRow>,
    /// Around the first centre.
    pub range: Range,
    /// Mirror and gloss, by the opening angle of the cone, degrees.
    pub reflection: Vec<At>,
    /// Fast filters.
    pub filters: Vec<FilterRow>,
    /// Against the size of the cube.
    pub sizes: Vec<AtSize>,
    /// Against the size of the table.
    pub tables: Vec<AtSize>,
    /// Spherical harmonics of order 2 instead of the table.
    pub harmonics: Option<Estimate>,
    /// Against the number of centres.
    pub several: Vec<At>,
    /// The hybrid.
    pub hybrid: Vec<AtReach>,
    /// Conversions.
    pub round_trips: Vec<RoundTripRow>,
    /// How long it took.
    pub speed: Vec<Speed>,
    /// In words.
    pub findings: Vec<String>,
}
