use super::*;
use crate::formfactor::impossible::Reason;
use crate::formfactor::mistake::{Layout, undo};
use crate::formfactor::testing::{box_room, noisy};
use crate::formfactor::{Surroundings, enforce};
use crate::scene::Patch;
use crate::stats::test_random::Random;
use std::f64::consts::PI;

/// A room of 1.5 x 2 x 3.6 m: 22 patches of unlike areas.
fn room() -> (Vec<Patch>, FormFactors) {
    box_room([1.5, 2.0, 3.6], [1, 2, 3])
}

fn around(patches: &[Patch], closed: bool) -> Surroundings<'_> {
    Surroundings { areas: patches.iter().map(|p| p.area).collect(), closed, patches }
}

fn judged(f: &FormFactors, around: &Surroundings) -> Physics {
    examine(f, around, Rule::usual(f))
}

fn mapped(f: &FormFactors, to: impl Fn(usize, usize, f64) -> Option<(usize, usize, f64)>) -> FormFactors {
    let mut rows = vec![vec![]; f.n];
    for i in 0..f.n {
        for (i, j, v) in f.row(i).filter_map(|(j, v)| to(i, j, v)) {
            rows[i].push((j as u32, v));
        }
    }
    rows.iter_mut().for_each(|r: &mut Vec<(u32, f64)>| r.sort_by_key(|e| e.0));
    FormFactors::from_exact_rows(rows)
}

#[test]
fn an_exact_matrix_is_sound_with_and_without_errors() {
    let (patches, f) = room();
    let physics = judged(&f, &around(&patches, true));
    assert!(!physics.broken && physics.mistake.is_none() && physics.impossible.is_empty(), "{physics:?}");
    assert_eq!((physics.threshold, physics.closure.rms_sigmas, physics.closure.tested), (None, None, 22));
    let exact = FormFactors { std_err: Some(vec![0.0; f.stored()]), ..f };
    let physics = judged(&exact, &around(&patches, true));
    assert!(!physics.broken && physics.errors_known, "{physics:?}");
}

/// Over 100 noisy matrices with honest errors: none is called broken (false alarms 1e-6 each), and the defects have a
/// root mean square of one standard error. 22 rows, so 2200 degrees of freedom: 0.9 to 1.1 is 6.6 standard errors.
#[test]
fn honest_noise_is_not_broken() {
    let (patches, f) = room();
    let mut random = Random(9);
    let (mut rows, mut pairs) = (0.0, 0.0);
    for _ in 0..100 {
        let physics = judged(&noisy(&f, &mut random), &around(&patches, true));
        assert!(!physics.broken, "{physics:?}");
        rows += physics.closure.rms_sigmas.unwrap().powi(2) / 100.0;
        pairs += physics.reciprocity.rms_sigmas.unwrap().powi(2) / 100.0;
    }
    println!("rms sigmas: rows {:.3}, pairs {:.3}", rows.sqrt(), pairs.sqrt());
    assert!((0.9..1.1).contains(&rows.sqrt()) && (0.9..1.1).contains(&pairs.sqrt()));
}

#[test]
fn a_wrong_row_and_a_wrong_pair_are_found_in_the_noise() {
    let (patches, f) = room();
    let mut given = noisy(&f, &mut Random(4));
    let k = given.row_starts[7] + 2;
    given.values[k] *= 2.5;
    let j = given.columns[k] as usize;
    let physics = judged(&given, &around(&patches, true));
    assert!(physics.broken);
    assert_eq!(physics.reciprocity.worst[0].pair, (7.min(j), 7.max(j)));
    assert!(physics.reciprocity.broken == 1 && physics.mistake.is_none(), "{physics:?}");
    // A row that lacks a half.
    let mut given = noisy(&f, &mut Random(4));
    let row = given.row_starts[5]..given.row_starts[6];
    given.values[row].iter_mut().for_each(|v| *v *= 0.5);
    let physics = judged(&given, &around(&patches, true));
    assert!(physics.closure.worst[0].row == 5 && physics.closure.broken == 1, "{physics:?}");
}

#[test]
fn classic_mistakes_are_named_and_undone() {
    let (patches, f) = room();
    let around = around(&patches, true);
    let areas = around.areas.clone();
    let scaled = |c: f64| mapped(&f, move |i, j, v| Some((i, j, c * v)));
    let cases = [
        (mapped(&f, |i, j, v| Some((j, i, v))), Layout::Transposed, None),
        (mapped(&f, |i, j, v| Some((i, j, areas[i] * v))), Layout::ExchangeAreas, None),
        (mapped(&f, |i, j, v| (i < j).then_some((i, j, v))), Layout::OneTriangle, None),
        (scaled(PI), Layout::AsIs, Some("pi")),
        (scaled(1.0 / PI), Layout::AsIs, Some("1/pi")),
        (scaled(0.5), Layout::AsIs, Some("1/2")),
        (mapped(&f, |i, j, v| Some((j, i, PI * v))), Layout::Transposed, Some("pi")),
    ];
    for (given, layout, constant) in cases {
        let physics = judged(&given, &around);
        let mistake = physics.mistake.clone().unwrap_or_else(|| panic!("{layout:?} {constant:?}: {physics:?}"));
        assert_eq!((mistake.layout, mistake.constant.as_deref()), (layout, constant));
        let meant = undo(&given, &around, &mistake);
        assert!(!judged(&meant, &around).broken);
        assert!((meant.get(3, 12) - f.get(3, 12)).abs() < 1e-15 && meant.stored() == f.stored());
    }
}

#[test]
fn a_constant_factor_shows_in_the_open_too() {
    let (patches, f) = room();
    // Without its last wall the room is open, and row sums say little.
    let open = &patches[..20];
    let few = mapped(&f, |i, j, v| (i < 20 && j < 20).then_some((i, j, PI * v)));
    let few = FormFactors::from_exact_rows((0..20).map(|i| few.row(i).map(|(j, v)| (j as u32, v)).collect()).collect());
    let physics = judged(&few, &around(open, false));
    assert!(physics.broken);
    assert_eq!(physics.mistake.unwrap().constant.as_deref(), Some("pi"));
    assert!(physics.impossible.iter().any(|i| i.reason == Reason::AboveUnobstructed));
}

#[test]
fn equal_areas_hide_a_transposition_but_not_an_exchange() {
    let (patches, f) = box_room([1.0; 3], [2; 3]);
    let around = around(&patches, true);
    let physics = judged(&mapped(&f, |i, j, v| Some((i, j, 0.25 * v))), &around);
    let mistake = physics.mistake.unwrap();
    assert_eq!((mistake.layout, mistake.scale), (Layout::ExchangeAreas, 1.0));
    assert!(!judged(&mapped(&f, |i, j, v| Some((j, i, v))), &around).broken);
}

#[test]
fn impossible_entries_are_listed_by_reason_and_taken_out() {
    let (patches, f) = room();
    let mut rows: Vec<Vec<(u32, f64)>> = (0..f.n).map(|i| f.row(i).map(|(j, v)| (j as u32, v)).collect()).collect();
    rows[0].insert(0, (0, 0.1));
    // Patches 0 and 1 lie in one plane.
    rows[0].insert(1, (1, 0.05));
    rows[4].last_mut().unwrap().1 = 1.5;
    rows[5].last_mut().unwrap().1 = -0.25;
    rows[6].last_mut().unwrap().1 = 0.9;
    let given = FormFactors::from_exact_rows(rows);
    let physics = judged(&given, &around(&patches, true));
    let reasons: Vec<Reason> = physics.impossible.iter().map(|i| i.reason).collect();
    let all = [Reason::Negative, Reason::AboveOne, Reason::SeesItself, Reason::FacingAway, Reason::AboveUnobstructed];
    assert_eq!(reasons, all);
    assert!(physics.impossible.iter().all(|i| i.entries == 1 && i.broken == 1), "{:?}", physics.impossible);
    let done = enforce(&given, &around(&patches, true));
    assert_eq!(done.info.forbidden, 2);
    assert!(!done.form_factors.holds(0, 0) && !done.form_factors.holds(0, 1));
    assert!(done.info.after.largest_closure < 1e-14, "{:?}", done.info.after);
}

#[test]
fn a_row_that_lost_its_entries_is_opened_again() {
    let (patches, f) = room();
    let given = mapped(&f, |i, j, v| (i != 4 && j != 4).then_some((i, j, v)));
    let around = around(&patches, true);
    assert_eq!(judged(&given, &around).closure.worst[0].row, 4);
    let done = enforce(&given, &around);
    assert!(done.info.opened > 0 && done.info.unmet.is_empty(), "{:?}", done.info);
    assert!(done.info.after.largest_closure < 1e-13);
    // What was opened is spread as it would be with nothing in between: near the truth here.
    let off = done.form_factors.row(4).map(|(j, v)| (v - f.get(4, j)).abs()).fold(0.0, f64::max);
    println!("largest error of the opened row {off:.2e}");
    assert!(off < 0.1, "{off}");
}
