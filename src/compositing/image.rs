//! The intermediate image: faces, and per sub-scanline the visible segments [NINT89 fig. 2].

use crate::math::DVec3;
use crate::scene::{Appearance, Material};
use crate::view::{Camera, Photometry};
use serde::{Deserialize, Serialize};

/// What one camera sees of some clusters of a scene, by visible segments on every sub-scanline.
#[derive(Debug, Clone, PartialEq)]
pub struct SpanImage {
    /// The camera; its size is that of the picture at scale 1.
    pub camera: Camera,
    /// Sub-scanlines per scanline, n0.
    pub per_line: u32,
    /// Bands and their luminance weights.
    pub photometry: Photometry,
    /// Materials by number: the colour table.
    pub materials: Vec<Material>,
    /// What was scanned, in order of name.
    pub clusters: Vec<Cluster>,
    /// Every face of the clusters, visible or not (hidden ones cast shadows and are mirrored), in order of
    /// [`SpanFace::key`].
    pub faces: Vec<SpanFace>,
    /// Lights, fog, finishes, trees of the scene, to be replaced at will before shading.
    pub appearance: Appearance,
    /// Sub-scanlines at y = j / n0, j = 0..=n0 * height.
    pub lines: Vec<Line>,
}

/// A part of a scene that was scanned by itself.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Cluster {
    /// Its name: that of its objects, joined by `+`.
    pub name: String,
    /// Objects, sorted.
    pub objects: Vec<String>,
    /// SHA-256 of its faces and of the camera, hexadecimal: tells whether it must be scanned again.
    pub hash: String,
}

/// A planar convex polygon of the scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpanFace {
    /// Name of the surface and number of the facet within it: unique in a scene, whatever is scanned with it.
    pub key: (String, u32),
    /// Corners in metres, counter-clockwise seen from the front.
    pub vertices: Vec<DVec3>,
    /// Index into [`SpanImage::materials`].
    pub material: u32,
    /// Index into [`SpanImage::clusters`].
    pub cluster: u32,
    /// Radiates from both sides.
    pub two_sided: bool,
    /// Index into [`Appearance::trees`], where the polygon is a tree turned to the eye.
    pub tree: Option<u32>,
}

/// Reciprocal depth as it changes over the picture: `at + along_x * x + along_y * y`, 1/m; x, y in pixels.
///
/// Depth is measured along the viewing direction. Its reciprocal is linear in the picture, grows towards the eye, and is
/// 0 at infinity, where the background lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthPlane {
    /// Value at the upper left corner.
    pub at: f64,
    /// Slope along a scanline, per pixel.
    pub along_x: f64,
    /// Slope down the picture, per pixel.
    pub along_y: f64,
}

/// A visible segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Where it begins, pixels from the left edge.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// Index into [`SpanImage::faces`].
    pub face: u32,
    /// False where the parallel light of the scene does not reach: shadow edges end segments.
    pub lit: bool,
}

/// One sub-scanline.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Line {
    /// What hides everything behind it, left to right, without overlaps; gaps show the background.
    pub solid: Vec<Span>,
    /// What can be seen through and is not hidden by `solid`: trees and transparent faces, by left end; they may overlap.
    pub over: Vec<Span>,
}
