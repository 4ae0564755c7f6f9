use super::*;

fn bands() -> Vec<String> {
    ["r", "g"].map(String::from).to_vec()
}

#[test]
fn every_format_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let b = Radiosity {
        bands: 2,
        values: vec![1.0, 0.1, 0.0, 0.0, 2.5, 1e-9],
        std_err: Some(vec![0.1, 0.2, 0.0, 0.0, 0.0, 0.3]),
    };
    let bands = bands();
    let present = [true, false, true];
    let names = BandNames { scene: "s", scene_hash: "h", bands: &bands, present: &present };
    for file in ["b.csv", "b.json", "b.npz", "b.npy"] {
        let path = folder.path().join(file);
        let format = SolutionFormat::of(&path).unwrap();
        std::fs::write(&path, write_solution(&b, names, format)).unwrap();
        let mut expected = b.clone();
        if format == SolutionFormat::Npy {
            expected.std_err = None;
        }
        assert_eq!(read_solution(&path).unwrap().fit(&bands, &present).unwrap(), expected, "{file}");
    }
}

#[test]
fn bands_may_come_in_any_order_and_rows_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("b.csv");
    std::fs::write(&path, "patch,g,r\n1, 4,3\n0,2,1\n").unwrap();
    let b = read_solution(&path).unwrap().fit(&bands(), &[true, true]).unwrap();
    assert_eq!((b.values, b.std_err), (vec![1.0, 2.0, 3.0, 4.0], None));
}

#[test]
fn what_is_wrong_is_named_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("b.csv");
    for (text, expected) in [
        ("patch,r,g\n0,1,2\n0,1,2\n", "line 3: patch 0 stands twice"),
        ("patch,r,g\n0,1,nan\n1,1,1\n", "patch 0: NaN is not a finite number"),
        ("patch,r,g\n0,1,x\n", "line 2: \"x\" is not a number"),
        ("patch,r,g\n0,1\n", "line 2: has 2 fields"),
        ("patch,r,g\n0,1,2\n", "patch 1: is missing"),
        ("patch,r,g\n0,1,2\n1,1,2\n2,1,2\n", "patch 2: the scene has only 2"),
        ("patch,r,b\n0,1,2\n1,1,2\n", "has bands r, b, but the scene has r, g"),
        ("a,r\n", "line 1: does not begin with patch"),
    ] {
        std::fs::write(&path, text).unwrap();
        let result = read_solution(&path).and_then(|s| s.fit(&bands(), &[true, true]));
        let message = result.unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
}
