//! Scans against rays, clusters against the whole, coverage against areas.

use super::composite::composite;
use super::image::{Line, SpanFace, SpanImage};
use super::project::Projection;
use super::regenerate::{Scaling, regenerate};
use super::testing::{Random, image, part, triangles};
use crate::math::{DVec3, unit_normal};

/// Nearest face along the ray of a picture point, by plane and sides of the polygon: nothing in common with the scan.
fn nearest(image: &SpanImage, x: f64, y: f64) -> Option<(u32, f64)> {
    let ray = image.camera.ray(x, y);
    let hit = |(f, k): (&SpanFace, u32)| {
        let n = unit_normal(&f.vertices);
        let depth = n.dot(f.vertices[0] - image.camera.eye) / n.dot(ray);
        let p = image.camera.eye + ray * depth;
        let m = f.vertices.len();
        let side = |i: usize| (f.vertices[(i + 1) % m] - f.vertices[i]).cross(p - f.vertices[i]).dot(n);
        (depth > 0.0 && ((0..m).all(|i| side(i) >= 0.0) || (0..m).all(|i| side(i) <= 0.0))).then_some((k, depth))
    };
    image.faces.iter().zip(0..).filter_map(hit).min_by(|a, b| a.1.total_cmp(&b.1))
}

fn at(line: &Line, x: f64) -> Option<u32> {
    line.solid.iter().find(|s| s.from <= x && x < s.to).map(|s| s.face)
}

#[test]
fn the_scan_sees_what_rays_see() {
    let image = image(triangles(60, 1), 1, [64, 48], 3);
    let mut random = Random::new(2);
    let (mut seen, mut crossed) = (0, 0);
    for _ in 0..40_000 {
        let j = (random.next() * (image.lines.len() - 2) as f64) as usize + 1;
        let (x, y) = (random.within(0.0, 64.0), j as f64 / 3.0);
        let line = &image.lines[j];
        // Within rounding of an end both answers are right.
        if line.solid.iter().any(|s| (s.from - x).abs() < 1e-9 || (s.to - x).abs() < 1e-9) {
            continue;
        }
        let by_rays = nearest(&image, x, y);
        assert_eq!(at(line, x), by_rays.map(|(f, _)| f), "at {x}, {y}");
        if let Some((f, depth)) = by_rays {
            let w = image.faces[f as usize].depth(&image.camera).value(x, y);
            assert!((w * depth - 1.0).abs() < 1e-9);
            seen += 1;
        }
    }
    for line in &image.lines {
        crossed += line.solid.windows(2).filter(|w| w[0].to == w[1].from).count();
        assert!(line.solid.windows(2).all(|w| w[0].to <= w[1].from), "sorted, without overlaps");
    }
    assert!(seen > 10_000 && crossed > 500, "{seen} points on faces, {crossed} changes of face: too few to tell");
}

#[test]
fn clusters_in_any_order_are_the_whole() {
    for k in 2..=8 {
        let whole = image(triangles(80, 10 + u64::from(k)), k, [48, 36], 3);
        let mut random = Random::new(u64::from(k));
        for _ in 0..3 {
            let mut order: Vec<u32> = (0..k).collect();
            (1..order.len()).rev().for_each(|i| order.swap(i, (random.next() * (i + 1) as f64) as usize));
            let parts: Vec<SpanImage> = order.iter().map(|c| part(&whole, *c)).collect();
            let all = parts[1..].iter().fold(parts[0].clone(), |sum, p| composite(&sum, p).expect("of one view"));
            assert_eq!(all.faces, whole.faces);
            assert_eq!(all.clusters, whole.clusters);
            assert_eq!(all.lines, whole.lines, "{k} clusters, order {order:?}: not the same to the bit");
        }
    }
}

#[test]
fn pairs_first_are_the_same_as_one_by_one() {
    let whole = image(triangles(60, 5), 4, [40, 30], 2);
    let p: Vec<SpanImage> = (0..4).map(|c| part(&whole, c)).collect();
    let pairs = [composite(&p[3], &p[1]), composite(&p[2], &p[0])].map(|c| c.expect("of one view"));
    assert_eq!(composite(&pairs[0], &pairs[1]).expect("of one view"), whole);
}

#[test]
fn views_that_differ_and_clusters_twice_are_refused() {
    let whole = image(triangles(9, 5), 3, [40, 30], 2);
    let (a, b) = (part(&whole, 0), part(&whole, 1));
    let said = |a: &SpanImage, b: &SpanImage| composite(a, b).expect_err("refused").to_string();
    assert!(said(&a, &a).contains("both hold face"));
    assert!(said(&a, &SpanImage { per_line: 3, ..b.clone() }).contains("sub-scanlines"));
    let mut turned = b.clone();
    turned.camera.fov = 50.0;
    assert!(said(&a, &turned).contains("camera"));
    let mut other = b.clone();
    other.materials[0].reflectance[0] = 0.1;
    assert!(said(&a, &other).contains("\"grey\""));
}

/// Coverage of a face per pixel.
fn coverage(image: &SpanImage) -> Vec<f64> {
    let scaling = Scaling::new(image.per_line, image.camera.size, [1.0, 1.0]).expect("scale 1");
    regenerate(&scaling, 1, |j, row| image.lines[j as usize].solid.iter().for_each(|s| row.add(s.from, s.to, &[1.0])))
        .values
}

/// Area of a polygon in the picture within one pixel, cut by half-planes.
fn area_within(corners: &[(f64, f64)], pixel: (f64, f64)) -> f64 {
    let mut polygon: Vec<DVec3> = corners.iter().map(|c| DVec3::new(c.0, c.1, 0.0)).collect();
    for (normal, offset) in
        [(DVec3::X, pixel.0), (-DVec3::X, -pixel.0 - 1.0), (DVec3::Y, pixel.1), (-DVec3::Y, -pixel.1 - 1.0)]
    {
        if polygon.len() >= 3 {
            polygon = crate::math::clip_to_half_space(&polygon, normal, offset);
        }
    }
    if polygon.len() < 3 {
        return 0.0;
    }
    crate::math::area(&polygon)
}

#[test]
fn coverage_of_random_polygons_converges_to_their_area_at_second_order() {
    let size = [12, 9];
    let mut errors = Vec::new();
    let counts = [1, 2, 4, 8, 16, 32];
    for per_line in counts {
        let mut sum = 0.0;
        let mut pixels = 0;
        for seed in 0..40 {
            let triangle = triangles(1, 100 + seed);
            let projection = Projection::of(&super::testing::camera(size));
            let corners: Vec<_> =
                triangle[0].iter().filter_map(|v| projection.project(*v)).map(|(x, y, _)| (x, y)).collect();
            let image = image(triangle, 1, size, per_line);
            for (i, got) in coverage(&image).into_iter().enumerate() {
                let true_area = area_within(&corners, ((i % 12) as f64, (i / 12) as f64));
                let partly = true_area > 1e-9 && true_area < 1.0 - 1e-9;
                sum += (got - true_area).powi(2);
                pixels += usize::from(partly);
                assert!((got - true_area).abs() < 1.0 / f64::from(per_line), "{got} against {true_area}");
            }
        }
        errors.push((sum / pixels as f64).sqrt());
    }
    // Within a pixel the length of a polygon on a line is continuous but for level edges and kinked: trapezoids fall as
    // n^-2 where the kinks are, and the whole between n^-1.5 and n^-2.
    let rate = (errors[1] / errors[5]).ln() / 16f64.ln();
    assert!((1.5..2.2).contains(&rate), "{errors:?}: rate {rate}");
    assert!(errors[5] < 1e-3, "{errors:?}");
}
