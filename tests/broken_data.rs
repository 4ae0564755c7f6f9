//! Broken solutions, matrices, references and command lines: each is refused with exit 2 and one message that names
//! file and place; nothing is written and nothing panics.

use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::Path;

/// Two plates face to face, one patch each, two bands.
const PLATES: &str = r#"
format = "etalon-scene/1"
name = "plates"
[photometry]
bands = ["a", "b"]
luminance = [0.5, 0.5]
[[material]]
name = "lamp"
reflectance = 0.5
emission = 1.0
[[surface]]
name = "floor"
material = "lamp"
polygon = [[0,0,0],[1,0,0],[1,1,0],[0,1,0]]
[[surface]]
name = "ceiling"
material = "lamp"
polygon = [[0,0,1],[0,1,1],[1,1,1],[1,0,1]]
"#;

fn etalon(folder: &Path, arguments: &str) -> std::process::Output {
    let mut command = Command::cargo_bin("etalon").expect("the binary");
    command.current_dir(folder).env("NO_COLOR", "1").args(arguments.split_whitespace());
    command.output().expect("it runs")
}

fn workshop() -> tempfile::TempDir {
    let place = tempfile::tempdir().expect("a folder");
    fs::write(place.path().join("plates.toml"), PLATES).expect("writable");
    for (arguments, seed) in [("-o ref", 0), ("-o other", 1)] {
        let out = etalon(place.path(), &format!("reference plates.toml {arguments} --rays 256 --seed {seed}"));
        assert_eq!(out.status.code(), Some(0), "{}", String::from_utf8_lossy(&out.stderr));
    }
    fs::write(place.path().join("good.csv"), "patch,a,b\n0,1,1\n1,1,1\n").expect("writable");
    place
}

/// Everything below a folder, with its bytes.
fn all(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut out = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            out.push((path.display().to_string(), Vec::new()));
            out.extend(all(&path));
        } else {
            out.push((path.display().to_string(), fs::read(&path).expect("readable")));
        }
    }
    out.sort();
    out
}

/// Runs a command that has to be refused, for people and for programs; returns what is wrong with the refusal.
fn refusal(folder: &Path, arguments: &str, says: &[&str]) -> Vec<String> {
    let before = all(folder);
    let mut wrong = Vec::new();
    let mut expect = |holds: bool, what: String| {
        if !holds {
            wrong.push(format!("{arguments}: {what}"));
        }
    };
    let out = etalon(folder, arguments);
    let (text, message) = (String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr));
    expect(out.status.code() == Some(2), format!("exit {:?}: {message}{text}", out.status.code()));
    expect(text.is_empty(), format!("printed on stdout: {text}"));
    // Scenes are shown with the place drawn; everything else is one line.
    let drawn = message.starts_with("etalon::scene::");
    let errors = message.lines().filter(|l| l.starts_with("error:")).count();
    expect(errors == usize::from(!drawn), format!("{errors} messages: {message}"));
    for part in says {
        expect(message.contains(part), format!("\"{part}\" is not in: {message}"));
    }
    let out = etalon(folder, &format!("{arguments} --json"));
    let value: Value = serde_json::from_slice(&out.stdout).unwrap_or_default();
    let json = value["error"]["message"].as_str().unwrap_or_default();
    expect(out.status.code() == Some(2) && value["error"]["code"] == "bad-input", format!("--json: {value}"));
    expect(says.iter().all(|part| json.contains(part)), format!("--json lacks {says:?}: {value}"));
    expect(all(folder) == before, "something was written or changed".into());
    wrong
}

/// An array as NumPy stores it.
fn npy(descr: &str, shape: &str, payload: &[u8]) -> Vec<u8> {
    let mut header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    header += &" ".repeat(63 - (10 + header.len()) % 64);
    header.push('\n');
    [b"\x93NUMPY\x01\x00", &(header.len() as u16).to_le_bytes()[..], header.as_bytes(), payload].concat()
}

fn f8(shape: &str, values: &[f64]) -> Vec<u8> {
    npy("<f8", shape, &values.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>())
}

fn i4(values: &[i32]) -> Vec<u8> {
    npy("<i4", &format!("({},)", values.len()), &values.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>())
}

fn npz(members: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, bytes) in members {
        zip.start_file(format!("{name}.npy"), zip::write::SimpleFileOptions::default()).expect("memory");
        zip.write_all(bytes).expect("memory");
    }
    zip.finish().expect("memory").into_inner()
}

/// A CSR matrix, sound unless the arguments are not.
fn csr(shape: &[i32], indptr: &[i32], indices: &[i32], data: &[f64]) -> Vec<u8> {
    npz(&[
        ("shape", i4(shape)),
        ("format", npy("|S3", "()", b"csr")),
        ("indptr", i4(indptr)),
        ("indices", i4(indices)),
        ("data", f8(&format!("({},)", data.len()), data)),
    ])
}

#[rustfmt::skip]
fn solutions() -> Vec<(&'static str, Vec<u8>, Vec<&'static str>)> {
    let t = |s: &str| s.as_bytes().to_vec();
    let json = |bands: &str, radiosity: &str, more: &str|
        format!("{{\"format\": \"etalon-solution/1\",\n\"bands\": {bands},\n\"radiosity\": {radiosity}{more}}}").into_bytes();
    let two = "(2, 2)";
    vec![
        ("empty.csv", t(""), vec!["line 1", "patch,<band>", "the first line names"]),
        ("header.csv", t("facet,a,b\n0,1,1\n"), vec!["line 1", "patch,<band>"]),
        ("no-bands.csv", t("patch\n0\n1\n"), vec!["line 1", "patch,<band>"]),
        ("header-only.csv", t("patch,a,b\n"), vec!["patch 0", "is missing", "needs a row"]),
        ("twice-named.csv", t("patch,a,a\n0,1,1\n1,1,1\n"), vec!["line 1", "\"a\" twice"]),
        ("patch-twice-named.csv", t("patch,a,patch\n0,1,1\n1,1,1\n"), vec!["line 1", "\"patch\" twice"]),
        ("half-errors.csv", t("patch,a,b,a_std_err\n0,1,1,0\n1,1,1,0\n"), vec!["line 1", "every band its"]),
        ("stray-error.csv", t("patch,a,b,c_std_err\n0,1,1,0\n1,1,1,0\n"), vec!["line 1", "_std_err"]),
        ("other-band.csv", t("patch,a,c\n0,1,1\n1,1,1\n"), vec!["bands a, c", "the scene has a, b"]),
        ("one-band.csv", t("patch,a\n0,1\n1,1\n"), vec!["bands a,", "the scene has a, b"]),
        ("three-bands.csv", t("patch,a,b,c\n0,1,1,1\n1,1,1,1\n"), vec!["bands a, b, c"]),
        ("short-row.csv", t("patch,a,b\n0,1\n1,1,1\n"), vec!["line 2", "has 2 fields"]),
        ("long-row.csv", t("patch,a,b\n0,1,1\n1,1,1,1\n"), vec!["line 3", "has 4 fields"]),
        ("word.csv", t("patch,a,b\n0,1,bright\n1,1,1\n"), vec!["line 2", "\"bright\" is not a number"]),
        ("comma.csv", t("patch,a,b\n0,1,\n1,1,1\n"), vec!["line 2", "\"\" is not a number"]),
        ("negative-patch.csv", t("patch,a,b\n-1,1,1\n1,1,1\n"), vec!["line 2", "\"-1\" is not a patch number"]),
        ("fraction-patch.csv", t("patch,a,b\n0.5,1,1\n1,1,1\n"), vec!["line 2", "\"0.5\" is not a patch number"]),
        ("huge-patch.csv", t("patch,a,b\n0,1,1\n99999999999999999999999,1,1\n"), vec!["line 3", "is not a patch number"]),
        ("far-patch.csv", t("patch,a,b\n0,1,1\n1,1,1\n99999999999,1,1\n"), vec!["patch 99999999999", "only 2 patches"]),
        ("repeated.csv", t("patch,a,b\n0,1,1\n0,1,1\n"), vec!["line 3", "patch 0 stands twice"]),
        ("missing.csv", t("patch,a,b\n0,1,1\n"), vec!["patch 1", "is missing"]),
        ("nan.csv", t("patch,a,b\n0,1,nan\n1,1,1\n"), vec!["patch 0", "not a finite number"]),
        ("infinite.csv", t("patch,a,b\n0,1,1\n1,inf,1\n"), vec!["patch 1", "not a finite number"]),
        ("overflow.csv", t("patch,a,b\n0,1,1\n1,1e999,1\n"), vec!["patch 1", "not a finite number"]),
        ("negative-error.csv", t("patch,a,b,a_std_err,b_std_err\n0,1,1,0,-1\n1,1,1,0,0\n"), vec!["patch 0", "below 0"]),
        ("nan-error.csv", t("patch,a,b,a_std_err,b_std_err\n0,1,1,0,nan\n1,1,1,0,0\n"), vec!["patch 0", "finite"]),
        ("latin1.csv", b"patch,a,b\n0,1,1\n1,1,\xe9\n".to_vec(), vec!["line 3", "UTF-8"]),
        ("binary.csv", vec![0xff; 64], vec!["line 1", "UTF-8"]),
        ("semicolons.csv", t("patch;a;b\n0;1;1\n"), vec!["line 1", "patch,<band>"]),
        ("empty.json", t(""), vec!["line 1", "etalon-solution/1"]),
        ("cut.json", t("{\"format\": \"etalon-solution/1\",\n\"bands\": [\"a\""), vec!["line 2", "etalon-solution/1"]),
        ("list.json", t("[1, 2, 3]"), vec!["line 1", "\"radiosity\""]),
        ("format.json", t("{\"format\": \"etalon-solution/9\", \"bands\": [\"a\"], \"radiosity\": []}"), vec!["etalon-solution/9", "this version reads"]),
        ("no-format.json", t("{\"bands\": [\"a\"], \"radiosity\": []}"), vec!["line 1", "missing field `format`"]),
        ("no-values.json", t("{\"format\": \"etalon-solution/1\", \"bands\": [\"a\"]}"), vec!["missing field `radiosity`"]),
        ("no-bands.json", json("[]", "[[], []]", ""), vec!["names no band"]),
        ("short-row.json", json("[\"a\",\"b\"]", "[[1,1],[1]]", ""), vec!["\"radiosity\", patch 1", "has 1 values for 2 bands"]),
        ("error-row.json", json("[\"a\",\"b\"]", "[[1,1],[1,1]]", ", \"std_err\": [[0],[0,0]]"), vec!["\"std_err\", patch 0"]),
        ("error-rows.json", json("[\"a\",\"b\"]", "[[1,1],[1,1]]", ", \"std_err\": [[0,0]]"), vec!["\"std_err\"", "has 1 rows"]),
        ("null.json", json("[\"a\",\"b\"]", "[[1,null],[1,1]]", ""), vec!["line 3", "null"]),
        ("text.json", json("[\"a\",\"b\"]", "[[1,\"x\"],[1,1]]", ""), vec!["line 3", "string \"x\""]),
        ("too-few.json", json("[\"a\",\"b\"]", "[[1,1]]", ""), vec!["holds 1 patches", "the scene has 2"]),
        ("too-many.json", json("[\"a\",\"b\"]", "[[1,1],[1,1],[1,1]]", ""), vec!["holds 3 patches"]),
        ("foreign.json", json("[\"a\",\"b\"]", "[[1,1],[1,1]]", ", \"scene_hash\": \"00ff\""), vec!["another scene"]),
        ("empty.npy", t(""), vec!["array \"radiosity\"", "cut off"]),
        ("text.npy", t("1 2 3\n4 5 6\n"), vec!["array \"radiosity\""]),
        ("cut.npy", f8(two, &[1.0, 1.0, 1.0]), vec!["array \"radiosity\"", "cut off"]),
        ("vast.npy", f8("(4000000000000, 2)", &[1.0]), vec!["array \"radiosity\"", "more bytes than there are"]),
        ("overflowing.npy", f8("(4294967296, 4294967296, 4)", &[1.0]), vec!["more bytes than there are"]),
        ("cube.npy", f8("(1, 2, 2)", &[1.0; 4]), vec!["shape [1, 2, 2]", "N x bands"]),
        ("scalar.npy", f8("()", &[1.0]), vec!["shape []"]),
        ("too-few.npy", f8("(1, 2)", &[1.0; 2]), vec!["holds 1 patches"]),
        ("one-band.npy", f8("(2,)", &[1.0; 2]), vec!["bands 1 in number"]),
        ("nan.npy", f8(two, &[1.0, 1.0, f64::NAN, 1.0]), vec!["patch 1", "not a finite number"]),
        ("complex.npy", npy("<c16", two, &[0; 64]), vec!["type c16", "float64"]),
        ("objects.npy", npy("|O", two, &[0; 64]), vec!["array \"radiosity\""]),
        ("empty.npz", t(""), vec!["not a readable .npz", "numpy.savez"]),
        ("text.npz", t("hello"), vec!["not a readable .npz"]),
        ("cut.npz", npz(&[("radiosity", f8(two, &[1.0; 4]))])[..60].to_vec(), vec!["not a readable .npz", "cut off"]),
        ("no-array.npz", npz(&[("B", f8(two, &[1.0; 4]))]), vec!["no array \"radiosity\"", "radiosity=B"]),
        ("error-shape.npz", npz(&[("radiosity", f8(two, &[1.0; 4])), ("std_err", f8("(4,)", &[0.0; 4]))]), vec!["array \"std_err\"", "shape [4]"]),
        ("error-nan.npz", npz(&[("radiosity", f8(two, &[1.0; 4])), ("std_err", f8(two, &[f64::NAN; 4]))]), vec!["patch 0", "finite"]),
        ("picture.png", t("x"), vec!["ending", ".csv, .json, .npy or .npz"]),
        ("none", t("x"), vec!["ending", "reference directory"]),
    ]
}

#[test]
fn broken_solutions() {
    let place = workshop();
    let mut wrong = Vec::new();
    for (file, bytes, says) in solutions() {
        fs::write(place.path().join(file), bytes).expect("writable");
        let says: Vec<&str> = says.into_iter().chain([file]).collect();
        wrong.extend(refusal(place.path(), &format!("compare {file} --reference ref"), &says));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[rustfmt::skip]
fn matrices() -> Vec<(&'static str, Vec<u8>, Vec<&'static str>)> {
    let t = |s: &str| s.as_bytes().to_vec();
    let mtx = |rest: &str| format!("%%MatrixMarket matrix coordinate real general\n{rest}").into_bytes();
    let (shape, ptr, ind, data) = ([2, 2], [0, 1, 2], [1, 0], [0.2, 0.2]);
    vec![
        ("empty.csv", t(""), vec!["line 1", "i,j,form_factor"]),
        ("header.csv", t("row,col,value\n0,1,0.2\n"), vec!["line 1", "i,j,form_factor"]),
        ("word.csv", t("i,j,form_factor\n0,1,some\n"), vec!["line 2", "\"some\" is not a number"]),
        ("index.csv", t("i,j,form_factor\n0,1,0.2\nx,0,0.2\n"), vec!["line 3", "\"x\" is not a patch number"]),
        ("short.csv", t("i,j,form_factor\n0\n"), vec!["line 2", "not a number"]),
        ("outside.csv", t("i,j,form_factor\n0,2,0.2\n"), vec!["entry (0, 2)", "outside a 2 x 2", "from 0"]),
        ("negative.csv", t("i,j,form_factor\n0,1,-0.2\n"), vec!["entry (0, 1)", ">= 0"]),
        ("nan.csv", t("i,j,form_factor\n0,1,NaN\n"), vec!["entry (0, 1)", ">= 0"]),
        ("twice.csv", t("i,j,form_factor\n0,1,0.2\n0,1,0.2\n"), vec!["entry (0, 1)", "stands twice", "once"]),
        ("error-word.csv", t("i,j,form_factor,std_err\n0,1,0.2,low\n"), vec!["line 2", "\"low\" is not a number"]),
        ("error-negative.csv", t("i,j,form_factor,std_err\n0,1,0.2,-1\n"), vec!["entry (0, 1)", "below 0"]),
        ("latin1.csv", b"i,j,form_factor\n0,1,\xe9\n".to_vec(), vec!["line 2", "UTF-8"]),
        ("empty.mtx", t(""), vec!["line 1", "Matrix Market"]),
        ("dense.mtx", t("%%MatrixMarket matrix array real general\n2 2\n"), vec!["line 1", "Matrix Market"]),
        ("pattern.mtx", t("%%MatrixMarket matrix coordinate pattern general\n2 2 1\n1 2\n"), vec!["line 3", "three numbers"]),
        ("no-size.mtx", mtx("% nothing\n"), vec!["line 2", "size line"]),
        ("size.mtx", mtx("3 3 1\n1 2 0.2\n"), vec!["is 3 x 3", "2 patches", "--max-edge"]),
        ("size-nan.mtx", mtx("nan nan 1\n1 2 0.2\n"), vec!["NaN x NaN"]),
        ("cut.mtx", mtx("2 2 2\n1 2 0.2\n"), vec!["announces 2 entries but holds 1", "cut off"]),
        ("count.mtx", mtx("2 2 1e30\n1 2 0.2\n"), vec!["announces"]),
        ("from-zero.mtx", mtx("2 2 1\n0 1 0.2\n"), vec!["line 3", "count from 1"]),
        ("index-nan.mtx", mtx("2 2 1\nnan 1 0.2\n"), vec!["line 3", "no row and column"]),
        ("index-half.mtx", mtx("2 2 1\n1.5 1 0.2\n"), vec!["line 3", "no row and column"]),
        ("index-huge.mtx", mtx("2 2 1\n1e300 1 0.2\n"), vec!["outside a 2 x 2"]),
        ("word.mtx", mtx("2 2 1\n1 2 some 0.2\n"), vec!["line 3", "three numbers"]),
        ("latin1.mtx", [mtx("2 2 1\n"), b"1 2 \xe9\n".to_vec()].concat(), vec!["line 3", "not text"]),
        ("text.npz", t("hello"), vec!["not a readable .npz", "save_npz"]),
        ("no-shape.npz", npz(&[("data", f8("(1,)", &[1.0]))]), vec!["no array \"shape\"", "save_npz"]),
        ("shape.npz", csr(&[3, 3], &ptr, &ind, &data), vec!["is 3 x 3", "2 patches"]),
        ("shape-one.npz", csr(&[2], &ptr, &ind, &data), vec!["array \"shape\"", "two numbers"]),
        ("indptr-short.npz", csr(&shape, &[0, 2], &ind, &data), vec!["array \"indptr\"", "rising list of 3"]),
        ("indptr-falls.npz", csr(&shape, &[0, 2, 1], &ind, &data), vec!["array \"indptr\"", "rising"]),
        ("indptr-negative.npz", csr(&shape, &[-1, 1, 2], &ind, &data), vec!["array \"indptr\"", "from 0"]),
        ("indptr-end.npz", csr(&shape, &[0, 1, 9], &ind, &data), vec!["array \"indptr\"", "ends with 9"]),
        ("index-negative.npz", csr(&shape, &ptr, &[1, -1], &data), vec!["entry (1, -1)"]),
        ("index-outside.npz", csr(&shape, &ptr, &[1, 7], &data), vec!["entry (1, 7)", "outside"]),
        ("data-short.npz", csr(&shape, &ptr, &ind, &[0.2]), vec!["array \"data\"", "1 values for 2"]),
        ("data-nan.npz", csr(&shape, &ptr, &ind, &[0.2, f64::NAN]), vec!["entry (1, 0)", ">= 0"]),
        ("twice.npz", csr(&shape, &[0, 2, 2], &[1, 1], &data), vec!["entry (0, 1)", "twice"]),
        ("vast.npz", npz(&[("shape", npy("<i8", "(1000000000000,)", &[0; 16]))]), vec!["array \"shape\"", "more bytes"]),
        ("format.npz", npz(&[("shape", i4(&shape)), ("format", npy("|S3", "()", b"dia")), ("data", f8("(2,)", &data))]), vec!["format \"dia\"", ".tocsr()"]),
        ("matrix.txt", t("x"), vec!["ending", ".npz, .csv or .mtx"]),
    ]
}

#[test]
fn broken_matrices() {
    let place = workshop();
    let mut wrong = Vec::new();
    for (file, bytes, says) in matrices() {
        fs::write(place.path().join(file), bytes).expect("writable");
        let says: Vec<&str> = says.into_iter().chain([file]).collect();
        let command = format!("solve plates.toml --method gather --form-factors {file} -o out.csv");
        wrong.extend(refusal(place.path(), &command, &says));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Every file of a reference cut off at several lengths, changed in single bits, missing, swapped.
#[test]
fn broken_references() {
    let place = workshop();
    let here = place.path();
    let copy = here.join("broken");
    let mut wrong = Vec::new();
    let mut refuse = |name: &str, bytes: Option<&[u8]>, says: &[&str]| {
        let _ = fs::remove_dir_all(&copy);
        fs::create_dir(&copy).expect("a folder");
        for entry in fs::read_dir(here.join("ref")).expect("a folder") {
            let path = entry.expect("an entry").path();
            fs::copy(&path, copy.join(path.file_name().expect("a name"))).expect("copied");
        }
        match bytes {
            Some(bytes) => fs::write(copy.join(name), bytes).expect("writable"),
            None => fs::remove_file(copy.join(name)).expect("removable"),
        }
        let command = "check good.csv --reference broken --max-rms 5%";
        wrong.extend(refusal(here, command, &[&["broken"], says].concat()).into_iter().map(|w| format!("{name}: {w}")));
    };
    for name in ["reference.json", "scene.json", "replicates.npz", "reference.csv"] {
        let sound = fs::read(here.join("ref").join(name)).expect("readable");
        let damaged: &[&str] = &[&format!("broken/{name}"), "damaged", "compute it again"];
        for share in [0, 1, 5, 9] {
            refuse(name, Some(&sound[..sound.len() * share / 10]), damaged);
        }
        refuse(name, Some(&sound[..sound.len() - 1]), damaged);
        refuse(name, Some(&[&sound[..], b"\n"].concat()), damaged);
        for share in [1, 3, 5, 7, 9] {
            let mut changed = sound.clone();
            changed[sound.len() * share / 10] ^= 1 << (share % 8);
            // A manifest that accuses another file of its own fault is as good.
            let accused: &[&str] = if name == "reference.json" { &["broken/", "damaged"] } else { damaged };
            refuse(name, Some(&changed), accused);
        }
        let other = fs::read(here.join("other").join(name)).expect("readable");
        if other != sound {
            refuse(name, Some(&other), &["broken/", "damaged"]);
        }
        if name != "reference.json" {
            refuse(name, None, &[&format!("broken/{name}"), "is missing", "damaged"]);
        }
    }
    refuse("reference.json", None, &["not a reference directory", "etalon reference"]);
    let manifest = fs::read_to_string(here.join("ref/reference.json")).expect("readable");
    let newer = manifest.replace("etalon-reference/1", "etalon-reference/2");
    refuse("reference.json", Some(newer.as_bytes()), &["etalon-reference/2", "update etalon"]);
    // A failed self-check cannot be talked away.
    let talked = manifest.replace("\"passed\": true", "\"passed\": false");
    refuse("reference.json", Some(talked.as_bytes()), &["checksum", "damaged"]);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The clock's file takes no part: it may be changed or left out.
#[test]
fn a_reference_without_its_clock_is_sound() {
    let place = workshop();
    fs::remove_file(place.path().join("ref/timing.json")).expect("removable");
    assert_eq!(etalon(place.path(), "compare good.csv --reference ref").status.code(), Some(0));
}

#[rustfmt::skip]
const COMMAND_LINES: &[(&str, &[&str])] = &[
    ("compare nowhere.csv --reference ref", &["nowhere.csv", "no such file"]),
    ("compare good.csv --reference nowhere.csv", &["nowhere.csv", "no such file"]),
    ("compare good.csv --reference nowhere", &["nowhere", "ending"]),
    ("compare good.csv --reference .", &["not a reference directory"]),
    ("compare good.csv --reference gaps.csv", &["gaps.csv", "patch 1", "is missing"]),
    ("compare gaps.csv --reference gaps.csv", &["gaps.csv", "patch 1", "is missing"]),
    ("compare good.csv --reference ref --confidence 0", &["--confidence"]),
    ("compare good.csv --reference ref --confidence 100%", &["--confidence"]),
    ("compare good.csv --reference ref --confidence nan", &["--confidence", "fraction"]),
    ("compare good.csv --reference ref --per face", &["--per", "face"]),
    ("compare good.csv --reference ref --scene nowhere.toml", &["nowhere.toml"]),
    ("compare good.csv --reference ref --report good.csv", &["good.csv", "not a folder"]),
    ("compare good.csv --reference ref --report good.csv/page", &["good.csv", "not a folder"]),
    ("compare good.csv --reference ref --markdown ref", &["ref", "folder"]),
    ("compare good.csv --reference ref --markdown no/where.md", &["no/where.md", "no folder"]),
    ("check good.csv --reference ref --max-rms -1%", &["--max-rms"]),
    ("check good.csv --reference ref --max-rms 5% --junit no/where.xml", &["no/where.xml", "no folder"]),
    ("check good.csv --reference ref --max-rms 5% --on-inconclusive perhaps", &["perhaps"]),
    ("reference plates.toml -o out --rays 0", &["--rays", "0"]),
    ("reference plates.toml -o out --rays -5", &["--rays", "-5"]),
    ("reference plates.toml -o out --rays many", &["--rays", "many"]),
    ("reference plates.toml -o out --rays 18446744073709551615", &["rays", "fewer --rays"]),
    ("reference plates.toml -o out --rays 99999999999999999999", &["--rays"]),
    ("reference plates.toml -o out --randomisations 7", &["--randomisations", "8"]),
    ("reference plates.toml -o out --randomisations 5000", &["--randomisations", "4095"]),
    ("reference plates.toml -o out --target-error 0%", &["--target-error", "above 0"]),
    ("reference plates.toml -o out --target-error x", &["--target-error", "fraction"]),
    ("reference plates.toml -o out --target-error 1% --rays 64", &["--rays", "--target-error"]),
    ("reference plates.toml -o out --max-time 0s", &["--max-time", "span"]),
    ("reference plates.toml -o out --max-time soon", &["--max-time", "span"]),
    ("reference plates.toml -o out --seed -1", &["--seed", "-1"]),
    ("reference plates.toml -o out --threads 0", &["--threads"]),
    ("reference plates.toml -o out --kernel magic", &["--kernel", "magic"]),
    ("reference plates.toml -o out --state 1", &["1", "state"]),
    ("reference plates.toml -o out --state last", &["--state", "last"]),
    ("reference plates.toml -o out --max-edge 0", &["--max-edge"]),
    ("reference plates.toml -o out --max-edge nan", &["--max-edge"]),
    ("reference plates.toml -o good.csv", &["good.csv", "choose another place"]),
    ("reference plates.toml -o good.csv/ref", &["good.csv/ref", "choose another place"]),
    ("reference plates.toml -o .", &["holds something else"]),
    ("reference plates.toml -o ..", &["holds something else"]),
    ("reference plates.toml -o notes", &["notes", "holds something else", "nothing was changed"]),
    ("reference plates.toml -o taken", &["taken.part", "holds something else", "nothing was changed"]),
    ("reference plates.toml -o /proc/nowhere/ref", &["/proc/nowhere/ref", "choose another place"]),
    ("reference plates.toml", &["--output"]),
    ("form-factors plates.toml -o f.png", &["f.png", "ending"]),
    ("form-factors plates.toml -o no/f.npz", &["no/f.npz", "no folder"]),
    ("form-factors plates.toml -o f.npz --std-err e.png", &["e.png", "ending"]),
    ("form-factors plates.toml -o /proc/f.npz", &["/proc/f.npz"]),
    ("solve plates.toml --method gather -o good.csv/s.csv", &["good.csv/s.csv", "not a folder"]),
    ("solve plates.toml --method gather:rays=18446744073709551615 -o s.csv", &["rays"]),
    ("solve plates.toml --method gather:rays=-1 -o s.csv", &["rays", "-1"]),
    ("solve plates.toml --method gather:speed=9 -o s.csv", &["speed"]),
    ("solve plates.toml --method gather:rays -o s.csv", &["rays"]),
    ("solve plates.toml --method hemicube:resolution=0 -o s.csv", &["resolution"]),
    ("solve plates.toml --method hemicube:resolution=999999999 -o s.csv", &["resolution"]),
    ("solve plates.toml --method  -o s.csv", &["--method"]),
    ("solve plates.toml --method gather -o ref", &["ref", "ending"]),
    ("scene patches plates.toml -o no/p.csv", &["no/p.csv", "no folder"]),
    ("scene check nowhere.toml", &["nowhere.toml"]),
    ("report nowhere", &["record.json", "check --report"]),
    ("report page", &["page/record.json", "missing field"]),
];

#[test]
fn broken_command_lines() {
    let place = workshop();
    let here = place.path();
    fs::write(here.join("gaps.csv"), "patch,a,b\n0,1,1\n99999999999,1,1\n").expect("writable");
    for folder in ["notes", "page", "taken.part"] {
        fs::create_dir(here.join(folder)).expect("a folder");
    }
    fs::write(here.join("notes/thesis.tex"), "x").expect("writable");
    fs::write(here.join("taken.part/thesis.tex"), "x").expect("writable");
    fs::write(here.join("page/record.json"), "{\"format\": \"etalon-record/1\"}").expect("writable");
    let wrong: Vec<String> = COMMAND_LINES.iter().flat_map(|(line, says)| refusal(here, line, says)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn there_are_many_of_them_and_none_twice() {
    let mut names: Vec<String> = Vec::new();
    names.extend(solutions().iter().map(|s| format!("solution {}", s.0)));
    names.extend(matrices().iter().map(|s| format!("matrix {}", s.0)));
    names.extend(COMMAND_LINES.iter().map(|s| s.0.to_string()));
    let count = names.len();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), count);
    assert!(count >= 160, "{count}");
}
