//! glTF files made in tests.
#![allow(dead_code)]

use base64::Engine;
use serde_json::{Value, json};

/// Corners of the unit square in the plane z = 0 of the file, and its two triangles.
pub const SQUARE: [[f32; 3]; 4] = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
pub const SQUARE_TRIANGLES: [u16; 6] = [0, 1, 2, 0, 2, 3];

/// Positions, then indices.
pub fn bytes(positions: &[[f32; 3]], indices: &[u16]) -> Vec<u8> {
    let mut out: Vec<u8> = positions.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    out.extend(indices.iter().flat_map(|i| i.to_le_bytes()));
    out
}

pub fn data_uri(bytes: &[u8]) -> String {
    format!("data:application/octet-stream;base64,{}", base64::engine::general_purpose::STANDARD.encode(bytes))
}

/// One node that shows one mesh of one primitive; the buffer has no address yet.
pub fn frame(positions: usize, indices: usize) -> Value {
    let (p, i) = (12 * positions, 2 * indices);
    json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": p + i }],
        "bufferViews": [
            { "buffer": 0, "byteLength": p },
            { "buffer": 0, "byteOffset": p, "byteLength": i },
        ],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": positions, "type": "VEC3" },
            { "bufferView": 1, "componentType": 5123, "count": indices, "type": "SCALAR" },
        ],
        "materials": [{ "name": "paint", "pbrMetallicRoughness": { "baseColorFactor": [0.7, 0.6, 0.5, 1] } }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1, "material": 0 }] }],
        "nodes": [{ "mesh": 0 }],
        "scenes": [{ "nodes": [0] }],
        "scene": 0,
    })
}

/// A whole file with its buffer inside.
pub fn embedded(positions: &[[f32; 3]], indices: &[u16]) -> Value {
    let mut root = frame(positions.len(), indices.len());
    root["buffers"][0]["uri"] = data_uri(&bytes(positions, indices)).into();
    root
}

/// The unit square.
pub fn square() -> Value {
    embedded(&SQUARE, &SQUARE_TRIANGLES)
}

/// A GLB file of some chunks.
pub fn glb(json: &[u8], bin: Option<&[u8]>) -> Vec<u8> {
    let mut body = Vec::new();
    let mut chunk = |kind: &[u8; 4], data: &[u8], fill: u8| {
        let padded = data.len().next_multiple_of(4);
        body.extend((padded as u32).to_le_bytes());
        body.extend(kind);
        body.extend(data);
        body.resize(body.len() + padded - data.len(), fill);
    };
    chunk(b"JSON", json, b' ');
    if let Some(bin) = bin {
        chunk(b"BIN\0", bin, 0);
    }
    let mut out = b"glTF".to_vec();
    out.extend(2u32.to_le_bytes());
    out.extend((body.len() as u32 + 12).to_le_bytes());
    out.extend(body);
    out
}

/// The unit square as GLB.
pub fn square_glb() -> Vec<u8> {
    let root = frame(SQUARE.len(), SQUARE_TRIANGLES.len());
    glb(root.to_string().as_bytes(), Some(&bytes(&SQUARE, &SQUARE_TRIANGLES)))
}
