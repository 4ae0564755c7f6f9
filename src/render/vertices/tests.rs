//! Known answers: the weights of the paper, linear fields, constants, what stays sharp, what the mean does.

use super::*;
use crate::math::{Bilinear, area, centroid, triangle_cell_corners};
use crate::scene::{Grid, Material, Stage};
use proptest::prelude::*;

const SKEWED: [DVec3; 4] =
    [DVec3::new(0.0, 0.0, 1.0), DVec3::new(3.0, 0.5, 1.0), DVec3::new(3.5, 2.5, 1.0), DVec3::new(0.5, 2.0, 1.0)];

fn quads(corners: [DVec3; 4], na: u32, nb: u32) -> Vec<Vec<DVec3>> {
    let map = Bilinear::new(corners);
    (0..na * nb).map(|k| map.cell(k % na, k / na, na, nb).to_vec()).collect()
}

fn triangles(n: u32) -> Vec<Vec<DVec3>> {
    let t = [SKEWED[0], SKEWED[1], SKEWED[3]];
    let place = |k| Grid::Triangle { n }.place(k);
    (0..(n * n) as usize).map(|k| triangle_cell_corners(t, n, place(k).0, place(k).1).to_vec()).collect()
}

fn unit_square() -> [DVec3; 4] {
    [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y]
}

fn linear(p: DVec3) -> f64 {
    40.0 + 3.0 * p.x - 5.0 * p.y
}

/// Largest error at any vertex, and at points within every cell, for a linear field given by its means.
fn error_on_linear(polygons: &[Vec<DVec3>]) -> f64 {
    let stage = Stage::from_polygons(polygons);
    let mesh = Mesh::of_patches(&stage);
    let means: Vec<f64> = polygons.iter().map(|p| linear(centroid(p))).collect();
    let values = Stencils::of(&mesh).values(&means);
    let at_vertices = mesh.vertices().iter().zip(&values).map(|(v, x)| (x - linear(v.point)).abs());
    let inside = polygons.iter().enumerate().flat_map(|(i, polygon)| {
        let (mesh, values) = (&mesh, &values);
        let near = move |c: &DVec3| *c * 0.7 + centroid(polygon) * 0.3;
        polygon.iter().map(near).map(move |p| (mesh.value_at(i, p, values) - linear(p)).abs())
    });
    at_vertices.chain(inside).fold(0.0, f64::max)
}

#[test]
fn linear_fields_come_back_inside_at_the_rim_and_in_the_corners() {
    for (na, nb) in [(2, 2), (3, 5), (8, 2), (13, 13)] {
        let e = error_on_linear(&quads(SKEWED, na, nb));
        assert!(e < 1e-11, "{na} x {nb}: {e}");
    }
    for n in [2, 3, 4, 9] {
        let e = error_on_linear(&triangles(n));
        assert!(e < 1e-11, "triangle in {n} rows: {e}");
    }
}

#[test]
fn facets_of_one_plane_are_one_surface_even_where_their_cells_differ_in_size() {
    let left = [DVec3::ZERO, DVec3::X, DVec3::X + 2.0 * DVec3::Y, 2.0 * DVec3::Y];
    let right = [DVec3::X, DVec3::new(5.0, 0.0, 0.0), DVec3::new(5.0, 2.0, 0.0), DVec3::new(1.0, 2.0, 0.0)];
    let polygons = [quads(left, 4, 4), quads(right, 3, 4)].concat();
    assert!(error_on_linear(&polygons) < 1e-11);
    let stage = Stage::from_polygons(&polygons);
    assert_eq!(Mesh::of_patches(&stage).vertices().len(), 5 * 5 + 3 * 5);
}

#[test]
fn divisions_that_do_not_meet_make_one_surface_too() {
    let left = [DVec3::ZERO, DVec3::X, DVec3::X + 2.0 * DVec3::Y, 2.0 * DVec3::Y];
    let right = [DVec3::X, DVec3::new(2.0, 0.0, 0.0), DVec3::new(2.0, 2.0, 0.0), DVec3::new(1.0, 2.0, 0.0)];
    let polygons = [quads(left, 4, 5), quads(right, 3, 7)].concat();
    let e = error_on_linear(&polygons);
    assert!(e < 1e-11, "{e}");
    let stage = Stage::from_polygons(&polygons);
    let mesh = Mesh::of_patches(&stage);
    // Curved across the border only: both sides take the same value there, which neither could extrapolate alone.
    let curved = |p: DVec3| 10.0 + 30.0 * p.x * p.x;
    let b: Vec<f64> = polygons.iter().map(|p| curved(centroid(p))).collect();
    let values = Stencils::of(&mesh).values(&b);
    let side = |cells: std::ops::Range<usize>, p: DVec3| {
        let holds = |c: &usize| {
            mesh.corners(*c).iter().map(|v| v.y - p.y).fold([9.0, -9.0f64], |[l, h], d| [l.min(d), h.max(d)])
        };
        let touches = |c: &usize| mesh.corners(*c).iter().any(|v| (v.x - 1.0).abs() < 1e-9);
        let cell = cells.filter(touches).find(|c| holds(c)[0] <= 0.0 && holds(c)[1] >= 0.0).expect("a cell");
        mesh.value_at(cell, p, &values)
    };
    for k in 0..40 {
        let p = DVec3::new(1.0, 0.05 * f64::from(k) + 0.01, 0.0);
        let (l, r) = (side(0..20, p), side(20..41, p));
        assert!((l - r).abs() < 1e-9, "at {p}: {l} against {r}");
    }
}

#[test]
fn the_weights_are_those_of_the_paper() {
    let stage = Stage::from_polygons(&quads(unit_square(), 4, 4));
    let mesh = Mesh::of_patches(&stage);
    let b: Vec<f64> = (0..16).map(|k| f64::from(k * k % 11) + 5.0).collect();
    let values = Stencils::of(&mesh).values(&b);
    let at = |x: f64, y: f64| {
        let p = DVec3::new(x, y, 0.0) / 4.0;
        values[mesh.vertices().iter().position(|v| v.point.distance(p) < 1e-9).expect("a vertex")]
    };
    let inner = (b[0] + b[1] + b[4] + b[5]) / 4.0;
    assert!((at(1.0, 1.0) - inner).abs() < 1e-12);
    assert!((at(1.0, 0.0) - (b[0] + b[1] - inner)).abs() < 1e-12, "rim: B1 + B2 - inner");
    assert!((at(0.0, 0.0) - (2.0 * b[0] - inner)).abs() < 1e-12, "corner: 2 B1 - inner");
}

#[test]
fn a_strip_is_level_across_and_a_single_patch_is_level() {
    // Not quite straight, as measured rooms are: what little spread there is across must not be stretched.
    let crooked = [DVec3::ZERO, DVec3::new(4.0, 0.0, 0.0), DVec3::new(4.0, 1.01, 0.0), DVec3::new(0.0, 1.0, 0.0)];
    let stage = Stage::from_polygons(&quads(crooked, 4, 1));
    let mesh = Mesh::of_patches(&stage);
    let values = Stencils::of(&mesh).values(&[1.0, 3.0, 4.0, 4.5]);
    for (v, x) in mesh.vertices().iter().zip(&values) {
        let expected = [0.0, 2.0, 3.5, 4.25, 4.75][v.point.x.round() as usize];
        assert!((x - expected).abs() < 0.06, "at {}: {x}, not {expected}", v.point);
    }
    let alone = Stage::from_polygons(&quads(unit_square(), 1, 1));
    assert_eq!(Stencils::of(&Mesh::of_patches(&alone)).values(&[7.0]), [7.0; 4]);
}

#[test]
fn nothing_gets_darker_than_black_and_signed_fields_may() {
    let stage = Stage::from_polygons(&quads(unit_square(), 3, 3));
    let stencils = Stencils::of(&Mesh::of_patches(&stage));
    let mut b = [9.0; 9];
    (b[0], b[1], b[3]) = (0.5, 0.5, 0.5);
    let least = |b: &[f64]| stencils.values(b).into_iter().fold(f64::INFINITY, f64::min);
    assert_eq!(least(&b), 0.0);
    b[0] = -0.5;
    assert!(least(&b) < -1.0);
}

#[test]
fn edges_and_changes_of_material_stay_sharp() {
    let floor = quads(unit_square(), 2, 2);
    let wall = quads([DVec3::X, DVec3::X + DVec3::Z, DVec3::X + DVec3::Y + DVec3::Z, DVec3::X + DVec3::Y], 2, 2);
    let mut stage = Stage::from_polygons(&[floor, wall].concat());
    let values = |stage: &Stage, b: &[f64]| {
        let mesh = Mesh::of_patches(stage);
        let values = Stencils::of(&mesh).values(b);
        (mesh.vertices().len(), values.into_iter().map(|x| x.to_bits()).collect::<std::collections::BTreeSet<_>>())
    };
    let (vertices, seen) = values(&stage, &[1.0, 1.0, 1.0, 1.0, 5.0, 5.0, 5.0, 5.0]);
    assert_eq!((vertices, seen.len()), (18, 2), "floor and wall must not mix");
    stage.materials.push(Material { name: "red".into(), ..stage.materials[0].clone() });
    (stage.patches[1].material, stage.patches[3].material) = (1, 1);
    let (vertices, seen) = values(&stage, &[1.0, 2.0, 1.0, 2.0, 5.0, 5.0, 5.0, 5.0]);
    assert_eq!((vertices, seen.len()), (21, 3), "two materials must not mix");
}

#[test]
fn patches_that_take_no_part_are_left_out() {
    let polygons = quads(unit_square(), 4, 4);
    let mut stage = Stage::from_polygons(&polygons);
    stage.patches[5].area = 0.0;
    let mesh = Mesh::of_patches(&stage);
    let mut b: Vec<f64> = polygons.iter().map(|p| linear(centroid(p))).collect();
    b[5] = f64::NAN;
    let values = Stencils::of(&mesh).values(&b);
    assert!(mesh.vertices_of(5).is_empty());
    for (v, x) in mesh.vertices().iter().zip(&values) {
        assert!((x - linear(v.point)).abs() < 1e-11, "at {}: {x}", v.point);
    }
}

/// Area-weighted mean of the interpolated field: exact for parallelograms, whose mean is that of their corners.
fn mean_of_corners(mesh: &Mesh, values: &[f64]) -> f64 {
    let cell = |c: usize| {
        let own = mesh.vertices_of(c);
        area(mesh.corners(c)) * own.iter().map(|v| values[*v as usize]).sum::<f64>() / own.len() as f64
    };
    (0..mesh.cell_count()).map(cell).sum()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn constants_stay_and_the_mean_moves_little(b in prop::collection::vec(5.0..10.0f64, 64), c in 0.01..1e6f64) {
        let n = 8;
        let stage = Stage::from_polygons(&quads(unit_square(), n, n));
        let mesh = Mesh::of_patches(&stage);
        let stencils = Stencils::of(&mesh);
        prop_assert!(stencils.values(&[c; 64]).iter().all(|x| *x == c));
        // Stated bound: the largest step between neighbours over the number of cells along a side.
        let step = (0..64).map(|k| {
            let right = if k % 8 < 7 { (b[k + 1] - b[k]).abs() } else { 0.0 };
            let up = if k < 56 { (b[k + 8] - b[k]).abs() } else { 0.0 };
            right.max(up)
        });
        let bound = step.fold(0.0, f64::max) / f64::from(n);
        let shift = mean_of_corners(&mesh, &stencils.values(&b)) - b.iter().sum::<f64>() / 64.0;
        prop_assert!(shift.abs() <= bound, "{shift} against {bound}");
    }
}
