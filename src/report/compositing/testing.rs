//! A record made by hand, every number different from every other.

use crate::metrics::Verdict;
use crate::study::compositing::{ClusterRow, CompositeRow, CompositingRecord, EdgeRow, LightRow, PictureRow, Rms};

/// A number that no other `k` has, between `low` and twice that, of no round size.
fn odd(k: u32, low: f64) -> f64 {
    low * (1.0 + (f64::from(k) * 0.618_033_988_749_894_9).fract())
}

fn edge(k: u32, sub_scanlines: u32, scale: f64, error: f64) -> EdgeRow {
    EdgeRow {
        sub_scanlines,
        scale,
        error: Rms { value: error, interval: [0.93 * error, 1.08 * error] },
        off_by_a_step: odd(k, 0.021),
        segments: 20_011 + 1_003 * k as usize,
        bytes: 3_300_017 + 10_007 * k as usize,
        scan_seconds: odd(k, 0.031),
        draw_seconds: odd(k, 0.0043),
    }
}

/// Whose numbers the tests know in words.
fn light() -> LightRow {
    LightRow {
        name: "lamp <b> & \"co\"".into(),
        kind: "polyhedron".into(),
        points: 4_321,
        lit: 3_210,
        penumbra: 765,
        dark: 346,
        error: 0.0234,
        noise: 0.0179,
        with_error: 1_598,
        mean_squared_t: Some(1.173),
        worst_t: 4.83,
        allowed_t: 7.61,
        surely_off: 0,
        within: true,
        point_seconds: 2.56e-6,
        judge_point_seconds: 819.2e-6,
    }
}

pub(super) fn record() -> CompositingRecord {
    let bad = LightRow {
        name: "sun".into(),
        kind: "parallel".into(),
        mean_squared_t: None,
        surely_off: 57,
        within: false,
        ..light()
    };
    let cluster = |k: u32, name: &str| ClusterRow {
        name: name.into(),
        faces: 5_100 + k as usize,
        visible_faces: 2_200 + k as usize,
        segments: 61_000 + k as usize,
        bytes: 940_000 + k as usize,
        seconds: odd(90 + k, 0.0171),
    };
    CompositingRecord {
        scene: "town <with> \"names\" & more".into(),
        camera: "<script>alert(1)</script>".into(),
        size: [1_320, 1_241],
        faces: 12_377,
        kernel: "embree <4>".into(),
        samples: 1_024,
        seed: 987_654_321,
        edges: vec![edge(1, 1, 1.0, 0.0912), edge(2, 3, 1.0, 0.0317), edge(3, 9, 1.0, 0.00714)],
        rate: Some(1.159),
        scaled: vec![edge(4, 1, 0.85, 0.0834), edge(5, 3, 0.85, 0.0288), edge(6, 3, 1.35, 0.0452)],
        lights: vec![light(), bad],
        clusters: vec![cluster(7, "houses"), cluster(8, "trees & <hedges>")],
        composite: Some(CompositeRow {
            clusters: 2,
            orders: 6,
            same_segments: true,
            worst: 3.14e-9,
            bytes: 1_777_333,
            seconds: 0.0653,
        }),
        picture: PictureRow {
            sub_scanlines: 3,
            lights: vec!["sun".into(), "lamp <b>".into()],
            error: Rms { value: 0.0587, interval: [0.0561, 0.0613] },
            noise: 0.0193,
            bias: -0.00456,
            off_by_a_step: 0.1472,
            traced: 0.0836,
            shadow_bytes: 7_654_321,
            passes: 5,
            seconds: 1.87,
            judge_seconds: 46.4,
            judge_rays: 135_791_357,
            equal_samples: Some(111.0),
            equal_seconds: Some(5.03),
        },
        findings: vec![
            "Edges: 3.2 % off at 3 sub-scanlines of \"<script>\"".into(),
            "The picture: -0.46 % too dark, shaded in 1.9 s".into(),
        ],
        limit: Some(0.025),
        judged_at: 3,
        verdict: Some(Verdict::Fail),
    }
}

/// The same on a machine several times as slow.
pub(super) fn slow() -> CompositingRecord {
    let mut r = record();
    let edges = r.edges.iter_mut().chain(&mut r.scaled);
    edges.for_each(|e| (e.scan_seconds, e.draw_seconds) = (3.7 * e.scan_seconds, 5.1 * e.draw_seconds));
    r.lights.iter_mut().for_each(|l| (l.point_seconds, l.judge_point_seconds) = (2.0 * l.point_seconds, 9.1e-6));
    r.clusters.iter_mut().for_each(|c| c.seconds *= 3.0);
    r.composite.iter_mut().for_each(|c| c.seconds *= 7.0);
    let p = &mut r.picture;
    (p.seconds, p.judge_seconds, p.equal_seconds) = (9.9, 99.0, None);
    r.findings[1] = "The picture: -0.46 % too dark, shaded in 9.9 s".into();
    r
}

/// The same with nothing known where nothing may be known.
pub(super) fn unknown() -> CompositingRecord {
    let mut r = record();
    (r.rate, r.limit, r.verdict, r.composite) = (None, None, None, None);
    (r.picture.equal_samples, r.picture.equal_seconds) = (None, None);
    (r.edges, r.scaled, r.lights, r.clusters) = (vec![], vec![], vec![], vec![]);
    (r.findings, r.picture.lights) = (vec![], vec![]);
    r
}
