//! A camera for a scene that has none.

use super::Visibility;
use crate::math::DVec3;
use crate::raycast::Tracer;
use crate::scene::{Grid, Patch, Stage};
use crate::view::Camera;

/// Size of a fitted picture, pixels.
const SIZE: [u32; 2] = [640, 480];
/// Size of the trial pictures that candidates are judged by.
const TRIAL: [u32; 2] = [48, 36];
/// Share of the picture that a scene seen from outside fills at most, along each axis.
const FILLED: f64 = 0.94;
/// Vertical field of view from outside and from inside, degrees.
const FOV: [f64; 2] = [38.0, 72.0];

/// The camera that shows most of the scene: three-quarter views from outside and from the corners inside are
/// tried, and the one that sees the fronts of the largest area wins, few backs and little background counting too.
///
/// z is taken as up.
pub fn fit_camera(tracer: &Tracer) -> Camera {
    let regions = Regions::of(tracer.stage());
    let tried: Vec<(Camera, Sight)> =
        candidates(tracer.stage()).into_iter().map(|c| look(tracer, &regions, c)).collect();
    let most = tried.iter().map(|(_, s)| s.area).fold(0.0, f64::max);
    let mut best: Option<(f64, Camera)> = None;
    for (camera, sight) in tried {
        let score = sight.score(most);
        // The first of equals stays: the order of candidates is the order of preference.
        if best.as_ref().is_none_or(|(s, _)| score > *s + 1e-9) {
            best = Some((score, camera));
        }
    }
    let camera = best.map_or_else(|| from_outside(-DVec3::ONE, DVec3::ONE, DVec3::new(1.0, -1.0, 1.0)), |(_, c)| c);
    Camera { size: SIZE, ..camera }
}

/// A camera with a picture of another size. The vertical field of view stays; a fitted camera opens it where a
/// narrower picture would cut off what it was fitted to.
pub fn resized(camera: &Camera, fitted: bool, size: [u32; 2]) -> Camera {
    let shape = |s: [u32; 2]| f64::from(s[0]) / f64::from(s[1]);
    let narrower = (shape(camera.size) / shape(size)).max(1.0);
    let wider = |fov: f64| 2.0 * ((0.5 * fov.to_radians()).tan() * narrower).atan().to_degrees();
    let fov = if fitted && narrower > 1.0 { wider(camera.fov) } else { camera.fov };
    Camera { fov, size, ..camera.clone() }
}

fn candidates(stage: &Stage) -> Vec<Camera> {
    let (low, high) = stage.bounds();
    if !(high - low).is_finite() {
        return Vec::new();
    }
    let (centre, size) = ((low + high) * 0.5, high - low);
    let mut all: Vec<Camera> = outside_directions().map(|d| from_outside(low, high, d)).collect();
    // A flat scene has no inside.
    if size.min_element() > 1e-3 * size.length() {
        all.extend(inside_corners().map(|c| from_inside(centre, size, c)));
    }
    all
}

/// Towards the eye: three-quarter views first, steep and shallow, then along the axes.
fn outside_directions() -> impl Iterator<Item = DVec3> {
    let around = (0..16).map(|k| (f64::from(k) * 22.5 - 67.5).to_radians());
    let raised = [28.0, 55.0, -28.0, 5.0].map(|d: f64| d.to_radians());
    let ring = raised.into_iter().flat_map(move |e| around.clone().map(move |a| (a, e)));
    let tilted = ring.map(|(a, e)| DVec3::new(a.cos() * e.cos(), a.sin() * e.cos(), e.sin()));
    tilted.chain([DVec3::new(0.0, -0.06, 1.0), DVec3::new(0.0, -0.06, -1.0)])
}

/// Corners of the bounding box as fractions of its half size, a little inside; eye height first.
fn inside_corners() -> impl Iterator<Item = DVec3> {
    let sides = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    [0.2, 0.9, -0.9].into_iter().flat_map(move |z| sides.map(|(x, y)| DVec3::new(0.9 * x, 0.9 * y, z)))
}

/// Looks at the middle of the box from `towards_eye`, as near as the picture still holds all eight corners.
fn from_outside(low: DVec3, high: DVec3, towards_eye: DVec3) -> Camera {
    let centre = (low + high) * 0.5;
    let forward = -towards_eye.normalize();
    let right = forward.cross(DVec3::Z).normalize();
    let up = right.cross(forward);
    let half = (0.5 * FOV[0].to_radians()).tan() * FILLED;
    let wide = half * f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let distance = (0..8).map(|k| {
        let pick = |axis: usize| if k >> axis & 1 == 0 { low[axis] } else { high[axis] };
        let corner = DVec3::new(pick(0), pick(1), pick(2)) - centre;
        (corner.dot(up).abs() / half).max(corner.dot(right).abs() / wide) - corner.dot(forward)
    });
    let distance = distance.fold(0.0, f64::max).max(1e-6);
    fitted(centre - forward * distance, centre, FOV[0])
}

fn from_inside(centre: DVec3, size: DVec3, corner: DVec3) -> Camera {
    let eye = centre + 0.5 * size * corner;
    let target = centre - 0.5 * size * corner * DVec3::new(0.35, 0.35, 0.5);
    fitted(eye, target, FOV[1])
}

fn fitted(eye: DVec3, target: DVec3, fov: f64) -> Camera {
    Camera { name: "fitted".into(), eye, target, up: DVec3::Z, fov, size: TRIAL }
}

/// Regions along each edge of a quadrilateral.
const DIVISION: u32 = 3;

/// Quadrilaterals in ninths, everything else whole: large enough to be hit by the few rays of a trial picture
/// from near and far alike.
struct Regions {
    /// Region of each patch.
    of_patch: Vec<usize>,
    /// Area of each region, m^2.
    areas: Vec<f64>,
}

impl Regions {
    fn of(stage: &Stage) -> Self {
        let of_patch: Vec<usize> = stage.patches.iter().map(|p| region(stage, p)).collect();
        let sides = 2 * (DIVISION * DIVISION) as usize;
        let mut areas = vec![0.0; stage.facets.len() * sides];
        for (patch, region) in stage.patches.iter().zip(&of_patch).filter(|(p, _)| p.is_present()) {
            areas[*region] += patch.area;
        }
        Self { of_patch, areas }
    }
}

fn region(stage: &Stage, patch: &Patch) -> usize {
    let Some(facet) = stage.facets.get(patch.facet as usize) else { return 0 };
    let back = patch.normal.dot(facet.normal) < 0.0;
    let cell = match facet.grid {
        Grid::Quad { na, nb } => patch.a * DIVISION / na + patch.b * DIVISION / nb * DIVISION,
        Grid::Triangle { .. } | Grid::Whole => 0,
    };
    let side = patch.facet as usize * 2 + usize::from(back);
    side * (DIVISION * DIVISION) as usize + cell as usize
}

/// How much a camera shows.
struct Sight {
    /// Area of the regions in sight, m^2.
    area: f64,
    /// Share of the picture that shows patches.
    front: f64,
    /// Share of the picture that shows backs.
    back: f64,
    /// True for a view from outside: the whole scene in one picture, preferred where it shows as much.
    outside: bool,
}

impl Sight {
    fn score(&self, most: f64) -> f64 {
        // Relative to the best: few rays never meet all regions of a large mesh.
        let area = self.area / most.max(f64::MIN_POSITIVE);
        area + 0.15 * self.front - 0.5 * self.back + if self.outside { 0.1 } else { 0.0 }
    }
}

fn look(tracer: &Tracer, regions: &Regions, camera: Camera) -> (Camera, Sight) {
    let (low, high) = tracer.stage().bounds();
    let outside = camera.eye.cmplt(low).any() || camera.eye.cmpgt(high).any();
    let seen = Visibility::cast(tracer, &camera, 1);
    let [front, back, _] = seen.shares();
    let region = |pixel| regions.of_patch.get(seen.samples(pixel)[0] as usize).copied();
    let mut in_sight: Vec<usize> = (0..seen.pixel_count()).filter_map(region).collect();
    in_sight.sort_unstable();
    in_sight.dedup();
    let area = in_sight.iter().map(|r| regions.areas[*r]).sum();
    (camera, Sight { area, front, back, outside })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::testing::{plate, room, tracer};

    #[test]
    fn a_closed_room_is_seen_from_inside() {
        let stage = room();
        let camera = fit_camera(&tracer(&stage));
        let (low, high) = stage.bounds();
        assert!(camera.eye.cmpgt(low).all() && camera.eye.cmplt(high).all(), "{:?}", camera.eye);
        assert_eq!(camera.size, SIZE);
    }

    #[test]
    fn a_plate_is_seen_from_its_front_and_wholly() {
        for turned in [false, true] {
            let stage = plate(turned);
            let camera = fit_camera(&tracer(&stage));
            assert_eq!(camera.eye.z > 0.0, !turned, "{:?}", camera.eye);
            let seen = Visibility::cast(&tracer(&stage), &camera, 1);
            let [w, h] = SIZE.map(|s| s as usize);
            let rim = (0..w).flat_map(|x| [x, x + (h - 1) * w]).chain((0..h).flat_map(|y| [y * w, y * w + w - 1]));
            assert!(rim.into_iter().all(|p| seen.coverage(p).is_empty()), "there is a margin");
            assert!(seen.shares()[0] > 0.2, "and not much of one: {:?}", seen.shares());
            assert!(seen.middles(&[0, 1, 2, 3]).iter().all(Option::is_some));
        }
    }
}
