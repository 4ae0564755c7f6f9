//! `etalon convert`: numbers of other programs onto the patches, and what it refuses.

#[path = "common/program.rs"]
mod program;

use program::{json, ok, refused};
use std::f64::consts::PI;
use std::fmt::Write;
use std::path::Path;

const SCENE: &str = r#"format = "etalon-scene/1"
name = "plates"
[photometry]
bands = ["y"]
primaries = "mono"
[[material]]
name = "grey"
reflectance = 0.5
emission = 1.0
[[surface]]
name = "floor"
material = "grey"
polygon = [[0,0,0], [2,0,0], [2,2,0], [0,2,0]]
patches = [2, 2]
[[surface]]
name = "ceiling"
material = "grey"
polygon = [[0,0,1], [0,2,1], [2,2,1], [2,0,1]]
"#;

/// The scene, and its faces as an OBJ in the given unit with one value each.
fn folder(unit: f64, faces: usize) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("scene.toml"), SCENE).unwrap();
    let (mut obj, mut table) = (String::new(), String::from("face,y\n"));
    let floor = |x: f64, y: f64| [[x, y, 0.0], [x + 1.0, y, 0.0], [x + 1.0, y + 1.0, 0.0], [x, y + 1.0, 0.0]];
    let ceiling = [[0.0, 0.0, 1.0], [0.0, 2.0, 1.0], [2.0, 2.0, 1.0], [2.0, 0.0, 1.0]];
    let all = [floor(0.0, 0.0), floor(1.0, 0.0), floor(0.0, 1.0), floor(1.0, 1.0), ceiling];
    for (k, face) in all.iter().take(faces).enumerate() {
        face.iter().for_each(|[x, y, z]| writeln!(obj, "v {} {} {}", x / unit, y / unit, z / unit).unwrap());
        writeln!(obj, "f {} {} {} {}", 4 * k + 1, 4 * k + 2, 4 * k + 3, 4 * k + 4).unwrap();
        writeln!(table, "{k},{}", k + 1).unwrap();
    }
    std::fs::write(at("mesh.obj"), obj).unwrap();
    std::fs::write(at("values.csv"), table).unwrap();
    folder
}

/// Patches and values of a solution file.
fn rows(folder: &Path, name: &str) -> Vec<(usize, Vec<f64>)> {
    let text = std::fs::read_to_string(folder.join(name)).unwrap();
    let row = |line: &str| {
        let mut fields = line.split(',');
        (fields.next().unwrap().parse().unwrap(), fields.map(|x| x.parse().unwrap()).collect())
    };
    text.lines().skip(1).map(row).collect()
}

/// Options with what they make of a value.
type Quantity = (&'static str, fn(f64) -> f64);

const CONVERT: &str = "convert mesh.obj --values values.csv --scene scene.toml";

#[test]
fn values_of_a_mesh_in_every_quantity() {
    let folder = folder(1.0, 5);
    let at = folder.path();
    let radiosity: [Quantity; 5] = [
        ("", |v| v),
        ("--quantity radiance", |v| PI * v),
        ("--quantity reflected", |v| 1.0 + v),
        ("--quantity irradiance", |v| 1.0 + 0.5 * v),
        ("--quantity radiance --factor 0.5", |v| 0.5 * PI * v),
    ];
    for (options, expected) in radiosity {
        ok(at, &format!("{CONVERT} {options} -o out.csv"));
        let rows = rows(at, "out.csv");
        assert_eq!(rows.len(), 5, "{options}");
        for (patch, b) in rows {
            assert!((b[0] - expected(patch as f64 + 1.0)).abs() < 1e-14, "{options} {patch}: {b:?}");
        }
    }
    let told = json(at, &format!("{CONVERT} -o out.json"));
    assert_eq!((&told["carried"]["covered"], &told["left_out"]), (&1.0.into(), &0.into()), "{told}");
    // Its own output is a solution, also on the mesh of the patches.
    for name in ["out.json", "out.npy", "out.npz", "out.vtu", "out.ply"] {
        ok(at, &format!("{CONVERT} -o {name}"));
        ok(at, &format!("convert {name} --scene scene.toml -o again.csv"));
        assert_eq!(
            rows(at, "again.csv").iter().map(|r| r.1[0]).collect::<Vec<_>>(),
            [1.0, 2.0, 3.0, 4.0, 5.0],
            "{name}"
        );
    }
}

#[test]
fn values_per_patch_take_their_errors_along() {
    let folder = folder(1.0, 5);
    let table: String = (0..5).map(|i| format!("{i},0.5,0.01\n")).collect();
    std::fs::write(folder.path().join("in.csv"), format!("patch,y,y_std_err\n{table}")).unwrap();
    ok(folder.path(), "convert in.csv --scene scene.toml --quantity radiance -o out.csv");
    for (_, b) in rows(folder.path(), "out.csv") {
        assert!((b[0] - 0.5 * PI).abs() < 1e-15 && (b[1] - 0.01 * PI).abs() < 1e-15);
    }
    ok(folder.path(), "convert in.csv --scene scene.toml --transfer srgb -o out.csv");
    assert!((rows(folder.path(), "out.csv")[0].1[0] - 0.214_041_14).abs() < 1e-8);
}

#[test]
fn a_mesh_in_millimetres_is_refused_and_taken_with_its_unit() {
    let folder = folder(0.001, 5);
    let told = refused(folder.path(), &format!("{CONVERT} -o out.csv"));
    assert!(told.contains("--units") && told.contains("2000.000") && told.contains("ceiling"), "{told}");
    assert!(!folder.path().join("out.csv").exists());
    ok(folder.path(), &format!("{CONVERT} --units mm -o out.csv"));
    ok(folder.path(), &format!("{CONVERT} --units 0.001 -o out.csv"));
    assert_eq!(rows(folder.path(), "out.csv").len(), 5);
}

#[test]
fn patches_without_a_face_are_refused_by_name_or_left_out() {
    let folder = folder(1.0, 3);
    let told = refused(folder.path(), &format!("{CONVERT} --reach 0 -o out.csv"));
    assert!(
        told.contains("3 of \"floor\"") && told.contains("4 of \"ceiling\"") && told.contains("5.0000 m^2"),
        "{told}"
    );
    let told = refused(folder.path(), &format!("{CONVERT} --skip-unmatched -o out.npy"));
    assert!(told.contains(".csv"), "{told}");
    ok(folder.path(), &format!("{CONVERT} --skip-unmatched -o out.csv"));
    assert_eq!(rows(folder.path(), "out.csv").iter().map(|r| r.0).collect::<Vec<_>>(), [0, 1, 2]);
}

#[test]
fn mistakes_are_refused_with_their_mend() {
    let folder = folder(1.0, 5);
    let at = folder.path();
    std::fs::write(at.join("in.csv"), "patch,y\n0,1\n1,1\n2,1\n3,1\n4,1\n").unwrap();
    std::fs::write(at.join("rgb.csv"), "face,r,g,b\n0,1,1,1\n1,1,1,1\n2,1,1,1\n3,1,1,1\n4,1,1,1\n").unwrap();
    let mistakes = [
        ("convert in.csv --scene scene.toml --units mm -o out.csv".to_string(), "--units is for"),
        ("convert in.csv --scene scene.toml --skip-unmatched -o out.csv".into(), "--skip-unmatched is for"),
        ("convert in.csv --scene scene.toml --factor 0 -o out.csv".into(), "--factor"),
        ("convert in.csv --scene scene.toml --factor nan -o out.csv".into(), "--factor"),
        ("convert in.csv --scene scene.toml -o out.txt".into(), ".vtu"),
        ("convert nothing.ply --scene scene.toml -o out.csv".into(), "nothing.ply"),
        (format!("{CONVERT} --reach -1 -o out.csv"), "--reach"),
        (format!("{CONVERT} --units yard -o out.csv"), "unit of length"),
        (format!("{CONVERT} --transfer srgb -o out.csv"), "--transfer srgb"),
        ("convert mesh.obj --values rgb.csv --scene scene.toml -o out.csv".into(), "--fields"),
    ];
    for (arguments, mend) in mistakes {
        let told = refused(at, &arguments);
        assert!(told.contains(mend), "{arguments}: {told}");
        assert!(!at.join("out.csv").exists() && !at.join("out.txt").exists(), "{arguments}");
    }
}
