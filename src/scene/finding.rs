//! What the scene doctor found: data only, kept with references and shown in reports.

use serde::{Deserialize, Serialize};

/// One thing about a scene that its author should know.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// What kind of thing.
    pub kind: FindingKind,
    /// How much it matters.
    pub severity: Severity,
    /// Where.
    pub place: Place,
    /// What is wrong, one sentence with its numbers.
    pub what: String,
    /// What comes of it; `None` where no number can be had.
    pub consequence: Option<Consequence>,
    /// What to do.
    pub mend: String,
}

/// Kinds of findings, in the order in which they are told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FindingKind {
    /// A mesh was mended while it was read.
    Import,
    /// Sizes that look like another unit than metres.
    Units,
    /// A surface of an enclosure that shows it its back.
    Winding,
    /// The same face twice.
    Duplicate,
    /// Coplanar faces that face the same way and share an area.
    Overlap,
    /// Fronts in contact: areas that take no part.
    Contact,
    /// Light gets out where the scene looks closed.
    Gap,
    /// A vertex inside the edge of a neighbour.
    TJunction,
    /// Backs seen by rays.
    BacksSeen,
    /// The middle of a patch lies inside another object.
    BuriedCentre,
    /// A needle of a patch.
    Sliver,
    /// Nothing emits.
    Dark,
    /// A patch whose light comes through so few rays that it needs many.
    ManyRays,
}

/// How much a finding matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// Legal and handled; worth knowing.
    Note,
    /// Likely not what the author meant, or costly.
    Warning,
    /// Results would be wrong.
    Error,
}

/// Where a finding lies.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Place {
    /// Surfaces concerned.
    pub surfaces: Vec<String>,
    /// Patches concerned, by number: all of them, or the worst first where they are many.
    pub patches: Vec<u32>,
    /// The number that makes each of them worth telling, where there is one: a covered share, a width in metres.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub values: Vec<f64>,
    /// A point to look at, metres.
    pub point: Option<[f64; 3]>,
}

/// What comes of a finding, in a number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Consequence {
    /// One sentence with the number in it.
    pub text: String,
    /// The number: a share, an area, a count of rays.
    pub value: f64,
    /// Its standard error, where it is an estimate.
    pub std_err: Option<f64>,
    /// Its unit: `share`, `m^2`, `rays`, `m`.
    pub unit: String,
}

impl FindingKind {
    /// Name in messages and data.
    pub fn name(self) -> &'static str {
        match self {
            Self::Import => "import",
            Self::Units => "units",
            Self::Winding => "winding",
            Self::Duplicate => "duplicate",
            Self::Overlap => "overlap",
            Self::Contact => "contact",
            Self::Gap => "gap",
            Self::TJunction => "t-junction",
            Self::BacksSeen => "backs-seen",
            Self::BuriedCentre => "buried-centre",
            Self::Sliver => "sliver",
            Self::Dark => "dark",
            Self::ManyRays => "many-rays",
        }
    }
}

impl Severity {
    /// Name in messages and data.
    pub fn name(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}
