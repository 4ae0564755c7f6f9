use super::*;
use crate::io::scene::{SceneOptions, open_scene};
use crate::solution::Radiosity;
use std::fs;

fn stages() -> Vec<Stage> {
    let scene = open_scene("builtin:dynamic-cube", &SceneOptions::default()).expect("a scene");
    (0..=scene.edits.len()).map(|k| scene.at(k).expect("a state")).collect()
}

fn snapshots(stages: &[Stage]) -> Vec<Snapshot> {
    let one = |k: usize| {
        let stage = &stages[k / 2];
        let bands = stage.band_count();
        let value = |i: usize| if stage.patches[i / bands].is_present() { (i + k) as f64 / 3.0 } else { 0.0 };
        let values = (0..stage.patch_count() * bands).map(value).collect();
        let radiosity = Radiosity { bands, values, std_err: None };
        Snapshot { edit: k / 2, shots: 3 * k as u64, rays: 100 * k as u64, seconds: 0.1 * k as f64, radiosity }
    };
    (0..4).map(one).collect()
}

fn write(folder: &Path, stages: &[Stage], format: SolutionFormat, snapshots: &[Snapshot]) {
    let mut writer = SeriesWriter::create(folder, format).expect("a folder");
    for s in snapshots {
        let stage = &stages[s.edit];
        let present: Vec<bool> = stage.patches.iter().map(|p| p.is_present()).collect();
        let names = BandNames { scene: &stage.name, scene_hash: "", bands: &stage.photometry.bands, present: &present };
        writer.add(s, names).expect("written");
    }
}

#[test]
fn what_is_written_comes_back_to_the_bit_and_replaces_what_was_there() {
    let (place, stages) = (tempfile::tempdir().expect("a folder"), stages());
    let folder = place.path().join("series");
    let all = snapshots(&stages);
    write(&folder, &stages, SolutionFormat::Csv, &all);
    for format in [SolutionFormat::Csv, SolutionFormat::Npy] {
        write(&folder, &stages, format, &all);
        assert_eq!(read_series(&folder, "mine", &stages).expect("reads").snapshots, all);
        assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 5);
    }
    fs::write(folder.join("thesis.tex"), "!").expect("written");
    let refused = SeriesWriter::create(&folder, SolutionFormat::Csv).expect_err("something else").to_string();
    assert!(refused.contains("thesis.tex") && folder.join(INDEX).is_file(), "{refused}");
}

#[test]
fn an_interrupted_run_leaves_what_it_had() {
    let (place, stages) = (tempfile::tempdir().expect("a folder"), stages());
    let folder = place.path().join("series");
    let all = snapshots(&stages);
    write(&folder, &stages, SolutionFormat::Npy, &all[..2]);
    // A snapshot file without its line: the process died between the two.
    fs::write(folder.join("snapshot-0002.npy"), b"half").expect("written");
    assert_eq!(read_series(&folder, "mine", &stages).expect("reads").snapshots, all[..2]);
}

#[test]
fn every_fault_of_an_index_is_named_with_its_line() {
    let (place, stages) = (tempfile::tempdir().expect("a folder"), stages());
    let folder = place.path().join("series");
    write(&folder, &stages, SolutionFormat::Csv, &snapshots(&stages));
    let last = stages.len();
    let beyond = format!("file,seconds,shots,rays,edit\nsnapshot-0000.csv,0,0,0,{last}\n");
    let faults = [
        ("file,seconds,shots,rays\n", "no column \"edit\""),
        ("file,seconds,shots,rays,edit,cost\n", "\"cost\" that is unknown"),
        ("file,seconds,shots,rays,edit,edit\n", "\"edit\" twice"),
        ("file,seconds,shots,rays,edit\n", "no snapshot"),
        ("file,seconds,shots,rays,edit\nsnapshot-0000.csv,x,0,0,0\n", "line 2: seconds \"x\""),
        ("file,seconds,shots,rays,edit\nsnapshot-0000.csv,inf,0,0,0\n", "line 2: seconds \"inf\""),
        ("file,seconds,shots,rays,edit\nsnapshot-0000.csv,-1,0,0,0\n", "seconds \"-1\""),
        ("file,seconds,shots,rays,edit\nsnapshot-0000.csv,1,-3,0,0\n", "shots \"-3\""),
        ("file,seconds,shots,rays,edit\nsnapshot-0000.csv,1,0,1.5,0\n", "rays \"1.5\""),
        ("file,seconds,shots,rays,edit\nsnapshot-0000.csv,1,0\n", "has 3 fields"),
        ("file,seconds,shots,rays,edit\n,1,0,0,0\n", "names no file"),
        ("file,seconds,shots,rays,edit\nnowhere.csv,1,0,0,0\n", "no file \"nowhere.csv\""),
        ("file,seconds,shots,rays,edit\n../index.csv,1,0,0,0\n", "leaves the folder"),
        ("file,seconds,shots,rays,edit\n/etc/passwd,1,0,0,0\n", "leaves the folder"),
        (beyond.as_str(), "beyond the"),
        (
            "file,seconds,shots,rays,edit\nsnapshot-0000.csv,2,0,0,0\nsnapshot-0001.csv,1,0,0,0\n",
            "line 3: seconds fall",
        ),
        ("file,seconds,shots,rays,edit\nsnapshot-0000.csv,1,9,0,0\nsnapshot-0001.csv,1,8,0,0\n", "shots fall"),
        ("file,seconds,shots,rays,edit\nsnapshot-0000.csv,1,9,7,0\nsnapshot-0001.csv,1,9,6,0\n", "rays fall"),
        ("file,seconds,shots,rays,edit\nsnapshot-0002.csv,1,0,0,1\nsnapshot-0000.csv,1,0,0,0\n", "edits fall"),
    ];
    for (index, message) in faults {
        fs::write(folder.join(INDEX), index).expect("written");
        let said = read_series(&folder, "mine", &stages).expect_err(message).to_string();
        assert!(said.contains(message) && said.contains(INDEX) && said.contains(';'), "{message}: {said}");
    }
    fs::remove_file(folder.join(INDEX)).expect("removed");
    assert!(read_series(&folder, "mine", &stages).expect_err("no index").to_string().contains("a series is a folder"));
}

#[test]
fn radiosities_of_another_scene_are_refused() {
    let (place, stages) = (tempfile::tempdir().expect("a folder"), stages());
    let folder = place.path().join("series");
    write(&folder, &stages, SolutionFormat::Csv, &snapshots(&stages)[..1]);
    let bands = stages[0].photometry.bands.join(",");
    let row = vec!["1"; stages[0].band_count()].join(",");
    fs::write(folder.join("snapshot-0000.csv"), format!("patch,{bands}\n0,{row}\n")).expect("written");
    let said = read_series(&folder, "mine", &stages).expect_err("too few").to_string();
    assert!(said.contains("snapshot-0000.csv") && said.contains("line 2"), "{said}");
}
