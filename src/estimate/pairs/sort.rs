//! Sorting pairs: proved visible, proved unseen, perhaps hidden in part, or left to rays.

use super::congruent::Congruent;
use super::sides::{Side, sides};
use super::{Coverage, PairPlan};
use crate::formfactor::{facing, polygon_to_polygon};
use crate::math::{Bounds, BoxTree, DVec3, Polytope};
use crate::raycast::{Between, Bodies, Shaft, bodies};
use crate::scene::Stage;
use rayon::prelude::*;

/// What reaches into a shaft by less than this share of the scene's extent touches it.
const TOUCHING: f64 = 1e-11;

/// A pair that is seen wholly, were it not for some bodies.
#[derive(Debug)]
pub(super) struct Pair {
    /// The patch with the lower side.
    pub from: u32,
    /// The other.
    pub to: u32,
    /// `A F` with nothing between, m^2.
    pub open: f64,
    /// Bodies that may stand between, by number; none where the pair is visible.
    pub between: Vec<u32>,
}

/// All pairs of a stage, sorted.
pub(super) struct Sorted {
    /// What can hide.
    pub bodies: Vec<Polytope>,
    /// Pairs that exchange something with nothing between.
    pub pairs: Vec<Pair>,
    /// Pairs left to rays one by one.
    pub left: Vec<(u32, u32)>,
    /// Patches on emitting sides, where only their pairs are covered.
    pub covered: Option<Vec<bool>>,
    /// Number of pairs that are not covered.
    pub uncovered: u64,
    /// Pairs proved not to see each other.
    pub unseen: u64,
}

/// Sorts all pairs. `progress` is told how many patches are done.
pub(super) fn sort(stage: &Stage, plan: &PairPlan, progress: &(dyn Fn(u64) + Sync)) -> Sorted {
    let Bodies { list: bodies, of_facet } = bodies(stage);
    let (lo, hi) = stage.bounds();
    let touching = TOUCHING * (hi - lo).length();
    let tree = BoxTree::new(bodies.iter().map(|b| Bounds::of(b.vertices()).grown(touching)).collect());
    let scene = Scene { stage, sides: sides(stage), bodies, of_facet, tree, touching, plan: *plan };
    let of_side = |s: usize| {
        let found = scene.side(s);
        progress(scene.sides[s].patches.len() as u64);
        found
    };
    let found: Vec<Vec<Found>> = (0..scene.sides.len()).into_par_iter().map(of_side).collect();
    let covered = (plan.coverage == Coverage::Emitters).then(|| scene.covered());
    let (bodies, pairs, left) = (scene.bodies, Vec::new(), Vec::new());
    let mut sorted = Sorted { bodies, pairs, left, covered, uncovered: 0, unseen: 0 };
    for part in found.into_iter().flatten() {
        sorted.pairs.extend(part.pairs);
        sorted.left.extend(part.left);
        sorted.uncovered += part.uncovered;
        sorted.unseen += part.unseen;
    }
    sorted
}

/// Everything pairs are sorted by.
struct Scene<'a> {
    stage: &'a Stage,
    sides: Vec<Side>,
    bodies: Vec<Polytope>,
    of_facet: Vec<Option<u32>>,
    tree: BoxTree,
    touching: f64,
    plan: PairPlan,
}

/// What the pairs of one patch came to.
#[derive(Default)]
struct Found {
    pairs: Vec<Pair>,
    left: Vec<(u32, u32)>,
    uncovered: u64,
    unseen: u64,
}

/// A later side, and what stands before it.
struct Ahead {
    side: usize,
    between: Between,
    alike: Option<Congruent>,
}

impl Scene<'_> {
    /// The pairs of one side with all later sides, patch by patch.
    fn side(&self, s: usize) -> Vec<Found> {
        let side = &self.sides[s];
        let (mut unseen, mut uncovered, mut ahead) = (0, 0, Vec::new());
        for t in s + 1..self.sides.len() {
            let other = &self.sides[t];
            let pairs = (side.patches.len() * other.patches.len()) as u64;
            if self.plan.coverage == Coverage::Emitters && !side.emits && !other.emits {
                uncovered += pairs;
                continue;
            }
            match self.between_sides(side, other) {
                None | Some(Between::Wall) => unseen += pairs,
                Some(between) => ahead.push(Ahead { side: t, between, alike: Congruent::of(side, other) }),
            }
        }
        let mut found: Vec<Found> = side.patches.par_iter().map(|i| self.patch(*i, s, &ahead)).collect();
        found.push(Found { unseen, uncovered, ..Found::default() });
        found
    }

    /// The patches on emitting sides.
    fn covered(&self) -> Vec<bool> {
        let mut covered = vec![false; self.stage.patch_count()];
        self.sides.iter().filter(|s| s.emits).flat_map(|s| &s.patches).for_each(|i| covered[*i as usize] = true);
        covered
    }

    /// What stands between two sides; `None` if neither lies before the other.
    fn between_sides(&self, one: &Side, other: &Side) -> Option<Between> {
        let (a, b) = facing(&one.polygon, &other.polygon)?;
        let mut near = Vec::new();
        self.tree.near(&Bounds::of(&a).joined(Bounds::of(&b)), |k| near.push(k));
        let own = [self.of_facet[one.facet], self.of_facet[other.facet]];
        near.retain(|k| !own.contains(&Some(*k)));
        near.sort_unstable();
        Some(Shaft::new(&a, &b, self.touching).between(&self.bodies, near.into_iter()))
    }

    /// The same of two polygons, where only the bodies of a list can stand between.
    fn between(&self, a: &[DVec3], b: &[DVec3], list: &[u32]) -> Option<Between> {
        let (a, b) = facing(a, b)?;
        Some(Shaft::new(&a, &b, self.touching).between(&self.bodies, list.iter().copied()))
    }

    /// The pairs of one patch with the sides ahead.
    fn patch(&self, i: u32, s: usize, ahead: &[Ahead]) -> Found {
        let corners = &self.stage.patches[i as usize].corners;
        let mut found = Found::default();
        for a in ahead {
            let other = &self.sides[a.side];
            let narrowed = match &a.between {
                Between::Some(list) if self.sides[s].patches.len() > 1 && other.patches.len() > 1 => {
                    self.between(corners, &other.polygon, list)
                }
                all => Some(all.clone()),
            };
            for j in &other.patches {
                let between = match &narrowed {
                    Some(Between::Some(list)) => self.between(corners, &self.stage.patches[*j as usize].corners, list),
                    all => all.clone(),
                };
                self.put(i, *j, s, a, between, &mut found);
            }
        }
        found
    }

    fn put(&self, i: u32, j: u32, s: usize, ahead: &Ahead, between: Option<Between>, found: &mut Found) {
        let between = match between {
            None | Some(Between::Wall) => {
                found.unseen += 1;
                return;
            }
            Some(Between::Nothing) => Vec::new(),
            Some(Between::Some(few)) if few.len() > self.plan.most_bodies => {
                found.left.push((i, j));
                return;
            }
            Some(Between::Some(few)) => few,
        };
        let open = self.open(i, j, s, ahead);
        if open > 0.0 {
            found.pairs.push(Pair { from: i, to: j, open, between });
        } else {
            found.unseen += 1;
        }
    }

    /// The exchange of a pair were nothing between, m^2.
    fn open(&self, i: u32, j: u32, s: usize, ahead: &Ahead) -> f64 {
        let of = |k: u32| &self.stage.patches[k as usize];
        let closed = |i: u32, j: u32| {
            let mut sum = 0.0;
            for p in &of(i).region.pieces {
                let area = crate::math::area(p);
                sum += of(j).region.pieces.iter().map(|q| area * polygon_to_polygon(p, q)).sum::<f64>();
            }
            sum
        };
        match &ahead.alike {
            Some(table) => {
                let (first, second) = (&self.sides[s].patches, &self.sides[ahead.side].patches);
                table.get(of(i), of(j), |p, q| closed(first[p], second[q]))
            }
            None => closed(i, j),
        }
    }
}
