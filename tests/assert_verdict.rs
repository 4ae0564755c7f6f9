//! The library's front: a reference computed, stored, opened, and verdicts asserted.

use etalon::{
    Error, Estimator, KernelKind, Limits, Radiosity, Reference, ReferenceOptions, Stage, Verdict, assert_verdict,
    open_scene, solve,
};

fn stage() -> Stage {
    open_scene("builtin:cube-one-emitter").expect("a scene").at(0).expect("a stage")
}

fn options(rays: u64) -> ReferenceOptions {
    ReferenceOptions::default().estimator(Estimator::Rays).rays(rays).kernel(KernelKind::Builtin)
}

fn reference() -> Reference {
    Reference::compute(&stage(), &options(16_384)).expect("a reference")
}

/// Cube with one emitter, reflectance 0.5, E = 1: the exact radiosities, scaled.
fn scaled(by: f64) -> Radiosity {
    let mut b = reference().radiosity();
    b.values.iter_mut().for_each(|v| *v *= by);
    Radiosity { std_err: None, ..b }
}

#[test]
fn what_is_right_passes_and_what_is_wrong_fails() {
    let reference = reference();
    assert_verdict!(reference.check(&scaled(1.0), &Limits::rms(0.02)).expect("a check"));
    assert_verdict!(reference.check(&scaled(1.1), &Limits::rms(0.02)).expect("a check"), Fail);
    let hemicube = solve(&stage(), "hemicube:resolution=200", 0).expect("a solution");
    assert_verdict!(reference.check(&hemicube, &Limits::rms(0.05)).expect("a check"));
}

#[test]
fn a_limit_within_the_noise_is_inconclusive_and_passes_no_assertion() {
    let noisy = Reference::compute(&stage(), &options(256)).expect("a reference");
    let mut mine = noisy.radiosity();
    mine.std_err = None;
    let check = noisy.check(&mine, &Limits::rms(0.01)).expect("a check");
    assert_verdict!(check, Inconclusive);
    let panicked = std::panic::catch_unwind(|| assert_verdict!(check));
    let message = *panicked.expect_err("no pass").downcast::<String>().expect("a message");
    assert!(message.contains("not pass: inconclusive") && message.contains("times the rays"), "{message}");
}

#[test]
fn a_failed_assertion_says_where_and_by_how_much() {
    let reference = reference();
    let mut mine = scaled(1.0);
    mine.values[3] *= 2.0;
    let panicked = std::panic::catch_unwind(|| {
        assert_verdict!(reference.check(&mine, &Limits::rms(0.02)).expect("a check"));
    });
    let message = *panicked.expect_err("no pass").downcast::<String>().expect("a message");
    let worst = message.lines().find(|l| l.contains("patch")).expect("a worst patch");
    assert!(message.contains("limit 2.000e-2: fail") && worst.contains("patch 3 ("), "{message}");
}

#[test]
fn a_stored_reference_is_opened_again_until_the_scene_changes() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("cube.ref");
    let first = Reference::open_or_compute(&path, &stage(), &options(1024)).expect("computed");
    let second = Reference::open_or_compute(&path, &stage(), &options(1024)).expect("opened");
    assert_eq!(first.radiosity(), second.radiosity());
    let written = std::fs::metadata(path.join("reference.json")).expect("stored").modified().expect("a time");
    // A target that the stored one has not reached is computed, however many rays that one has.
    let sharp = options(16).target_error(0.5 * first.provenance().relative_error);
    let better = Reference::open_or_compute(&path, &stage(), &sharp).expect("computed");
    assert!(better.provenance().relative_error <= 0.5 * first.provenance().relative_error);
    let mut changed = stage();
    changed.materials.iter_mut().for_each(|m| m.reflectance.iter_mut().for_each(|r| *r *= 0.5));
    let third = Reference::open_or_compute(&path, &changed, &options(1024)).expect("computed again");
    assert_ne!(first.radiosity(), third.radiosity());
    assert!(std::fs::metadata(path.join("reference.json")).expect("stored").modified().expect("a time") >= written);
    let file = folder.path().join("mine.csv");
    std::fs::write(&file, "patch,y\n0,1\n1,1\n").expect("written");
    let short = third.read_solution(&file).expect_err("rows are missing");
    assert!(matches!(&short, Error::File(e) if e.to_string().contains("mine.csv")), "{short}");
}

#[test]
fn mistakes_are_errors_not_panics() {
    let reference = reference();
    assert!(matches!(reference.check(&scaled(1.0), &Limits::default()), Err(Error::NoLimit)));
    assert!(matches!(reference.check(&scaled(1.0), &Limits::rms(f64::NAN)), Err(Error::NoLimit)));
    let short = Radiosity { bands: 1, values: vec![1.0; 5], std_err: None };
    assert!(matches!(reference.check(&short, &Limits::rms(0.1)), Err(Error::Judge(_))));
    assert!(matches!(solve(&stage(), "radiance", 0), Err(Error::Method(_))));
    assert!(matches!(open_scene("no-such-scene.toml"), Err(Error::SceneFile(_))));
    let top1 = reference.check(&scaled(1.0), &Limits::top1(0.1)).expect("a check");
    assert_eq!(top1.verdict(), Verdict::Inconclusive, "there is no state before");
}
