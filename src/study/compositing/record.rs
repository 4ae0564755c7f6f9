//! The finished record of an audit: numbers and words, no work.

use crate::metrics::Verdict;
use serde::{Deserialize, Serialize};

/// Everything that an audit of compositing found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CompositingRecord {
    /// Name of the scene.
    pub scene: String,
    /// Name of the camera.
    pub camera: String,
    /// Size of the pictures, pixels.
    pub size: [u32; 2],
    /// Faces of the scene, trees included.
    pub faces: usize,
    /// Kernel of the judge.
    pub kernel: String,
    /// Samples per pixel of the judge's pictures.
    pub samples: u64,
    /// Seed of all that is random.
    pub seed: u64,
    /// Edges: one colour a face, by number of sub-scanlines at scale 1.
    pub edges: Vec<EdgeRow>,
    /// Power of the number of sub-scanlines with which the error falls, over `edges` where it is above its noise; `None` where
    /// that cannot be told.
    pub rate: Option<f64>,
    /// The same pictures scaled in both directions.
    pub scaled: Vec<EdgeRow>,
    /// Every light at points in sight.
    pub lights: Vec<LightRow>,
    /// The parts that were scanned by themselves.
    pub clusters: Vec<ClusterRow>,
    /// All parts in one against the whole scene; `None` where there is one part only.
    pub composite: Option<CompositeRow>,
    /// The shaded picture against rays.
    pub picture: PictureRow,
    /// What was found, in words.
    pub findings: Vec<String>,
    /// Limit on the antialiasing error.
    pub limit: Option<f64>,
    /// Sub-scanlines that the limit was held against.
    pub judged_at: u32,
    /// The verdict.
    pub verdict: Option<Verdict>,
}

/// An error over the pixels of a picture: root mean square of the luminance over the judge's mean luminance, the judge's
/// own noise taken off.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rms {
    /// The estimate; 0 where noise is all there is.
    pub value: f64,
    /// Its interval at 95 %.
    pub interval: [f64; 2],
}

/// The edges of one picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EdgeRow {
    /// Sub-scanlines per scanline of the scan, n0.
    pub sub_scanlines: u32,
    /// T_x and T_y.
    pub scale: f64,
    /// Error.
    pub error: Rms,
    /// Share of pixels surely (three standard errors) off by more than a step of an 8-bit display.
    pub off_by_a_step: f64,
    /// Segments of the scan.
    pub segments: usize,
    /// Bytes of its file.
    pub bytes: usize,
    /// Wall-clock time of the scan.
    pub scan_seconds: f64,
    /// Wall-clock time from segments to pixels.
    pub draw_seconds: f64,
}

/// One light, held against rays at points in sight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LightRow {
    /// Its name.
    pub name: String,
    /// Its type: `parallel`, `point`, `linear`, `area`, `polyhedron`, `sky`.
    pub kind: String,
    /// Points compared.
    pub points: usize,
    /// Of these wholly lit.
    pub lit: usize,
    /// Lit in part.
    pub penumbra: usize,
    /// Turned away, or wholly in shadow.
    pub dark: usize,
    /// Root mean square of the difference in irradiance over that of the judge, the judge's noise taken off.
    pub error: f64,
    /// Standard error of the judge in the same unit, root mean square.
    pub noise: f64,
    /// Points that have a standard error.
    pub with_error: usize,
    /// Mean of the squared differences in standard errors over those, what rays may miss of a lamp taken off; at most about
    /// 15 / 13 where all is well (Student t of 15 degrees).
    pub mean_squared_t: Option<f64>,
    /// The largest difference in standard errors, what rays may miss of a lamp (14 over their number) taken off.
    pub worst_t: f64,
    /// What the largest stays below in 999 of 1000 such audits where all is well (Student t of 15 degrees, Bonferroni over
    /// points): nominal, since few hits are not normal.
    pub allowed_t: f64,
    /// Points without a standard error at which the two differ by more than rays can miss.
    pub surely_off: usize,
    /// True if nothing is beyond what is allowed.
    pub within: bool,
    /// Wall-clock time per point of the candidate.
    pub point_seconds: f64,
    /// The same of the judge.
    pub judge_point_seconds: f64,
}

/// One part of the scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ClusterRow {
    /// Its objects.
    pub name: String,
    /// Faces.
    pub faces: usize,
    /// Faces in sight with the others not there.
    pub visible_faces: usize,
    /// Segments.
    pub segments: usize,
    /// Bytes of its file.
    pub bytes: usize,
    /// Wall-clock time of its scan.
    pub seconds: f64,
}

/// Parts in one against the whole.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CompositeRow {
    /// Parts.
    pub clusters: usize,
    /// Orders in which they were composited.
    pub orders: usize,
    /// True if faces and segments were the same to the bit but for shadow edges, in every order.
    pub same_segments: bool,
    /// Largest difference of a pixel of the shaded pictures over the brightest pixel.
    pub worst: f64,
    /// Bytes of the composite's file.
    pub bytes: usize,
    /// Wall-clock time of compositing all once.
    pub seconds: f64,
}

/// The shaded picture against one cast by rays.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PictureRow {
    /// Sub-scanlines.
    pub sub_scanlines: u32,
    /// Lights by name.
    pub lights: Vec<String>,
    /// Error.
    pub error: Rms,
    /// The judge's standard error in the same unit, root mean square over pixels.
    pub noise: f64,
    /// Mean difference over the judge's mean.
    pub bias: f64,
    /// Share of pixels surely off by more than a step of an 8-bit display.
    pub off_by_a_step: f64,
    /// Share of pixels that were traced.
    pub traced: f64,
    /// Most bytes of shadow volumes at a time.
    pub shadow_bytes: usize,
    /// Passes over the image.
    pub passes: usize,
    /// Wall-clock time of scan and shading.
    pub seconds: f64,
    /// Wall-clock time of the judge.
    pub judge_seconds: f64,
    /// Rays of the judge.
    pub judge_rays: u64,
    /// Samples per pixel at which the judge's noise alone would be the candidate's error, estimated by the root of their
    /// number.
    pub equal_samples: Option<f64>,
    /// Time of rays for that, estimated.
    pub equal_seconds: Option<f64>,
}
