//! The scenes of the experiments of George, Sillion and Greenberg 1990: their sizes, what an edit changes, and that
//! the files are what their generator writes (those of `hemicube_scenes.rs` too).

use etalon::doctor::examine;
use etalon::io::scene::{builtin, builtin_text};
use etalon::scene::{FindingKind, Scene, Stage};
use std::path::Path;
use std::process::Command;

const NAMES: [&str; 3] = ["cube-room", "cube-room-edits", "robot-room"];

fn scene(name: &str) -> Scene {
    builtin(name).expect("a built-in scene")
}

fn stage(name: &str, state: usize) -> Stage {
    scene(name).at(state).expect("a state")
}

fn present(stage: &Stage) -> usize {
    stage.patches.iter().filter(|p| p.is_present()).count()
}

fn is_of(stage: &Stage, patch: usize, object: &str) -> bool {
    stage.surfaces[stage.patches[patch].surface as usize].object == object
}

#[test]
fn sizes_are_those_of_the_paper() {
    for name in ["cube-room", "cube-room-edits"] {
        let room = stage(name, 1);
        assert_eq!((room.patch_count(), room.elements.len()), (450, 1750), "{name}");
        assert_eq!((present(&room), present(&stage(name, 0))), (450, 450 - 24), "{name}: nothing is covered");
    }
    let room = stage("robot-room", 1);
    assert_eq!((room.patch_count(), room.elements.len()), (12_700, 45_900));
    assert_eq!(present(&room), 12_700 - 20, "the soles alone are covered wholly");
}

#[test]
fn experiments_add_one_object_and_nothing_else() {
    for (name, object) in [("cube-room", "cube"), ("robot-room", "robot")] {
        assert_eq!(scene(name).edits.len(), 1, "{name}");
        let (before, after) = (stage(name, 0), stage(name, 1));
        let mut covered = 0.0;
        for (i, (p, q)) in before.patches.iter().zip(&after.patches).enumerate() {
            assert_eq!((before.reflectance(i), before.emission(i)), (after.reflectance(i), after.emission(i)));
            if is_of(&after, i, object) {
                assert!(!p.is_present(), "{name}: patch {i} stands before the edit");
            } else {
                assert_eq!(p.corners, q.corners, "{name}: patch {i} moved");
                assert!(p.is_present() && q.is_present() && q.area <= p.area, "{name}: patch {i}");
                covered += p.area - q.area;
            }
        }
        // Two soles of 0.12 m x 0.28 m, at nine tenths; the cube hovers.
        let soles = if object == "robot" { 2.0 * 0.12 * 0.28 * 0.81 } else { 0.0 };
        assert!((covered - soles).abs() < 1e-7, "{name}: {covered} m^2 covered, of {soles}");
    }
}

#[test]
fn the_sequence_has_an_edit_of_every_kind() {
    let stages: Vec<Stage> = (0..=6).map(|k| stage("cube-room-edits", k)).collect();
    assert_eq!(scene("cube-room-edits").edits.len(), 6);
    let cube = (0..450).find(|i| is_of(&stages[1], *i, "cube")).expect("a cube");
    let lamp = (0..450).find(|i| is_of(&stages[1], *i, "lamp")).expect("a lamp");
    let here: Vec<bool> = stages.iter().map(|s| s.patches[cube].is_present()).collect();
    assert_eq!(here, [false, true, true, true, true, true, false], "added first, removed last");
    let total = |k: usize| stages[k].areas().iter().sum::<f64>();
    assert!((total(2) - total(1)).abs() < 1e-12, "moved");
    assert_ne!(stages[1].patches[cube].corners, stages[2].patches[cube].corners);
    assert!((total(2) - total(3) - 2.0 * 0.36 * 0.36).abs() < 1e-9, "the sides are halved");
    assert_ne!(stages[3].reflectance(cube), stages[4].reflectance(cube));
    assert_ne!(stages[4].emission(lamp), stages[5].emission(lamp));
    assert_eq!(present(&stages[6]), present(&stages[0]));
}

#[test]
fn materials_are_plausible_and_lamps_few() {
    for name in NAMES {
        let room = stage(name, 1);
        for m in &room.materials {
            assert!(m.reflectance.iter().all(|r| (0.2..=0.8).contains(r)), "{name}: {}", m.name);
        }
        let lamps = (0..room.patch_count()).filter(|i| room.emission(*i).iter().any(|e| *e > 0.0)).count();
        assert_eq!(lamps, if name == "robot-room" { 4 } else { 1 }, "{name}");
        assert_eq!(room.cameras.len(), 1, "{name}");
    }
}

/// No gap, no back seen by rays, no lamp that few rays find: only the robot's feet touch the floor.
#[test]
fn the_doctor_finds_contact_under_the_feet_alone() {
    for (name, states) in [("cube-room", 0..=1), ("cube-room-edits", 2..=5), ("robot-room", 0..=1)] {
        for state in states {
            let found = examine(&scene(name), &stage(name, state)).expect("an examination");
            let feet = |kind| matches!(kind, FindingKind::Contact | FindingKind::BuriedCentre);
            let meant = |kind| name == "robot-room" && state == 1 && feet(kind);
            assert!(found.iter().all(|f| meant(f.kind)), "{name} in state {state}: {found:#?}");
            assert_eq!(found.is_empty(), (name, state) != ("robot-room", 1));
        }
    }
}

#[test]
fn files_are_what_their_generator_writes() {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("references/scenes/generate/make.py");
    let folder = tempfile::tempdir().expect("a folder");
    let run = Command::new("python3").arg("-B").arg(script).arg(folder.path()).output();
    let Ok(run) = run else {
        eprintln!("there is no python3 here: the generator is not run");
        return;
    };
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    for name in NAMES.into_iter().chain(["office", "small-lamp", "aliasing-only"]) {
        let written = std::fs::read_to_string(folder.path().join(format!("{name}.toml"))).expect("a scene");
        assert!(Some(written.as_str()) == builtin_text(name), "{name}.toml is not what generate/make.py writes");
    }
}
