//! The references that come with the program: whole, of the scenes they are named after, right.

#[path = "common/program.rs"]
mod program;

use etalon::io::scene::builtin;
use etalon::io::{StoredReference, certified, certified_names};
use program::{json, refused, run};

fn stored(name: &str) -> StoredReference {
    certified(name).expect("there is one").unwrap_or_else(|e| panic!("{name}: {e}"))
}

#[test]
fn each_is_whole_sound_and_of_its_scene() {
    assert!(certified_names().len() >= 12);
    for name in certified_names() {
        let r = stored(name);
        let scene = builtin(name).expect("a built-in scene");
        assert_eq!(r.scene_hash, scene.at(scene.edits.len()).expect("a stage").hash(), "{name}");
        assert!(r.self_check.passed(), "{name}");
        assert!(r.provenance.relative_error < 5e-4, "{name}: {}", r.provenance.relative_error);
    }
}

/// In a furnace of reflectance rho everything has B = E / (1 - rho), whatever its shape.
#[test]
fn the_furnace_is_exact() {
    let r = stored("furnace-l");
    let (stage, b) = (&r.stage, r.patches.mean());
    for i in 0..stage.patch_count() {
        let (rho, e) = (stage.reflectance(i)[0], stage.emission(i)[0]);
        let exact = e / (1.0 - rho);
        let (off, se) = ((b.of(i)[0] - exact).abs(), b.std_err_of(i).expect("stated")[0]);
        // Eight replicates, 184 patches: beyond 12 of their errors once in a thousand runs.
        assert!(off <= 12.0 * se + 1e-12 && off < 4e-8 * exact, "{i}: {off:e} {se:e} of {exact}");
    }
}

/// Opposed and adjacent unit squares of one reflectance, one of them emitting: two unknowns, closed form factors.
#[test]
fn two_squares_are_exact() {
    // F of opposed unit squares at distance 1, and of unit squares that share an edge.
    let opposed = 0.199_824_895_698_387_02;
    let adjacent = 0.200_043_776_075_403_23;
    for (name, f) in [("opposed-squares", opposed), ("edge-squares", adjacent)] {
        let r = stored(name);
        let (stage, b) = (&r.stage, r.patches.mean());
        let present: Vec<usize> = (0..stage.patch_count()).filter(|i| stage.patches[*i].is_present()).collect();
        assert_eq!(present.len(), 2, "{name}");
        let (i, j) = (present[0], present[1]);
        let of = |k: usize| (stage.reflectance(k)[0], stage.emission(k)[0]);
        let ((ri, ei), (rj, ej)) = (of(i), of(j));
        let bi = (ei + ri * f * ej) / (1.0 - ri * rj * f * f);
        let bj = ej + rj * f * bi;
        assert!(
            (b.of(i)[0] - bi).abs() < 1e-9 * bi.max(1e-9) && (b.of(j)[0] - bj).abs() < 1e-9 * bj.max(1e-9),
            "{name}"
        );
    }
}

#[test]
fn they_judge_by_name() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    json(here, "solve builtin:cornell-box-coarse --method hemicube:resolution=200 -o mine.csv");
    let check = "check mine.csv --reference builtin:cornell-box-coarse --scene builtin:cornell-box-coarse";
    assert_eq!(run(here, &format!("{check} --max-rms 5%")).0, 0);
    assert_eq!(run(here, &format!("{check} --max-rms 0.01%")).0, 1);
    let what = refused(here, "check mine.csv --reference builtin:cornel-box --max-rms 5%");
    assert!(what.contains("cornell-box-coarse"), "{what}");
    // Of another scene.
    assert_eq!(run(here, "check mine.csv --reference builtin:furnace-l --max-rms 5%").0, 2);
}
