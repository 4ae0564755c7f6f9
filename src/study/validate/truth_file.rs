//! The form factors of `references/truth/form_factors.json`, as data.

use crate::math::DVec3;
use serde::Deserialize;

/// The file, part of the program.
const TEXT: &str = include_str!("../../../references/truth/form_factors.json");

#[derive(Deserialize)]
struct File {
    cases: Vec<Case>,
}

/// One case: two surfaces, what stands between, and the exact values.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Case {
    pub id: String,
    pub citation: String,
    pub surface1: Shape,
    pub surface2: Shape,
    pub blockers: Vec<Shape>,
    pub values: Values,
}

/// Form factors as decimals of 21 digits.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Values {
    #[serde(rename = "F12")]
    pub there: String,
    /// None from an element, which has no area.
    #[serde(rename = "F21")]
    pub back: Option<String>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub(super) enum Shape {
    Polygon { vertices: Vec<DVec3> },
    Disk { center: DVec3, normal: DVec3, radius: f64 },
    Annulus { center: DVec3, normal: DVec3, inner_radius: f64, outer_radius: f64 },
    Point { position: DVec3, normal: DVec3 },
    Sphere { center: DVec3, radius: f64, side: Side },
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Side {
    Inside,
    Outside,
}

/// All cases, in the order of the file.
pub(super) fn cases() -> Vec<Case> {
    // The text is part of the program, and a test reads it.
    serde_json::from_str::<File>(TEXT).map(|f| f.cases).unwrap_or_default()
}
