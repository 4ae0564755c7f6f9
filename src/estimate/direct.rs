//! Light that arrives straight from point lights, as the mean irradiance of patches and elements.
//!
//! Unobstructed it is a solid angle, in closed form. Where nothing can be shown to stand between, that is the answer,
//! without rays; elsewhere shadow rays find the visible share of it.

use super::Emitter;
use super::shadow::{is_open, lit};
use crate::formfactor::catalogue::polygon_solid_angle;
use crate::formfactor::point_to_polygon;
use crate::math::{DVec3, compensated_sum};
use crate::raycast::Tracer;
use crate::sampling::{Stream, owen_scrambled, sobol};
use crate::scene::{Distribution, PointLight, Region, Stage};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Pairs of facet and lit surface beyond which nothing is proved: rays are faster then.
const MOST_PROOFS: usize = 1 << 30;

/// A surface that may be lit: where its rays start, and what of it takes part.
#[derive(Debug, Clone, Copy)]
pub struct Lit<'a> {
    /// Where shadow rays start.
    pub emitter: &'a Emitter,
    /// The part that takes part.
    pub region: &'a Region,
    /// Area of that, m^2.
    pub area: f64,
}

/// The patches of a stage as surfaces that may be lit.
pub fn lit_patches<'a>(stage: &'a Stage, emitters: &'a [Option<Emitter>]) -> Vec<Option<Lit<'a>>> {
    let of = |(e, p): (&'a Option<Emitter>, &'a crate::scene::Patch)| {
        e.as_ref().map(|emitter| Lit { emitter, region: &p.region, area: p.area })
    };
    emitters.iter().zip(&stage.patches).map(of).collect()
}

/// The elements of a stage likewise.
pub fn lit_elements<'a>(stage: &'a Stage, emitters: &'a [Option<Emitter>]) -> Vec<Option<Lit<'a>>> {
    let of = |(e, p): (&'a Option<Emitter>, &'a crate::scene::Element)| {
        e.as_ref().map(|emitter| Lit { emitter, region: &p.region, area: p.area })
    };
    emitters.iter().zip(&stage.elements).map(of).collect()
}

/// Mean irradiance by point lights, W/m^2 per band.
#[derive(Debug, Clone, PartialEq)]
pub struct DirectLight {
    /// Number of bands.
    pub bands: usize,
    /// Means over all randomisations: surfaces x bands.
    pub mean: Vec<f64>,
    /// The same with randomisation r left out: R vectors.
    pub left_out: Vec<Vec<f64>>,
}

impl DirectLight {
    /// Independent replicates (pseudo-values of the means): R vectors, surfaces x bands.
    pub fn replicates(&self) -> Vec<Vec<f64>> {
        let r = self.left_out.len() as f64;
        let pseudo = |without: &Vec<f64>| self.mean.iter().zip(without).map(|(m, w)| r * m - (r - 1.0) * w).collect();
        self.left_out.iter().map(pseudo).collect()
    }
}

/// Mean irradiance of every surface by the point lights of the stage: `None` where there are no lights.
///
/// Surfaces that a light sees whole get the closed form, without error. Of others the visible share, weighted with the
/// kernel, is found by `rays` shadow rays in each of R randomisations: nothing if no ray arrives, all of it if all do.
pub fn direct_light(
    tracer: &Tracer,
    surfaces: &[Option<Lit>],
    stream: Stream,
    rays: u64,
    randomisations: u16,
) -> Option<DirectLight> {
    let stage = tracer.stage();
    if stage.lights.is_empty() {
        return None;
    }
    let bands = stage.band_count();
    let prove = surfaces.len().saturating_mul(stage.facets.len()) <= MOST_PROOFS;
    let one = |surface: &Option<Lit>| {
        let mut all = vec![vec![0.0; bands]; 1 + usize::from(randomisations)];
        let Some(surface) = surface else { return all };
        for (l, light) in stage.lights.iter().enumerate() {
            let open = unobstructed(light, surface);
            if open <= 0.0 {
                continue;
            }
            let clear = prove && surface.region.pieces.iter().all(|p| is_open(stage, light.position, p));
            let stream = stream.child(surface.emitter.key).child(l as u64);
            let shares = if clear { None } else { Some(shares(tracer, surface, light, stream, rays, randomisations)) };
            for (k, values) in all.iter_mut().enumerate() {
                let share = shares.as_ref().map_or(1.0, |s| s[k]);
                values.iter_mut().zip(&light.intensity).for_each(|(v, i)| *v += i * open * share);
            }
        }
        all
    };
    let each: Vec<Vec<Vec<f64>>> = surfaces.par_iter().map(one).collect();
    let column = |k: usize| each.iter().flat_map(|s| s[k].iter().copied()).collect();
    let left_out = (1..=usize::from(randomisations)).map(column).collect();
    Some(DirectLight { bands, mean: column(0), left_out })
}

/// Mean irradiance per intensity (1/m^2) if nothing stood between.
fn unobstructed(light: &PointLight, surface: &Lit) -> f64 {
    let piece = |p: &Vec<DVec3>| match light.distribution {
        Distribution::Isotropic => polygon_solid_angle(light.position, p),
        Distribution::Lambert(axis) => PI * point_to_polygon(light.position, axis, p),
    };
    compensated_sum(surface.region.pieces.iter().map(piece)) / surface.area
}

/// Visible share of the light, weighted with the kernel: over all randomisations, then with each left out.
fn shares(
    tracer: &Tracer,
    surface: &Lit,
    light: &PointLight,
    stream: Stream,
    rays: u64,
    randomisations: u16,
) -> Vec<f64> {
    let sums: Vec<[f64; 2]> =
        (0..randomisations).map(|r| weights(tracer, surface, light, stream.child(u64::from(r)), rays)).collect();
    let total = |skip: Option<usize>| {
        let kept = || sums.iter().enumerate().filter(move |(r, _)| Some(*r) != skip);
        let all: f64 = kept().map(|(_, s)| s[1]).sum();
        if all > 0.0 { kept().map(|(_, s)| s[0]).sum::<f64>() / all } else { 0.0 }
    };
    std::iter::once(None).chain((0..sums.len()).map(Some)).map(total).collect()
}

/// Sums of the kernel `I(t) cos / d^2` over the samples: of those that see the light, and of all.
fn weights(tracer: &Tracer, surface: &Lit, light: &PointLight, stream: Stream, rays: u64) -> [f64; 2] {
    let digits = [stream.child(0), stream.child(1)];
    let unit = |k: u64, d: usize| (owen_scrambled(sobol(k, d), digits[d]) >> 11) as f64 * f64::powi(2.0, -53);
    let mut sums = [0.0; 2];
    let mut first = 0;
    while first < rays {
        let count = (rays - first).min(256);
        let points: Vec<DVec3> =
            (first..first + count).map(|k| surface.emitter.map.at(unit(k, 0), unit(k, 1))).collect();
        let seen = lit(tracer, surface.emitter.facet, &points, light.position);
        for (p, seen) in points.iter().zip(seen) {
            let to = light.position - *p;
            let cosine = to.dot(surface.emitter.frame.z).max(0.0) / to.length();
            let kernel = light.share_towards(*p) * cosine / to.length_squared();
            sums[0] += if seen { kernel } else { 0.0 };
            sums[1] += kernel;
        }
        first += count;
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::patch_emitters;
    use crate::io::scene::{SceneOptions, open_scene};
    use crate::raycast::{KernelKind, open_kernels};
    use crate::sampling::Role;

    fn of(text: &str, rays: u64) -> (Stage, DirectLight) {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("s.toml");
        std::fs::write(&path, text).unwrap();
        let stage = open_scene(path.to_str().unwrap(), &SceneOptions::default()).unwrap().at(0).unwrap();
        let kernels = open_kernels(KernelKind::Builtin, &stage).unwrap();
        let tracer = Tracer::new(&stage, kernels.kernel, kernels.exact, false);
        let emitters = patch_emitters(&stage);
        let stream = Stream::new(Role::Judge, 0);
        let direct = direct_light(&tracer, &lit_patches(&stage, &emitters), stream, rays, 8).unwrap();
        (stage, direct)
    }

    const HEAD: &str = "format = \"etalon-scene/1\"\n[photometry]\nbands = [\"y\"]\n[[material]]\nname = \"m\"\n\
                        reflectance = 0.5\n[[surface]]\nname = \"floor\"\nmaterial = \"m\"\n\
                        polygon = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]]\npatches = 2\n";

    #[test]
    fn a_light_over_a_floor_is_in_closed_form() {
        let lamp = "[[light]]\ntype = \"point\"\nposition = [1, 1, 1]\nintensity = 6\n";
        let (_, direct) = of(&format!("{HEAD}{lamp}"), 16);
        // Each quarter of the floor of a cube of 2 m: a 24th of the sphere on 1 m^2.
        let exact = 6.0 * 4.0 * PI / 24.0;
        assert!(direct.mean.iter().all(|h| (h - exact).abs() < 1e-13), "{:?}", direct.mean);
        assert!(direct.left_out.iter().all(|r| *r == direct.mean), "no rays, no error");
        let lamp = "[[light]]\ntype = \"point\"\nposition = [1, 1, 1]\nintensity = 1\ndistribution = \"lambert\"\n\
                    direction = [0, 0, -2]\n";
        let (_, direct) = of(&format!("{HEAD}{lamp}"), 16);
        // Howell C-11's element: the factor of a unit square over its corner, 1 m away, times pi.
        let root = 0.5f64.sqrt();
        assert!(direct.mean.iter().all(|h| (h - root * root.atan()).abs() < 1e-14), "{:?}", direct.mean);
        let behind = lamp.replace("-2", "2");
        assert!(of(&format!("{HEAD}{behind}"), 16).1.mean.iter().all(|h| *h == 0.0));
    }

    /// A half plane over x < 1 hides exactly the half of every patch beyond its shadow's edge.
    #[test]
    fn shadows_are_found_by_rays_and_their_error_is_told() {
        let screen = "[[surface]]\nname = \"screen\"\nmaterial = \"m\"\n\
                      polygon = [[-9, -9, 0.5], [0.75, -9, 0.5], [0.75, 9, 0.5], [-9, 9, 0.5]]\n\
                      [[light]]\ntype = \"point\"\nposition = [1, 1, 1]\nintensity = 1\n";
        let (stage, direct) = of(&format!("{HEAD}{screen}"), 1024);
        // The shadow's edge: x = 1 - 2 * 0.25 = 0.5 on the floor, through the middle of patches 0 and 2.
        let seen = [[0.5, 0.], [1., 0.], [1., 1.], [0.5, 1.]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let exact = polygon_solid_angle(DVec3::ONE, &seen);
        let replicates = direct.replicates();
        for i in [0, 2] {
            let values: Vec<f64> = replicates.iter().map(|r| r[i]).collect();
            let e = crate::stats::mean_interval(&values, 1.0 - 1e-6);
            assert!(e.std_err.unwrap() > 0.0 && e.std_err.unwrap() < 2e-3 * exact, "{e:?}");
            assert!(e.low <= exact && exact <= e.high, "patch {i}: {e:?} {exact}");
        }
        // Beside the shadow: all of it, without error.
        let whole = polygon_solid_angle(DVec3::ONE, &stage.patches[1].corners);
        assert!((direct.mean[1] - whole).abs() < 1e-14 && direct.left_out.iter().all(|r| r[1] == direct.mean[1]));
        // The screen faces up, its own front is lit.
        assert!(direct.mean[4] > 0.0);
    }
}
