//! Shadow volumes of one lamp, only those that can matter to some receivers [NINT89 fig. 7].

use super::casters::Casters;
use super::crowd::{Ball, Crowd, neighbours};
use super::lamp::{Kind, Lamp};
use crate::math::{Bounds, DVec3, Plane};

/// The shadow volumes of one lamp that can matter to some receivers: of all casters only those that can stand between.
///
/// Made for the visible faces of one cluster, or for one face, and dropped again: memory is that of one cluster at a
/// time. Good for the lamp it was made for, and for points within the receivers' box.
#[derive(Default)]
pub struct Volumes {
    pub(super) volumes: Vec<Volume>,
    /// Corners of the casters; of lamps with sharp shadows the sides of the volumes instead.
    pub(super) corners: Vec<DVec3>,
    pub(super) sides: Vec<Plane>,
    pub(super) crowd: Crowd,
    pub(super) slack: f64,
}

/// One caster and its share of the lists.
pub(super) struct Volume {
    pub caster: u32,
    start: u32,
    count: u32,
    pub plane: Plane,
}

impl Volumes {
    /// Of all casters those that can stand between the lamp and a point of the receivers' box.
    pub fn new(lamp: &Lamp, casters: &Casters, receivers: &Bounds) -> Self {
        let slack = casters.slack;
        let mut made = Self { slack, ..Self::default() };
        if !receivers.lo.cmple(receivers.hi).all() {
            return made;
        }
        let corners: [DVec3; 8] = std::array::from_fn(|k| {
            let pick = |axis: usize| if k >> axis & 1 == 0 { receivers.lo[axis] } else { receivers.hi[axis] };
            DVec3::new(pick(0), pick(1), pick(2))
        });
        let mut found: Vec<u32> = Vec::new();
        match &lamp.kind {
            // They shine from infinitely far: boxes tell little.
            Kind::Parallel { .. } | Kind::Sky(_) => found.extend(0..casters.count() as u32),
            _ => casters.tree.near(&lamp.bounds.joined(*receivers), |i| found.push(i)),
        }
        found.retain(|i| !casters.corners(*i).is_empty() && may_stand(lamp, casters, *i, &corners));
        // The tree's order is the same everywhere, but not that of the numbers.
        found.sort_unstable();
        let balls: Vec<Ball> = found.iter().map(|i| Ball::around(casters.corners(*i))).collect();
        let order = neighbours(&balls);
        made.crowd = Crowd::new(order.iter().map(|k| balls[*k as usize]).collect());
        for k in order {
            let i = found[k as usize];
            let (points, plane) = (casters.corners(i), casters.planes[i as usize]);
            let start = if lamp.is_hard() { made.sides.len() } else { made.corners.len() };
            if lamp.is_hard() {
                sides(lamp, points, &plane, slack, &mut made.sides);
            } else {
                made.corners.extend_from_slice(points);
            }
            let end = if lamp.is_hard() { made.sides.len() } else { made.corners.len() };
            made.volumes.push(Volume { caster: i, start: start as u32, count: (end - start) as u32, plane });
        }
        made
    }

    /// How many volumes there are.
    pub fn count(&self) -> usize {
        self.volumes.len()
    }

    /// The memory they take, bytes.
    pub fn bytes(&self) -> usize {
        size_of::<Self>()
            + size_of_val(&self.volumes[..])
            + size_of_val(&self.corners[..])
            + size_of_val(&self.sides[..])
            + self.crowd.bytes()
    }

    pub(super) fn corners(&self, volume: &Volume) -> &[DVec3] {
        &self.corners[volume.start as usize..][..volume.count as usize]
    }

    pub(super) fn sides(&self, volume: &Volume) -> &[Plane] {
        &self.sides[volume.start as usize..][..volume.count as usize]
    }
}

/// False if a caster cannot stand between the lamp and any point of a box.
fn may_stand(lamp: &Lamp, casters: &Casters, i: u32, receivers: &[DVec3; 8]) -> bool {
    let (points, plane, slack) = (casters.corners(i), &casters.planes[i as usize], casters.slack);
    match &lamp.kind {
        Kind::Parallel { .. } | Kind::Point(_) => {
            let mut all = Vec::with_capacity(points.len() + 1);
            sides(lamp, points, plane, slack, &mut all);
            !all.is_empty() && all.iter().all(|s| receivers.iter().any(|p| s.height(*p) > 0.0))
        }
        Kind::Sky(sky) => {
            let top = points.iter().map(|p| p.dot(sky.up)).fold(f64::NEG_INFINITY, f64::max);
            receivers.iter().any(|p| top - p.dot(sky.up) > slack)
        }
        Kind::Tube { .. } | Kind::Panels(_) => {
            let both = || lamp.points.iter().chain(receivers);
            if both().all(|p| plane.height(*p) <= slack) || both().all(|p| plane.height(*p) >= -slack) {
                return false;
            }
            let way = lamp.ball.centre - 0.5 * (receivers[0] + receivers[7]);
            let apart = |axis: DVec3| {
                let span = |of: &mut dyn Iterator<Item = &DVec3>| {
                    of.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), p| {
                        let at = axis.dot(*p);
                        (lo.min(at), hi.max(at))
                    })
                };
                let (a, b) = (span(&mut points.iter()), span(&mut both()));
                let margin = slack * axis.length();
                a.1 < b.0 - margin || b.1 < a.0 - margin
            };
            let edges = (0..points.len()).map(|k| points[(k + 1) % points.len()] - points[k]);
            !edges.map(|e| e.cross(way)).any(apart)
        }
    }
}

/// The sides of the shadow volume of a caster by a lamp with sharp shadows, inwards; first that of the caster itself.
/// None for a caster seen edge-on.
fn sides(lamp: &Lamp, points: &[DVec3], plane: &Plane, slack: f64, out: &mut Vec<Plane>) {
    let (turned, apex) = match &lamp.kind {
        Kind::Parallel { to_light } => {
            let cosine = plane.normal.dot(*to_light);
            (if cosine.abs() <= 1e-9 { 0.0 } else { cosine }, None)
        }
        Kind::Point(bulb) => {
            let height = plane.height(bulb.position);
            (if height.abs() <= slack { 0.0 } else { height }, Some(bulb.position))
        }
        _ => (0.0, None),
    };
    if turned == 0.0 {
        return;
    }
    let sign = -turned.signum();
    // What the caster touches lies on it, not in its shadow.
    out.push(Plane { normal: plane.normal * sign, offset: plane.offset * sign + slack });
    for k in 0..points.len() {
        let (a, b) = (points[k], points[(k + 1) % points.len()]);
        match (&lamp.kind, apex) {
            (Kind::Parallel { to_light }, _) => {
                let normal = (b - a).cross(*to_light) * sign;
                out.push(Plane { normal, offset: normal.dot(a) });
            }
            (_, Some(apex)) => {
                let normal = (a - apex).cross(b - apex) * sign;
                out.push(Plane { normal, offset: normal.dot(apex) });
            }
            _ => {}
        }
    }
}
