//! How much of a picture each patch or element takes.

use super::{Mesh, Visibility};
use crate::view::Levels;
use rayon::prelude::*;

/// Pixels that one thread counts before it adds up.
const PIXELS_AT_ONCE: usize = 1 << 14;

/// Who is seen, and by how much.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// Share of all pictures together that each cell of a mesh takes; they add to 1 less what is background or back.
    pub shares: Vec<f64>,
}

impl Seen {
    /// The cells of a mesh, its patches or its elements, in these pictures.
    pub fn of<'a>(mesh: &Mesh, pictures: impl IntoIterator<Item = &'a Visibility>) -> Self {
        let (n, mut all) = (mesh.cell_count(), 0u64);
        let mut counts = vec![0u64; n];
        for visibility in pictures {
            let count = |mut counts: Vec<u64>, pixel: usize| {
                for (k, patch) in visibility.samples(pixel).iter().enumerate() {
                    if let Some(point) = visibility.point(mesh.stage(), pixel, k) {
                        counts[mesh.cell_at(*patch as usize, point)] += 1;
                    }
                }
                counts
            };
            // Whole numbers: the sum does not depend on who adds first.
            let of_picture = (0..visibility.pixel_count())
                .into_par_iter()
                .with_min_len(PIXELS_AT_ONCE)
                .fold(|| vec![0; n], count)
                .reduce(|| vec![0; n], |a, b| a.iter().zip(&b).map(|(a, b)| a + b).collect());
            counts.iter_mut().zip(of_picture).for_each(|(sum, n)| *sum += n);
            all += (visibility.pixel_count() * visibility.samples(0).len()) as u64;
        }
        Self { shares: counts.into_iter().map(|n| n as f64 / all.max(1) as f64).collect() }
    }
}

/// What a picture holds, of the luminance (cd/m^2) of each cell and whether it is a lamp. Where nothing can be seen, as
/// dark as can just not be seen.
pub fn picture_levels(seen: &Seen, luminances: impl IntoIterator<Item = f64>, is_lamp: &[bool]) -> Levels {
    let cells = luminances.into_iter().zip(&seen.shares).zip(is_lamp);
    Levels::of(cells.map(|((l, share), lamp)| (l, *share, *lamp))).unwrap_or_else(Levels::dark)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::testing::{room, tracer};

    #[test]
    fn shares_of_a_closed_room_add_to_one_less_backs() {
        let stage = room();
        let seen = Visibility::cast(&tracer(&stage), &stage.cameras[0], 2);
        let shares = Seen::of(&Mesh::of_patches(&stage), [&seen, &seen]).shares;
        let sum: f64 = shares.iter().sum();
        assert!((sum - seen.shares()[0]).abs() < 1e-12, "{sum}");
        let by_coverage: f64 = (0..seen.pixel_count())
            .flat_map(|p| seen.coverage(p))
            .filter(|(patch, _)| *patch == 3)
            .map(|(_, share)| share / seen.pixel_count() as f64)
            .sum();
        assert!((shares[3] - by_coverage).abs() < 1e-12);
    }
}
