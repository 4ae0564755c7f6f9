//! What stands in the empty corners of the cross: the names of the faces, what the colours mean, the inset.

use super::window::{self, Window, line};
use super::{Shown, Wrong};
use crate::render::Raster;
use crate::render::text::{LINE, width as text_width, write};

/// Edge of a sample of colour, pixels; words begin this far to the right of it.
const SAMPLE: u32 = 14;
const WORDS: u32 = 22;

/// Lays a picture over another.
pub(super) fn lay(raster: &mut Raster, over: &Raster, [left, top]: [u32; 2]) {
    for y in 0..over.height {
        let row = 4 * (y * over.width) as usize;
        let to = 4 * ((top + y) as usize * raster.width as usize + left as usize);
        let length = 4 * over.width as usize;
        raster.rgba[to..to + length].copy_from_slice(&over.rgba[row..row + length]);
    }
    rim(raster, [left, top].map(f64::from), f64::from(over.width), 2.0);
}

/// Frames the part of the whole that an inset shows.
pub(super) fn frame(raster: &mut Raster, whole: &Window, part: &Window) {
    let cells = f64::from(part.size) / part.scale;
    rim(raster, whole.place([part.left, part.top]), cells * whole.scale, 1.4);
}

fn rim(raster: &mut Raster, [x, y]: [f64; 2], edge: f64, width: f64) {
    let corners = [[x, y], [x + edge, y], [x + edge, y + edge], [x, y + edge]];
    (0..4).for_each(|k| line(raster, [corners[k], corners[(k + 1) % 4]], width, [0; 3], 0.8));
}

/// Names of the four sides, beside their inner ends in the empty corners.
pub(super) fn face_names(raster: &mut Raster) {
    let (size, corner) = (raster.width, raster.width / 4);
    let beside = 4;
    write(raster, corner - text_width("+y") - beside, beside, "+y");
    write(raster, corner - text_width("-y") - beside, size - LINE, "-y");
    write(raster, beside, corner - LINE, "-x");
    write(raster, size - text_width("+x") - beside, 3 * corner + beside, "+x");
}

/// What the colours mean, from an upper left corner down.
pub(super) fn key(raster: &mut Raster, [left, top]: [u32; 2]) {
    let patch = Shown::Patch { patch: 0, surface: 0 };
    let too_much = Wrong { excess: 0.6, mixed: 0.6 };
    let too_little = Wrong { excess: -0.6, mixed: 0.6 };
    let mixed = Wrong { excess: 0.0, mixed: 0.8 };
    let samples: [(&str, Shown, Wrong); 7] = [
        ("source, as counted", Shown::Source, Wrong::default()),
        ("source: counted too much", Shown::Source, too_much),
        ("source: not counted", patch, too_little),
        ("other patches", patch, Wrong::default()),
        ("shared by several", patch, mixed),
        ("a back: black", Shown::Back, Wrong::default()),
        ("nothing", Shown::Nothing, Wrong::default()),
    ];
    for ((words, shown, wrong), y) in samples.into_iter().zip((top..).step_by(LINE as usize + 6)) {
        sample(raster, [left, y + 1], shown, wrong);
        write(raster, left + WORDS, y, words);
    }
    let y = top + samples_height(7);
    let ends = [[left, y + LINE / 2], [left + SAMPLE, y + LINE / 2]].map(|p| p.map(f64::from));
    line(raster, ends, 2.2, [0; 3], 1.0);
    write(raster, left + WORDS, y, "true silhouette");
}

fn samples_height(count: u32) -> u32 {
    count * (LINE + 6)
}

/// A cell as it is painted, with its rim.
fn sample(raster: &mut Raster, [left, top]: [u32; 2], shown: Shown, wrong: Wrong) {
    let cell = window::cell(shown, wrong, SAMPLE);
    for (k, rgb) in cell.iter().enumerate() {
        let (x, y) = (left + k as u32 % SAMPLE, top + k as u32 / SAMPLE);
        if x < raster.width && y < raster.height {
            let at = 4 * (y as usize * raster.width as usize + x as usize);
            raster.rgba[at..at + 3].copy_from_slice(rgb);
        }
    }
    rim(raster, [left, top].map(f64::from), f64::from(SAMPLE), 1.0);
}
