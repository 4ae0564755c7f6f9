//! Irradiance over the object: map against truth, point by point, by distance, by number of centres, and the hybrid.

use super::bench::{Bench, Gathered, Probe, mean_of};
use super::record::{At, AtReach, Parts, PointRow};
use crate::audit::envmap::{Lobe, Point, Station, gather_near, relative_error};
use crate::math::DVec3;
use crate::sampling::{Role, Stream};
use crate::scene::NO_FACET;

/// Bands of distance over the object.
const BINS: usize = 8;

/// Irradiances at the points of the object.
pub(super) struct Over {
    pub points: Vec<Point>,
    /// Number of the centre that serves each.
    pub served: Vec<usize>,
    pub map: Vec<f64>,
    pub centre: Gathered,
    pub without: Gathered,
    pub truth: Gathered,
}

/// The nearest of some places.
pub(super) fn nearest(to: DVec3, places: impl Iterator<Item = DVec3>) -> usize {
    let distances = places.map(|p| p.distance_squared(to)).enumerate();
    distances.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(k, _)| k)
}

fn station(p: &Point, place: DVec3, facet: u32) -> Station {
    Station { place, axis: p.normal, horizon: Some(p.normal), facet }
}

impl Over {
    pub(super) fn find(bench: &Bench, probes: &[Probe], points: Vec<Point>) -> Self {
        let free: Vec<Station> = points.iter().map(|p| station(p, p.place, NO_FACET)).collect();
        let there: Vec<Station> = points.iter().map(|p| station(p, p.place, p.facet)).collect();
        let truth = bench.arrives(true, &there, Lobe::Cosine);
        let without = bench.arrives(false, &free, Lobe::Cosine);
        Self { served: Vec::new(), map: Vec::new(), centre: Vec::new(), without, truth, points }.served(bench, probes)
    }

    /// The same points served by other maps.
    pub(super) fn served(&self, bench: &Bench, probes: &[Probe]) -> Self {
        let points = self.points.clone();
        let served: Vec<usize> =
            points.iter().map(|p| nearest(p.place, probes.iter().map(|c| c.centre.point))).collect();
        let centres: Vec<Station> =
            points.iter().zip(&served).map(|(p, k)| station(p, probes[*k].centre.point, NO_FACET)).collect();
        let map = points.iter().zip(&served).map(|(p, k)| probes[*k].irradiance(p.normal)).collect();
        let centre = bench.arrives(false, &centres, Lobe::Cosine);
        Self { points, served, map, centre, without: self.without.clone(), truth: self.truth.clone() }
    }

    /// The points for which this holds.
    fn some(&self, bench: &Bench, chosen: &[usize]) -> Parts {
        let of = |g: &Gathered| -> Gathered { chosen.iter().map(|k| g[*k].clone()).collect() };
        let map: Vec<f64> = chosen.iter().map(|k| self.map[*k]).collect();
        bench.parts(&map, &of(&self.centre), &of(&self.without), &of(&self.truth))
    }

    pub(super) fn parts(&self, bench: &Bench) -> Parts {
        bench.parts(&self.map, &self.centre, &self.without, &self.truth)
    }

    fn distances(&self, probes: &[Probe]) -> Vec<f64> {
        let of = |(p, k): (&Point, &usize)| p.place.distance(probes[*k].centre.point);
        self.points.iter().zip(&self.served).map(of).collect()
    }

    /// Bands of as many points each, by distance.
    pub(super) fn by_distance(&self, bench: &Bench, probes: &[Probe]) -> Vec<At> {
        let distances = self.distances(probes);
        let mut order: Vec<usize> = (0..self.points.len()).collect();
        order.sort_by(|a, b| distances[*a].total_cmp(&distances[*b]));
        let size = order.len().div_ceil(BINS).max(1);
        let band = |chosen: &[usize]| At {
            x: chosen.iter().map(|k| distances[*k]).sum::<f64>() / chosen.len() as f64,
            parts: self.some(bench, chosen),
        };
        order.chunks(size).map(band).collect()
    }

    pub(super) fn rows(&self, probes: &[Probe]) -> Vec<PointRow> {
        let distances = self.distances(probes);
        let row = |k: usize| {
            let (p, means) = (&self.points[k], [&self.centre, &self.without, &self.truth].map(|g| mean_of(&g[k])));
            PointRow {
                patch: p.patch,
                place: p.place.to_array(),
                normal: p.normal.to_array(),
                distance: distances[k],
                centre: self.served[k],
                map: self.map[k],
                at_centre: means[0].0,
                without: means[1].0,
                truth: means[2].0,
                std_err: means.map(|m| m.1),
            }
        };
        (0..self.points.len()).map(row).collect()
    }

    /// With 1, 2, 4 and 8 centres spread over the object, each point served by the nearest.
    pub(super) fn several(&self, bench: &Bench, first: &Probe, size: u32) -> Vec<At> {
        let with = |count: usize| {
            let centres = spread(&self.points, count);
            let probes: Vec<Probe> = centres.iter().map(|c| bench.probe(first.centre.moved(*c), size)).collect();
            At { x: probes.len() as f64, parts: self.served(bench, &probes).parts(bench) }
        };
        [1, 2, 4, 8].into_iter().filter(|n| *n <= self.points.len()).map(with).collect()
    }

    /// Rays up to a reach, the map beyond: reaches as multiples of `size`, metres.
    pub(super) fn hybrid(&self, bench: &Bench, probes: &[Probe], size: f64) -> Vec<AtReach> {
        let reaches = [0.0, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0].map(|m| m * size);
        // The candidate's rays are its own.
        let stream = Stream::new(Role::Candidate, bench.request.seed);
        let mut found: Vec<Gathered> = vec![vec![Vec::new(); self.points.len()]; reaches.len()];
        for (k, probe) in probes.iter().enumerate() {
            let mine: Vec<usize> = (0..self.points.len()).filter(|p| self.served[*p] == k).collect();
            let stations: Vec<Station> = mine
                .iter()
                .map(|p| &self.points[*p])
                .map(|p| Station { place: p.place, axis: p.normal, horizon: Some(p.normal), facet: p.facet })
                .collect();
            let map = |d: DVec3| probe.mirror(d);
            let luminances = &bench.luminances;
            let near =
                gather_near(&bench.full, &stations, Lobe::Cosine, &reaches, luminances, map, stream, bench.rays());
            for (p, by_reach) in mine.into_iter().zip(near) {
                by_reach.into_iter().enumerate().for_each(|(j, values)| found[j][p] = values);
            }
        }
        let error = |g: &Gathered| {
            let d: Gathered =
                g.iter().zip(&self.truth).map(|(a, t)| a.iter().zip(t).map(|(a, t)| a - t).collect()).collect();
            relative_error(&d, &self.truth, bench.request.confidence)
        };
        reaches.iter().zip(&found).map(|(reach, g)| AtReach { reach: *reach, total: error(g) }).collect()
    }
}

/// Centres of so many parts of the points: far apart to begin with, then the middles of what is nearest to each.
fn spread(points: &[Point], count: usize) -> Vec<DVec3> {
    let places: Vec<DVec3> = points.iter().map(|p| p.place).collect();
    let middle = |of: &[DVec3]| of.iter().copied().sum::<DVec3>() / of.len() as f64;
    let mut centres = vec![middle(&places)];
    while centres.len() < count {
        let far = |p: &DVec3| centres.iter().map(|c| c.distance_squared(*p)).fold(f64::INFINITY, f64::min);
        let next = places.iter().copied().max_by(|a, b| far(a).total_cmp(&far(b)));
        centres.extend(next);
    }
    for _ in 0..20 {
        let mut parts = vec![Vec::new(); centres.len()];
        places.iter().for_each(|p| parts[nearest(*p, centres.iter().copied())].push(*p));
        centres.iter_mut().zip(&parts).filter(|(_, part)| !part.is_empty()).for_each(|(c, part)| *c = middle(part));
    }
    centres
}
