//! Radiosities on the patches of a stage as a VTK grid: XML with inline base64, in full precision.

use crate::io::scene::mesh::{ERROR_TAIL, STEM};
use crate::scene::Stage;
use crate::solution::Radiosity;
use base64::Engine;
use std::fmt::Write;

/// The present patches as polygons in metres, z up, with cell data: `radiosity_<band>` in W/m^2,
/// `radiosity_<band>_std_err` where known, and the number of the `patch`. Corners are those of the whole cell, also where
/// some of it is in contact with another surface. Same solution, same bytes.
///
/// # Panics
/// If the radiosities are not one per patch and band of the stage, which is a mistake of the program.
pub fn write_vtu(stage: &Stage, b: &Radiosity) -> Vec<u8> {
    let bands = &stage.photometry.bands;
    assert_eq!((b.len(), b.bands), (stage.patch_count(), bands.len()), "radiosities of the patches");
    let present: Vec<usize> = (0..b.len()).filter(|i| stage.patches[*i].is_present()).collect();
    let corners = |i: &usize| stage.patches[*i].corners.iter();
    let points: Vec<f64> = present.iter().flat_map(corners).flat_map(|p| p.to_array()).map(|x| x + 0.0).collect();
    let sizes: Vec<i64> = present.iter().map(|i| stage.patches[*i].corners.len() as i64).collect();
    let ends = sizes.iter().scan(0, |end, k| {
        *end += k;
        Some(*end)
    });
    let ends: Vec<i64> = ends.collect();
    let count = points.len() / 3;
    let types: Vec<u8> = sizes.iter().map(|k| [5, 9].get(*k as usize - 3).copied().unwrap_or(7)).collect();
    let mut out = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<UnstructuredGrid>\n",
    );
    let _ = writeln!(out, "<Piece NumberOfPoints=\"{count}\" NumberOfCells=\"{}\">", present.len());
    out.push_str("<Points>\n");
    array(&mut out, "Points", "Float64", 3, points.iter().map(|v| v.to_le_bytes()));
    out.push_str("</Points>\n<Cells>\n");
    array(&mut out, "connectivity", "Int64", 1, (0..count as i64).map(i64::to_le_bytes));
    array(&mut out, "offsets", "Int64", 1, ends.into_iter().map(i64::to_le_bytes));
    array(&mut out, "types", "UInt8", 1, types.into_iter().map(u8::to_le_bytes));
    out.push_str("</Cells>\n<CellData>\n");
    for (band, name) in bands.iter().enumerate() {
        let of = |i: &usize| b.of(*i)[band].to_le_bytes();
        array(&mut out, &format!("{STEM}{name}"), "Float64", 1, present.iter().map(of));
    }
    if let Some(errors) = &b.std_err {
        for (band, name) in bands.iter().enumerate() {
            let of = |i: &usize| errors[i * b.bands + band].to_le_bytes();
            array(&mut out, &format!("{STEM}{name}{ERROR_TAIL}"), "Float64", 1, present.iter().map(of));
        }
    }
    array(&mut out, "patch", "Int64", 1, present.iter().map(|i| (*i as i64).to_le_bytes()));
    out.push_str("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
    out.into_bytes()
}

fn array<const N: usize>(
    out: &mut String,
    name: &str,
    kind: &str,
    components: usize,
    items: impl Iterator<Item = [u8; N]>,
) {
    let data: Vec<u8> = items.flatten().collect();
    let mut bytes = (data.len() as u64).to_le_bytes().to_vec();
    bytes.extend(data);
    let name = escaped(name);
    let _ = writeln!(
        out,
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"binary\">"
    );
    base64::engine::general_purpose::STANDARD.encode_string(bytes, out);
    out.push_str("\n</DataArray>\n");
}

/// A name as it can stand in an attribute.
fn escaped(name: &str) -> String {
    let text: String = name.chars().map(|c| if c.is_control() { '_' } else { c }).collect();
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
