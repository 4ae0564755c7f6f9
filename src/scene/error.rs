//! What can be wrong with a scene as a whole.

/// Why a scene cannot be set up in a state.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// The state asked for does not exist.
    #[error(
        "there is no state \"{asked}\": the scene has {last} edits; ask for initial, final or a number from 0 to {last}"
    )]
    NoSuchState {
        /// What was asked for.
        asked: String,
        /// Number of the last state.
        last: usize,
    },
    /// No object stands there.
    #[error("nothing stands there in state {state}; a scene needs at least one surface in every state")]
    Empty {
        /// Number of the state.
        state: usize,
    },
    /// An edit or `absent` names an object that no surface belongs to.
    #[error("no surface belongs to the object \"{object}\"; the objects are: {known}")]
    UnknownObject {
        /// The edit, counted from 1; 0 for `[initial]`.
        edit: usize,
        /// The name that is unknown.
        object: String,
        /// The names there are.
        known: String,
    },
    /// An object is added that is there already.
    #[error(
        "edit {edit} adds the object \"{object}\", which stands there already; remove it first, or list it under absent"
    )]
    AlreadyThere {
        /// The edit, counted from 1.
        edit: usize,
        /// Name of the object.
        object: String,
    },
    /// An object is removed that is not there.
    #[error("edit {edit} removes the object \"{object}\", which is not there; add it first, or take it out of absent")]
    NotThere {
        /// The edit, counted from 1.
        edit: usize,
        /// Name of the object.
        object: String,
    },
    /// An edit carries coordinates out of range.
    #[error(
        "edit {edit} leaves the surface \"{surface}\" with coordinates that are not finite or with no area; use smaller numbers"
    )]
    Collapsed {
        /// The edit, counted from 1.
        edit: usize,
        /// Name of the surface.
        surface: String,
    },
    /// Two polygons in one plane face the same way and overlap.
    #[error(
        "surfaces \"{first}\" and \"{second}\" overlap in one plane and radiate to the same side \
         ({area:.3e} m^2 in state {state}); cut one of them back, or move it off the other's plane"
    )]
    SameFacing {
        /// Index of the one that comes first.
        first_index: u32,
        /// Index of the other.
        second_index: u32,
        /// Name of the one that comes first.
        first: String,
        /// Name of the other.
        second: String,
        /// Area of the overlap, m^2.
        area: f64,
        /// Number of the state.
        state: usize,
    },
    /// More patches or elements than numbers or memory allow.
    #[error("the scene has {count} {what}, more than the {limit} that fit; use fewer or larger ones")]
    TooMany {
        /// Patches or elements.
        what: &'static str,
        /// How many there are.
        count: u64,
        /// How many there may be.
        limit: u64,
    },
}
