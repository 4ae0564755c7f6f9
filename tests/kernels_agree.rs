//! Every kernel against brute force and against every other.
//!
//! Scenes are made in code, seeds are fixed. Where there is no Embree its part is skipped with a notice.

use etalon::math::{DVec3, unit_normal};
use etalon::raycast::specimen::{Numbers, box_polygons, bumpy_ball, clutter, rays_from, rotated, tessellated};
use etalon::raycast::{
    BuiltinKernel, KernelError, KernelInfo, KernelKind, Kernels, RayBatch, RayKernel, agree, open_kernels, plane_groups,
};
use etalon::scene::{NO_FACET, Stage};

/// The textbook: every triangle of every facet by Cramer's rule (Moeller and Trumbore), nearest wins.
struct BruteForce<'a> {
    stage: &'a Stage,
    groups: Vec<u32>,
    info: KernelInfo,
}

impl<'a> BruteForce<'a> {
    fn new(stage: &'a Stage) -> Self {
        let info = KernelInfo { name: "brute force".into(), version: "0".into(), path: None, instruction_set: None };
        Self { stage, groups: plane_groups(stage), info }
    }

    fn nearest(&self, o: DVec3, d: DVec3, from: u32) -> u32 {
        let own = self.groups.get(from as usize);
        let mut best = (f64::INFINITY, NO_FACET);
        for (f, facet) in self.stage.facets.iter().enumerate().filter(|(f, _)| Some(&self.groups[*f]) != own) {
            let v = &facet.vertices;
            for k in 1..v.len() - 1 {
                if let Some(t) = triangle(o, d, v[0], v[k], v[k + 1]).filter(|t| *t < best.0) {
                    best = (t, f as u32);
                }
            }
        }
        best.1
    }
}

fn triangle(o: DVec3, d: DVec3, a: DVec3, b: DVec3, c: DVec3) -> Option<f64> {
    let (e1, e2, s) = (b - a, c - a, o - a);
    let p = d.cross(e2);
    let q = s.cross(e1);
    let det = e1.dot(p);
    let (u, v, t) = (s.dot(p) / det, d.dot(q) / det, e2.dot(q) / det);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0).then_some(t)
}

impl RayKernel for BruteForce<'_> {
    fn info(&self) -> &KernelInfo {
        &self.info
    }
    fn intersect(&self, rays: &RayBatch, facets: &mut [u32]) {
        for (k, f) in facets.iter_mut().enumerate() {
            *f = self.nearest(rays.origin_of(k), rays.direction_of(k), rays.from);
        }
    }
}

fn hits(kernel: &dyn RayKernel, rays: &RayBatch) -> Vec<u32> {
    let mut facets = vec![0; rays.len()];
    kernel.intersect(rays, &mut facets);
    facets
}

fn escapes(kernel: &dyn RayKernel, batches: &[RayBatch]) -> usize {
    batches.iter().map(|r| hits(kernel, r).iter().filter(|f| **f == NO_FACET).count()).sum()
}

/// `n` rays from every `every`-th facet.
fn batches(stage: &Stage, every: usize, n: usize, seed: u64) -> Vec<RayBatch> {
    let mut numbers = Numbers::new(seed);
    (0..stage.facets.len() as u32).step_by(every).map(|f| rays_from(stage, f, n, &mut numbers)).collect()
}

fn odd_axis() -> DVec3 {
    DVec3::new(1.0, 2.0, 3.0).normalize()
}

/// A room with boxes in it, which may pass through one another.
fn cluttered(boxes: usize, seed: u64, turn: f64) -> Stage {
    let polygons = clutter(DVec3::new(3.0, 4.0, 2.5), boxes, &mut Numbers::new(seed));
    Stage::from_polygons(&rotated(&polygons, odd_axis(), turn))
}

/// The Embree kernels of this build, none where there is no library.
fn embree(stage: &Stage) -> Vec<Kernels> {
    let mut kinds = vec![KernelKind::Embree];
    if cfg!(feature = "embree4-rs") {
        kinds.push(KernelKind::Embree4Rs);
    }
    let opened = kinds.into_iter().map(|kind| match open_kernels(kind, stage) {
        Ok(kernels) => Some(kernels),
        Err(e @ KernelError::NotFound { .. }) => {
            eprintln!("skipped: {e}");
            None
        }
        Err(e) => panic!("{kind:?}: {e}"),
    });
    opened.flatten().collect()
}

/// Embree must see what the built-in kernel sees.
fn embree_agrees(name: &str, stage: &Stage, batches: &[RayBatch]) {
    for Kernels { kernel, exact, .. } in embree(stage) {
        let a = agree(kernel.as_ref(), exact.as_ref(), stage, batches);
        eprintln!("{name}, {}: {} rays, {:.1e} near an edge", a.kernels[0].name, a.rays, a.near_edge);
        assert!(a.holds(), "{name}: {a:#?}");
    }
}

#[test]
fn the_built_in_kernel_finds_what_brute_force_finds() {
    for seed in 0..8 {
        let stage = cluttered(20, seed, 0.3 * seed as f64);
        let (kernel, brute) = (BuiltinKernel::new(&stage), BruteForce::new(&stage));
        for rays in batches(&stage, 1, 150, seed) {
            let found = hits(&kernel, &rays);
            let mut by_all = vec![0; rays.len()];
            kernel.intersect_all(&rays, &mut by_all);
            assert_eq!(found, by_all, "the hierarchy loses hits");
            assert_eq!(found, hits(&brute, &rays), "seed {seed}, from {}", rays.from);
        }
    }
}

#[test]
fn closed_rooms_at_any_angle_lose_no_ray() {
    let l_shape = |turn| {
        // Two boxes that share an opening: the floor and ceiling are cut where the side wall ends.
        let cut = [0.0, 1.0, 2.5].map(|x| DVec3::new(x, 0.0, 0.0));
        let mut polygons = Vec::new();
        for (k, (y, skip)) in [(2.0, 1), (1.0, 0)].into_iter().enumerate() {
            let (low, high) = (cut[k], DVec3::new(cut[k + 1].x, y, 0.8));
            polygons.extend(box_polygons(low, high, true).into_iter().enumerate().filter(|f| f.0 != skip).map(|f| f.1));
        }
        let [a, b] = [1.0, 2.0].map(|y| DVec3::new(1.0, y, 0.0));
        polygons.push(vec![a, a + DVec3::Z * 0.8, b + DVec3::Z * 0.8, b]);
        Stage::from_polygons(&rotated(&polygons, odd_axis(), turn))
    };
    let mut rooms = vec![("ball", Stage::from_polygons(&bumpy_ball(20, true)))];
    for turn in [0.0, 0.4, 1.9] {
        rooms.push(("clutter", cluttered(30, 3, turn)));
        rooms.push(("l-shape", l_shape(turn)));
    }
    let mut rays = 0;
    for (name, stage) in rooms {
        let n = 400_000 / stage.facets.len();
        let batches = batches(&stage, 1, n, 5);
        rays += batches.len() * n;
        assert_eq!(escapes(&BuiltinKernel::new(&stage), &batches), 0, "{name}");
        embree_agrees(name, &stage, &batches);
        for Kernels { kernel, .. } in embree(&stage) {
            assert!(escapes(kernel.as_ref(), &batches) <= 1, "{name}: cracks");
        }
    }
    assert!(rays > 2_500_000);
}

#[test]
fn a_front_beats_a_back_where_plates_coincide() {
    let mut polygons = box_polygons(DVec3::ZERO, DVec3::ONE, true);
    let plate = [(0.1, 0.2), (0.9, 0.2), (0.9, 0.8), (0.1, 0.8)].map(|(x, y)| DVec3::new(x, y, 0.37)).to_vec();
    // The back comes first, so that only the rule can prefer the front; the fronts differ in size.
    polygons.push(plate.iter().rev().copied().collect());
    polygons.push(plate.clone());
    let half: Vec<DVec3> = plate.iter().map(|v| DVec3::new(v.x, v.y.min(0.5), v.z)).collect();
    polygons.push(half);
    for turn in [0.0, 0.7, 2.1] {
        let stage = Stage::from_polygons(&rotated(&polygons, odd_axis(), turn));
        let kernel = BuiltinKernel::new(&stage);
        let mut seen = [0; 9];
        for (facet, n) in [(5, 40_000), (4, 40_000)] {
            let rays = rays_from(&stage, facet, n, &mut Numbers::new(9));
            hits(&kernel, &rays).iter().for_each(|f| seen[*f as usize] += 1);
            let wrong = if facet == 5 { 6 } else { 7 };
            assert!(hits(&kernel, &rays).iter().all(|f| *f != wrong && *f != 8), "turn {turn}, from {facet}");
        }
        assert!(seen[6] > 5_000 && seen[7] > 5_000, "{seen:?}");
        embree_agrees("plates", &stage, &batches(&stage, 1, 20_000, 4));
    }
}

#[test]
fn the_own_plane_is_never_met() {
    let room = box_polygons(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5), true);
    for turn in [0.0, 0.2, 1.1] {
        let stage = Stage::from_polygons(&rotated(&tessellated(&room, 9, 9), odd_axis(), turn));
        let groups = plane_groups(&stage);
        let batches = batches(&stage, 1, 300, 6);
        let exact: Vec<Box<dyn RayKernel>> = vec![Box::new(BuiltinKernel::new(&stage))];
        let all = embree(&stage).into_iter().map(|k| Box::new(k.kernel) as Box<dyn RayKernel>).chain(exact);
        for kernel in all {
            for rays in &batches {
                let own = groups[rays.from as usize];
                let found = hits(kernel.as_ref(), rays);
                assert!(found.iter().all(|f| *f != NO_FACET && groups[*f as usize] != own), "turn {turn}");
            }
        }
        embree_agrees("tessellated room", &stage, &batches);
    }
}

/// Rays that start ever closer to the edges and corners of a tilted floor, down to rounding.
fn rays_near_edges(stage: &Stage, facet: u32) -> RayBatch {
    let v = &stage.facets[facet as usize].vertices;
    let mut numbers = Numbers::new(facet.into());
    let mut rays = rays_from(stage, facet, 20_000, &mut numbers);
    let centre = v.iter().sum::<DVec3>() / v.len() as f64;
    for k in 0..rays.len() {
        let (a, b) = (v[k % v.len()], v[(k + 1) % v.len()]);
        let along = if k % 3 == 0 { 10f64.powf(numbers.between(-14.0, -1.0)) } else { numbers.unit() };
        let edge = a.lerp(b, along);
        let origin = edge.lerp(centre, 10f64.powf(numbers.between(-12.0, -1.0)));
        rays.set(k, origin, rays.direction_of(k));
    }
    rays
}

#[test]
fn no_light_is_lost_next_to_a_wall() {
    // Walls at right angles, leaning inward (acute wedges at the floor), and a ball of triangles.
    let mut leaning = box_polygons(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5), true);
    leaning.iter_mut().flatten().filter(|v| v.z > 0.0).for_each(|v| *v = DVec3::new(1.9 + 0.1 * v.x, v.y, v.z));
    let upright = box_polygons(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5), true);
    for (name, polygons) in [("upright", upright), ("leaning", leaning), ("ball", bumpy_ball(3, true))] {
        for turn in [0.0, 0.3] {
            let stage = Stage::from_polygons(&rotated(&polygons, odd_axis(), turn));
            let batches: Vec<RayBatch> = (0..stage.facets.len() as u32).map(|f| rays_near_edges(&stage, f)).collect();
            assert_eq!(escapes(&BuiltinKernel::new(&stage), &batches), 0, "{name}");
            for Kernels { kernel, .. } in embree(&stage) {
                assert_eq!(escapes(kernel.as_ref(), &batches), 0, "{name}");
            }
            embree_agrees(name, &stage, &batches);
        }
    }
}

#[test]
fn sheets_too_close_for_single_precision_are_told_apart() {
    for gap in [1e-5, 1e-6, 1e-7, 1e-8] {
        let mut polygons = box_polygons(DVec3::ZERO, DVec3::ONE, true);
        polygons.extend(box_polygons(DVec3::new(0.1, 0.1, 0.5), DVec3::new(0.9, 0.9, 0.5 + 3.0 * gap), false));
        // A gap between two fronts: what starts on one meets the other.
        polygons.extend(box_polygons(DVec3::new(0.2, 0.2, 0.5 + 5.0 * gap), DVec3::new(0.8, 0.8, 0.6), false));
        let stage = Stage::from_polygons(&rotated(&polygons, odd_axis(), 0.9));
        embree_agrees(&format!("gap {gap}"), &stage, &batches(&stage, 1, 3_000, 8));
        let under = 12 + 4;
        let rays = rays_from(&stage, under, 2_000, &mut Numbers::new(2));
        for Kernels { kernel, .. } in embree(&stage) {
            let onto_sheet = hits(kernel.as_ref(), &rays).iter().filter(|f| **f == 6 + 5).count();
            assert!(onto_sheet > 1_990, "{onto_sheet}");
        }
    }
}

#[test]
fn cameras_near_and_far_see_the_same() {
    let stage = Stage::from_polygons(&bumpy_ball(12, false));
    let mut numbers = Numbers::new(11);
    for distance in [1.5, 30.0, 1e4, 1e8] {
        let eye = odd_axis() * distance;
        let mut rays = RayBatch::zeroed(5_003);
        for k in 0..rays.len() {
            rays.set(k, eye, (numbers.direction() * 1.2 - eye).normalize());
        }
        let brute = hits(&BruteForce::new(&stage), &rays);
        let differing = hits(&BuiltinKernel::new(&stage), &rays).iter().zip(&brute).filter(|(a, b)| a != b).count();
        assert!(differing <= usize::from(distance > 1e6), "{differing} at {distance}");
        assert!(brute.contains(&NO_FACET) && brute.iter().any(|f| *f != NO_FACET));
        embree_agrees(&format!("camera at {distance}"), &stage, &[rays]);
    }
}

#[test]
fn fine_meshes_agree() {
    let stage = Stage::from_polygons(&bumpy_ball(60, true));
    embree_agrees("43,200 triangles", &stage, &batches(&stage, 40, 300, 12));
}

#[test]
fn facets_that_are_not_quite_planar_stay_closed() {
    let mut polygons = box_polygons(DVec3::ZERO, DVec3::ONE, true);
    for v in polygons.iter_mut().flatten().filter(|v| **v == DVec3::ONE) {
        *v += DVec3::splat(1e-6);
    }
    assert!(polygons.iter().any(|p| (p[3] - p[0]).dot(unit_normal(&p[..3])).abs() > 1e-7));
    let stage = Stage::from_polygons(&polygons);
    let batches: Vec<RayBatch> = (0..6).map(|f| rays_from(&stage, f, 50_000, &mut Numbers::new(f.into()))).collect();
    assert_eq!(escapes(&BuiltinKernel::new(&stage), &batches), 0);
    embree_agrees("not quite planar", &stage, &batches);
}

#[test]
fn nothing_is_met_in_an_empty_scene() {
    let stage = Stage::from_polygons(&[]);
    let mut rays = RayBatch::zeroed(11);
    (0..11).for_each(|k| rays.set(k, DVec3::ZERO, DVec3::X));
    assert!(hits(&BuiltinKernel::new(&stage), &rays).iter().all(|f| *f == NO_FACET));
    for Kernels { kernel, .. } in embree(&stage) {
        assert!(hits(kernel.as_ref(), &rays).iter().all(|f| *f == NO_FACET));
    }
}
