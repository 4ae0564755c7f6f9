//! Fingerprints of matrices that are not ours: an independent program's hemi-cubes, and what is none.

use etalon::KernelKind;
use etalon::audit::fingerprint::{Fingerprint, Likeness, Mistake, Rule, fingerprint};
use etalon::estimate::{Blend, Estimator, PairPlan, pair_form_factors};
use etalon::io::read_form_factors;
use etalon::io::scene::builtin;
use etalon::io::scene::{SceneOptions, read_scene};
use etalon::methods::gather;
use etalon::methods::hemicube::{Delta, Params, form_factors};
use etalon::raycast::{Tracer, open_kernels};
use etalon::scene::Stage;
use etalon::solution::FormFactors;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("references/hemicube")
}

fn room() -> Stage {
    let scene = read_scene(&folder().join("room.toml"), &SceneOptions::default()).expect("the room");
    scene.at(0).expect("a state")
}

fn third_party(name: &str) -> FormFactors {
    read_form_factors(&folder().join("matrices").join(name), 30).expect("a stored matrix")
}

/// The matrix with every value changed; zeros stay.
fn changed(f: &FormFactors, mut change: impl FnMut(f64) -> f64) -> FormFactors {
    let mut f = f.clone();
    f.values.iter_mut().for_each(|v| *v = change(*v));
    f
}

/// Uniform numbers in [0, 1) from a fixed seed.
fn uniform() -> impl FnMut() -> f64 {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn printed(what: &str, stage: &Stage, f: &FormFactors) -> Fingerprint {
    let print = fingerprint(stage, f);
    println!("{what}: {print}");
    print.reasons.iter().for_each(|r| println!("    {r}"));
    print
}

/// A matrix of somebody's is told: resolution, rule, mistake.
fn told(name: &str, n: u32, rule: Rule, mistake: Mistake) -> Fingerprint {
    let print = printed(name, &room(), &third_party(name));
    assert_eq!(print.likeness, Likeness::Hemicube, "{name}");
    assert_eq!((print.resolution, print.rule, print.mistake), (Some(n), Some(rule), Some(mistake)), "{name}");
    print
}

/// The same, with every entry of all rows compared reproduced, or explained by pixels centred on a border.
fn explained(name: &str, n: u32, rule: Rule, mistake: Mistake) {
    let confirmed = told(name, n, rule, mistake).confirmed.expect("drawn");
    assert_eq!((confirmed.rows, confirmed.entries + confirmed.by_borders), (24, confirmed.of), "{name}");
}

#[test]
fn four_resolutions_of_the_1985_table() {
    for n in [32, 50, 100, 128] {
        explained(&format!("{n}-midpoint-none-world.npz"), n, Rule::Midpoint, Mistake::None);
    }
    explained("50-midpoint-none-diagonal.npz", 50, Rule::Midpoint, Mistake::None);
}

#[test]
fn the_other_two_rules() {
    explained("64-exact-none-world.npz", 64, Rule::Exact, Mistake::None);
    explained("64-exact-none-diagonal.npz", 64, Rule::Exact, Mistake::None);
    explained("80-normalised-none-diagonal.npz", 80, Rule::Normalised, Mistake::None);
}

#[test]
fn planted_mistakes() {
    let midpoint = Rule::Midpoint;
    explained("50-midpoint-missing-side-world.npz", 50, midpoint, Mistake::MissingSide);
    explained("64-midpoint-missing-top-world.npz", 64, midpoint, Mistake::MissingTop);
    explained("64-midpoint-half-pixel-world.npz", 64, midpoint, Mistake::PixelEdgeHalved);
    explained("50-midpoint-sides-upside-down-world.npz", 50, midpoint, Mistake::SidesUpsideDown);
    explained("32-midpoint-top-table-on-sides-world.npz", 32, midpoint, Mistake::TopTableOnSides);
    explained("100-exact-missing-side-diagonal.npz", 100, Rule::Exact, Mistake::MissingSide);
    explained("50-midpoint-side-without-z-diagonal.npz", 50, midpoint, Mistake::SideWithoutZ);
    explained("40-midpoint-exponent-one-diagonal.npz", 40, midpoint, Mistake::ExponentOne);
    explained("32-midpoint-pixel-corner-diagonal.npz", 32, midpoint, Mistake::PixelCorner);
}

#[test]
fn borders_explain_no_more_than_their_pixels() {
    // A twentieth moved from the largest entry of each row to the next: more than a column of pixels holds at N = 50.
    let mut f = third_party("50-midpoint-none-world.npz");
    for i in 0..f.n {
        let mut places: Vec<usize> = (f.row_starts[i]..f.row_starts[i + 1]).collect();
        places.sort_by(|a, b| f.values[*b].total_cmp(&f.values[*a]));
        f.values[places[0]] -= 0.05;
        f.values[places[1]] += 0.05;
    }
    let c = printed("a twentieth moved", &room(), &f).confirmed.expect("drawn");
    assert!(c.by_borders > 0, "no edge of this scene runs through a pixel's centre: {c:?}");
    assert!(c.of - c.entries - c.by_borders >= 2 * c.rows, "{c:?}");
}

#[test]
fn an_odd_resolution_is_told_by_its_row_sums() {
    told("51-midpoint-none-world.npz", 51, Rule::Midpoint, Mistake::OddRowLost);
}

#[test]
fn turned_by_chance_the_row_sums_still_tell() {
    let print = told("100-midpoint-none-random.npz", 100, Rule::Midpoint, Mistake::None);
    assert_eq!(print.axes, None);
}

#[test]
fn single_precision_still_tells() {
    let f = changed(&third_party("50-midpoint-none-world.npz"), |v| f64::from(v as f32));
    let print = fingerprint(&room(), &f);
    println!("{print}\n{:#?}", print.reasons);
    assert_eq!((print.likeness, print.resolution), (Likeness::Hemicube, Some(50)));
    assert_eq!((print.rule, print.mistake), (Some(Rule::Midpoint), Some(Mistake::None)));
}

/// What the gather method makes of a scene with so many rays.
fn gathered(stage: &Stage, rays: u64) -> FormFactors {
    let kernels = open_kernels(KernelKind::Builtin, stage).expect("kernels");
    let tracer = Tracer::new(stage, kernels.kernel, kernels.exact, true);
    let params = gather::Params { rays, randomisations: 8, estimator: Estimator::Rays };
    Blend::of_rays(&gather::form_factors(&tracer, &params, 7, &|_| ()).counts).form_factors()
}

/// A matrix by so many rays per row, drawn from a good one.
fn drawn_by_lot(truth: &FormFactors, rays: u32) -> FormFactors {
    let mut u = uniform();
    let rows = (0..truth.n).map(|i| {
        let mut hits = vec![0u32; truth.n];
        for _ in 0..rays {
            let mut left = u();
            let hit = truth.row(i).find(|(_, v)| {
                left -= v;
                left < 0.0
            });
            hits[hit.map_or(0, |(j, _)| j)] += 1;
        }
        let row = hits.iter().enumerate().filter(|(_, h)| **h > 0);
        row.map(|(j, h)| (j as u32, f64::from(*h) / f64::from(rays))).collect()
    });
    FormFactors::from_exact_rows(rows.collect())
}

#[test]
fn counts_of_rays_are_counts() {
    let (stage, truth) = (room(), third_party("64-exact-none-diagonal.npz"));
    for (rays, f) in [(2048, gathered(&stage, 2048)), (3000, drawn_by_lot(&truth, 3000))] {
        let print = printed("rays", &stage, &f);
        assert_eq!(print.likeness, Likeness::RayCounts { rays });
        assert_eq!((print.resolution, print.rule, print.mistake), (None, None, None));
    }
}

#[test]
fn exact_form_factors_are_no_hemicube() {
    let scenes = ["furnace", "cornell-box-coarse"].map(|name| builtin(name).expect("a scene").at(0).expect("a state"));
    for (stage, points) in scenes.iter().zip([0, 200_000]).chain([(&room(), 200_000)]) {
        let plan = PairPlan { points, ..PairPlan::default() };
        let f = pair_form_factors(stage, &plan, &|_| ()).form_factors;
        let print = printed("pair by pair", stage, &f);
        assert_eq!(print.likeness, Likeness::NoSignOfHemicube);
        assert_eq!((print.resolution, print.rule, print.mistake), (None, None, None));
    }
}

#[test]
fn our_own_hemicubes_are_told_in_closed_and_open_scenes() {
    for (name, n, delta, rule) in [
        ("furnace", 100, Delta::Midpoint, Rule::Midpoint),
        ("furnace", 50, Delta::Exact, Rule::Exact),
        ("cornell-box-coarse", 50, Delta::Midpoint, Rule::Midpoint),
        ("cornell-box-coarse", 128, Delta::Exact, Rule::Exact),
        ("cornell-box", 100, Delta::Midpoint, Rule::Midpoint),
    ] {
        let stage = builtin(name).expect("a scene").at(0).expect("a state");
        let params = Params { resolution: n, delta, ..Params::default() };
        let print = printed(name, &stage, &form_factors(&stage, &params, &|_| ()).expect("a matrix"));
        assert_eq!(print.likeness, Likeness::Hemicube, "{name}");
        assert_eq!((print.resolution, print.rule), (Some(n), Some(rule)), "{name}");
        assert_eq!(print.mistake, Some(Mistake::None), "{name}");
        let confirmed = print.confirmed.expect("drawn");
        assert_eq!((confirmed.entries, confirmed.whole_rows), (confirmed.of, confirmed.rows), "{name}");
    }
}

#[test]
fn noise_is_no_hemicube() {
    let truth = third_party("64-exact-none-diagonal.npz");
    let mut u = uniform();
    let noisy = changed(&truth, |v| v * (1.0 + 0.02 * (u() - 0.5)));
    let mut closed = noisy.clone();
    for i in 0..closed.n {
        let sum = closed.row_sum(i);
        closed.values[closed.row_starts[i]..closed.row_starts[i + 1]].iter_mut().for_each(|v| *v /= sum);
    }
    for f in [noisy, closed] {
        let print = fingerprint(&room(), &f);
        println!("{print}\n{:#?}", print.reasons);
        assert_eq!(print.likeness, Likeness::NoSignOfHemicube);
        assert_eq!((print.resolution, print.rule, print.mistake), (None, None, None));
    }
}

#[test]
fn what_cannot_be_told_is_not_told() {
    // A table that sums to 1 and a turn nobody knows: small entries alone could tell.
    let print = fingerprint(&room(), &third_party("48-exact-none-random.npz"));
    println!("{print}\n{:#?}", print.reasons);
    assert_eq!((print.likeness, print.resolution), (Likeness::NoSignOfHemicube, None));
    // Three decimal places.
    let f = changed(&third_party("50-midpoint-none-world.npz"), |v| (v * 1e3).round() / 1e3);
    let print = fingerprint(&room(), &f);
    println!("{print}\n{:#?}", print.reasons);
    assert_eq!((print.likeness, print.resolution), (Likeness::CannotBeTold, None));
    // Two rows.
    let mut rows = vec![Vec::new(); 30];
    for (i, row) in rows.iter_mut().enumerate().take(2) {
        *row = third_party("50-midpoint-none-world.npz").row(i).map(|(j, v)| (j as u32, v)).collect();
    }
    let print = fingerprint(&room(), &FormFactors::from_exact_rows(rows));
    assert_eq!((print.likeness, print.resolution), (Likeness::CannotBeTold, None));
}
