//! A tree of bounding boxes: what lies near a box, what along a ray.

use super::DVec3;

/// An axis-aligned box.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    /// Lowest corner.
    pub lo: DVec3,
    /// Highest corner.
    pub hi: DVec3,
}

impl Bounds {
    /// Holds no point; joined with another box it gives the other.
    pub const NOTHING: Self = Self { lo: DVec3::INFINITY, hi: DVec3::NEG_INFINITY };

    /// The box of some points.
    pub fn of(points: &[DVec3]) -> Self {
        points.iter().fold(Self::NOTHING, |b, p| Self { lo: b.lo.min(*p), hi: b.hi.max(*p) })
    }

    /// Larger by `by` on every side.
    pub fn grown(self, by: f64) -> Self {
        Self { lo: self.lo - by, hi: self.hi + by }
    }

    /// The box of both.
    pub fn joined(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// True if they share a point.
    pub fn meets(&self, other: &Self) -> bool {
        self.lo.cmple(other.hi).all() && other.lo.cmple(self.hi).all()
    }

    /// The second largest extent of the common part of two boxes that meet: how far it is from a mere edge.
    pub fn common_breadth(&self, other: &Self) -> f64 {
        let extent = self.hi.min(other.hi) - self.lo.max(other.lo);
        let mut sides = extent.to_array();
        sides.sort_by(f64::total_cmp);
        sides[1]
    }

    /// Where the ray enters the box, if it does.
    fn entry(&self, origin: DVec3, inverse: DVec3) -> Option<f64> {
        let (a, b) = ((self.lo - origin) * inverse, (self.hi - origin) * inverse);
        let (near, far) = (a.min(b).max_element(), a.max(b).min_element());
        (near <= far && far >= 0.0).then_some(near)
    }
}

struct Node {
    bounds: Bounds,
    /// Leaf: range into `order`. Inner node: `count` 0, children at the next place and at `start`.
    start: u32,
    count: u32,
}

/// Boxes by place, halved along their longest spread.
pub struct BoxTree {
    nodes: Vec<Node>,
    order: Vec<u32>,
    boxes: Vec<Bounds>,
}

const LEAF: usize = 4;

impl BoxTree {
    /// The tree over some boxes, which keep their numbers.
    pub fn new(boxes: Vec<Bounds>) -> Self {
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

    /// Box number `i`.
    pub fn bounds(&self, i: u32) -> &Bounds {
        &self.boxes[i as usize]
    }

    /// Calls `visit` for every box that meets `bounds`.
    pub fn near(&self, bounds: &Bounds, mut visit: impl FnMut(u32)) {
        let mut stack = if self.nodes.is_empty() { Vec::new() } else { vec![0u32] };
        while let Some(at) = stack.pop() {
            let node = &self.nodes[at as usize];
            if !node.bounds.meets(bounds) {
                continue;
            }
            match node.count {
                0 => stack.extend([node.start, at + 1]),
                _ => self.leaf(node).filter(|i| self.boxes[*i as usize].meets(bounds)).for_each(&mut visit),
            }
        }
    }

    /// Calls `visit` for boxes on the ray, near ones first; it returns how far is still of interest.
    pub fn along(&self, origin: DVec3, direction: DVec3, mut visit: impl FnMut(u32) -> f64) {
        let inverse = direction.recip();
        let mut reach = f64::INFINITY;
        let entry = |at: u32| self.nodes[at as usize].bounds.entry(origin, inverse).map(|t| (t, at));
        let mut stack: Vec<(f64, u32)> =
            if self.nodes.is_empty() { Vec::new() } else { entry(0).into_iter().collect() };
        while let Some((t, at)) = stack.pop() {
            let node = &self.nodes[at as usize];
            if t > reach {
                continue;
            }
            if node.count > 0 {
                self.leaf(node).for_each(|i| reach = visit(i));
                continue;
            }
            match (entry(at + 1), entry(node.start)) {
                (Some(a), Some(b)) => stack.extend(if a.0 <= b.0 { [b, a] } else { [a, b] }),
                (one, other) => stack.extend(one.or(other)),
            }
        }
    }

    fn leaf(&self, node: &Node) -> impl Iterator<Item = u32> + '_ {
        self.order[node.start as usize..][..node.count as usize].iter().copied()
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
