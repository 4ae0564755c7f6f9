//! The item buffer: which patch shows where, each in a colour of its own.

use super::{Raster, Visibility};
use crate::raycast::{BACK, ESCAPED};

/// Odd, so that multiplying by it mixes 24-bit numbers without ever making two of them one; chosen so that numbers up
/// to 24 apart, which neighbours often are, differ by a fair step in at least one channel.
const SPREAD: u32 = 0x0097_f99d;

/// Eight-bit colour of a patch: different for all of the first 16,777,215 numbers, never black.
pub fn item_colour(patch: u32) -> [u8; 3] {
    let mixed = (patch + 1).wrapping_mul(SPREAD) & 0x00ff_ffff;
    // The leading bits are dealt out to red, green and blue in turn: they decide what the eye tells apart.
    let channel = |c: u32| (0..8).map(|k| (mixed >> (23 - 3 * k - c) & 1) << (7 - k)).sum::<u32>() as u8;
    [channel(0), channel(1), channel(2)]
}

/// The patch in the first sample of each pixel, in its colour; backs black, the background transparent. Nothing is
/// mixed: every colour in the picture is a patch.
pub fn paint_items(visibility: &Visibility) -> Raster {
    let [width, height] = visibility.size();
    let pixel = |p: usize| match visibility.samples(p)[0] {
        ESCAPED => [0; 4],
        BACK => [0, 0, 0, 255],
        patch => {
            let [r, g, b] = item_colour(patch);
            [r, g, b, 255]
        }
    };
    Raster { width, height, rgba: (0..visibility.pixel_count()).flat_map(pixel).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::testing::{room, tracer};
    use std::collections::BTreeSet;

    #[test]
    fn no_two_patches_share_a_colour() {
        let colours: BTreeSet<[u8; 3]> =
            (0..1 << 17).chain((1 << 24) - 1 - (1 << 17)..(1 << 24) - 1).map(item_colour).collect();
        assert_eq!(colours.len(), 1 << 18);
        assert!(!colours.contains(&[0; 3]));
    }

    #[test]
    fn neighbours_differ_to_the_eye() {
        let apart = |a: [u8; 3], b: [u8; 3]| (0..3).map(|c| a[c].abs_diff(b[c])).max().unwrap_or(0);
        let least = |step: u32| (0..40_000).map(|n| apart(item_colour(n), item_colour(n + step))).min().unwrap_or(0);
        assert!((1..=24).all(|step| least(step) >= 16), "{:?}", (1..=24).map(least).collect::<Vec<_>>());
    }

    #[test]
    fn as_many_colours_as_patches_in_sight() {
        let stage = room();
        let seen = Visibility::cast(&tracer(&stage), &stage.cameras[0], 1);
        let raster = paint_items(&seen);
        let colours: BTreeSet<&[u8]> = raster.rgba.chunks(4).collect();
        let patches: BTreeSet<u32> = (0..seen.pixel_count()).map(|p| seen.samples(p)[0]).collect();
        assert_eq!(colours.len(), patches.len());
    }
}
