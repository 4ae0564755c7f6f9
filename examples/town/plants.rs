//! Trees of triangles: a trunk, branches, and leaves that do not touch one another.

use super::solid::{Dice, Solids, v};
use etalon::math::DVec3;

const OBJECT: &str = "trees";

/// Half the breadth of a leaf's circle, metres.
const LEAF: f64 = 0.17;

/// Feet of trees that are pictures: place, breadth and height.
pub const PICTURES: [([f64; 3], [f64; 2]); 9] = [
    ([5.2, -7.8, 0.12], [3.6, 4.05]),
    ([11.0, -13.0, 0.12], [5.0, 5.62]),
    ([16.0, -20.0, 0.12], [6.0, 6.75]),
    ([13.0, -9.5, 0.12], [4.4, 4.95]),
    ([22.0, -12.0, 0.12], [6.0, 6.75]),
    ([-5.6, -14.5, 0.12], [3.4, 3.82]),
    ([5.6, 24.0, 0.12], [3.6, 4.05]),
    ([-5.6, 30.0, 0.12], [3.6, 4.05]),
    ([5.6, 44.0, 0.12], [3.8, 4.27]),
];

/// The trees with leaves.
pub fn build(solids: &mut Solids) {
    let mut dice = Dice::new(87);
    for (x, y, height) in [(-5.5, 12.0, 5.2), (5.6, 14.5, 5.0), (9.5, -18.5, 6.0)] {
        tree(solids, &mut dice, v(x, y, 0.12), height);
    }
}

fn tree(solids: &mut Solids, dice: &mut Dice, foot: DVec3, height: f64) {
    let bark = (OBJECT, "bark");
    let fork = foot + DVec3::Z * (0.42 * height);
    solids.prism(bark, [foot, fork], [0.16, 0.11], 7, [true, true]);
    let mut wood = vec![[foot, fork]];
    let crown = foot + DVec3::Z * (0.7 * height);
    for k in 0..4 {
        let angle = std::f64::consts::TAU * (f64::from(k) + dice.within(-0.2, 0.2)) / 4.0;
        let level = v(angle.cos(), angle.sin(), 0.0);
        let from = fork + level * 0.13 + DVec3::Z * 0.05;
        let to = from + level * (0.16 * height) + DVec3::Z * (0.2 * height);
        solids.prism(bark, [from, to], [0.05, 0.02], 5, [true, true]);
        wood.push([from, to]);
    }
    let half = v(0.27, 0.27, 0.29) * height;
    let mut leaves: Vec<DVec3> = Vec::new();
    // So many tries that more would add little.
    for _ in 0..4000 {
        let p = v(dice.within(-1.0, 1.0), dice.within(-1.0, 1.0), dice.within(-1.0, 1.0));
        let centre = crown + p * half;
        let apart = leaves.iter().all(|q| q.distance(centre) > 2.0 * LEAF)
            && wood.iter().all(|ends| distance(centre, *ends) > LEAF + 0.13);
        // Most leaves are outside.
        if !(0.45..1.0).contains(&p.length()) || !apart || leaves.len() == 190 {
            continue;
        }
        leaves.push(centre);
        let axis = v(dice.within(-1.0, 1.0), dice.within(-1.0, 1.0), dice.within(-0.2, 1.0)).normalize_or(DVec3::Z);
        let (a, b) = axis.any_orthonormal_pair();
        let turn = dice.within(0.0, std::f64::consts::TAU);
        let corner = |k: u32| {
            let (s, c) = (turn + std::f64::consts::TAU / 3.0 * f64::from(k)).sin_cos();
            centre + (a * c + b * s) * LEAF
        };
        let leaf = if dice.next() < 0.5 { "leaf" } else { "young-leaf" };
        solids.face((OBJECT, leaf), (0..3).map(corner).collect(), axis);
    }
}

/// Distance of a point from a segment.
fn distance(p: DVec3, [a, b]: [DVec3; 2]) -> f64 {
    let along = (p - a).dot(b - a) / (b - a).length_squared();
    p.distance(a.lerp(b, along.clamp(0.0, 1.0)))
}
