//! Fingerprints of matrices that are not ours: an independent program's hemi-cubes, and what is none.

use etalon::audit::fingerprint::{Fingerprint, Likeness, Mistake, Rule, fingerprint};
use etalon::io::read_form_factors;
use etalon::io::scene::{SceneOptions, read_scene};
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

/// A matrix of somebody's is told: resolution, rule, mistake, and the share of entries reproduced is at least so much.
fn told(name: &str, n: u32, rule: Rule, mistake: Mistake, share: f64) -> Fingerprint {
    let print = fingerprint(&room(), &third_party(name));
    println!("{name}: {print}");
    print.reasons.iter().for_each(|r| println!("    {r}"));
    assert_eq!(print.likeness, Likeness::Hemicube, "{name}");
    assert_eq!((print.resolution, print.rule, print.mistake), (Some(n), Some(rule), Some(mistake)), "{name}");
    let got = print.confirmed.map_or(0.0, |c| c.share());
    assert!(got >= share, "{name}: {got}");
    print
}

#[test]
fn four_resolutions_of_the_1985_table() {
    for n in [32, 50, 100, 128] {
        told(&format!("{n}-midpoint-none-world.npz"), n, Rule::Midpoint, Mistake::None, 0.8);
    }
}

#[test]
fn the_other_two_rules() {
    told("64-exact-none-world.npz", 64, Rule::Exact, Mistake::None, 0.8);
    told("80-normalised-none-world.npz", 80, Rule::Normalised, Mistake::None, 0.8);
}

#[test]
fn planted_mistakes() {
    for (n, rule, mistake, name) in [
        (50, Rule::Midpoint, Mistake::MissingSide, "50-midpoint-missing-side-world.npz"),
        (100, Rule::Exact, Mistake::MissingSide, "100-exact-missing-side-world.npz"),
        (64, Rule::Midpoint, Mistake::MissingTop, "64-midpoint-missing-top-world.npz"),
        (50, Rule::Midpoint, Mistake::SideWithoutZ, "50-midpoint-side-without-z-world.npz"),
        (64, Rule::Midpoint, Mistake::PixelEdgeHalved, "64-midpoint-half-pixel-world.npz"),
        (40, Rule::Midpoint, Mistake::ExponentOne, "40-midpoint-exponent-one-world.npz"),
        (50, Rule::Midpoint, Mistake::SidesUpsideDown, "50-midpoint-sides-upside-down-world.npz"),
    ] {
        told(name, n, rule, mistake, 0.6);
    }
    // The corner that a pixel's delta is taken at depends on which way the axes run: the sum tells, entries may not.
    told("32-midpoint-pixel-corner-world.npz", 32, Rule::Midpoint, Mistake::PixelCorner, 0.0);
    told("32-midpoint-top-table-on-sides-world.npz", 32, Rule::Midpoint, Mistake::TopTableOnSides, 0.6);
}

#[test]
fn turned_by_chance_the_row_sums_still_tell() {
    let print = told("100-midpoint-none-random.npz", 100, Rule::Midpoint, Mistake::None, 0.0);
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

#[test]
fn counts_of_rays_are_counts() {
    let truth = third_party("64-exact-none-world.npz");
    let mut u = uniform();
    let rows = (0..truth.n).map(|i| {
        let mut hits = vec![0u32; truth.n];
        for _ in 0..4096 {
            let mut left = u();
            let hit = truth.row(i).find(|(_, v)| {
                left -= v;
                left < 0.0
            });
            hits[hit.map_or(0, |(j, _)| j)] += 1;
        }
        let row = hits.iter().enumerate().filter(|(_, h)| **h > 0);
        row.map(|(j, h)| (j as u32, f64::from(*h) / 4096.0)).collect()
    });
    let print = fingerprint(&room(), &FormFactors::from_exact_rows(rows.collect()));
    println!("{print}\n{:#?}", print.reasons);
    assert_eq!(print.likeness, Likeness::RayCounts { rays: 4096 });
    assert_eq!(print.resolution, None);
}

#[test]
fn noise_is_no_hemicube() {
    let truth = third_party("64-exact-none-world.npz");
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
