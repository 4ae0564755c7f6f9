//! A tree of bounding boxes: which facets lie near a box, which along a ray.

use crate::math::DVec3;

/// An axis-aligned box.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    pub lo: DVec3,
    pub hi: DVec3,
}

impl Bounds {
    const NOTHING: Self = Self { lo: DVec3::INFINITY, hi: DVec3::NEG_INFINITY };

    pub(super) fn of(points: &[DVec3]) -> Self {
        points.iter().fold(Self::NOTHING, |b, p| Self { lo: b.lo.min(*p), hi: b.hi.max(*p) })
    }

    pub(super) fn grown(self, by: f64) -> Self {
        Self { lo: self.lo - by, hi: self.hi + by }
    }

    fn joined(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    pub(super) fn meets(&self, other: &Self) -> bool {
        self.lo.cmple(other.hi).all() && other.lo.cmple(self.hi).all()
    }

    /// True if the ray passes through the box before `t_max`.
    fn on_ray(&self, origin: DVec3, inverse: DVec3, t_max: f64) -> bool {
        let (a, b) = ((self.lo - origin) * inverse, (self.hi - origin) * inverse);
        let (near, far) = (a.min(b).max_element(), a.max(b).min_element());
        near <= far && far >= 0.0 && near <= t_max
    }
}

struct Node {
    bounds: Bounds,
    /// Leaf: range into `order`. Inner node: `count` 0, children at the next place and at `start`.
    start: u32,
    count: u32,
}

/// Boxes by place, halved along their longest spread.
pub(super) struct BoxTree {
    nodes: Vec<Node>,
    order: Vec<u32>,
    boxes: Vec<Bounds>,
}

const LEAF: usize = 4;

impl BoxTree {
    pub(super) fn new(boxes: Vec<Bounds>) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..boxes.len() as u32).collect(), boxes };
        if !tree.boxes.is_empty() {
            tree.split(0, tree.boxes.len());
        }
        tree
    }

    fn split(&mut self, from: usize, to: usize) -> u32 {
        let boxes = &self.boxes;
        let part = &mut self.order[from..to];
        let bounds = part.iter().fold(Bounds::NOTHING, |b, i| b.joined(boxes[*i as usize]));
        let at = self.nodes.len();
        self.nodes.push(Node { bounds, start: from as u32, count: (to - from) as u32 });
        if to - from > LEAF {
            let middle = |i: &u32| boxes[*i as usize].lo + boxes[*i as usize].hi;
            let spread = Bounds::of(&part.iter().map(middle).collect::<Vec<_>>());
            let axis = (spread.hi - spread.lo).max_position();
            let half = part.len() / 2;
            // Ties by number, so that the tree is the same everywhere.
            part.select_nth_unstable_by(half, |i, j| middle(i)[axis].total_cmp(&middle(j)[axis]).then(i.cmp(j)));
            self.split(from, from + half);
            let right = self.split(from + half, to);
            self.nodes[at].start = right;
            self.nodes[at].count = 0;
        }
        at as u32
    }

    fn walk(&self, mut enter: impl FnMut(&Bounds) -> bool, mut visit: impl FnMut(u32)) {
        let mut stack = if self.nodes.is_empty() { Vec::new() } else { vec![0u32] };
        while let Some(at) = stack.pop() {
            let node = &self.nodes[at as usize];
            if !enter(&node.bounds) {
                continue;
            }
            if node.count == 0 {
                stack.extend([node.start, at + 1]);
            } else {
                self.order[node.start as usize..][..node.count as usize].iter().for_each(|i| visit(*i));
            }
        }
    }

    /// Calls `visit` for every box that meets `bounds`.
    pub(super) fn near(&self, bounds: &Bounds, mut visit: impl FnMut(u32)) {
        self.walk(
            |b| b.meets(bounds),
            |i| {
                if self.boxes[i as usize].meets(bounds) {
                    visit(i);
                }
            },
        );
    }

    /// Calls `visit` for boxes on the ray, which returns how far is still of interest.
    pub(super) fn along(&self, origin: DVec3, direction: DVec3, mut visit: impl FnMut(u32) -> f64) {
        let inverse = direction.recip();
        let reach = std::cell::Cell::new(f64::INFINITY);
        self.walk(|b| b.on_ray(origin, inverse, reach.get()), |i| reach.set(visit(i)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(n: usize) -> BoxTree {
        BoxTree::new((0..n).map(|i| Bounds { lo: DVec3::splat(i as f64), hi: DVec3::splat(i as f64 + 0.5) }).collect())
    }

    #[test]
    fn finds_what_is_near_and_nothing_else() {
        let mut found = Vec::new();
        row(100).near(&Bounds { lo: DVec3::splat(10.2), hi: DVec3::splat(12.1) }, |i| found.push(i));
        found.sort_unstable();
        assert_eq!(found, [10, 11, 12]);
        BoxTree::new(Vec::new()).near(&Bounds::of(&[DVec3::ZERO]), |_| panic!("nothing is there"));
    }

    #[test]
    fn finds_what_lies_on_a_ray() {
        let mut found = Vec::new();
        row(50).along(DVec3::new(20.2, 20.2, -5.0), DVec3::Z, |i| {
            found.push(i);
            f64::INFINITY
        });
        assert!(found.contains(&20) && found.len() <= 2 * LEAF, "{found:?}");
    }
}
