//! Why a shooting solver cannot go on.

use crate::methods::hemicube::HemicubeError;
use crate::raycast::KernelError;
use crate::scene::SceneError;

/// Why a shooting solver cannot be had, or refuses an edit. What it had is kept.
#[derive(Debug, thiserror::Error)]
pub enum ShootingError {
    /// The scene, or the scene after an edit, is not sound.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// There is no such ray kernel.
    #[error(transparent)]
    Kernel(#[from] KernelError),
    /// Settings of the hemi-cube.
    #[error(transparent)]
    Hemicube(#[from] HemicubeError),
    /// A setting that cannot be read.
    #[error("{method}: `{text}` is not a setting; settings are {settings}")]
    Setting {
        /// `progressive` or `redistribution`.
        method: &'static str,
        /// What was written.
        text: String,
        /// What can be written.
        settings: String,
    },
    /// The edit brings patches whose numbers were not known when the solver was opened.
    #[error(
        "the edit brings {got} patch numbers where the scene had {expected}; put the new surface into the scene file as \
         a `replace` edit, so that its numbers are known from the start"
    )]
    NewNumbers {
        /// Patches after the edit.
        got: usize,
        /// Patches the solver was opened with.
        expected: usize,
    },
    /// The scene has point lights.
    #[error(
        "the scene has {0} point lights, which shooting does not know; `etalon reference` does, or use an emitting surface"
    )]
    PointLights(usize),
    /// There are no more edits in the scene.
    #[error("all {0} edits of the scene are applied")]
    NoMoreEdits(usize),
    /// Something is selected already.
    #[error("\"{0}\" is selected; drop it before another edit")]
    Selected(String),
    /// Edits that a saved state could not be taken up with.
    #[error("{0} edits were made that the scene file does not have; a state can be saved only with edits of the file")]
    Unsaved(usize),
    /// A saved state of something else.
    #[error("the saved state belongs to {0}")]
    Foreign(&'static str),
    /// A saved state that cannot be.
    #[error("the saved state is damaged ({0})")]
    Damaged(String),
    /// Nothing is selected.
    #[error("no object is selected")]
    NothingSelected,
}
