//! References that come with the program.

use super::{FileError, StoredReference};
use std::path::Path;

/// A name with the bytes of `references/certified/NAME.zip`.
macro_rules! reference {
    ($name:literal) => {
        ($name, include_bytes!(concat!("../../references/certified/", $name, ".zip")).as_slice())
    };
}

/// Names of built-in scenes with their references, in the order in which they are listed.
const CERTIFIED: &[(&str, &[u8])] = &[
    reference!("cornell-box-coarse"),
    reference!("cornell-box"),
    reference!("furnace-l"),
    reference!("opposed-squares"),
    reference!("edge-squares"),
    reference!("cube-one-emitter"),
    reference!("l-room"),
    reference!("dynamic-cube"),
    reference!("cube-room"),
    reference!("small-lamp"),
    reference!("visibility-only"),
    reference!("furnished-room"),
];

/// Names of the references that come with the program.
pub fn certified_names() -> Vec<&'static str> {
    CERTIFIED.iter().map(|(name, _)| *name).collect()
}

/// The reference of a built-in scene at its final state; `None` where none comes with the program. Verified like any other:
/// every byte against its checksum.
pub fn certified(name: &str) -> Option<Result<StoredReference, FileError>> {
    let (name, bytes) = CERTIFIED.iter().find(|(n, _)| *n == name)?;
    Some(StoredReference::read_archive(Path::new(&format!("builtin:{name}")), bytes))
}
