//! A camera for scenes that come without one: of a fixed set of views, the one that shows most.

use super::Facet;
use super::tree::{Bounds, BoxTree, meet};
use crate::math::DVec3;
use crate::view::Camera;
use std::collections::BTreeSet;

/// Name of the fitted camera.
const NAME: &str = "fitted";
/// Rays across and down with which a view is judged.
const JUDGED: [u32; 2] = [24, 18];

/// The view that shows the most radiating sides: from inside near the corners, or from outside.
/// `None` where nothing stands.
pub(super) fn fitted_camera(facets: &[Facet]) -> Option<Camera> {
    let all = facets.iter().map(|f| Bounds::of(&f.vertices)).reduce(Bounds::joined)?;
    let tolerance = 1e-9 * all.lo.distance(all.hi);
    let tree = BoxTree::new(facets.iter().map(|f| Bounds::of(&f.vertices).grown(tolerance)).collect());
    let judged = views(&all).into_iter().map(|c| (worth(&c, facets, &tree, tolerance), c));
    // The first of equals.
    judged.reduce(|best, next| if next.0 > best.0 { next } else { best }).map(|(_, camera)| camera)
}

/// Views in the order of preference.
fn views(all: &Bounds) -> Vec<Camera> {
    let (middle, half) = ((all.lo + all.hi) / 2.0, (all.hi - all.lo) / 2.0);
    let radius = half.length();
    let mut views = Vec::new();
    let signs = |k: u32| DVec3::from_array([0, 1, 2].map(|c| if k >> c & 1 == 0 { -1.0 } else { 1.0 }));
    // Upper corners first: people look down into rooms.
    for k in [4, 5, 6, 7, 0, 1, 2, 3] {
        views.push(view(middle + half * signs(k) * DVec3::new(0.85, 0.85, 0.6), middle, 75.0));
    }
    for k in [4, 5, 6, 7, 0, 1, 2, 3] {
        let oblique = signs(k) * DVec3::new(0.55, 0.75, 0.45);
        views.push(view(middle + oblique.normalize() * 2.2 * radius, middle, 50.0));
    }
    for axis in [DVec3::Y, DVec3::X, DVec3::Z] {
        for sign in [-1.0, 1.0] {
            views.push(view(middle + axis * (sign * 2.2 * radius), middle, 50.0));
        }
    }
    views
}

fn view(eye: DVec3, target: DVec3, fov: f64) -> Camera {
    let steep = (target - eye).normalize().z.abs() > 0.99;
    let up = if steep { DVec3::Y } else { DVec3::Z };
    Camera { name: NAME.into(), eye, target, up, fov, size: [640, 480] }
}

/// Share of the picture that shows radiating sides, weighted with how many facets are seen.
fn worth(camera: &Camera, facets: &[Facet], tree: &BoxTree, tolerance: f64) -> f64 {
    let mut seen = BTreeSet::new();
    let mut fronts = 0;
    let [w, h] = camera.size.map(f64::from);
    for k in 0..JUDGED[0] * JUDGED[1] {
        let (x, y) = (f64::from(k % JUDGED[0]) + 0.5, f64::from(k / JUDGED[0]) + 0.5);
        let direction = camera.direction(x * w / f64::from(JUDGED[0]), y * h / f64::from(JUDGED[1]));
        if let Some(facet) = front_met(camera.eye, direction, facets, tree, tolerance) {
            fronts += 1;
            seen.insert(facet);
        }
    }
    f64::from(fronts) * (seen.len() as f64).sqrt()
}

/// The facet whose radiating side a ray meets first; a front beats a back at the same distance.
fn front_met(origin: DVec3, direction: DVec3, facets: &[Facet], tree: &BoxTree, tolerance: f64) -> Option<u32> {
    let (mut nearest, mut front) = (f64::INFINITY, None);
    tree.along(origin, direction, |i| {
        if let Some((t, dark)) = meet(&facets[i as usize], origin, direction, tolerance).filter(|(t, _)| *t > 0.0) {
            if t < nearest - tolerance || (t < nearest + tolerance && !dark) {
                (nearest, front) = (t, (!dark).then_some(i));
            }
        }
        nearest + 2.0 * tolerance
    });
    front
}
