//! What of the sky casters hide from a point: half planes about the axis of both horizons, in each of which the hidden
//! arcs are found exactly.
//!
//! From arc to arc the hidden light is a smooth function but where corners of casters pass: bands end there. Between
//! them two half planes are Gauss's points, weighted so that a sky hidden altogether is hidden exactly.

use super::cone::{Cones, turn};
use super::sky::{Lune, Sky};
use super::stretch::join;
use super::volumes::Volumes;
use crate::math::DVec3;
use std::cell::RefCell;

/// More corners than this many times the half planes asked for, and bands end no longer at corners; there are more of
/// them instead.
const MOST_CORNERS: usize = 8;
const MORE_BANDS: usize = 2;

/// Bands thinner than this, rad, are left out.
const THIN: f64 = 1e-12;

thread_local! {
    static ROOM: RefCell<Room> = RefCell::default();
}

/// The factor of what a point sees of the sky.
pub(super) fn seen(sky: &Sky, half_planes: usize, point: DVec3, normal: DVec3, own: u32, volumes: &Volumes) -> f64 {
    let open = sky.open(normal);
    let lune = Lune::new(normal, sky.up);
    if !(open > 0.0 && lune.end() > THIN) {
        return 0.0;
    }
    ROOM.with_borrow_mut(|room| {
        room.cones.gather(&lune, point, normal, own, volumes);
        if room.cones.is_empty() {
            return open;
        }
        room.draw_bands(half_planes, lune.end());
        room.find_arcs();
        (open - room.hidden(sky, &lune).unwrap_or(open)).clamp(0.0, open)
    })
}

/// Room for one point, used again and again.
#[derive(Default)]
struct Room {
    cones: Cones,
    /// Where bands begin and end, rad.
    bands: Vec<f64>,
    /// Two for each band, and the hidden arcs of each: stretches of x = cot(psi).
    planes: Vec<HalfPlane>,
    arcs: Vec<Vec<(f64, f64)>>,
}

/// Of an angle phi.
#[derive(Clone, Copy)]
pub(super) struct HalfPlane {
    pub sine: f64,
    pub cosine: f64,
    /// Grows with phi.
    pub turn: f64,
}

impl HalfPlane {
    fn at(phi: f64) -> Self {
        let (sine, cosine) = phi.sin_cos();
        Self { sine, cosine, turn: turn(cosine, sine) }
    }
}

impl Room {
    /// Even bands, cut where corners are.
    fn draw_bands(&mut self, half_planes: usize, end: f64) {
        let mut even = half_planes.div_ceil(2).max(1);
        self.bands.clear();
        if self.cones.corners() <= MOST_CORNERS * half_planes {
            self.bands.extend(self.cones.corner_angles());
        } else {
            even *= MORE_BANDS;
        }
        self.bands.extend((0..=even).map(|k| end * k as f64 / even as f64));
        self.bands.sort_unstable_by(f64::total_cmp);
        self.bands.dedup_by(|next, last| *next - *last <= THIN);
        self.planes.clear();
        for band in self.bands.windows(2) {
            let (middle, off) = (0.5 * (band[0] + band[1]), (band[1] - band[0]) / 12f64.sqrt());
            self.planes.extend([HalfPlane::at(middle - off), HalfPlane::at(middle + off)]);
        }
    }

    /// The hidden arcs of all half planes.
    fn find_arcs(&mut self) {
        if self.arcs.len() < self.planes.len() {
            self.arcs.resize_with(self.planes.len(), Vec::new);
        }
        self.arcs[..self.planes.len()].iter_mut().for_each(Vec::clear);
        // Broad ones first: in a town they hide most of what stands behind them.
        for broad in [true, false] {
            for cone in self.cones.iter().filter(|c| c.is_broad() == broad) {
                let first = self.planes.partition_point(|p| p.turn < cone.from);
                for (plane, arcs) in self.planes[first..].iter().zip(&mut self.arcs[first..]) {
                    if plane.turn > cone.to {
                        break;
                    }
                    if let Some(arc) = self.cones.arc(cone, plane) {
                        add(arcs, arc);
                    }
                }
            }
        }
    }

    /// The light that is hidden; `None` if all of it is.
    fn hidden(&mut self, sky: &Sky, lune: &Lune) -> Option<f64> {
        let (mut sum, mut dark) = (0.0, true);
        let (sin_tilt, cos_tilt) = lune.tilt.sin_cos();
        for (band, (planes, arcs)) in self.planes.chunks(2).zip(self.arcs.chunks_mut(2)).enumerate() {
            if arcs.iter().all(Vec::is_empty) {
                dark = false;
                continue;
            }
            let (mut plain, mut raised, mut plain_unit, mut raised_unit) = (0.0, 0.0, 0.0, 0.0);
            for (plane, arcs) in planes.iter().zip(arcs) {
                join(arcs);
                dark &= arcs[..] == [(f64::NEG_INFINITY, f64::INFINITY)];
                let g = plane.sine * cos_tilt + plane.cosine * sin_tilt;
                for arc in arcs {
                    let arc = sky.arc(lune, plane, *arc);
                    plain += g * arc.plain;
                    raised += g * plane.sine * arc.raised;
                }
                plain_unit += g;
                raised_unit += g * plane.sine;
            }
            // Integrals over the band of sin(phi + tilt) and of sin(phi) sin(phi + tilt).
            let (a, width) = (self.bands[band], self.bands[band + 1] - self.bands[band]);
            let middle = a + 0.5 * width + lune.tilt;
            if plain_unit > 0.0 {
                sum += plain / plain_unit * 2.0 * middle.sin() * (0.5 * width).sin();
            }
            if raised_unit > 0.0 {
                let whole = 0.5 * (width * cos_tilt - width.sin() * (a + middle + 0.5 * width).cos());
                sum += raised / raised_unit * whole;
            }
        }
        (!dark).then_some(sum)
    }
}

/// Adds an arc to others: to the first of them if they touch, so that few are left to be sorted.
fn add(arcs: &mut Vec<(f64, f64)>, arc: (f64, f64)) {
    match arcs.first_mut() {
        Some(first) if arc.0 <= first.1 && first.0 <= arc.1 => *first = (first.0.min(arc.0), first.1.max(arc.1)),
        _ => arcs.push(arc),
    }
}
