//! Triangles of primitives: lists, strips and fans, with and without indices.

use super::json::Primitive;
use crate::io::scene::mesh::model::{At, MeshFault};

/// How vertices make triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mode {
    List,
    Strip,
    Fan,
}

impl Mode {
    /// The mode of a primitive; `None` for points and lines.
    pub(super) fn of(primitive: &Primitive, place: &str) -> Result<Option<Self>, MeshFault> {
        match primitive.mode {
            0..=3 => Ok(None),
            4 => Ok(Some(Self::List)),
            5 => Ok(Some(Self::Strip)),
            6 => Ok(Some(Self::Fan)),
            mode => MeshFault::new(At::Part(format!("{place}.mode")), format!("the mode {mode} does not exist"))
                .mend("use 4, 5 or 6: triangles, strip or fan"),
        }
    }
}

/// Corners of all triangles, wound so that fronts stay fronts; `count` vertices or indices.
pub(super) fn triangles(mode: Mode, count: usize, place: &str) -> Result<Vec<[usize; 3]>, MeshFault> {
    if mode == Mode::List && !count.is_multiple_of(3) {
        let message = format!("{count} corners make no whole number of triangles");
        return MeshFault::new(At::Part(place.into()), message).mend("is the mode right? 4 needs three for each");
    }
    Ok(match mode {
        Mode::List => (0..count / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
        // Every other triangle of a strip runs the other way round.
        Mode::Strip => (0..count.saturating_sub(2)).map(|t| [t, t + 1 + t % 2, t + 2 - t % 2]).collect(),
        Mode::Fan => (0..count.saturating_sub(2)).map(|t| [t + 1, t + 2, 0]).collect(),
    })
}
