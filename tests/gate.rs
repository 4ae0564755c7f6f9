//! `etalon check` as a gate: limits on places, baselines, looks until decided, bisection, keys, schema, one line for a log.

#[path = "common/program.rs"]
mod program;

use program::{etalon, json, ok, refused, run};
use serde_json::Value;
use std::path::Path;

/// A scene with occlusion, its reference, and three solutions: two hemi-cubes and one with a surface wrong.
fn workshop() -> tempfile::TempDir {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "reference builtin:cornell-box-coarse -o ref --rays 4096");
    ok(here, "solve builtin:cornell-box-coarse --method hemicube:resolution=50 -o coarse.csv");
    ok(here, "solve builtin:cornell-box-coarse --method hemicube:resolution=400 -o fine.csv");
    place
}

fn outcome<'a>(v: &'a Value, metric: &str) -> &'a Value {
    let limits = v["limits"].as_array().expect("limits");
    limits.iter().find(|l| l["metric"] == metric).unwrap_or_else(|| panic!("{metric}: {v}"))
}

/// What `--json` printed, whatever the exit code.
fn told(here: &Path, arguments: &str) -> (i32, Value) {
    let (code, out, err) = run(here, &format!("{arguments} --json"));
    (code, serde_json::from_str(&out).unwrap_or_else(|e| panic!("{e}: {out}{err}")))
}

/// The solution file with the values of one surface times a factor, by hand.
fn with_surface_times(here: &Path, from: &str, to: &str, surface: &str, factor: f64) {
    ok(here, "scene patches builtin:cornell-box-coarse -o patches.csv");
    let patches = std::fs::read_to_string(here.join("patches.csv")).expect("written");
    let own: Vec<&str> = patches
        .lines()
        .filter(|l| l.split(',').nth(1) == Some(surface))
        .map(|l| l.split(',').next().expect("a number"))
        .collect();
    assert!(!own.is_empty(), "{surface}");
    let text = std::fs::read_to_string(here.join(from)).expect("written");
    let line = |l: &str| {
        let mut cells: Vec<String> = l.split(',').map(String::from).collect();
        if own.contains(&cells[0].as_str()) {
            cells[1..].iter_mut().for_each(|c| *c = format!("{}", factor * c.parse::<f64>().expect("a number")));
        }
        cells.join(",") + "\n"
    };
    std::fs::write(here.join(to), text.lines().map(line).collect::<String>()).expect("writable");
}

#[test]
fn limits_on_places_name_the_place_that_fails() {
    let place = workshop();
    let here = place.path();
    with_surface_times(here, "fine.csv", "floor.csv", "floor", 1.3);
    let limits = "--reference ref --reflected --limit rms@surface:floor=20% --limit energy@surface:floor=10% \
                  --limit rms@surface:back-wall=20% --limit rms@band:r=40% --max-energy 50%";
    let (code, v) = told(here, &format!("check floor.csv {limits}"));
    assert_eq!((code, v["verdict"].as_str()), (1, Some("fail")), "{v}");
    assert_eq!(outcome(&v, "rms@surface:floor")["verdict"], "fail");
    assert_eq!(outcome(&v, "energy@surface:floor")["verdict"], "fail");
    for kept in ["rms@surface:back-wall", "rms@band:r", "energy"] {
        assert_eq!(outcome(&v, kept)["verdict"], "pass", "{kept}");
    }
    // The floor is 30 % too bright, and so says its energy.
    let energy = outcome(&v, "energy@surface:floor")["estimate"]["value"].as_f64().expect("a number");
    assert!((energy - 0.3).abs() < 0.05, "{energy}");
    // Five limits share the risk.
    assert!((v["confidence"].as_f64().expect("a number") - 0.99).abs() < 1e-12, "{v}");
    let text = run(here, &format!("check floor.csv {limits}")).1;
    assert!(text.contains("on surface \"floor\"") && text.contains("beyond the limit of 20 %"), "{text}");
    let what = refused(here, "check fine.csv --reference ref --limit rms@surface:flor=1%");
    assert!(what.contains("no surface \"flor\"") && what.contains("floor"), "{what}");
    assert!(refused(here, "check fine.csv --reference ref --limit rms@floor=1%").contains("METRIC@WHERE=X"));
    assert!(refused(here, "check fine.csv --reference ref --max-rms 1% --limit rms=2%").contains("twice"));
}

#[test]
fn the_worst_patch_is_found_where_eq_7_sees_nothing() {
    let place = workshop();
    let here = place.path();
    // The reference itself, with one patch 5 % off.
    let means = std::fs::read_to_string(here.join("ref/reference.csv")).expect("written");
    let line = |l: &str| {
        let cells: Vec<&str> = l.split(',').take(4).collect();
        let off = if cells[0] == "44" { 1.05 } else { 1.0 };
        let value = |c: &&str| c.parse::<f64>().map_or(c.to_string(), |x| format!("{}", off * x));
        let cells: Vec<String> = std::iter::once(cells[0].to_string()).chain(cells[1..].iter().map(value)).collect();
        cells.join(",") + "\n"
    };
    std::fs::write(here.join("one.csv"), means.lines().map(line).collect::<String>()).expect("writable");
    let (code, v) = told(here, "check one.csv --reference ref --max-rms 1% --max-worst 3%");
    assert_eq!(code, 1, "{v}");
    assert_eq!((&outcome(&v, "rms")["verdict"], &outcome(&v, "worst")["verdict"]), (&"pass".into(), &"fail".into()));
    let worst = outcome(&v, "worst");
    assert!((worst["estimate"]["value"].as_f64().expect("a number") - 0.05).abs() < 1e-3, "{worst}");
    // What passed says what it would have caught: not much above its limit, with so little noise.
    let caught = outcome(&v, "rms")["smallest_caught"].as_f64().expect("known");
    assert!(caught > 0.01 && caught < 0.012, "{caught}");
}

#[test]
fn a_baseline_is_saved_held_against_and_replaced() {
    let place = workshop();
    let here = place.path();
    // Missing: an error, and nothing is made.
    let what = refused(here, "check fine.csv --reference ref --baseline main.json");
    assert!(what.contains("main.json") && what.contains("etalon baseline save"), "{what}");
    assert!(!here.join("main.json").exists());
    let v = json(here, "baseline save fine.csv --reference ref --reflected -o main.json");
    assert!(
        v["suggested_limits"]["rms"].as_f64().expect("a number") > v["metrics"]["rms"]["high"].as_f64().expect("one")
    );
    assert!(refused(here, "baseline save coarse.csv --reference ref --reflected -o main.json").contains("update"));
    let bytes = std::fs::read(here.join("main.json")).expect("written");
    // The same again is no worse; the coarse one is, for sure.
    let gate = "--reference ref --reflected --baseline main.json";
    assert_eq!(run(here, &format!("check fine.csv {gate}")).0, 0);
    let (code, v) = told(here, &format!("check coarse.csv {gate}"));
    assert_eq!((code, outcome(&v, "worse")["verdict"].as_str()), (1, Some("fail")), "{v}");
    // With a margin that it keeps.
    assert_eq!(run(here, &format!("check coarse.csv {gate} --max-worse 50%")).0, 0);
    assert_eq!(std::fs::read(here.join("main.json")).expect("there"), bytes);
    // Diff leaves it alone, update replaces it; both in standard errors.
    for (command, changed) in [("diff", false), ("update", true)] {
        let v = json(here, &format!("baseline {command} main.json coarse.csv --reference ref --reflected"));
        let rms = &v["changes"][0];
        assert_eq!((rms["metric"].as_str(), v["updated"].as_bool()), (Some("rms"), Some(changed)));
        assert!(rms["sigmas"].as_f64().expect("known") > 5.0, "{rms}");
        assert_eq!(std::fs::read(here.join("main.json")).expect("there") != bytes, changed);
    }
    assert_eq!(run(here, &format!("check coarse.csv {gate}")).0, 0);
    // Other light, another scene, a changed file.
    assert!(refused(here, "check coarse.csv --reference ref --baseline main.json").contains("reflected"));
    ok(here, "reference builtin:furnace -o other --rays 256");
    ok(here, "solve builtin:furnace --method gather:rays=256 -o furnace.csv");
    let what = refused(here, "check furnace.csv --reference other --reflected --baseline main.json");
    assert!(what.contains("cornell-box-coarse"), "{what}");
    let text = String::from_utf8(std::fs::read(here.join("main.json")).expect("there")).expect("text");
    std::fs::write(here.join("main.json"), text.replacen("0.", "0.1", 1)).expect("writable");
    assert!(refused(here, &format!("check coarse.csv {gate}")).contains("by hand"));
}

#[test]
fn looks_go_on_until_it_is_decided() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    let reference = "reference builtin:cube-one-emitter --estimator rays --rays 256";
    ok(here, &format!("{reference} -o noisy"));
    ok(here, "solve builtin:cube-one-emitter --method gather:rays=65536 -o cube.csv");
    let gate = "check cube.csv --reference noisy --max-rms 0.5%";
    assert_eq!(run(here, gate).0, 3);
    let (code, v) = told(here, &format!("{gate} --until-decided --max-time 60s --save-reference better"));
    assert_eq!((code, v["verdict"].as_str()), (0, Some("pass")), "{v}");
    let looks = v["looks"].as_array().expect("looks");
    assert!(looks.len() > 1 && looks[0]["verdict"] == "inconclusive", "{v}");
    assert!((looks[0]["confidence"].as_f64().expect("a number") - 0.975).abs() < 1e-12);
    // The last reference is kept, and decides at once.
    assert_eq!(run(here, "check cube.csv --reference better --max-rms 0.5%").0, 0);
    // The stored one is as it was.
    assert!(json(here, &format!("{reference} -o noisy"))["already_there"].as_bool().expect("told"));
    // No time: what is known is said.
    let (code, v) = told(here, "check cube.csv --reference noisy --max-rms 0.05% --until-decided --max-time 1ms");
    assert_eq!((code, v["verdict"].as_str()), (3, Some("inconclusive")), "{v}");
    assert!(
        refused(here, "check cube.csv --reference cube.csv --max-rms 1% --until-decided").contains("--until-decided")
    );
}

#[test]
fn bisection_marks_commits_good_bad_and_skipped() {
    let place = workshop();
    let here = place.path();
    let code = |arguments: &str| run(here, &format!("bisect {arguments}")).0;
    assert_eq!(code("fine.csv --reference ref --max-rms 5%"), 0);
    assert_eq!(code("coarse.csv --reference ref --max-rms 0.1%"), 1);
    // A commit that did not build leaves no solution, a broken one half of it: skipped.
    assert_eq!(code("missing.csv --reference ref --max-rms 5%"), 125);
    std::fs::write(here.join("half.csv"), "patch,r,g,b\n0,1,1,1\n").expect("writable");
    assert_eq!(code("half.csv --reference ref --max-rms 5%"), 125);
    // What is wrong at every commit ends the bisection.
    assert_eq!(code("fine.csv --reference nowhere --max-rms 5%"), 128);
    assert_eq!(code("fine.csv --reference ref"), 128);
}

#[test]
fn a_log_gets_one_line() {
    let place = workshop();
    let (code, out, err) = run(place.path(), "check fine.csv --reference ref --max-rms 5% --quiet");
    assert_eq!((code, out.lines().count(), err.as_str()), (0, 1, ""), "{out}");
    assert!(out.starts_with("PASS fine.csv passes: ") && out.contains("limit of 5 %"), "{out}");
}

#[test]
fn a_comment_has_its_picture_beside_it() {
    let place = workshop();
    let here = place.path();
    run(here, "check coarse.csv --reference ref --max-rms 0.1% --markdown out.md");
    let text = std::fs::read_to_string(here.join("out.md")).expect("written");
    assert!(text.contains("](out.png)") && text.contains("\u{2503}"), "{text}");
    let picture = image::open(here.join("out.png")).expect("a picture");
    assert!(picture.width() > 400 && picture.width() < 900, "{}", picture.width());
}

#[test]
fn the_key_of_a_reference_changes_with_what_makes_it() {
    let place = tempfile::tempdir().expect("a folder");
    let key = |arguments: &str| ok(place.path(), &format!("reference {arguments} --print-key --kernel builtin"));
    let one = key("builtin:furnace");
    assert!(one.starts_with("etalon-reference-") && one.trim().len() == 17 + 32, "{one}");
    assert_eq!(one, key("builtin:furnace --max-time 5m --threads 1"));
    for other in [
        "builtin:furnace-l",
        "builtin:furnace --rays 65536",
        "builtin:furnace --seed 1",
        "builtin:furnace --estimator rays",
        "builtin:furnace --truth continuous",
        "builtin:furnace --target-error 1%",
    ] {
        assert_ne!(one, key(other), "{other}");
    }
    assert!(std::fs::read_dir(place.path()).expect("a folder").next().is_none());
}

#[test]
fn what_is_printed_keeps_the_published_schema() {
    let place = workshop();
    let here = place.path();
    let schema: Value = serde_json::from_str(&ok(here, "schema")).expect("JSON");
    let schema = jsonschema::validator_for(&schema).expect("a schema");
    let sound = |v: &Value| {
        let wrong: Vec<String> = schema.iter_errors(v).map(|e| format!("{}: {e}", e.instance_path())).collect();
        assert!(wrong.is_empty(), "{wrong:#?}\n{v:#}");
    };
    ok(here, "baseline save fine.csv --reference ref -o main.json");
    for arguments in [
        "compare coarse.csv --reference ref",
        "compare coarse.csv --reference fine.csv",
        "check coarse.csv --reference ref --max-rms 0.1% --max-worst 5% --limit rms@band:g=3% --baseline main.json",
        "check fine.csv --reference ref --max-rms 5% --reflected --until-decided",
        "check coarse.csv --reference ref --before fine.csv --max-top1 5%",
        "check coarse.csv --reference ref --max-visible 10% --tone tr93-consistent --display crt",
        "check missing.csv --reference ref --max-rms 5%",
    ] {
        sound(&told(here, arguments).1);
    }
    // And it can tell: a verdict that there is not, a number that is a text, an error without a place.
    let mut v = told(here, "check fine.csv --reference ref --max-rms 5%").1;
    sound(&v);
    v["verdict"] = "maybe".into();
    assert!(!schema.is_valid(&v));
    v["verdict"] = "pass".into();
    v["rms"]["low"] = "0".into();
    assert!(!schema.is_valid(&v));
    assert!(!schema.is_valid(&serde_json::json!({ "error": { "code": "bad-input", "message": "x" } })));
}

#[test]
fn completions_of_options_do_not_clash() {
    // Every command can print its help: clap checks names and conflicts of all options on the way.
    let place = tempfile::tempdir().expect("a folder");
    for command in ["check", "compare", "bisect", "baseline save", "baseline diff", "baseline update", "reference"] {
        ok(place.path(), &format!("{command} --help"));
    }
    assert!(etalon(place.path()).args(["schema"]).output().expect("it runs").status.success());
}

/// A solution file with every value times a factor.
fn times(here: &Path, from: &str, to: &str, factor: f64) {
    let text = std::fs::read_to_string(here.join(from)).expect("written");
    let line = |l: &str| {
        let mut cells: Vec<String> = l.split(',').map(String::from).collect();
        cells[1..].iter_mut().for_each(|c| *c = c.parse::<f64>().map_or(c.clone(), |x| format!("{}", factor * x)));
        cells.join(",") + "\n"
    };
    std::fs::write(here.join(to), text.lines().map(line).collect::<String>()).expect("writable");
}

#[test]
fn their_mesh_and_their_units_are_judged_like_our_own() {
    let place = workshop();
    let here = place.path();
    let rms = |arguments: &str| {
        let v = json(here, &format!("compare {arguments} --reference ref"));
        v["rms"]["value"].as_f64().expect("a number")
    };
    let own = rms("fine.csv");
    for mesh in ["fine.ply", "fine.vtu"] {
        ok(here, &format!("convert fine.csv --scene builtin:cornell-box-coarse -o {mesh}"));
        assert!((rms(mesh) / own - 1.0).abs() < 1e-5, "{mesh}: {} {own}", rms(mesh));
    }
    times(here, "fine.csv", "radiance.csv", 1.0 / std::f64::consts::PI);
    assert!((rms("radiance.csv --quantity radiance") / own - 1.0).abs() < 1e-9);
    times(here, "fine.csv", "exposed.csv", 4.0);
    assert!((rms("exposed.csv --factor 0.25") / own - 1.0).abs() < 1e-9);
    // Not said, it is found out: by name, wherever a verdict is told.
    let (code, v) = told(here, "check radiance.csv --reference ref --max-rms 5%");
    assert_eq!((code, v["causes"][0]["kind"].as_str()), (1, Some("radiance")), "{v}");
    let (_, text, _) =
        run(here, "check radiance.csv --reference ref --max-rms 5% --junit j.xml --markdown m.md --quiet");
    let files = ["j.xml", "m.md"].map(|f| std::fs::read_to_string(here.join(f)).expect("written"));
    for told in [&text, &files[0], &files[1]] {
        assert!(told.contains("radiance"), "{told}");
    }
    // A right one is not accused, and nobody looks where it is not asked for.
    let v = told(here, "check fine.csv --reference ref --max-rms 5% --causes always").1;
    assert_eq!(v["causes"].as_array().expect("a list").len(), 0, "{v}");
    assert_eq!(
        told(here, "check radiance.csv --reference ref --max-rms 5% --causes never").1["causes"][0],
        Value::Null
    );
    ok(here, "solve builtin:cube-one-emitter --method gather:rays=64 -o cube.csv");
    ok(here, "convert cube.csv --scene builtin:cube-one-emitter -o cube.ply");
    assert!(refused(here, "compare cube.ply --reference cube.csv").contains("--scene"));
    ok(here, "compare cube.ply --reference cube.csv --scene builtin:cube-one-emitter");
    assert!(refused(here, "compare fine.csv --reference ref --units mm").contains("--units"));
}

#[test]
fn patches_without_a_value_are_named_or_left_out_on_demand() {
    let place = workshop();
    let here = place.path();
    ok(here, "convert fine.csv --scene builtin:cornell-box-coarse -o fine.ply");
    // The first face goes.
    let text = std::fs::read_to_string(here.join("fine.ply")).expect("written");
    let head: Vec<&str> = text.lines().take_while(|l| *l != "end_header").collect();
    let count = |what: &str| -> usize {
        let line = head.iter().find_map(|l| l.strip_prefix(what)).expect("an element");
        line.trim().parse().expect("a number")
    };
    let (faces, vertices) = (count("element face"), count("element vertex"));
    let body = head.len() + 1 + vertices;
    let cut: String = text
        .lines()
        .enumerate()
        .filter(|(k, _)| *k != body)
        .map(|(_, l)| l.replace(&format!("element face {faces}"), &format!("element face {}", faces - 1)) + "\n")
        .collect();
    std::fs::write(here.join("cut.ply"), cut).expect("writable");
    let what = refused(here, "check cut.ply --reference ref --max-rms 5%");
    assert!(what.contains("--skip-unmatched"), "{what}");
    let (code, v) = told(here, "check cut.ply --reference ref --max-rms 5% --skip-unmatched");
    assert_eq!(code, 0, "{v}");
    assert!(v["notices"].to_string().contains("left out"), "{v}");
}

#[test]
fn what_is_seen_can_be_a_limit() {
    let place = workshop();
    let here = place.path();
    let (code, seen) = told(here, "check coarse.csv --reference ref --max-visible 100%");
    assert_eq!(code, 0, "{seen}");
    let share = &seen["as_seen"]["share"];
    let (low, high) = (share["low"].as_f64().expect("a number"), share["high"].as_f64().expect("a number"));
    assert!(low > 0.0 && high <= 1.0 && share["std_err"].is_null(), "{share}");
    assert_eq!(seen["limits"][0]["metric"], "visible");
    // How accurate it would have to be: a step of the display is between a thousandth and a few per cent of the light.
    let needed = &seen["as_seen"]["needed"];
    let everywhere = needed["everywhere"].as_f64().expect("a number");
    assert!(everywhere > 1e-3 && everywhere < 0.1 && needed["median"].as_f64() >= Some(everywhere), "{needed}");
    let (code, _) = told(here, &format!("check coarse.csv --reference ref --max-visible {}", 0.5 * low));
    assert_eq!(code, 1);
    // The reference itself is seen to be wrong nowhere.
    let (_, exact) = told(here, "check ref --reference ref --max-visible 0");
    assert_eq!(exact["as_seen"]["share"]["value"], 0.0);
    let steps = exact["as_seen"]["worst"]["steps"].as_f64().expect("a number");
    assert!(steps.abs() < 1e-9, "{steps}");
    ok(here, "solve builtin:cube-one-emitter --method hemicube:resolution=20 -o cube.csv");
    let err = told(here, "check cube.csv --reference cube.csv --max-visible 1%").1;
    assert!(err["error"]["message"].as_str().is_some_and(|m| m.contains("--scene")), "{err}");
    let err = told(here, "check coarse.csv --reference ref --limit visible=1%").1;
    assert!(err["error"]["message"].as_str().is_some_and(|m| m.contains("--max-visible")), "{err}");
}
