//! Published test suites, receivers and point lights, as a script sees them.

#[path = "common/program.rs"]
mod program;

use program::{json, ok, refused, run};
use serde_json::Value;
use std::path::Path;

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

#[test]
fn closed_forms_hold_and_say_how() {
    let place = folder();
    let v = json(place.path(), "validate closed-forms --rays 16384");
    let rows = v["values"].as_array().expect("rows");
    let by = |route: &str| rows.iter().filter(|r| r["route"] == route).count();
    assert_eq!(v["failed"], 0);
    assert_eq!((by("none"), by("shadows")), (0, 40));
    // Two directions of 53 pairs of polygons, one of 11 elements; disks and spheres.
    assert_eq!(by("polygon"), 2 * 53 + 11);
    assert!(by("catalogue") >= 40, "{}", by("catalogue"));
    for r in rows.iter().filter(|r| r["route"] != "shadows") {
        let (error, exact) = (r["error"].as_f64().expect("an error"), r["exact"].as_f64().expect("a value"));
        assert!(error.abs() <= 1e-12f64.max(1e-9 * exact) && r["std_err"].is_null(), "{r}");
    }
    for r in rows.iter().filter(|r| r["route"] == "shadows") {
        let (error, exact) = (r["error"].as_f64().expect("an error"), r["exact"].as_f64().expect("a value"));
        assert!(error.abs() <= 1e-12f64.max(1e-9 * exact) && r["std_err"].is_number(), "{r}");
        assert!(r["interval"][0].as_f64() <= Some(exact) && Some(exact) <= r["interval"][1].as_f64(), "{r}");
    }
}

/// A sound engine fails this with a probability of 1e-6.
#[test]
fn cie_171_holds_and_never_says_certified() {
    let place = folder();
    let v = json(place.path(), "validate cie171 --rays 65536");
    let rows = v["values"].as_array().expect("rows");
    // 10 + 10 + 2 + (10 + 4 + 4) + 11 + 11.
    assert_eq!((v["failed"].as_u64(), v["inconclusive"].as_u64(), rows.len()), (Some(0), Some(0), 62));
    assert!(v["verdict"].as_str().expect("words").starts_with("validated against CIE 171:2006"));
    let of = |case: &str| rows.iter().filter(|r| r["case"] == case).collect::<Vec<_>>();
    for r in of("5.2") {
        assert!(r["std_err"].is_null() && r["deviation"].as_f64().expect("a number").abs() < 1e-12, "exact: {r}");
    }
    for r in of("5.3") {
        assert!(r["std_err"].as_f64().expect("an error") > 0.0, "{r}");
    }
    assert_eq!(of("5.8").len(), 11);
    assert!(of("5.8").iter().all(|r| r["deviation"].as_f64().expect("a number").abs() < 0.01));
    assert!(!v.to_string().contains("ertif"), "{v}");
}

#[test]
fn too_few_rays_are_told_apart_from_a_fault() {
    let place = folder();
    let (code, out, _) = run(place.path(), "validate cie171 --rays 16 --randomisations 8");
    assert_eq!(code, 3, "{out}");
    assert!(out.contains("need more --rays"), "{out}");
}

/// Two bands, a screen in the way of one lamp, a reflecting floor.
const SCENE: &str = r#"format = "etalon-scene/1"
[photometry]
bands = ["warm", "cool"]
luminance = [1, 1]
[[material]]
name = "black"
reflectance = 0
[[material]]
name = "lamp"
reflectance = 0
emission = [2, 1]
[[surface]]
name = "screen"
material = "black"
two_sided = true
polygon = [[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]]
[[surface]]
name = "panel"
material = "lamp"
polygon = [[3, -1, 1], [3, 1, 1], [5, 1, 1], [5, -1, 1]]
[[light]]
type = "point"
position = [0, 0, 2]
intensity = [4, 8]
[[receiver]]
name = "in the shadow"
position = [0, 0, 0]
normal = [0, 0, 1]
[[receiver]]
name = "in the open, tilted"
position = [0, 0, 3]
normal = [0, 3, -4]
[[receiver]]
name = "looking away"
position = [0, 0, 4]
normal = [0, 0, 1]
[[receiver]]
name = "under the panel"
position = [4, 0, 0]
normal = [0, 0, 1]
"#;

fn numbers(v: &Value) -> Vec<f64> {
    v.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

#[test]
fn receivers_see_lamps_panels_and_shadows() {
    let place = folder();
    let here = place.path();
    std::fs::write(here.join("s.toml"), SCENE).expect("writable");
    let v = json(here, "receivers s.toml -o r.csv --rays 65536");
    let of = |k: usize| (numbers(&v["receivers"][k]["irradiance"]), numbers(&v["receivers"][k]["std_err"]));
    // I cos / d^2 at 1 m, tilted by 4/5.
    let (open, errors) = of(1);
    assert!((open[0] - 3.2).abs() < 1e-12 && (open[1] - 6.4).abs() < 1e-12, "{open:?}");
    assert!(errors.iter().all(|e| *e < 1e-14), "no ray brought any light: {errors:?}");
    assert_eq!(of(2).0, [0.0, 0.0]);
    // In the shadow: the panel alone, between 3 and 5 m aside: F of the two corners' rectangles.
    let corner = |x: f64| {
        let (a, b) = (x, 1.0f64);
        let (u, v) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
        (a / u * (b / u).atan() + b / v * (a / v).atan()) / std::f64::consts::TAU
    };
    let aside = 2.0 * (corner(5.0) - corner(3.0));
    // Under the panel: the panel, and the lamp past the screen's rim (sight line leaves x = 1 at z = 1.5).
    let straight = 4.0 * 2.0 / 20f64.powf(1.5);
    for (k, factor, lamp) in [(0, aside, 0.0), (3, 4.0 * corner(1.0), 1.0)] {
        let (e, s) = of(k);
        for (c, (panel, light)) in [(2.0, straight), (1.0, 2.0 * straight)].into_iter().enumerate() {
            let exact = panel * factor + light * lamp;
            // Student's t with 15 degrees of freedom: false alarm 1e-6 each.
            assert!(
                (e[c] - exact).abs() < 7.5 * s[c] && s[c] > 0.0 && s[c] < 0.02 * exact,
                "{k} {c}: {e:?} {s:?} {exact}"
            );
        }
    }
    let table = std::fs::read_to_string(here.join("r.csv")).expect("written");
    assert!(table.starts_with("receiver,x,y,z,normal_x,normal_y,normal_z,warm,warm_std_err,cool,cool_std_err\n"));
    assert_eq!(table.lines().count(), 5);
    assert!(table.contains("\n\"in the open, tilted\",0,0,3,0,"), "{table}");
    let same = |threads: &str| {
        ok(here, &format!("receivers s.toml -o t.csv --rays 4096 --threads {threads}"));
        std::fs::read(here.join("t.csv")).expect("written")
    };
    assert_eq!(same("1"), same("2"));
}

#[test]
fn lights_enter_references_and_are_told() {
    let place = folder();
    let here = place.path();
    let told = ok(here, "scene check builtin:cie171-5-8");
    assert!(told.contains("1 point light"), "{told}");
    assert!(ok(here, "scene check builtin:cie171-5-3").contains("10 receivers"));
    // A closed grey cube: mean radiosity = rho / (1 - rho) * flux / area, by energy alone.
    ok(here, "reference builtin:cie171-5-8 --state 5 -o ref --rays 16384");
    let table: Value = json(here, "compare ref --reference ref");
    assert!(table["rms"]["value"].as_f64().is_some(), "{table}");
    let message = refused(here, "solve builtin:cie171-5-8 --method hemicube -o b.csv");
    assert!(message.contains("point light"), "{message}");
    assert!(!here.join("b.csv").exists());
    refused(here, "solve builtin:cie171-5-8 --method gather -o b.csv");
}

#[test]
fn mistakes_are_told() {
    let place = folder();
    let here: &Path = place.path();
    assert!(refused(here, "receivers builtin:furnace -o r.csv").contains("add a [[receiver]]"));
    assert!(!here.join("r.csv").exists());
    refused(here, "validate cie172");
    refused(here, "validate cie171 --rays 0");
}
