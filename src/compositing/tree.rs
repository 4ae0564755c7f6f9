//! Trees: pictures on transparent polygons that stand upright and turn to whoever looks.

use super::texture::{Beyond, Sampler};
use crate::math::DVec3;
use crate::scene::Tree;

/// Who looks at a tree, or shines on it: what it turns to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Viewer {
    /// An eye, a lamp, a point of a mirror: its place, metres.
    Point(DVec3),
    /// Parallel light: the direction towards it, of any length.
    Direction(DVec3),
}

/// A tree that has turned: where its polygon stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turned {
    /// Lower left corner seen from the viewer, metres.
    pub corner: DVec3,
    /// Lower edge, to the right.
    pub breadth: DVec3,
    /// Left edge, upward.
    pub height: DVec3,
    /// Unit normal: the horizontal direction to the viewer.
    pub normal: DVec3,
}

/// Where a ray meets a tree's polygon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TreeHit {
    /// Index into [`crate::scene::Appearance::trees`].
    pub tree: u32,
    /// How far along the ray, in lengths of its direction.
    pub distance: f64,
    /// Place in the picture: 0 to 1 from left to right seen from the viewer.
    pub s: f64,
    /// The same upward.
    pub t: f64,
}

/// Closer than this share of its size a ray leaves a tree, and does not meet it.
const LEAVING: f64 = 1e-9;

impl Turned {
    /// Turns a tree. To a viewer straight above or below it has no side to turn, and shows an arbitrary one.
    pub fn new(tree: &Tree, viewer: Viewer) -> Self {
        let towards = match viewer {
            Viewer::Point(p) => p - tree.foot,
            Viewer::Direction(d) => d,
        };
        let level = towards - tree.up * towards.dot(tree.up);
        let known = level.length() > 1e-12 * towards.length();
        let normal =
            if known { level.normalize_or_zero() } else { tree.up.any_orthogonal_vector().normalize_or_zero() };
        let breadth = tree.up.cross(normal) * tree.size[0];
        Self { corner: tree.foot - 0.5 * breadth, breadth, height: tree.up * tree.size[1], normal }
    }

    /// Corners, counter-clockwise seen from the viewer, the lower left one first.
    pub fn corners(&self) -> [DVec3; 4] {
        let Self { corner: c, breadth: b, height: h, .. } = *self;
        [c, c + b, c + b + h, c + h]
    }

    /// Distance (in lengths of `direction`) and place in the picture where a ray meets the polygon, from either side.
    pub fn hit(&self, origin: DVec3, direction: DVec3) -> Option<(f64, f64, f64)> {
        let (b2, h2) = (self.breadth.length_squared(), self.height.length_squared());
        let from = self.corner - origin;
        let distance = from.dot(self.normal) / direction.dot(self.normal);
        let near = LEAVING * (b2 + h2).sqrt();
        if !distance.is_finite() || distance * direction.length() <= near {
            return None;
        }
        let p = direction * distance - from;
        let (s, t) = (p.dot(self.breadth) / b2, p.dot(self.height) / h2);
        ((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t)).then_some((distance, s, t))
    }
}

/// The corners of a tree that has turned to a viewer, counter-clockwise seen from there, metres.
pub fn turned(tree: &Tree, viewer: Viewer) -> [DVec3; 4] {
    Turned::new(tree, viewer).corners()
}

/// All trees of a scene turned to one viewer.
#[derive(Debug, Clone)]
pub struct Grove<'a> {
    trees: &'a [Tree],
    turned: Vec<Turned>,
    viewer: Viewer,
}

impl<'a> Grove<'a> {
    /// Turns trees to a viewer.
    pub fn new(trees: &'a [Tree], viewer: Viewer) -> Self {
        Self { trees, turned: trees.iter().map(|t| Turned::new(t, viewer)).collect(), viewer }
    }

    /// Tree number `i` as it stands.
    pub fn get(&self, i: u32) -> Option<&Turned> {
        self.turned.get(i as usize)
    }

    /// All trees that a ray meets before `reach` (in lengths of `direction`), by distance, into `out`.
    pub fn hits(&self, origin: DVec3, direction: DVec3, reach: f64, out: &mut Vec<TreeHit>) {
        out.clear();
        for (tree, turned) in self.turned.iter().enumerate() {
            if let Some((distance, s, t)) = turned.hit(origin, direction).filter(|h| h.0 < reach) {
                out.push(TreeHit { tree: tree as u32, distance, s, t });
            }
        }
        out.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.tree.cmp(&b.tree)));
    }

    /// Share of the light that comes from the viewer to a point, past all trees but `own`: the product of 1 - opacity
    /// along the way.
    pub fn transmittance(&self, point: DVec3, own: Option<u32>, sampler: &Sampler) -> f64 {
        let (direction, reach) = match self.viewer {
            Viewer::Point(p) => (p - point, 1.0),
            Viewer::Direction(d) => (d, f64::INFINITY),
        };
        let mut share = 1.0;
        for (tree, turned) in self.turned.iter().enumerate() {
            if own == Some(tree as u32) {
                continue;
            }
            let Some((_, s, t)) = turned.hit(point, direction).filter(|h| h.0 < reach) else { continue };
            let (_, alpha) = sampler.sample(self.trees[tree].picture, s, t, Beyond::Nothing);
            share *= 1.0 - f64::from(alpha);
            if share <= 0.0 {
                return 0.0;
            }
        }
        share
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Picture;

    fn tree(foot: DVec3) -> Tree {
        Tree { name: "t".into(), object: "o".into(), foot, up: DVec3::Z, size: [2.0, 4.0], picture: 0 }
    }

    /// Left half half opaque, right half opaque green.
    fn sampler() -> Sampler {
        let rgba = [[255, 0, 0, 128], [0, 255, 0, 255]].concat();
        Sampler::new(&[Picture { name: "t".into(), size: [2, 1], rgba }]).expect("a picture")
    }

    #[test]
    fn turns_to_eyes_and_to_light_and_stays_upright() {
        let t = tree(DVec3::new(1.0, 2.0, 0.5));
        // Seen from -y, right is +x.
        let corners = turned(&t, Viewer::Point(DVec3::new(1.0, -9.0, 7.0)));
        assert_eq!(corners[0], DVec3::new(0.0, 2.0, 0.5));
        assert_eq!(corners[1], DVec3::new(2.0, 2.0, 0.5));
        assert_eq!(corners[2], DVec3::new(2.0, 2.0, 4.5));
        let sun = Turned::new(&t, Viewer::Direction(DVec3::new(3.0, 0.0, 4.0)));
        assert_eq!(sun.normal, DVec3::X);
        let n = crate::math::unit_normal(&sun.corners());
        assert!((n - DVec3::X).length() < 1e-15, "its front looks at the light: {n}");
        // From straight above it shows some side, of the right size.
        let above = turned(&t, Viewer::Point(t.foot + DVec3::Z));
        assert!((crate::math::area(&above) - 8.0).abs() < 1e-12);
    }

    #[test]
    fn a_leaning_tree_turns_about_its_trunk() {
        let t = Tree { up: DVec3::new(0.6, 0.0, 0.8), ..tree(DVec3::ZERO) };
        let turned = Turned::new(&t, Viewer::Point(DVec3::new(5.0, -8.0, 3.0)));
        assert!(turned.normal.dot(t.up).abs() < 1e-15 && turned.breadth.dot(t.up).abs() < 1e-15);
        assert!(turned.normal.dot(DVec3::new(5.0, -8.0, 3.0)) > 0.0);
    }

    #[test]
    fn rays_find_their_place_in_the_picture() {
        let t = Turned::new(&tree(DVec3::ZERO), Viewer::Point(DVec3::new(0.0, -10.0, 0.0)));
        let hit = t.hit(DVec3::new(0.5, -10.0, 1.0), DVec3::Y * 2.0);
        assert_eq!(hit, Some((5.0, 0.75, 0.25)));
        // From behind the same point of the picture.
        assert_eq!(t.hit(DVec3::new(0.5, 10.0, 1.0), -DVec3::Y), Some((10.0, 0.75, 0.25)));
        for (origin, direction) in [
            (DVec3::new(1.01, -10.0, 1.0), DVec3::Y),
            (DVec3::new(0.5, -10.0, -0.01), DVec3::Y),
            (DVec3::new(0.5, -10.0, 1.0), -DVec3::Y),
            (DVec3::new(0.5, 0.0, 1.0), DVec3::X),
            (DVec3::new(0.5, 0.0, 1.0), DVec3::Y),
            (DVec3::new(0.5, 0.0, 1.0), DVec3::ZERO),
        ] {
            assert_eq!(t.hit(origin, direction), None, "{origin} {direction}");
        }
    }

    #[test]
    fn light_passes_what_is_not_opaque() {
        let trees = [tree(DVec3::ZERO), tree(DVec3::new(0.0, 3.0, 0.0)), tree(DVec3::new(0.0, 30.0, 0.0))];
        let (s, half) = (sampler(), 1.0 - 128.0 / 255.0);
        let sun = Grove::new(&trees, Viewer::Direction(-DVec3::Y));
        let through = |grove: &Grove, x: f64, y: f64, own| grove.transmittance(DVec3::new(x, y, 2.0), own, &s);
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-6, "{a} instead of {b}");
        close(through(&sun, -0.5, 5.0, None), half * half);
        close(through(&sun, -0.5, 1.0, None), half);
        close(through(&sun, -0.5, 1.0, Some(0)), 1.0);
        close(through(&sun, 0.5, 1.0, None), 0.0);
        close(through(&sun, -0.5, -1.0, None), 1.0);
        // A lamp between the trees: what stands behind it does not count, and it turns them to itself.
        let lamp = Grove::new(&trees, Viewer::Point(DVec3::new(-0.5, 1.5, 2.0)));
        close(through(&lamp, -0.5, 1.0, None), 1.0);
        close(lamp.transmittance(DVec3::new(-0.5, 20.0, 2.0), None, &s), {
            let (_, a, b) = Turned::new(&trees[1], Viewer::Point(DVec3::new(-0.5, 1.5, 2.0)))
                .hit(DVec3::new(-0.5, 20.0, 2.0), -DVec3::Y)
                .expect("a tree");
            1.0 - f64::from(s.sample(0, a, b, Beyond::Nothing).1)
        });
        // By distance.
        let mut hits = Vec::new();
        sun.hits(DVec3::new(0.5, 50.0, 2.0), -DVec3::Y, 49.0, &mut hits);
        assert_eq!(hits.iter().map(|h| h.tree).collect::<Vec<_>>(), [2, 1]);
    }
}
