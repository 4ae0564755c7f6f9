//! Patches of two regular grids: pairs that lie to each other alike have the same form factor, computed once.

use super::sides::{Lattice, Side};
use crate::math::DVec3;
use crate::scene::Patch;
use std::sync::OnceLock;

/// Steps of two grids that differ by so little (relative) are the same step.
const SAME_STEP: f64 = 1e-12;

/// The same for how far two grids are out of step.
const SAME_PLACE: f64 = 1e-10;

/// Exchanges of the pairs of two sides, by how they lie to each other.
pub(super) struct Congruent {
    grids: [Lattice; 2],
    /// Which axis of the first grid each axis of the second runs along, and whether forwards.
    along: [Option<(usize, i64)>; 2],
    /// Lowest place along the axes of the first grid, and number of places.
    low: [i64; 2],
    width: [i64; 2],
    /// Along an axis at right angles to all else, places p and `mirror - p` are images of each other.
    mirror: [Option<i64>; 2],
    values: Vec<OnceLock<f64>>,
}

impl Congruent {
    /// The table of two sides; `None` where few pairs lie like another.
    pub fn of(first: &Side, second: &Side) -> Option<Self> {
        let (p, q) = (first.lattice?, second.lattice?);
        let mut along = [None; 2];
        let mut low = [0i64; 2];
        let mut high = p.size.map(|n| i64::from(n) - 1);
        let mut size = 1;
        for (k, step) in [q.u, q.v].into_iter().enumerate() {
            along[k] = [p.u, p.v].into_iter().enumerate().find_map(|(m, s)| shared(s, step).map(|sign| (m, -sign)));
            match along[k] {
                Some((m, sign)) => {
                    let reach = sign * (i64::from(q.size[k]) - 1);
                    low[m] += reach.min(0);
                    high[m] += reach.max(0);
                }
                None => size *= i64::from(q.size[k]),
            }
        }
        let width = [high[0] - low[0] + 1, high[1] - low[1] + 1];
        let size = usize::try_from(size * width[0] * width[1]).ok()?;
        let worthwhile = size * 2 <= first.patches.len() * second.patches.len();
        let mirror = [0, 1].map(|m| mirrored(&p, &q, m, along));
        worthwhile.then(|| Self {
            grids: [p, q],
            along,
            low,
            width,
            mirror,
            values: (0..size).map(|_| OnceLock::new()).collect(),
        })
    }

    /// The exchange of a pair. Where none that lies alike has been met, `f` computes it for the first of its kind
    /// (numbers within the two sides): whoever asks, the same bits.
    pub fn get(&self, p: &Patch, q: &Patch, f: impl FnOnce(usize, usize) -> f64) -> f64 {
        let mut place = [i64::from(p.a), i64::from(p.b)];
        let own = [i64::from(q.a), i64::from(q.b)];
        let (mut alone, mut stride) = (0, 1);
        for k in 0..2 {
            match self.along[k] {
                Some((m, sign)) => place[m] += sign * own[k],
                None => {
                    alone += stride * own[k];
                    stride *= i64::from(self.grids[1].size[k]);
                }
            }
        }
        for m in 0..2 {
            let image = self.mirror[m].map_or(place[m], |sum| sum - place[m]);
            if (self.low[m]..self.low[m] + self.width[m]).contains(&image) {
                place[m] = place[m].min(image);
            }
        }
        let at = place[0] - self.low[0] + self.width[0] * (place[1] - self.low[1] + self.width[1] * alone);
        *self.values[at as usize].get_or_init(|| {
            let (i, j) = self.first_of_kind(place, own);
            f(i, j)
        })
    }

    /// The pair with the lowest places in the second grid that lies like those at `place`.
    fn first_of_kind(&self, place: [i64; 2], mut own: [i64; 2]) -> (usize, usize) {
        let mut at = place;
        for k in 0..2 {
            if let Some((m, sign)) = self.along[k] {
                let last = i64::from(self.grids[0].size[m]) - 1;
                at[m] = place[m].clamp(0, last);
                own[k] = sign * (place[m] - at[m]);
            }
        }
        let number = |[a, b]: [i64; 2], grid: &Lattice| (a + b * i64::from(grid.size[0])) as usize;
        (number(at, &self.grids[0]), number(own, &self.grids[1]))
    }
}

/// What places along axis `m` of the first grid and their mirror images add up to, where mirroring changes nothing.
fn mirrored(p: &Lattice, q: &Lattice, m: usize, along: [Option<(usize, i64)>; 2]) -> Option<i64> {
    let u = [p.u, p.v][m];
    let k = (0..2).find(|k| along[*k].is_some_and(|(to, _)| to == m))?;
    let square = |v: DVec3| v.dot(u).abs() <= SAME_STEP * v.length() * u.length();
    if !square([p.v, p.u][m]) || !square([q.v, q.u][k]) {
        return None;
    }
    // The middles of the first cells, in steps: pairs at d and at -d - 2 x this are images of each other.
    let apart = (p.first - q.first).dot(u) / u.length_squared();
    let sum = -2.0 * apart;
    ((sum - sum.round()).abs() <= SAME_PLACE).then(|| sum.round() as i64)
}

/// +1 or -1 if the steps are the same up to sign.
fn shared(a: DVec3, b: DVec3) -> Option<i64> {
    let slack = SAME_STEP * a.length();
    if a.distance(b) <= slack {
        Some(1)
    } else if a.distance(-b) <= slack {
        Some(-1)
    } else {
        None
    }
}
