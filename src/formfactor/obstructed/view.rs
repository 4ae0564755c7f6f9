//! A pair of polygons with the bodies between them, in coordinates of the target: its plane is z = 0, its front z > 0.

use crate::math::{DVec2, DVec3, Plane, Polytope, PolytopeEdge};

/// The pair as the integrand sees it.
pub(super) struct View {
    /// Polygon the integral runs over, in coordinates of its own plane.
    pub domain: Vec<DVec2>,
    /// Origin of those coordinates.
    pub origin: DVec3,
    /// Their unit axes.
    pub axes: [DVec3; 2],
    /// Unit normal of the domain.
    pub normal: DVec3,
    /// Target polygon, counter-clockwise seen from its front.
    pub target: Vec<DVec2>,
    /// Bodies cut to what lies in front of both.
    pub bodies: Vec<Body>,
    /// Extent of the pair, m.
    pub extent: f64,
}

/// A body in coordinates of the target.
pub(super) struct Body {
    /// Vertices.
    pub vertices: Vec<DVec3>,
    /// Planes of the faces, normals outwards.
    pub planes: Vec<Plane>,
    /// Edges between faces.
    pub edges: Vec<PolytopeEdge>,
    /// A point inside.
    pub centre: DVec3,
    /// True for a polygon without thickness.
    pub is_flat: bool,
    /// Angle under which the corners of a plate may seem to lie out of its plane, with a margin.
    pub warp: f64,
}

/// Share of the extent below which heights are rounding.
pub(super) const SLACK: f64 = 1e-12;

/// Margin over what rounded corners are out of a plane.
pub(super) const MARGIN: f64 = 4.0;

impl View {
    /// The view of `target` from `domain`, both cut to what lies in front of the other already. Bodies that cannot
    /// matter are left out.
    pub fn new(domain: &[DVec3], target: &[DVec3], bodies: &[&Polytope]) -> Self {
        let (near, far) = (Plane::of(domain), Plane::of(target));
        let centre = target.iter().sum::<DVec3>() / target.len() as f64;
        let e1 = longest_edge(target);
        let e2 = far.normal.cross(e1);
        let into = |v: DVec3| DVec3::new(v.dot(e1), v.dot(e2), v.dot(far.normal));
        let place = |p: DVec3| into(p - centre);
        let extent = domain.iter().chain(target).map(|p| p.distance(centre)).fold(0.0, f64::max);
        let rounding = SLACK * extent + MARGIN * (out_of_plane(&near, domain) + out_of_plane(&far, target));
        let cut = |b: &&Polytope| {
            // A corner shared with the target may stick out of a plane as far as corners are rounded: a sliver that
            // hides nothing, but whose edges point anywhere.
            let out = roughness(b);
            let slack = rounding + MARGIN * out;
            let front = b.in_front(&near, slack)?.in_front(&far, slack)?;
            let plane = |p: &Plane| Plane { normal: into(p.normal), offset: -p.height(centre) };
            Some(Body {
                vertices: front.vertices().iter().map(|v| place(*v)).collect(),
                planes: front.planes().iter().map(plane).collect(),
                edges: front.edges().to_vec(),
                centre: place(front.centre()),
                is_flat: front.is_flat(),
                warp: if front.is_flat() { MARGIN * out / size(&front) } else { 0.0 },
            })
        };
        let f1 = longest_edge(domain);
        let f2 = near.normal.cross(f1);
        let foot = domain[0];
        Self {
            domain: domain.iter().map(|p| DVec2::new((*p - foot).dot(f1), (*p - foot).dot(f2))).collect(),
            origin: place(foot),
            axes: [into(f1), into(f2)],
            normal: into(near.normal),
            target: target.iter().map(|p| place(*p).truncate()).collect(),
            bodies: bodies.iter().filter_map(cut).collect(),
            extent,
        }
    }

    /// The point of the domain with the given coordinates.
    pub fn point(&self, p: DVec2) -> DVec3 {
        self.origin + self.axes[0] * p.x + self.axes[1] * p.y
    }

    /// Height of a point over the plane of the domain.
    pub fn above_domain(&self, p: DVec3) -> f64 {
        (p - self.origin).dot(self.normal)
    }

    /// Coordinates in the domain's plane of a point, projected at right angles.
    pub fn in_domain(&self, p: DVec3) -> DVec2 {
        let w = p - self.origin;
        DVec2::new(w.dot(self.axes[0]), w.dot(self.axes[1]))
    }
}

/// How far the corners of a body are rounded out of its faces, m.
pub(super) fn roughness(body: &Polytope) -> f64 {
    let out = |p: &Plane| if body.is_flat() { out_of_plane(p, body.vertices()) } else { above(p, body) };
    body.planes().iter().map(out).fold(0.0, f64::max)
}

/// How far corners lie out of their plane, m.
pub(super) fn out_of_plane(plane: &Plane, corners: &[DVec3]) -> f64 {
    corners.iter().map(|v| plane.height(*v).abs()).fold(0.0, f64::max)
}

/// How far corners of a solid rise above one of its faces, m: rounding.
fn above(plane: &Plane, body: &Polytope) -> f64 {
    body.vertices().iter().map(|v| plane.height(*v)).fold(0.0, f64::max)
}

/// Reach of a body from its centre, m.
pub(super) fn size(body: &Polytope) -> f64 {
    body.vertices().iter().map(|v| v.distance(body.centre())).fold(f64::MIN_POSITIVE, f64::max)
}

pub(super) fn longest_edge(polygon: &[DVec3]) -> DVec3 {
    let next = polygon.iter().cycle().skip(1);
    let edges = polygon.iter().zip(next).map(|(a, b)| *b - *a);
    let longest = edges.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    longest.unwrap_or(DVec3::X).normalize_or(DVec3::X)
}
