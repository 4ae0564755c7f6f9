//! `etalon render` as a script sees it: exit codes and mends, same bytes, what is in the pictures.

#[path = "common/program.rs"]
mod program;

use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
use program::{ok, refused};
use serde_json::Value;
use std::collections::{BTreeSet, HashMap};
use std::path::Path;

fn pixels(path: &Path) -> image::RgbaImage {
    image::open(path).expect("a PNG").into_rgba8()
}

fn colours(picture: &image::RgbaImage) -> BTreeSet<[u8; 4]> {
    picture.pixels().map(|p| p.0).collect()
}

fn layers(path: &Path) -> HashMap<String, FlatSamples> {
    let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
    let image = reader.all_attributes().from_file(path).expect("an EXR");
    image.layer_data.channel_data.list.into_iter().map(|c| (c.name.to_string(), c.sample_data)).collect()
}

/// A furnace solved exactly: 2 W/m^2 everywhere, seen from within.
fn furnace() -> tempfile::TempDir {
    let place = tempfile::tempdir().expect("a folder");
    ok(place.path(), "solve builtin:furnace --method gather:rays=256 -o furnace.csv");
    place
}

#[test]
fn a_furnace_is_one_colour_in_every_style() {
    let place = furnace();
    for style in ["smooth", "constant", "both"] {
        let size = "--size 60x40 --caption off --tone linear -o out.png";
        ok(
            place.path(),
            &format!("render builtin:furnace --solution furnace.csv --style {style} {size} --exposure -1"),
        );
        let picture = pixels(&place.path().join("out.png"));
        let width = if style == "both" { 120 } else { 60 };
        assert_eq!(picture.dimensions(), (width, 40));
        // All that shines is white; a stop less is half of it: 188 in sRGB.
        assert_eq!(colours(&picture), BTreeSet::from([[188, 188, 188, 255]]), "{style}");
    }
    ok(place.path(), "render builtin:furnace --solution furnace.csv --white 8 --size 9x9 -o out.png");
    // A quarter of white.
    assert_eq!(colours(&pixels(&place.path().join("out.png"))), BTreeSet::from([[137, 137, 137, 255]]));
}

#[test]
fn layers_hold_the_numbers() {
    let place = furnace();
    ok(place.path(), "render builtin:furnace --solution furnace.csv --size 30x20 -o out.exr");
    let found = layers(&place.path().join("out.exr"));
    for name in ["Y", "smooth.Y", "constant.Y"] {
        let FlatSamples::F32(values) = &found[name] else { panic!("numbers") };
        assert!(values.len() == 600 && values.iter().all(|v| (v - 2.0).abs() < 1e-6), "{name}");
    }
    let FlatSamples::F32(luminance) = &found["luminance.Y"] else { panic!("luminances") };
    let expected = (179.0 * 2.0 / std::f64::consts::PI) as f32;
    assert!(luminance.iter().all(|v| (v / expected - 1.0).abs() < 1e-6));
    let FlatSamples::U32(numbers) = &found["patch.number"] else { panic!("numbers") };
    assert!(numbers.iter().all(|n| *n < 96));
}

#[test]
fn the_item_buffer_has_a_colour_for_every_patch_in_sight() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "render builtin:cornell-box --style items -o items.png");
    ok(here, "render builtin:cornell-box --style items -o items.exr");
    let picture = pixels(&here.join("items.png"));
    let found = layers(&here.join("items.exr"));
    let FlatSamples::U32(numbers) = &found["patch.number"] else { panic!("numbers") };
    let mut colour_of: HashMap<u32, [u8; 4]> = HashMap::new();
    for (number, pixel) in numbers.iter().zip(picture.pixels()) {
        assert_eq!(*colour_of.entry(*number).or_insert(pixel.0), pixel.0);
    }
    let shown: BTreeSet<[u8; 4]> = colour_of.values().copied().collect();
    assert!(shown.len() > 500 && shown.len() == colour_of.len(), "{} of {}", shown.len(), colour_of.len());
}

#[test]
fn a_reference_shows_itself_with_its_errors_and_sets_the_exposure() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "reference builtin:cube-one-emitter -o ref --rays 256");
    ok(here, "solve builtin:cube-one-emitter --method gather:rays=256 -o mine.csv");
    let white = |arguments: &str| -> f64 {
        let json: Value =
            serde_json::from_str(&ok(here, &format!("{arguments} --tone linear --size 40x30 --json"))).expect("JSON");
        json["pictures"][0]["tone"]["white_luminance"].as_f64().expect("a number")
    };
    let own = white("render ref -o a.png");
    assert_eq!(own, white("render ref --solution mine.csv -o b.png"));
    assert_ne!(own, white("render builtin:cube-one-emitter --solution mine.csv -o c.png"));
    assert_eq!(own, white("render builtin:cube-one-emitter --solution ref -o d.png"));
    for quantity in ["luminance", "std-err", "relative-std-err", "band:y"] {
        ok(here, &format!("render ref --quantity {quantity} --size 40x30 -o q.png"));
        let picture = pixels(&here.join("q.png"));
        // The bar alone runs through more colours than the small picture has patches.
        assert!(picture.width() > 400 && colours(&picture).len() > 200, "{quantity}");
    }
    let err = refused(here, "render ref --quantity band:x -o e.png");
    assert!(err.contains("has y") && !here.join("e.png").exists(), "{err}");
}

#[test]
fn same_bytes_on_any_number_of_threads() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "solve builtin:cornell-box-coarse --method gather:rays=256 -o mine.csv");
    for (threads, name) in [(1, "one"), (3, "three")] {
        let common = format!("render builtin:cornell-box-coarse --solution mine.csv --size 90x80 --threads {threads}");
        ok(here, &format!("{common} --style both -o {name}.png"));
        ok(here, &format!("{common} -o {name}.exr"));
    }
    for ending in ["png", "exr"] {
        let bytes = |name: &str| std::fs::read(here.join(format!("{name}.{ending}"))).expect("written");
        assert!(bytes("one") == bytes("three"), "{ending}");
    }
}

const TWO_CAMERAS: &str = r#"
format = "etalon-scene/1"
name = "plate"
[photometry]
primaries = "mono"
bands = ["y"]
[[material]]
name = "glow"
reflectance = 0.5
emission = 1.0
[[surface]]
name = "plate"
material = "glow"
polygon = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
patches = [4, 4]
elements = [2, 2]
[[camera]]
name = "Above"
eye = [0.5, 0.5, 2]
target = [0.5, 0.5, 0]
up = [0, 1, 0]
fov = 40
size = [40, 40]
[[camera]]
name = "a/side"
eye = [2, 0.5, 1]
target = [0.5, 0.5, 0]
up = [0, 0, 1]
fov = 50
size = [30, 20]
"#;

#[test]
fn a_folder_takes_all_cameras_and_a_ramp_is_upright_and_smooth() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    std::fs::write(here.join("plate.toml"), TWO_CAMERAS).expect("writable");
    // Patch a + 4 b: brighter towards +x and, more so, towards +y.
    let value = |k: usize| 3.0 + (k % 4) as f64 + 2.0 * (k / 4) as f64;
    let rows: String = (0..16).map(|k| format!("{k},{}\n", value(k))).collect();
    std::fs::write(here.join("ramp.csv"), format!("patch,y\n{rows}")).expect("writable");
    ok(here, "render plate.toml --solution ramp.csv -o pictures");
    let mut names: Vec<_> =
        std::fs::read_dir(here.join("pictures")).expect("made").map(|e| e.expect("an entry").file_name()).collect();
    names.sort();
    assert_eq!(names, ["Above.png", "a_side.png"]);
    assert_eq!(pixels(&here.join("pictures/a_side.png")).dimensions(), (30, 20));
    ok(here, "render plate.toml --solution ramp.csv --camera Above --samples 1 --size 200x200 -o above.exr");
    let found = layers(&here.join("above.exr"));
    let (FlatSamples::F32(smooth), FlatSamples::F32(cover)) = (&found["smooth.Y"], &found["A"]) else { panic!() };
    // Across the plate the field is B = 3 + (4 x - 0.5) + 2 (4 y - 0.5); y is up in the picture.
    let half = 20f64.to_radians().tan() * 2.0;
    let mut checked = 0;
    for p in (0..40_000).filter(|p| cover[*p] == 1.0) {
        let place = |pixel: usize| (pixel as f64 + 0.5) / 100.0 - 1.0;
        let (x, y) = (0.5 + half * place(p % 200), 0.5 - half * place(p / 200));
        let expected = 4.0 * x + 8.0 * y + 1.5;
        assert!((f64::from(smooth[p]) - expected).abs() < 1e-5, "({x}, {y}): {} {expected}", smooth[p]);
        checked += 1;
    }
    assert!(checked > 15_000, "{checked}");
}

#[test]
fn elements_are_shown_where_values_are_theirs() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    std::fs::write(here.join("plate.toml"), TWO_CAMERAS).expect("writable");
    let rows: String = (0..64).map(|k| format!("{k},{}\n", 1 + k)).collect();
    std::fs::write(here.join("fine.csv"), format!("patch,y\n{rows}")).expect("writable");
    let common = "render plate.toml --solution fine.csv --per element --style constant --samples 1 --white 100";
    ok(here, &format!("{common} --size 200x200 -o fine.exr"));
    let found = layers(&here.join("fine.exr"));
    let FlatSamples::F32(values) = &found["constant.Y"] else { panic!("numbers") };
    let seen: BTreeSet<u32> = values.iter().map(|v| *v as u32).filter(|v| *v > 0).collect();
    assert_eq!(seen, (1..=64).collect());
    // Lower left corner of the plate: element 0 of patch 0; the one right of it is element 1.
    let at = |x: usize, y: usize| values[y * 200 + x];
    let (left, low, step) = (35, 165, 17);
    assert_eq!([at(left, low), at(left + step, low), at(left, low - step)], [1.0, 2.0, 3.0]);
}

#[test]
fn mistakes_are_refused_with_the_mend_and_leave_nothing_behind() {
    let place = furnace();
    let here = place.path();
    std::fs::write(here.join("plate.toml"), TWO_CAMERAS).expect("writable");
    let plate = "render plate.toml --style items";
    let before = std::fs::read_dir(here).expect("a folder").count();
    for (arguments, mend) in [
        ("render builtin:furnace -o out.png", "--solution"),
        ("render furnace.csv -o out.png", "SCENE --solution furnace.csv"),
        ("render builtin:cornell-box --solution furnace.csv -o out.png", "bands"),
        ("render builtin:furnace --solution furnace.csv -o out.jpg", ".png"),
        ("render builtin:furnace --solution furnace.csv -o nowhere/out.png", "create it first"),
        ("render builtin:furnace --solution furnace.csv --camera x -o out.png", "leave --camera out"),
        (
            "render builtin:furnace --solution furnace.csv --quantity std-err --style smooth -o out.png",
            "--style constant",
        ),
        ("render builtin:furnace --solution furnace.csv --style items --quantity luminance -o out.png", "leave one"),
        ("render builtin:furnace --solution furnace.csv --quantity luminance -o out.exr", ".png"),
        ("render builtin:furnace --solution furnace.csv --quantity brightness -o out.png", "luminance, std-err"),
        ("render builtin:furnace --solution furnace.csv --white 0 -o out.png", "above 0"),
        ("render builtin:furnace --solution furnace.csv --exposure nan -o out.png", "--exposure"),
        ("render builtin:furnace --solution furnace.csv --size 10 -o out.png", "640x480"),
        ("render builtin:furnace --solution furnace.csv --size 16384x16384 -o out.png", "smaller --size"),
        ("render builtin:furnace --solution furnace.csv --samples 0 -o out.png", "--samples"),
        (&format!("{plate} --camera Below -o out.png"), "Above, a/side"),
    ] {
        let err = refused(here, arguments);
        assert!(err.contains(mend), "{arguments}: {err}");
    }
    assert_eq!(std::fs::read_dir(here).expect("a folder").count(), before);
}

/// What `render --json` says of its only picture.
fn tone(here: &Path, arguments: &str) -> Value {
    let json: Value = serde_json::from_str(&ok(here, &format!("{arguments} --json"))).expect("JSON");
    json["pictures"][0]["tone"].clone()
}

/// Every pixel of a furnace has one luminance, 2 W/m^2 times 179 / pi: the eye is adapted to 10^0.84 times that, and the
/// bytes follow by eqs. 7 to 15, worked out here from the printed formulas.
#[test]
fn a_furnace_is_shown_as_the_paper_says() {
    let place = furnace();
    let here = place.path();
    let lambert = 1e4 / std::f64::consts::PI;
    let luminance: f64 = 179.0 * 2.0 / std::f64::consts::PI;
    let alpha = |w: f64| 0.4 * (w / lambert).log10() + 2.92;
    let beta = |w: f64| -0.4 * (w / lambert).log10().powi(2) - 2.584 * (w / lambert).log10() + 2.0208;
    for (display, peak, contrast, gamma) in [("crt", 86.0f64, 35.0f64, 1.2), ("400:900:2.2", 400.0, 900.0, 2.2)] {
        for (operator, viewer) in [("tr93", 1.0), ("tr93-consistent", 10f64.powf(0.84))] {
            let (eye, screen) = (luminance * 10f64.powf(0.84), viewer * peak / contrast.sqrt());
            let brils = beta(eye) + alpha(eye) * (luminance / lambert).log10();
            let shown = lambert * 10f64.powf((brils - beta(screen)) / alpha(screen));
            let n = (shown / peak - 1.0 / contrast).max(0.0).powf(1.0 / gamma);
            let byte = (255.0 * n).round() as u8;
            let common = format!("render builtin:furnace --solution furnace.csv --tone {operator} --display {display}");
            let told = tone(here, &format!("{common} --size 20x10 -o out.png"));
            assert_eq!(colours(&pixels(&here.join("out.png"))), BTreeSet::from([[byte, byte, byte, 255]]), "{common}");
            assert!((told["adapted_to"].as_f64().expect("a number") / eye - 1.0).abs() < 1e-6, "{told}");
            assert_eq!(told["clipped_black"], f64::from(u8::from(n == 0.0)), "{told}");
        }
    }
}

#[test]
fn from_searchlight_to_firefly_the_eye_tells_and_the_scaling_does_not() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "solve builtin:cornell-box-coarse --method gather:rays=256 -o mine.csv");
    let picture = |lamp: f64, operator: &str| {
        let common = format!("render builtin:cornell-box-coarse --solution mine.csv --size 60x60 --tone {operator}");
        let told = tone(here, &format!("{common} --display crt --lamp {lamp} -o out.png"));
        let mean = pixels(&here.join("out.png")).pixels().map(|p| f64::from(p.0[1])).sum::<f64>() / 3600.0;
        (told, mean)
    };
    // 1,000 lamberts.
    let lamps = [3.183_098_86e6, 3.183_098_86e4, 3.183_098_86e2, 3.183_098_86];
    let eyes: Vec<(Value, f64)> = lamps.iter().map(|l| picture(*l, "tr93")).collect();
    assert!(eyes.windows(2).all(|w| w[0].1 > w[1].1 + 1.0), "{eyes:?}");
    // Adaptation follows the light, a factor of 100 a picture.
    let adapted = |k: usize| eyes[k].0["adapted_to_db"].as_f64().expect("a number");
    assert!((1..4).all(|k| (adapted(k - 1) - adapted(k) - 20.0).abs() < 1e-6));
    let scaled: Vec<f64> = [lamps[0], lamps[3]].iter().map(|l| picture(*l, "brightest").1).collect();
    assert_eq!(scaled[0], scaled[1]);
    // A hundred thousandth of a candela: below 27 dB more light would look darker, and the picture says so.
    let dark = picture(1e-5, "tr93").0;
    assert_eq!(dark["below_27_db"], true);
    assert_eq!(eyes[0].0["below_27_db"], false);
    let told = ok(here, "render builtin:cornell-box-coarse --solution mine.csv --tone tr93 --lamp 1e-5 -o out.png");
    assert!(told.contains("27 dB"), "{told}");
}

#[test]
fn wrong_eyes_and_screens_are_refused() {
    let place = furnace();
    for (option, mend) in [
        ("--tone gamma", "tr93-consistent"),
        ("--display lcd", "PEAK:CONTRAST:GAMMA"),
        ("--display 80:1:2.2", "contrast above 1"),
        ("--efficacy 0", "above 0"),
        ("--adapt -3", "above 0"),
        ("--tone tr93 --exposure 1", "--tone linear"),
        ("--lamp nan", "above 0"),
    ] {
        let err = refused(place.path(), &format!("render builtin:furnace --solution furnace.csv {option} -o x.png"));
        assert!(err.contains(mend), "{option}: {err}");
    }
    assert!(!place.path().join("x.png").exists());
}
