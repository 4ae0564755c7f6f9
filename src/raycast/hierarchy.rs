//! A four-wide hierarchy of boxes over a binary one from `obvhs`, in single precision with room for rounding.
//!
//! Only boxes are single precision. Everything is scaled to a scene of diagonal 1 about its centre, and every
//! box is padded by [`PAD`], several times what rounding of origin, direction and plane distances adds up to,
//! so that no polygon is missed. The compressed eight-wide hierarchy of `obvhs` measured no faster here: most of
//! the time goes into fetching and testing polygons.

use crate::math::DVec3;
use glam::{Vec3A, Vec4};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::{Bvh2, builder::build_bvh2};
use std::time::Duration;

/// Padding of every box. With unit roundoff u = 6e-8, coordinates below 2 and distances below 3 (of the
/// diagonal), the errors of the slab test add up to less than 12 u.
const PAD: f64 = 1e-6;

/// Nothing is further than this, in diagonals, from an origin that was brought near.
const FAR: f32 = 8.0;

/// Four boxes side by side, and what is in them: two cache lines.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Node {
    low: [Vec4; 3],
    high: [Vec4; 3],
    child: [u32; 4],
}

/// Top bit of a child: a leaf. The next four: its polygons less one; the rest: the first of them.
const LEAF: u32 = 1 << 31;
const COUNT_SHIFT: u32 = 27;
const FIRST_MASK: u32 = (1 << COUNT_SHIFT) - 1;
/// Most polygons of a leaf.
const LEAF_MAX: u32 = 4;

/// Boxes around numbered things.
pub(super) struct Hierarchy {
    nodes: Vec<Node>,
    root: Option<u32>,
}

/// A ray in units of the hierarchy.
#[derive(Clone, Copy)]
pub(super) struct BoxRay {
    origin: [Vec4; 3],
    inverse: [Vec4; 3],
}

impl BoxRay {
    /// From origin and unit direction, both scaled.
    #[inline]
    pub(super) fn new(origin: DVec3, direction: DVec3) -> Self {
        // Small enough to miss nothing, large enough that no product overflows.
        let inverse = |d: f64| if d.abs() < 1e-18 { 1e18f64.copysign(d) } else { 1.0 / d };
        Self {
            origin: origin.to_array().map(|x| Vec4::splat(x as f32)),
            inverse: direction.to_array().map(|d| Vec4::splat(inverse(d) as f32)),
        }
    }
}

impl Hierarchy {
    /// Over boxes (low, high) in scaled units; also the order in which things must be stored.
    pub(super) fn new(boxes: &[(DVec3, DVec3)]) -> (Self, Vec<u32>) {
        assert!(boxes.len() <= FIRST_MASK as usize, "more than 134 million polygons");
        if boxes.is_empty() {
            return (Self { nodes: Vec::new(), root: None }, Vec::new());
        }
        let padded: Vec<Aabb> = boxes.iter().map(|(lo, hi)| padded(*lo, *hi)).collect();
        let params = BvhBuildParams { max_prims_per_leaf: LEAF_MAX, ..BvhBuildParams::medium_build() };
        let binary = build_bvh2(&padded, params, &mut Duration::default());
        let mut wide = Self { nodes: Vec::with_capacity(binary.nodes.len() / 3 + 1), root: None };
        wide.root = Some(wide.widen(&binary, 0));
        (wide, binary.primitive_indices)
    }

    /// The four-wide form of a binary node: inner children are opened, largest first, until there are four.
    fn widen(&mut self, binary: &Bvh2, at: u32) -> u32 {
        let node = &binary.nodes[at as usize];
        if node.is_leaf() {
            return LEAF | (node.prim_count - 1) << COUNT_SHIFT | node.first_index;
        }
        let mut parts = vec![node.first_index, node.first_index + 1];
        while parts.len() < 4 {
            let area = |i: &usize| binary.nodes[parts[*i] as usize].aabb().half_area();
            let inner = (0..parts.len()).filter(|&i| !binary.nodes[parts[i] as usize].is_leaf());
            let Some(largest) = inner.max_by(|a, b| area(a).total_cmp(&area(b))) else { break };
            let first = binary.nodes[parts[largest] as usize].first_index;
            parts[largest] = first;
            parts.push(first + 1);
        }
        let number = self.nodes.len() as u32;
        self.nodes.push(boxes_of(binary, &parts));
        for (slot, part) in parts.into_iter().enumerate() {
            let child = self.widen(binary, part);
            self.nodes[number as usize].child[slot] = child;
        }
        number
    }

    /// Visits the leaves that a ray may meet, near boxes first. `visit` gets the range of things in a leaf and
    /// answers with the scaled distance beyond which nothing matters any more.
    #[inline]
    pub(super) fn walk(
        &self,
        ray: &BoxRay,
        stack: &mut Vec<(f32, u32)>,
        mut visit: impl FnMut(std::ops::Range<usize>) -> f32,
    ) {
        let mut limit = FAR;
        stack.clear();
        stack.extend(self.root.map(|r| (0.0, r)));
        while let Some((t, child)) = stack.pop() {
            if t > limit {
                continue;
            }
            if child & LEAF != 0 {
                let first = (child & FIRST_MASK) as usize;
                limit = visit(first..first + (child >> COUNT_SHIFT & 0xf) as usize + 1).min(FAR);
            } else {
                self.nodes[child as usize].enter(ray, limit, stack);
            }
        }
    }

    /// Numbers of the things whose padded boxes meet a scaled box.
    pub(super) fn in_box(&self, low: DVec3, high: DVec3, found: &mut Vec<u32>) {
        let Aabb { min, max } = padded(low, high);
        found.clear();
        let mut open: Vec<u32> = self.root.into_iter().collect();
        while let Some(child) = open.pop() {
            if child & LEAF != 0 {
                let first = child & FIRST_MASK;
                found.extend(first..first + (child >> COUNT_SHIFT & 0xf) + 1);
            } else {
                self.nodes[child as usize].overlapping(min, max, &mut open);
            }
        }
    }
}

impl Node {
    /// Pushes the children that a ray meets before `limit`, the nearest last.
    #[inline]
    fn enter(&self, ray: &BoxRay, limit: f32, stack: &mut Vec<(f32, u32)>) {
        let (mut from, mut to) = (Vec4::ZERO, Vec4::splat(limit));
        for axis in 0..3 {
            let a = (self.low[axis] - ray.origin[axis]) * ray.inverse[axis];
            let b = (self.high[axis] - ray.origin[axis]) * ray.inverse[axis];
            from = from.max(a.min(b));
            to = to.min(a.max(b));
        }
        let mut hit = from.cmple(to).bitmask();
        let from = from.to_array();
        let base = stack.len();
        while hit != 0 {
            let k = hit.trailing_zeros() as usize;
            hit &= hit - 1;
            let entry = (from[k], self.child[k]);
            let mut place = stack.len();
            stack.push(entry);
            while place > base && stack[place - 1].0 < entry.0 {
                stack[place] = stack[place - 1];
                place -= 1;
            }
            stack[place] = entry;
        }
    }

    fn overlapping(&self, min: Vec3A, max: Vec3A, open: &mut Vec<u32>) {
        let (min, max) = (min.to_array(), max.to_array());
        let apart = |axis: usize| {
            self.low[axis].cmpgt(Vec4::splat(max[axis])).bitmask()
                | self.high[axis].cmplt(Vec4::splat(min[axis])).bitmask()
        };
        let apart = apart(0) | apart(1) | apart(2);
        open.extend((0..4).filter(|k| apart & (1 << k) == 0).map(|k| self.child[k]));
    }
}

fn padded(low: DVec3, high: DVec3) -> Aabb {
    Aabb::new((low - PAD).as_vec3a(), (high + PAD).as_vec3a())
}

/// A node with its boxes filled in; empty slots lie where no ray gets.
fn boxes_of(binary: &Bvh2, parts: &[u32]) -> Node {
    let nowhere = 1e30;
    let mut low = [[nowhere; 4]; 3];
    let mut high = low;
    for (slot, part) in parts.iter().enumerate() {
        let b = binary.nodes[*part as usize].aabb();
        for axis in 0..3 {
            low[axis][slot] = b.min[axis];
            high[axis][slot] = b.max[axis];
        }
    }
    Node { low: low.map(Vec4::from), high: high.map(Vec4::from), child: [0; 4] }
}
