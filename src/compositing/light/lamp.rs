//! A light made ready: one face for all kinds.

use super::crowd::{Ball, Shaft};
use super::panel::{self, Panel};
use super::point::Bulb;
use super::sky::Sky;
use super::stretch::{join, within};
use super::volumes::Volumes;
use super::{dome, tube};
use crate::math::{Bounds, DVec3};
use crate::scene::{Light, LightShape};

/// Half planes that the sky is cut by where nothing else is asked for.
const HALF_PLANES: usize = 24;

/// A light made ready. The irradiance that it brings is its strength, per band, times a **factor** of point and normal.
pub struct Lamp {
    pub(super) kind: Kind,
    /// Points whose hull is the lamp; none for those infinitely far.
    pub(super) points: Vec<DVec3>,
    pub(super) bounds: Bounds,
    pub(super) ball: Ball,
    half_planes: usize,
}

/// What kinds need.
pub(super) enum Kind {
    /// Unit vector to the light.
    Parallel { to_light: DVec3 },
    /// Position, distribution, curve.
    Point(Bulb),
    /// The ends of a tube.
    Tube { from: DVec3, to: DVec3 },
    /// Polygons that shine to their front.
    Panels(Vec<Panel>),
    /// The sky.
    Sky(Sky),
}

impl Lamp {
    /// Makes a light ready. Panels without area shine on nothing.
    pub fn new(light: &Light) -> Self {
        let panels = |faces: &[Vec<DVec3>]| Kind::Panels(faces.iter().filter_map(|f| Panel::new(f)).collect());
        let kind = match &light.shape {
            LightShape::Parallel { direction } => Kind::Parallel { to_light: -direction.normalize_or_zero() },
            LightShape::Point { position, distribution, curve } => {
                Kind::Point(Bulb { position: *position, distribution: *distribution, curve: curve.clone() })
            }
            LightShape::Linear { from, to } => Kind::Tube { from: *from, to: *to },
            LightShape::Area { polygon } => panels(std::slice::from_ref(polygon)),
            LightShape::Polyhedron { faces } => panels(faces),
            LightShape::Sky { model, up } => Kind::Sky(Sky::new(*model, *up)),
        };
        let points = match &kind {
            Kind::Parallel { .. } | Kind::Sky(_) => Vec::new(),
            Kind::Point(bulb) => vec![bulb.position],
            Kind::Tube { from, to } => vec![*from, *to],
            Kind::Panels(panels) => panels.iter().flat_map(|p| p.corners.iter().copied()).collect(),
        };
        let (bounds, ball) = (Bounds::of(&points), Ball::around(&points));
        Self { kind, points, bounds, ball, half_planes: HALF_PLANES }
    }

    /// The same lamp, a sky cut by at least `n` half planes for its shadows (24 if not asked; 2 at least). Others stay.
    pub fn with_bands(mut self, n: usize) -> Self {
        self.half_planes = n.max(2);
        self
    }

    /// True for parallel and point lights, whose shadows have sharp edges.
    pub fn is_hard(&self) -> bool {
        matches!(self.kind, Kind::Parallel { .. } | Kind::Point(_))
    }

    /// The factor at a point (metres) with a unit normal, nothing standing between: in closed form for all but the clear
    /// sky, which is integrated to about 1e-6 of itself (once for a normal: it is kept until the next normal is asked).
    pub fn open(&self, point: DVec3, normal: DVec3) -> f64 {
        match &self.kind {
            Kind::Parallel { to_light } => normal.dot(*to_light).max(0.0),
            Kind::Point(bulb) => bulb.factor(point, normal),
            Kind::Tube { from, to } => tube::open(*from, *to, point, normal),
            Kind::Panels(panels) => panels.iter().map(|p| p.open(point, normal)).sum(),
            Kind::Sky(sky) => sky.open(normal),
        }
    }

    /// The factor with shadows. `own`: the caster that the point lies on, or [`super::NO_CASTER`]. For lamps with sharp
    /// shadows all or nothing; tubes and panels exactly; skies by half planes, and the more of them the better.
    pub fn seen(&self, point: DVec3, normal: DVec3, own: u32, volumes: &Volumes) -> f64 {
        match &self.kind {
            Kind::Parallel { .. } | Kind::Point(_) => {
                let open = self.open(point, normal);
                if open > 0.0 && self.is_dark(point, own, volumes) { 0.0 } else { open }
            }
            Kind::Tube { from, to } => tube::seen([*from, *to], self.ball, point, normal, own, volumes),
            Kind::Panels(panels) => panel::seen(panels, self.ball, point, normal, own, volumes),
            Kind::Sky(sky) => dome::seen(sky, self.half_planes, point, normal, own, volumes),
        }
    }

    /// Of the segment from `a` to `b` the parts in shadow, as parameters 0 to 1, sorted and joined; `out` is cleared
    /// first. `own`: the caster that the segment lies on. Nothing for lamps whose shadows have no sharp edges.
    pub fn hidden(&self, a: DVec3, b: DVec3, own: u32, volumes: &Volumes, out: &mut Vec<(f64, f64)>) {
        out.clear();
        let Some(shaft) = self.sharp_shaft(Ball::around(&[a, b])) else { return };
        volumes.crowd.any(
            |ball| shaft.meets(ball),
            |k| {
                let volume = &volumes.volumes[k];
                if volume.caster != own
                    && let Some(part) = within(a, b, volumes.sides(volume))
                {
                    out.push((part.from, part.to));
                }
                false
            },
        );
        join(out);
    }

    /// Radiance of a sky in a direction of any length, as a share of that at the zenith; 0 below the horizon, and for
    /// lamps that are none.
    pub fn sky(&self, direction: DVec3) -> f64 {
        match &self.kind {
            Kind::Sky(sky) => sky.radiance(direction.normalize_or_zero()),
            _ => 0.0,
        }
    }

    /// A point that stands for the lamp as seen from `point`: unit direction and distance in metres, infinite for
    /// parallel light and skies. The middle of a tube, of a panel's or a body's corners; the zenith.
    pub fn towards(&self, point: DVec3) -> (DVec3, f64) {
        match &self.kind {
            Kind::Parallel { to_light } => (*to_light, f64::INFINITY),
            Kind::Sky(sky) => (sky.up, f64::INFINITY),
            _ => {
                let way = self.ball.centre - point;
                (way.normalize_or_zero(), way.length())
            }
        }
    }

    /// True if some volume holds the point.
    fn is_dark(&self, point: DVec3, own: u32, volumes: &Volumes) -> bool {
        let Some(shaft) = self.sharp_shaft(Ball { centre: point, radius: 0.0 }) else { return false };
        volumes.crowd.any(
            |ball| shaft.meets(ball),
            |k| {
                let volume = &volumes.volumes[k];
                volume.caster != own && volumes.sides(volume).iter().all(|s| s.height(point) >= 0.0)
            },
        )
    }

    /// Where casters stand whose sharp shadow falls on a ball.
    fn sharp_shaft(&self, ball: Ball) -> Option<Shaft> {
        match &self.kind {
            Kind::Parallel { to_light } => Some(Shaft::along(ball, *to_light)),
            Kind::Point(bulb) => Some(Shaft::to(bulb.position, ball)),
            _ => None,
        }
    }
}
