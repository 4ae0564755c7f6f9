//! The program as a script sees it: exit codes, messages, same bytes, quiet pipes.

#[path = "common/program.rs"]
mod program;

use program::{etalon, json, ok, run};
use serde_json::Value;

/// A small closed scene with a small reference in `ref` and its exact candidate in `good.csv`.
fn workshop() -> tempfile::TempDir {
    let place = tempfile::tempdir().expect("a folder");
    ok(place.path(), "reference builtin:furnace -o ref --rays 2048");
    ok(place.path(), "solve builtin:furnace --method gather:rays=2048 -o good.csv");
    place
}

#[test]
fn every_method_gives_values_of_elements() {
    let place = tempfile::tempdir().expect("a folder");
    for method in ["gather:rays=64,estimator=rays", "hemicube:resolution=10", "progressive:rays=64,unshot=10%"] {
        ok(place.path(), &format!("solve builtin:cube-room --method {method} --per element -o e.csv --quiet"));
        let rows = std::fs::read_to_string(place.path().join("e.csv")).expect("written").lines().count() - 1;
        assert_eq!(rows, 1750, "{method}");
    }
}

#[test]
fn the_three_verdicts_and_their_codes() {
    let place = workshop();
    let here = place.path();
    // The furnace has no noise: B = 2 everywhere.
    let good = std::fs::read_to_string(here.join("good.csv")).expect("written");
    let patches = good.lines().skip(1).map(|line| line.split(',').next().expect("a patch"));
    let rows: String = patches.map(|p| format!("{p},2.1\n")).collect();
    let bright = format!("patch,y\n{rows}");
    std::fs::write(here.join("bright.csv"), bright).expect("writable");
    assert_eq!(run(here, "check good.csv --reference ref --max-rms 1%").0, 0);
    let (code, out, _) = run(here, "check bright.csv --reference ref --max-rms 1%");
    assert_eq!(code, 1, "{out}");
    let v = json(here, "compare bright.csv --reference ref");
    assert!((v["rms"]["value"].as_f64().expect("a number") - 0.05).abs() < 1e-9, "{v}");
    assert!((v["bias"]["value"].as_f64().expect("a number") - 0.05).abs() < 1e-9, "{v}");
    // Few rays against a tight limit on a scene with noise.
    ok(here, "reference builtin:cube-one-emitter -o noisy --rays 256 --estimator rays");
    ok(here, "solve builtin:cube-one-emitter --method gather:rays=65536 -o cube.csv");
    let tight = "check cube.csv --reference noisy --max-rms 0.1%";
    let (code, out, err) = run(here, tight);
    assert_eq!(code, 3, "{out}{err}");
    assert!(out.contains("rays"), "says how many more rays: {out}");
    assert_eq!(run(here, &format!("{tight} --on-inconclusive pass")).0, 0);
    assert_eq!(run(here, &format!("{tight} --on-inconclusive fail")).0, 1);
}

/// A file without the one block of a page that the clock writes.
fn without_clock(bytes: Vec<u8>) -> Vec<u8> {
    let at = |mark: &[u8]| bytes.windows(mark.len()).position(|w| w == mark);
    match (at(b"<!-- wall-clock: begin"), at(b"<!-- wall-clock: end")) {
        (Some(from), Some(to)) => [&bytes[..from], &bytes[to..]].concat(),
        _ => bytes,
    }
}

#[test]
fn same_bytes_on_any_number_of_threads() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    let files = |folder: &str| -> Vec<(String, Vec<u8>)> {
        let mut list: Vec<_> = std::fs::read_dir(here.join(folder))
            .expect("a folder")
            .map(|e| e.expect("an entry").path())
            .filter(|p| p.file_name().is_some_and(|n| n != "timing.json"))
            .map(|p| {
                let name = p.file_name().expect("a name").to_string_lossy().to_string();
                (name, without_clock(std::fs::read(&p).expect("readable")))
            })
            .collect();
        list.sort();
        list
    };
    for t in [1, 2] {
        let run = |args: &str| ok(here, &format!("{args} --threads {t}"));
        run(&format!("reference builtin:cornell-box-coarse -o ref{t} --rays 4096"));
        for (name, ending) in [("f", "npz"), ("f", "csv"), ("f", "mtx")] {
            run(&format!("form-factors builtin:cornell-box-coarse -o {name}{t}.{ending} --rays 1024"));
        }
        run(&format!("solve builtin:cornell-box-coarse --method hemicube:resolution=50 -o h{t}.csv"));
        run(&format!("solve builtin:cornell-box-coarse --method gather:rays=1024 -o g{t}.csv"));
        run(&format!(
            "check h1.csv --reference ref1 --max-rms 50% --on-inconclusive pass --report page --markdown m.md --junit j{t}.xml"
        ));
        // The text names its picture, and the report its page: written under one name, kept under two.
        for (from, to) in [("page", format!("page{t}")), ("m.md", format!("m{t}.md")), ("m.png", format!("m{t}.png"))] {
            std::fs::rename(here.join(from), here.join(to)).expect("renamed");
        }
    }
    assert_eq!(files("ref1"), files("ref2"));
    assert_eq!(files("page1"), files("page2"));
    for pair in [
        ("f1.npz", "f2.npz"),
        ("f1.csv", "f2.csv"),
        ("f1.mtx", "f2.mtx"),
        ("h1.csv", "h2.csv"),
        ("g1.csv", "g2.csv"),
        ("m1.md", "m2.md"),
        ("m1.png", "m2.png"),
        ("j1.xml", "j2.xml"),
    ] {
        let read = |n: &str| std::fs::read(here.join(n)).expect("readable");
        assert!(read(pair.0) == read(pair.1), "{pair:?} differ");
    }
}

#[test]
fn bad_usage_and_bad_input_end_with_two_and_one_message() {
    let place = workshop();
    let here = place.path();
    std::fs::write(here.join("short.csv"), "patch,y\n0,1\n").expect("writable");
    std::fs::write(here.join("notes.txt"), "hello").expect("writable");
    std::fs::create_dir(here.join("empty")).expect("a folder");
    for (arguments, expected) in [
        ("check good.csv --reference ref", "at least one limit"),
        ("check good.csv --reference ref --max-top1 5%", "--before"),
        ("check good.csv --reference ref --max-rms five", "not a fraction"),
        ("check short.csv --reference ref --max-rms 5%", "patch 1"),
        ("check good.csv --reference empty --max-rms 5%", "not a reference directory"),
        ("check good.csv --reference ref --max-rms 5% --scene builtin:cornell-box", "does not belong"),
        ("compare notes.txt --reference ref", "ending"),
        ("compare missing.csv --reference ref", "missing.csv"),
        ("compare good.csv --reference ref --confidence 1.5", "--confidence"),
        ("compare good.csv --reference ref --truth continuous", "patch-system"),
        ("reference builtin:nowhere -o x", "nowhere"),
        ("reference builtin:furnace -o x --randomisations 4", "8"),
        ("reference builtin:furnace -o x --target-error 0", "above 0"),
        ("reference builtin:furnace -o x --state 7", "7"),
        ("reference builtin:furnace -o notes.txt", "notes.txt"),
        ("form-factors builtin:furnace -o f.xls", "ending"),
        ("form-factors builtin:furnace -o nowhere/f.csv", "nowhere"),
        ("solve builtin:furnace --method magic -o s.csv", "magic"),
        ("solve builtin:furnace --method hemicube:resolution=7 -o s.csv", "resolution"),
        ("solve builtin:furnace --method gather:rays=0 -o s.csv", "rays"),
        ("solve builtin:furnace --method hemicube --rays 8 -o s.csv", "resolution"),
        ("solve builtin:furnace --method gather --form-factors notes.txt -o s.csv", "ending"),
        ("scene patches builtin:furnace -o p.doc", "ending"),
        ("scene patches builtin:furnace --max-edge -1 -o p.csv", "max-edge"),
        ("report empty", "record.json"),
        ("frobnicate", "frobnicate"),
    ] {
        let (code, out, err) = run(here, arguments);
        assert_eq!(code, 2, "{arguments}: {out}{err}");
        assert!(out.is_empty(), "{arguments} printed on stdout: {out}");
        assert!(err.contains(expected), "{arguments}: expected \"{expected}\" in: {err}");
        assert!(!err.contains("panicked"), "{arguments}: {err}");
        let (code, out, err) = run(here, &format!("{arguments} --json"));
        let v: Value = serde_json::from_str(&out).unwrap_or_else(|e| panic!("{arguments}: {e}: {out}"));
        assert_eq!((code, v["error"]["code"].as_str()), (2, Some("bad-input")), "{arguments}: {out}");
        assert!(v["error"]["message"].as_str().is_some_and(|m| m.contains(expected)), "{arguments}: {out}");
        assert!(err.is_empty(), "{arguments} --json printed on stderr: {err}");
    }
    assert!(!here.join("x").exists() && !here.join("s.csv").exists(), "something was written");
}

#[test]
fn a_tampered_reference_is_refused() {
    let place = workshop();
    let here = place.path();
    for name in ["scene.json", "replicates.npz", "reference.csv", "reference.json"] {
        let path = here.join("ref").join(name);
        let sound = std::fs::read(&path).expect("readable");
        for (how, bytes) in
            [("cut off", sound[..sound.len() / 2].to_vec()), ("changed", changed(&sound)), ("emptied", Vec::new())]
        {
            std::fs::write(&path, bytes).expect("writable");
            let (code, out, err) = run(here, "check good.csv --reference ref --max-rms 5%");
            assert_eq!(code, 2, "{name} {how}: {out}{err}");
            // A changed manifest accuses the file it now describes wrongly.
            assert!(err.contains("ref/") && err.contains("damaged"), "{name} {how}: {err}");
        }
        std::fs::remove_file(&path).expect("removable");
        assert_eq!(run(here, "check good.csv --reference ref --max-rms 5%").0, 2, "{name} removed");
        std::fs::write(&path, sound).expect("writable");
    }
    let manifest = here.join("ref/reference.json");
    let text =
        std::fs::read_to_string(&manifest).expect("readable").replace("etalon-reference/1", "etalon-reference/2");
    std::fs::write(&manifest, text).expect("writable");
    let (code, _, err) = run(here, "check good.csv --reference ref --max-rms 5%");
    assert!(code == 2 && err.contains("etalon-reference/2"), "{err}");
}

/// One digit of a number made another one, length kept.
fn changed(bytes: &[u8]) -> Vec<u8> {
    let mut out = bytes.to_vec();
    let at = out.iter().rposition(u8::is_ascii_digit).expect("a digit somewhere");
    out[at] = if out[at] == b'9' { b'8' } else { out[at] + 1 };
    out
}

/// A wall wound backwards in a scene that says it is closed: the judge refuses its own work.
#[test]
fn a_leaking_enclosure_fails_its_self_check() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    let wall = |name: &str, p: &str| {
        format!("[[surface]]\nname = \"{name}\"\nmaterial = \"white\"\npolygon = {p}\npatches = [2, 2]\n")
    };
    let mut scene = String::from(
        "format = \"etalon-scene/1\"\nname = \"leaky\"\nenclosure = true\n[photometry]\nprimaries = \"mono\"\nbands = [\"y\"]\n[[material]]\nname = \"white\"\nreflectance = 0.5\nemission = 1.0\n",
    );
    for (name, p) in [
        ("floor", "[[0,0,0],[1,0,0],[1,1,0],[0,1,0]]"),
        ("ceiling", "[[0,0,1],[0,1,1],[1,1,1],[1,0,1]]"),
        ("west", "[[0,0,0],[0,1,0],[0,1,1],[0,0,1]]"),
        ("east", "[[1,0,0],[1,1,0],[1,1,1],[1,0,1]]"), // backwards
        ("south", "[[0,0,0],[0,0,1],[1,0,1],[1,0,0]]"),
        ("north", "[[0,1,0],[1,1,0],[1,1,1],[0,1,1]]"),
    ] {
        scene += &wall(name, p);
    }
    std::fs::write(here.join("leaky.toml"), scene).expect("writable");
    let (code, out, err) = run(here, "reference leaky.toml -o ref --rays 1024");
    assert_eq!(code, 4, "{out}{err}");
    assert!(err.contains("leaks"), "{err}");
    assert!(here.join("ref/reference.json").is_file(), "the directory is kept");
    ok(here, "solve leaky.toml --method gather:rays=256 -o s.csv");
    let (code, _, err) = run(here, "check s.csv --reference ref --max-rms 5%");
    assert!(code == 2 && err.contains("self-check"), "{code} {err}");
    let (code, ..) = run(here, "compare s.csv --reference ref");
    assert_eq!(code, 0, "a comparison is still possible");
}

#[test]
fn states_before_and_after_a_change() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "reference builtin:dynamic-cube --state 1 -o after --rays 4096");
    ok(here, "reference builtin:dynamic-cube --state initial -o before --rays 4096");
    ok(here, "solve builtin:dynamic-cube --state 1 --method gather:rays=65536 -o s.csv");
    let v = json(here, "compare s.csv --reference after --before before");
    assert!(v["top1"]["value"].is_number(), "{v}");
    assert!(v["rms"]["low"].as_f64() <= v["rms"]["value"].as_f64(), "{v}");
    // Elements, where the scene has them.
    ok(here, "solve builtin:dynamic-cube --state 1 --method hemicube:resolution=64 --per element -o e.csv");
    let v = json(here, "compare e.csv --reference after --per element");
    assert!(v["rms"]["value"].as_f64().is_some_and(|x| x < 0.5), "{v}");
}

#[test]
fn two_solutions_without_rays() {
    let place = workshop();
    let here = place.path();
    ok(here, "solve builtin:furnace --method hemicube:resolution=50 -o h.json");
    let v = json(here, "compare h.json --reference good.csv --scene builtin:furnace");
    let rms = &v["rms"];
    assert!(rms["std_err"].is_null() && rms["low"] == rms["value"] && v["reference_noise_floor"].is_null(), "{v}");
    assert!(json(here, "compare h.json --reference good.csv")["rms"]["value"].is_number());
}

#[test]
fn stored_form_factors_are_used_again() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "form-factors builtin:cornell-box-coarse -o f.npz --std-err e.npz --rays 1024");
    ok(here, "form-factors builtin:cornell-box-coarse -o f.mtx --rays 1024");
    ok(here, "form-factors builtin:cornell-box-coarse -o f.csv --rays 1024");
    for f in ["npz", "mtx", "csv"] {
        ok(here, &format!("solve builtin:cornell-box-coarse --method gather --form-factors f.{f} -o {f}.npy"));
    }
    let read = |n: &str| std::fs::read(here.join(n)).expect("readable");
    assert!(read("npz.npy") == read("mtx.npy") && read("npz.npy") == read("csv.npy"));
}

#[test]
fn doctor_and_help_always_work() {
    let place = tempfile::tempdir().expect("a folder");
    ok(place.path(), "--help");
    ok(place.path(), "--version");
    json(place.path(), "doctor");
    let none = etalon(place.path()).env("ETALON_EMBREE", "none").arg("doctor").output().expect("it runs");
    assert_eq!(none.status.code(), Some(0));
    assert!(String::from_utf8_lossy(&none.stdout).contains("builtin"));
}
