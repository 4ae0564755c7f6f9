//! Mirror and gloss: looked up in the map against traced from the object.

use super::bench::{Bench, Probe};
use super::irradiance::nearest;
use super::record::At;
use crate::audit::envmap::{Lobe, Point, Station};
use crate::math::DVec3;
use crate::scene::NO_FACET;

/// Full opening angles of the cones, degrees; the first is as good as a mirror.
const CONES: [f64; 6] = [0.25, 1.0, 4.0, 12.0, 30.0, 60.0];

/// Points that face the eye, with the direction of the mirror.
fn mirrored(eye: DVec3, points: &[Point]) -> Vec<(Point, DVec3)> {
    let facing = |p: &&Point| p.normal.dot(eye - p.place) > 0.0;
    let mirror = |p: &Point| {
        let along = (p.place - eye).normalize();
        (*p, (along - p.normal * (2.0 * along.dot(p.normal))).normalize())
    };
    points.iter().filter(facing).map(mirror).collect()
}

pub(super) fn reflection(bench: &Bench, probes: &[Probe], points: &[Point]) -> Vec<At> {
    let seen = mirrored(bench.request.camera.eye, points);
    let serves: Vec<&Probe> =
        seen.iter().map(|(p, _)| &probes[nearest(p.place, probes.iter().map(|c| c.centre.point))]).collect();
    // A map knows of no surface: its cone is whole. What the surface cuts off is the object's doing.
    let at = |(_, axis): &(Point, DVec3), place: DVec3| Station { place, axis: *axis, horizon: None, facet: NO_FACET };
    let centres: Vec<Station> = seen.iter().zip(&serves).map(|(s, probe)| at(s, probe.centre.point)).collect();
    let free: Vec<Station> = seen.iter().map(|s| at(s, s.0.place)).collect();
    let there: Vec<Station> =
        seen.iter().map(|s| Station { horizon: Some(s.0.normal), facet: s.0.facet, ..at(s, s.0.place) }).collect();
    let cone = |degrees: f64| {
        let half = 0.5 * degrees.to_radians();
        let map: Vec<f64> = seen.iter().zip(&serves).map(|((_, axis), probe)| probe.glossy(*axis, half)).collect();
        let lobe = Lobe::Cone(half);
        let (centre, without) = (bench.arrives(false, &centres, lobe), bench.arrives(false, &free, lobe));
        let truth = bench.arrives(true, &there, lobe);
        At { x: degrees, parts: bench.parts(&map, &centre, &without, &truth) }
    };
    if seen.is_empty() { Vec::new() } else { CONES.iter().map(|d| cone(*d)).collect() }
}
