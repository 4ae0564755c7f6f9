//! Matrices with known truth for tests.

use super::{Surroundings, polygon_to_polygon};
use crate::math::{DVec3, unit_normal};
use crate::scene::{Patch, Region};
use crate::solution::FormFactors;
use crate::stats::test_random::Random;

/// Areas alone.
pub fn bare(areas: &[f64], closed: bool) -> Surroundings<'static> {
    Surroundings { areas: areas.to_vec(), closed, patches: &[] }
}

/// A box seen from inside, its edges divided as `k` says: patches, and their exact form factors.
pub fn box_room(size: [f64; 3], k: [usize; 3]) -> (Vec<Patch>, FormFactors) {
    let mut patches = vec![];
    for axis in 0..3 {
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        let step = (size[b] / k[b] as f64, size[c] / k[c] as f64);
        for side in [0.0, size[axis]] {
            for cell in 0..k[b] * k[c] {
                let (u, v) = ((cell % k[b]) as f64 * step.0, (cell / k[b]) as f64 * step.1);
                let at = |p: f64, q: f64| {
                    let mut point = [0.0; 3];
                    (point[axis], point[b], point[c]) = (side, p, q);
                    DVec3::from_array(point)
                };
                let mut corners = vec![at(u, v), at(u + step.0, v), at(u + step.0, v + step.1), at(u, v + step.1)];
                if side > 0.0 {
                    corners.reverse();
                }
                patches.push(patch(corners, step.0 * step.1));
            }
        }
    }
    let row = |a: &Patch| {
        let all = patches.iter().enumerate().map(|(j, b)| (j as u32, polygon_to_polygon(&a.corners, &b.corners)));
        all.filter(|(_, f)| *f > 0.0).collect()
    };
    let f = FormFactors::from_exact_rows(patches.iter().map(row).collect());
    (patches, f)
}

fn patch(corners: Vec<DVec3>, area: f64) -> Patch {
    Patch {
        surface: 0,
        material: 0,
        facet: 0,
        a: 0,
        b: 0,
        normal: unit_normal(&corners),
        area,
        region: Region::whole(corners.clone()),
        corners,
        elements: 0..0,
    }
}

/// The unit cube, `k` x `k` patches per face: areas and exact form factors.
pub fn cube(k: usize) -> (Vec<f64>, FormFactors) {
    let (patches, f) = box_room([1.0; 3], [k; 3]);
    (patches.iter().map(|p| p.area).collect(), f)
}

/// Every entry with independent normal noise of 3 %.
pub fn noisy(truth: &FormFactors, random: &mut Random) -> FormFactors {
    let mut f = truth.clone();
    let errors: Vec<f64> = truth.values.iter().map(|v| 0.03 * v).collect();
    f.values.iter_mut().zip(&errors).for_each(|(v, e)| *v += e * random.normal());
    f.std_err = Some(errors);
    f
}
