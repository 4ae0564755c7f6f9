//! The radiating sides of the facets of a stage, and their patches.

use crate::math::DVec3;
use crate::scene::{NO_FACET, Patch, Stage};

/// One side of a facet, with the patches on it that take part.
pub(in crate::estimate) struct Side {
    /// The undivided polygon, counter-clockwise seen from the radiating side.
    pub polygon: Vec<DVec3>,
    /// Its facet.
    pub facet: usize,
    /// Numbers of the patches, ascending.
    pub patches: Vec<u32>,
    /// True if a patch on it emits.
    pub emits: bool,
    /// Steps of the grid where all patches are the same parallelogram.
    pub lattice: Option<Lattice>,
}

/// Congruent parallelograms at `origin + a u + b v`.
#[derive(Debug, Clone, Copy)]
pub(in crate::estimate) struct Lattice {
    /// Step from column to column, m.
    pub u: DVec3,
    /// Step from row to row, m.
    pub v: DVec3,
    /// Middle of the first cell.
    pub first: DVec3,
    /// Columns and rows.
    pub size: [u32; 2],
}

/// Corners of a cell may differ by so much of the cell's size.
const CONGRUENT: f64 = 1e-12;

/// All sides that have patches.
pub(in crate::estimate) fn sides(stage: &Stage) -> Vec<Side> {
    let mut patches: Vec<[Vec<u32>; 2]> = vec![Default::default(); stage.facets.len()];
    for (i, patch) in stage.patches.iter().enumerate() {
        if patch.is_present() && patch.facet != NO_FACET {
            let facet = &stage.facets[patch.facet as usize];
            let is_back = facet.first_back_patch.is_some_and(|first| i as u32 >= first);
            // The back of a facet may also be numbered before another facet's front: the normal decides.
            let back = is_back && patch.normal.dot(facet.normal) < 0.0;
            patches[patch.facet as usize][usize::from(back)].push(i as u32);
        }
    }
    let mut out = Vec::new();
    for (number, (facet, [front, back])) in stage.facets.iter().zip(patches).enumerate() {
        for (numbers, turned) in [(front, false), (back, true)] {
            if numbers.is_empty() {
                continue;
            }
            let mut polygon = facet.vertices.clone();
            if turned {
                polygon.reverse();
            }
            let lattice = lattice(stage, &numbers);
            let emits = numbers.iter().any(|i| stage.emission(*i as usize).iter().any(|e| *e > 0.0));
            out.push(Side { polygon, facet: number, patches: numbers, emits, lattice });
        }
    }
    out
}

fn lattice(stage: &Stage, numbers: &[u32]) -> Option<Lattice> {
    let of = |i: u32| &stage.patches[i as usize];
    let first = of(numbers[0]);
    let (a, b) = numbers.iter().fold((0, 0), |(a, b), i| (of(*i).a.max(a), of(*i).b.max(b)));
    let cell = parallelogram(first)?;
    if numbers.len() != (a as usize + 1) * (b as usize + 1) {
        return None;
    }
    // From the far corners: steps that hold over the whole facet, not only in its first cell.
    let last = of(*numbers.last()?);
    let corner = |p: &Patch| p.corners.iter().sum::<DVec3>() / 4.0;
    let along = numbers.iter().find(|i| of(**i).a == a && of(**i).b == 0)?;
    let up = numbers.iter().find(|i| of(**i).a == 0 && of(**i).b == b)?;
    let step = |far: DVec3, n: u32, own: DVec3| if n > 0 { (far - corner(first)) / f64::from(n) } else { own };
    let (u, v) = (step(corner(of(*along)), a, cell[0]), step(corner(of(*up)), b, cell[1]));
    let size = cell[0].length().max(cell[1].length());
    let same = |i: &u32| {
        let p = of(*i);
        let place = corner(first) + u * f64::from(p.a) + v * f64::from(p.b);
        let shape = parallelogram(p);
        place.distance(corner(p)) <= CONGRUENT * size
            && shape.is_some_and(|s| s[0].distance(cell[0]) + s[1].distance(cell[1]) <= CONGRUENT * size)
    };
    (numbers.iter().all(same) && corner(last).is_finite()).then(|| Lattice {
        u,
        v,
        first: corner(first),
        size: [a + 1, b + 1],
    })
}

/// Edge vectors of a patch that is one whole parallelogram.
fn parallelogram(patch: &Patch) -> Option<[DVec3; 2]> {
    let c = &patch.corners;
    if c.len() != 4 || patch.region.pieces.len() != 1 {
        return None;
    }
    let (u, v) = (c[1] - c[0], c[3] - c[0]);
    let size = u.length().max(v.length());
    let whole = (patch.area - u.cross(v).length()).abs() <= CONGRUENT * size * size;
    ((c[2] - c[0]).distance(u + v) <= CONGRUENT * size && whole).then_some([u, v])
}
