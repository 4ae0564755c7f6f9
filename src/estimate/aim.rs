//! The rays of an emitter: samples of a net turned into origins and directions.

use super::Emitter;
use crate::math::{DVec3, Frame};
use crate::raycast::RayBatch;
use crate::sampling::{Net, PointMap, Stream, fold};

/// Rays of one batch: enough to feed packets, small enough for the first-level cache.
pub const BATCH: usize = 256;

/// Makes the rays of an emitter from samples `first ..` of a net.
pub fn fill(rays: &mut RayBatch, net: &Net, first: usize, emitter: &Emitter, shift: Stream) {
    let frame = turned_frame(emitter, shift);
    rays.from = emitter.facet;
    make_positions(rays, net, first, &emitter.map, [(shift.at(1) >> 33) as i32, (shift.at(2) >> 33) as i32]);
    make_directions(rays, net, first, &frame);
}

/// The frame in which the net's directions are taken: turned by an angle of the emitter's own.
pub fn turned_frame(emitter: &Emitter, shift: Stream) -> Frame {
    emitter.frame.turned(shift.unit(0) * std::f64::consts::TAU)
}

/// Middle of a 31-bit cell.
#[inline]
pub(super) fn unit(x: i32) -> f64 {
    (f64::from(x) + 0.5) * f64::powi(2.0, -31)
}

fn make_positions(rays: &mut RayBatch, net: &Net, first: usize, map: &PointMap, shift: [i32; 2]) {
    let n = rays.len();
    let (u, v) = (&net.u[first..first + n], &net.v[first..first + n]);
    match map {
        PointMap::Parallelogram { origin, e1, e2 } => place(rays, u, v, shift, [*origin, *e1, *e2], |u, v| (u, v)),
        PointMap::Triangle { origin, e1, e2 } => place(rays, u, v, shift, [*origin, *e1, *e2], fold),
        PointMap::Triangles(_) => {
            for k in 0..n {
                let p: DVec3 = map.at(unit(u[k] ^ shift[0]), unit(v[k] ^ shift[1]));
                (rays.origin[0][k], rays.origin[1][k], rays.origin[2][k]) = (p.x, p.y, p.z);
            }
        }
    }
}

/// Origins `o + a e1 + b e2`: straight loops that the compiler turns into vector code.
#[inline]
fn place(
    rays: &mut RayBatch,
    u: &[i32],
    v: &[i32],
    shift: [i32; 2],
    [o, e1, e2]: [DVec3; 3],
    shape: impl Fn(f64, f64) -> (f64, f64),
) {
    let n = u.len().min(BATCH);
    let (mut a, mut b) = ([0.0; BATCH], [0.0; BATCH]);
    for k in 0..n {
        (a[k], b[k]) = shape(unit(u[k] ^ shift[0]), unit(v[k] ^ shift[1]));
    }
    for c in 0..3 {
        let (o, e1, e2) = (o[c], e1[c], e2[c]);
        let out = &mut rays.origin[c][..n];
        for k in 0..n {
            out[k] = o + e1 * a[k] + e2 * b[k];
        }
    }
}

fn make_directions(rays: &mut RayBatch, net: &Net, first: usize, frame: &Frame) {
    let n = rays.len();
    let [lx, ly, lz] = std::array::from_fn(|c| &net.direction[c][first..first + n]);
    for c in 0..3 {
        let (x, y, z) = (frame.x[c], frame.y[c], frame.z[c]);
        let out = &mut rays.direction[c][..n];
        for k in 0..n {
            out[k] = f64::from(lx[k]) * x + f64::from(ly[k]) * y + f64::from(lz[k]) * z;
        }
    }
}
