//! Cars of some ninety faces each.

use super::solid::{Solids, v};
use etalon::math::DVec3;

const OBJECT: &str = "cars";

/// Half the breadth of the body; wheels stand outside of it, and mudguards would hide them.
const HALF: f64 = 0.72;

/// All cars: place of the middle, heading in degrees (0 is +x), paint.
pub fn build(solids: &mut Solids) {
    for (x, y, heading, paint) in [
        (2.0, -14.0, 90.0, "red"),
        (-2.0, -8.0, 270.0, "blue"),
        (2.0, 16.0, 90.0, "white"),
        (-2.0, 24.0, 270.0, "red"),
        (9.5, 2.0, 180.0, "blue"),
        (-2.0, 40.0, 270.0, "white"),
        (-12.0, -2.0, 0.0, "white"),
    ] {
        car(solids, v(x, y, 0.0), f64::to_radians(heading), paint);
    }
}

fn car(solids: &mut Solids, at: DVec3, heading: f64, paint: &str) {
    let (sine, cosine) = heading.sin_cos();
    let place = |p: DVec3| at + v(p.x * cosine - p.y * sine, p.x * sine + p.y * cosine, p.z);
    let mut add = |material: &str, corners: &[DVec3], faces: &[&[usize]]| {
        let corners: Vec<_> = corners.iter().map(|p| place(*p)).collect();
        solids.body((OBJECT, material), &corners, faces);
    };
    // The body: a convex outline seen from the side, drawn out over the breadth.
    let outline = [
        (-2.05, 0.3),
        (-1.95, 0.22),
        (1.95, 0.22),
        (2.05, 0.32),
        (2.05, 0.5),
        (1.75, 0.72),
        (0.9, 0.82),
        (-1.6, 0.82),
        (-2.0, 0.75),
        (-2.05, 0.6),
    ];
    let n = outline.len();
    let corners: Vec<_> = [-HALF, HALF].iter().flat_map(|y| outline.map(|(x, z)| v(x, *y, z))).collect();
    let around: Vec<Vec<usize>> = (0..n).map(|k| vec![k, (k + 1) % n, n + (k + 1) % n, n + k]).collect();
    let sides = [(0..n).collect::<Vec<_>>(), (n..2 * n).collect()];
    let faces: Vec<&[usize]> = around.iter().chain(&sides).map(Vec::as_slice).collect();
    add(paint, &corners, &faces);
    cabin(&mut add, paint);
    for (x, out) in [(-2.05f64, -1.0f64), (2.05, 1.0)] {
        // Bumpers and lamps stand on its ends.
        let (a, b) = (x, x + out * 0.12);
        block(&mut add, "rubber", v(a.min(b), -HALF, 0.34), v(a.max(b), HALF, 0.46));
        let lamp = if out > 0.0 { "headlamp" } else { "taillamp" };
        for y in [-0.55, 0.55] {
            let (a, b) = (x, x + out * 0.04);
            let top = if out > 0.0 { 0.498 } else { 0.585 };
            block(&mut add, lamp, v(a.min(b), y - 0.12, 0.462), v(a.max(b), y + 0.12, top));
        }
    }
    for (x, side) in [(-1.3, -1.0), (-1.3, 1.0), (1.3, -1.0), (1.3, 1.0)] {
        let (a, b) = (v(x, side * (HALF + 0.01), 0.302), v(x, side * (HALF + 0.19), 0.302));
        wheel(solids, &place, a, b);
    }
}

/// Windows within pillars, and the roof.
fn cabin(add: &mut impl FnMut(&str, &[DVec3], &[&[usize]]), paint: &str) {
    let ring = |front: f64, back: f64, half: f64, z: f64| {
        [v(front, -half, z), v(front, half, z), v(back, half, z), v(back, -half, z)]
    };
    let (low, high) = (ring(0.85, -1.55, 0.66, 0.82), ring(0.25, -1.1, 0.5, 1.4));
    let whole: Vec<DVec3> = low.into_iter().chain(high).collect();
    add(paint, &whole, &[&[0, 1, 2, 3], &[4, 5, 6, 7]]);
    let middle = whole.iter().sum::<DVec3>() / 8.0;
    for k in 0..4 {
        let n = (k + 1) % 4;
        let outer = [low[k], low[n], high[n], high[k]];
        let centre = outer.iter().sum::<DVec3>() / 4.0;
        let pane = outer.map(|p| centre + (p - centre) * 0.82);
        for i in 0..4 {
            let j = (i + 1) % 4;
            // The middle of the cabin tells which side is outside.
            let corners = [outer[i], outer[j], pane[j], pane[i], middle, middle, middle, middle];
            add(paint, &corners, &[&[0, 1, 2, 3]]);
        }
        let corners = [pane[0], pane[1], pane[2], pane[3], middle, middle, middle, middle];
        add("window", &corners, &[&[0, 1, 2, 3]]);
    }
}

fn block(add: &mut impl FnMut(&str, &[DVec3], &[&[usize]]), material: &str, low: DVec3, high: DVec3) {
    let corner = |k: usize| {
        let pick = |bit: usize, a: f64, b: f64| if k >> bit & 1 == 0 { a } else { b };
        v(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z))
    };
    let corners: Vec<_> = (0..8).map(corner).collect();
    add(
        material,
        &corners,
        &[&[0, 2, 6, 4], &[1, 3, 7, 5], &[0, 1, 5, 4], &[2, 3, 7, 6], &[0, 1, 3, 2], &[4, 5, 7, 6]],
    );
}

/// A tyre of ten sides that stands on the road, and the hub cap.
fn wheel(solids: &mut Solids, place: &impl Fn(DVec3) -> DVec3, inner: DVec3, outer: DVec3) {
    let (a, b) = (place(inner), place(outer));
    solids.prism((OBJECT, "rubber"), [a, b], [0.3; 2], 10, [true, true]);
    let out = (b - a).normalize();
    solids.prism((OBJECT, "metal"), [b, b + out * 0.02], [0.18, 0.15], 6, [true, true]);
}
