//! Which lamp is aimed at from where, and with what density: the sampling of sources.

use crate::math::DVec3;
use crate::sampling::PointMap;
use crate::scene::Stage;

/// Entries of the table of choices; a larger scene chooses by power alone.
const TABLE: usize = 1 << 22;
/// Where lamps spread over more than this share of all area, rays of the hemisphere find them by themselves.
const BROAD: f64 = 0.5;
/// Least cosine that a choice reckons with: what is grazing for the centres need not be so for all points.
const LEAST_COSINE: f64 = 0.05;
/// Stands for "no lamp".
const NONE: u32 = u32::MAX;

/// A patch that emits.
#[derive(Debug, Clone)]
struct Lamp {
    patch: u32,
    map: PointMap,
    normal: DVec3,
    /// m^2.
    area: f64,
}

/// A point on a lamp.
#[derive(Debug, Clone, Copy)]
pub(super) struct Aim {
    /// Patch it lies on.
    pub patch: u32,
    /// The point.
    pub point: DVec3,
}

/// All lamps of a stage, and the chance with which each is chosen from each patch.
///
/// The chances need no care: what a choice never aims at, rays of the hemisphere find with full weight (multiple
/// importance sampling, balance heuristic), so any table gives the right mean.
#[derive(Debug, Clone)]
pub(super) struct Lamps {
    lamps: Vec<Lamp>,
    /// Lamp of each patch.
    of_patch: Vec<u32>,
    /// Cumulative chances: one row of lamps per patch, or one row for all.
    table: Vec<f64>,
    one_row: bool,
}

impl Lamps {
    /// The lamps of a stage.
    pub fn of(stage: &Stage) -> Self {
        let mut found = Self { lamps: Vec::new(), of_patch: Vec::new(), table: Vec::new(), one_row: true };
        let power = |i: usize| stage.emission(i).iter().sum::<f64>() * stage.patches[i].area;
        let lit: Vec<usize> = (0..stage.patch_count()).filter(|i| power(*i) > 0.0).collect();
        if lit.is_empty() || is_broad(stage, &lit, &power) {
            return found;
        }
        found.of_patch = vec![NONE; stage.patch_count()];
        for i in lit {
            let patch = &stage.patches[i];
            if let Some(map) = PointMap::new(&patch.region.pieces) {
                found.of_patch[i] = found.lamps.len() as u32;
                found.lamps.push(Lamp { patch: i as u32, map, normal: patch.normal, area: patch.area });
            }
        }
        found.one_row = stage.patch_count() * found.lamps.len() > TABLE;
        let rows = if found.one_row { 1 } else { stage.patch_count() };
        for i in 0..rows {
            let chance = |l: &Lamp| {
                let power = power(l.patch as usize);
                if found.one_row { power } else { power * promise(stage, i, l.patch as usize) }
            };
            cumulate(&mut found.table, found.lamps.iter().map(chance).collect());
        }
        found
    }

    /// True if no lamp is aimed at from anywhere.
    pub fn is_empty(&self) -> bool {
        self.lamps.is_empty()
    }

    fn row(&self, patch: usize) -> &[f64] {
        let begin = if self.one_row { 0 } else { patch * self.lamps.len() };
        &self.table[begin..begin + self.lamps.len()]
    }

    /// A point on a lamp from three numbers in [0, 1); the first chooses the lamp and is used up by that in part only.
    /// `None` where nothing is aimed at from this patch.
    pub fn aim(&self, from: usize, s: f64, t: f64) -> Option<Aim> {
        let row = self.row(from);
        if *row.last()? <= 0.0 {
            return None;
        }
        let k = row.partition_point(|c| *c <= s).min(row.len() - 1);
        let begin = if k == 0 { 0.0 } else { row[k - 1] };
        let within = ((s - begin) / (row[k] - begin)).clamp(0.0, 1.0);
        let lamp = &self.lamps[k];
        Some(Aim { patch: lamp.patch, point: lamp.map.at(within, t) })
    }

    /// Density per solid angle with which, from a patch, the point of `lamp_patch` at `distance_squared` in this
    /// direction is aimed at; 0 for what is no lamp.
    pub fn density(&self, from: usize, lamp_patch: usize, distance_squared: f64, direction: DVec3) -> f64 {
        let Some(k) = self.of_patch.get(lamp_patch).filter(|k| **k != NONE).map(|k| *k as usize) else { return 0.0 };
        let row = self.row(from);
        let chance = row[k] - if k == 0 { 0.0 } else { row[k - 1] };
        let lamp = &self.lamps[k];
        let cosine = -lamp.normal.dot(direction);
        if cosine > 0.0 { chance * distance_squared / (lamp.area * cosine) } else { 0.0 }
    }
}

/// True if the power is spread so widely that aiming gains nothing: `(sum A E)^2 / sum A E^2` against all area.
fn is_broad(stage: &Stage, lit: &[usize], power: &dyn Fn(usize) -> f64) -> bool {
    let total: f64 = lit.iter().map(|i| power(*i)).sum();
    let squares: f64 = lit.iter().map(|i| power(*i).powi(2) / stage.patches[*i].area).sum();
    let area: f64 = stage.patches.iter().map(|p| p.area).sum();
    total * total > BROAD * area * squares
}

/// About the light that patch `i` has of a unit of power of patch `j`, nothing between; 0 where they cannot see
/// each other.
fn promise(stage: &Stage, i: usize, j: usize) -> f64 {
    let (a, b) = (&stage.patches[i], &stage.patches[j]);
    let (Some(from), Some(to)) = (a.region.centroid(), b.region.centroid()) else { return 0.0 };
    let behind = |normal: DVec3, at: DVec3, corners: &[DVec3]| corners.iter().all(|c| normal.dot(*c - at) <= 0.0);
    if behind(a.normal, from, &b.corners) || behind(b.normal, to, &a.corners) {
        return 0.0;
    }
    let way = to - from;
    let distance = way.length().max(f64::MIN_POSITIVE);
    let cosines = (a.normal.dot(way) / distance).max(LEAST_COSINE) * (-b.normal.dot(way) / distance).max(LEAST_COSINE);
    cosines / (distance * distance + 0.25 * (a.area + b.area))
}

/// Appends the running sums of chances, scaled to end at 1; all zero where there is none.
fn cumulate(table: &mut Vec<f64>, chances: Vec<f64>) {
    let total: f64 = chances.iter().sum();
    let mut sum = 0.0;
    let last = chances.iter().rposition(|c| *c > 0.0);
    for (k, chance) in chances.into_iter().enumerate() {
        sum += chance;
        let end = last.is_some_and(|l| k >= l);
        table.push(if end { 1.0 } else { sum / total.max(f64::MIN_POSITIVE) });
    }
}
