//! A record made by hand, every number different from every other.

use crate::metrics::Verdict;
use crate::stats::Estimate;
use crate::study::envmap::{At, AtReach, AtSize, EnvmapRecord, FilterRow, Parts, PointRow, Range, RoundTripRow, Speed};
use std::cell::Cell;

/// Numbers that do not come twice, of no round size.
struct Numbers(Cell<u32>);

impl Numbers {
    /// Between `low` and twice that.
    fn next(&self, low: f64) -> f64 {
        self.0.set(self.0.get() + 1);
        low * (1.0 + (f64::from(self.0.get()) * 0.618_033_988_749_894_9).fract())
    }

    fn estimate(&self, low: f64) -> Estimate {
        let (value, err) = (self.next(low), self.next(0.01 * low));
        Estimate { value, std_err: Some(err), low: value - 1.9 * err, high: value + 2.1 * err }
    }

    fn parts(&self, points: usize) -> Parts {
        let (map, parallax) = (self.next(0.1), self.next(0.6));
        Parts {
            points,
            total: Some(self.estimate(0.05)),
            map: Some(self.estimate(0.01)),
            parallax: Some(self.estimate(0.04)),
            occlusion: Some(self.estimate(0.03)),
            // Two of them make more than the whole: the third is below 0.
            shares: [map, parallax, 1.0 - map - parallax],
            bias: -self.next(0.01),
        }
    }

    fn at(&self, places: &[f64]) -> Vec<At> {
        places.iter().enumerate().map(|(k, x)| At { x: *x, parts: self.parts(100 + k) }).collect()
    }

    fn at_size(&self, sizes: &[u32]) -> Vec<AtSize> {
        let of = |size: &u32| AtSize {
            size: *size,
            table: Some(self.estimate(0.02)),
            convolved: (*size < 32).then(|| self.estimate(0.01)),
        };
        sizes.iter().map(of).collect()
    }
}

fn points(n: &Numbers) -> Vec<PointRow> {
    let point = |k: u32| PointRow {
        patch: 1000 + k,
        place: [n.next(1.0), n.next(1.0), n.next(1.0)],
        normal: [0.0, 0.0, 1.0],
        distance: n.next(0.5),
        centre: k as usize % 2,
        map: n.next(8.0),
        at_centre: n.next(8.0),
        without: n.next(8.0),
        truth: n.next(8.0),
        std_err: [n.next(0.1), n.next(0.1), n.next(0.1)],
    };
    (0..12).map(point).collect()
}

fn filters(n: &Numbers) -> Vec<FilterRow> {
    let mut rows = Vec::new();
    for width in [1.0, 4.5, 16.0] {
        for stretch in [1.0, 4.0] {
            for layout in ["cube", "lat-long"] {
                for filter in ["box", "ewa"] {
                    let [error, near_poles, worst] = [0.02, 0.05, 0.2].map(|low| n.next(low));
                    let (seconds, exact_seconds) = (n.next(1e-6), n.next(1e-4));
                    rows.push(FilterRow {
                        layout,
                        filter,
                        width,
                        stretch,
                        error,
                        near_poles: Some(near_poles),
                        worst,
                        seconds,
                        exact_seconds,
                    });
                }
            }
        }
    }
    let known = &mut rows[0];
    (known.error, known.near_poles, known.worst) = (0.0123, Some(0.0456), 0.789);
    (known.seconds, known.exact_seconds) = (2.5e-6, 1e-3);
    rows
}

fn estimate(value: f64, low: f64, high: f64) -> Option<Estimate> {
    Some(Estimate { value, std_err: Some(0.25 * (high - low)), low, high })
}

/// Whose numbers the tests know in words.
fn irradiance() -> Parts {
    Parts {
        points: 1234,
        total: estimate(0.1234, 0.1200, 0.1280),
        map: estimate(0.0117, 0.0113, 0.0122),
        parallax: estimate(0.1358, 0.1317, 0.1399),
        occlusion: estimate(0.0246, 0.0221, 0.0275),
        shares: [0.031, 1.204, -0.235],
        bias: -0.0456,
    }
}

pub(super) fn record() -> EnvmapRecord {
    let n = Numbers(Cell::new(0));
    let mut curve = n.at(&[0.125, 0.5, 2.25]);
    for a in &mut curve {
        (a.parts.occlusion, a.parts.shares[2]) = (None, 0.0);
    }
    let trip = |size, layout| RoundTripRow { size, layout, rms: n.next(0.03), energy: -n.next(0.001) };
    EnvmapRecord {
        scene: "room <with> \"names\" & more".into(),
        object: "<script>alert(1)</script>".into(),
        centres: vec![[0.5, -1.25, 0.75], [1.5, 2.0, 0.8]],
        size: 256,
        table: [40, 20],
        truth: "reference <solution>".into(),
        rays: 16_384,
        confidence: 0.95,
        limit: Some(0.07),
        verdict: Some(Verdict::Fail),
        irradiance: irradiance(),
        by_distance: n.at(&[0.4, 0.55, 0.71]),
        points: points(&n),
        range: Range { curve, stated: 0.055, within: Some(0.6789), between: [Some(0.4567), Some(2.25)], open: false },
        reflection: n.at(&[0.25, 4.0, 60.0]),
        filters: filters(&n),
        sizes: n.at_size(&[8, 16, 32]),
        tables: n.at_size(&[16, 40, 80]).into_iter().map(|a| AtSize { convolved: None, ..a }).collect(),
        harmonics: Some(n.estimate(0.03)),
        several: n.at(&[1.0, 2.0, 4.0]),
        hybrid: [0.0, 0.3, 0.6].map(|reach| AtReach { reach, total: Some(n.estimate(0.04)) }).to_vec(),
        round_trips: vec![trip(32, "lat-long"), trip(32, "sine-lat-long"), trip(64, "lat-long")],
        speed: vec![Speed { name: "cube", count: 393_216, seconds: 0.5 }],
        findings: vec![
            "Irradiance over \"<script>\" is wrong by -1.5 %.".into(),
            "In the open it stays within 5.5 % up to 0.679 m.".into(),
        ],
    }
}

/// The same with nothing known where nothing may be known.
pub(super) fn unknown() -> EnvmapRecord {
    let none =
        |points| Parts { points, total: None, map: None, parallax: None, occlusion: None, shares: [0.0; 3], bias: 0.0 };
    let mut r = record();
    let lists = [&mut r.by_distance, &mut r.range.curve, &mut r.reflection, &mut r.several];
    lists.into_iter().flatten().for_each(|a| a.parts = none(a.parts.points));
    r.irradiance = none(256);
    r.sizes.iter_mut().chain(&mut r.tables).for_each(|a| (a.table, a.convolved) = (None, None));
    r.hybrid.iter_mut().for_each(|h| h.total = None);
    (r.harmonics, r.limit, r.verdict) = (None, None, None);
    (r.range.within, r.range.between) = (None, [None, None]);
    r.points.iter_mut().for_each(|p| p.truth = 0.0);
    r
}
