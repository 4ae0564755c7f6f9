//! Carriageways, pavements with kerbs, markings, lamp posts.

use super::buildings::GROUND;
use super::solid::{Solids, v};
use etalon::math::DVec3;

const OBJECT: &str = "roads";
const MARK: (&str, &str) = (OBJECT, "marking");

/// Half the breadth of a carriageway, with the pavement, and how far the town goes.
const KERB: f64 = 4.0;
const BLOCK: f64 = 7.0;
const END: f64 = 110.0;

/// Markings lie this much above the road.
const PAINT: f64 = 0.005;

/// Where lamps hang, metres.
pub const LANTERNS: [[f64; 3]; 6] =
    [[3.1, -30.0, 5.8], [3.1, -13.0, 5.8], [3.1, 12.0, 5.8], [-3.1, 18.0, 5.8], [-3.1, -9.0, 5.8], [3.1, 34.0, 5.8]];

/// A level rectangle that is seen from above.
fn flat(solids: &mut Solids, of: (&str, &str), [x0, y0]: [f64; 2], [x1, y1]: [f64; 2], z: f64) {
    solids.face(of, vec![v(x0, y0, z), v(x1, y0, z), v(x1, y1, z), v(x0, y1, z)], DVec3::Z);
}

/// Everything that lies or stands on the ground.
pub fn build(solids: &mut Solids) {
    let road = (OBJECT, "asphalt");
    flat(solids, road, [-KERB, -KERB], [KERB, KERB], 0.0);
    for s in [-1.0, 1.0] {
        flat(solids, road, [-KERB, s * KERB], [KERB, s * END], 0.0);
        flat(solids, road, [s * KERB, -KERB], [s * END, KERB], 0.0);
    }
    for (sx, sy) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
        block(solids, sx, sy);
    }
    markings(solids);
    for [x, y, z] in LANTERNS {
        lamp_post(solids, x, y, z);
    }
}

/// A quarter of the town: pavement along two streets, and the ground behind it.
fn block(solids: &mut Solids, sx: f64, sy: f64) {
    let paving = (OBJECT, "paving");
    flat(solids, paving, [sx * KERB, sy * KERB], [sx * BLOCK, sy * BLOCK], GROUND);
    flat(solids, paving, [sx * KERB, sy * BLOCK], [sx * BLOCK, sy * END], GROUND);
    flat(solids, paving, [sx * BLOCK, sy * KERB], [sx * END, sy * BLOCK], GROUND);
    let ground = if sx > 0.0 && sy < 0.0 { "grass" } else { "paving" };
    flat(solids, (OBJECT, ground), [sx * BLOCK, sy * BLOCK], [sx * END, sy * END], GROUND);
    // Kerbs, in stones of their own as the pavement is.
    let kerb = (OBJECT, "kerb");
    for (a, b) in [(KERB, BLOCK), (BLOCK, END)] {
        let along_y = |y: f64, z: f64| v(sx * KERB, sy * y, z);
        let along_x = |x: f64, z: f64| v(sx * x, sy * KERB, z);
        let wall = |p: &dyn Fn(f64, f64) -> DVec3| vec![p(a, 0.0), p(b, 0.0), p(b, GROUND), p(a, GROUND)];
        solids.face(kerb, wall(&along_y), -DVec3::X * sx);
        solids.face(kerb, wall(&along_x), -DVec3::Y * sy);
    }
}

fn markings(solids: &mut Solids) {
    for s in [-1.0, 1.0] {
        for k in 0..16 {
            let at = 12.0 + 6.0 * f64::from(k);
            flat(solids, MARK, [-0.07, s * at], [0.07, s * (at + 3.0)], PAINT);
            flat(solids, MARK, [s * at, -0.07], [s * (at + 3.0), 0.07], PAINT);
        }
        // Zebra crossings, and the lines to stop at before them.
        for k in 0..7 {
            let at = -3.4 + f64::from(k);
            flat(solids, MARK, [at, s * 5.2], [at + 0.5, s * 8.2], PAINT);
            flat(solids, MARK, [s * 5.2, at], [s * 8.2, at + 0.5], PAINT);
        }
        flat(solids, MARK, [s * 0.2, s * -9.6], [s * 3.7, s * -9.2], PAINT);
        flat(solids, MARK, [s * -9.6, s * -3.7], [s * -9.2, s * -0.2], PAINT);
    }
}

/// A post on the pavement with an arm over the road, from which the lantern hangs.
fn lamp_post(solids: &mut Solids, x: f64, y: f64, z: f64) {
    let metal = (OBJECT, "metal");
    let foot = x.signum() * (KERB + 0.4);
    solids.prism(metal, [v(foot, y, GROUND), v(foot, y, z + 0.3)], [0.09, 0.06], 8, [true, true]);
    let (near, far) = (foot - x.signum() * 0.07, x);
    let (low, high) = (near.min(far), near.max(far));
    solids.cuboid(metal, v(low, y - 0.04, z + 0.19), v(high, y + 0.04, z + 0.27), &[]);
    // Light comes from below the pane.
    let lantern = |dx: f64, dy: f64, z: f64| v(x + dx, y + dy, z);
    for (a, b) in
        [((-1.0, -1.0), (1.0, -1.0)), ((1.0, -1.0), (1.0, 1.0)), ((1.0, 1.0), (-1.0, 1.0)), ((-1.0, 1.0), (-1.0, -1.0))]
    {
        let low = [a, b].map(|(i, j): (f64, f64)| lantern(0.22 * i, 0.16 * j, z + 0.06));
        let high = [a, b].map(|(i, j): (f64, f64)| lantern(0.12 * i, 0.1 * j, z + 0.18));
        let out = v(a.0 + b.0, a.1 + b.1, 0.0);
        solids.face(metal, vec![low[0], low[1], high[1], high[0]], out);
    }
    let lid = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(i, j)| lantern(0.12 * i, 0.1 * j, z + 0.18));
    solids.face(metal, lid.to_vec(), DVec3::Z);
    let pane = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(i, j)| lantern(0.22 * i, 0.16 * j, z + 0.06));
    solids.face((OBJECT, "headlamp"), pane.to_vec(), -DVec3::Z);
}
