//! The map's own error against the size of cube and table; spherical harmonics beside it.

use super::bench::{Bench, Gathered, Probe};
use super::irradiance::Over;
use super::record::AtSize;
use crate::audit::envmap::relative_error;
use crate::render::Centre;
use crate::stats::Estimate;
use crate::world::{DiffuseMap, Harmonics, Layout, WorldMap, irradiance_exact};

/// Edges of the cubes.
const SIZES: [u32; 7] = [4, 8, 16, 32, 64, 128, 256];
/// Widths of the tables; half as high.
const TABLES: [u32; 5] = [8, 16, 40, 80, 160];
/// The largest cube that is convolved for each point by itself.
const CONVOLVED: u32 = 64;

/// What a map says at each point against what arrives at its centre.
fn against(bench: &Bench, over: &Over, map: &[f64]) -> Option<Estimate> {
    let d: Gathered = over.centre.iter().zip(map).map(|(t, m)| t.iter().map(|t| m - t).collect()).collect();
    relative_error(&d, &over.centre, bench.request.confidence)
}

/// Normals of the points in the map's axes, for a map that serves all of them.
fn normals(centre: &Centre, over: &Over) -> Vec<crate::math::DVec3> {
    over.points.iter().map(|p| centre.frame.to_local(p.normal)).collect()
}

/// Against the size of the cube; `over` has but one centre.
pub(super) fn sizes(bench: &Bench, probe: &Probe, over: &Over) -> Vec<AtSize> {
    let normals = normals(&probe.centre, over);
    let of = |size: u32| {
        let map = bench.view(&probe.centre, Layout::Cube, size).radiances(&bench.mean, 1);
        let table = DiffuseMap::new(&map, bench.request.table);
        let looked_up: Vec<f64> = normals.iter().map(|n| table.lookup(*n)[0]).collect();
        let convolved = (size <= CONVOLVED).then(|| convolved(&map, &normals));
        AtSize {
            size,
            table: against(bench, over, &looked_up),
            convolved: convolved.and_then(|c| against(bench, over, &c)),
        }
    };
    SIZES.iter().map(|s| of(*s)).collect()
}

fn convolved(map: &WorldMap, normals: &[crate::math::DVec3]) -> Vec<f64> {
    use rayon::prelude::*;
    normals.par_iter().map(|n| irradiance_exact(map, *n)[0]).collect()
}

/// Against the size of the table, of the largest map.
pub(super) fn tables(bench: &Bench, probe: &Probe, over: &Over) -> Vec<AtSize> {
    let normals = normals(&probe.centre, over);
    let of = |width: u32| {
        let table = DiffuseMap::new(probe.pyramid.base(), [width, width / 2]);
        let looked_up: Vec<f64> = normals.iter().map(|n| table.lookup(*n)[0]).collect();
        AtSize { size: width, table: against(bench, over, &looked_up), convolved: None }
    };
    TABLES.iter().map(|w| of(*w)).collect()
}

/// Spherical harmonics of order 2 in place of the table.
pub(super) fn harmonics(bench: &Bench, probe: &Probe, over: &Over) -> Option<Estimate> {
    let harmonics = Harmonics::new(probe.pyramid.base());
    let map: Vec<f64> = normals(&probe.centre, over).iter().map(|n| harmonics.irradiance(*n)[0]).collect();
    against(bench, over, &map)
}
