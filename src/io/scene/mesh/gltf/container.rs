//! The two shapes of a glTF file: JSON, or GLB with the JSON and one buffer inside.

use crate::io::scene::mesh::model::{At, MeshFault};
use std::ops::Range;

const MAGIC: &[u8] = b"glTF";
const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;

/// Where the JSON and the first buffer lie in a GLB file.
pub(super) struct Chunks {
    pub json: Range<usize>,
    pub bin: Option<Range<usize>>,
}

/// True if the file is a GLB, whatever it is called.
pub(super) fn is_glb(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// Finds the chunks of a GLB file.
pub(super) fn chunks(bytes: &[u8]) -> Result<Chunks, MeshFault> {
    let word = |at: usize| bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let fault = |part: &str, message: String, mend: &str| MeshFault::new(At::Part(part.into()), message).mend(mend);
    let cut = "is the file cut short?";
    let (Some(version), Some(length)) = (word(4), word(8)) else {
        return fault("header", format!("the file has {} bytes, fewer than a GLB header", bytes.len()), cut);
    };
    if version != 2 {
        return fault("header", format!("the GLB version is {version}"), "export glTF 2.0");
    }
    if u64::from(length) > bytes.len() as u64 {
        let message = format!("the header says {length} bytes, but the file has {}", bytes.len());
        return fault("header", message, cut);
    }
    let end = length as usize;
    let mut found: Vec<(u32, Range<usize>)> = Vec::new();
    let mut at = 12;
    while at + 8 <= end {
        let (Some(size), Some(kind)) = (word(at), word(at + 4)) else { break };
        let start = at + 8;
        if size as usize > end - start {
            let message = format!("the chunk has {size} bytes, but {} are left", end - start);
            return fault(&format!("chunk {}", found.len()), message, cut);
        }
        at = start + size as usize;
        found.push((kind, start..at));
    }
    match found.as_slice() {
        [(JSON, json), rest @ ..] => {
            let bin = rest.first().filter(|(kind, _)| *kind == BIN).map(|(_, range)| range.clone());
            Ok(Chunks { json: json.clone(), bin })
        }
        [] => fault("chunk 0", "the file has no chunks".into(), cut),
        _ => fault("chunk 0", "the first chunk is not JSON".into(), "is this a GLB file?"),
    }
}
