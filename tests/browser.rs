//! The pages as a reader opens them: in a browser, from a file, with names that mean harm.

#[path = "common/browser.rs"]
mod browser;
#[path = "common/program.rs"]
mod program;

use browser::{Browser, browser};
use etalon::math::DVec3;
use etalon::render::{Scale, difference, luminance, to_srgb8};
use etalon::report::read_record;
use etalon::study::Record;
use image::RgbaImage;
use program::ok;
use serde_json::json;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Ends a script, opens another, and is markup besides.
const ATTACK: &str = "</script><script>alert(1)</script><b>&{{ 7 * 7 }}";

/// A folder with the pages of all tests.
struct Shop {
    place: tempfile::TempDir,
}

impl Shop {
    fn page(&self) -> PathBuf {
        self.place.path().join("page/report.html")
    }

    fn film(&self) -> PathBuf {
        self.place.path().join("film/index.html")
    }

    fn record(&self) -> Record {
        read_record(&std::fs::read(self.place.path().join("page/record.json")).expect("a record")).expect("reads")
    }
}

/// The coarse Cornell box, its names made harmful, before and after the tall block is taken away.
fn shop() -> &'static Shop {
    static SHOP: OnceLock<Shop> = OnceLock::new();
    SHOP.get_or_init(|| {
        let place = tempfile::tempdir().expect("a folder");
        let here = place.path();
        let attack = format!("'{ATTACK}'");
        let mut scene = std::fs::read_to_string("references/scenes/cornell-box-coarse.toml").expect("the scene");
        for name in ["\"cornell-box-coarse\"", "\"floor\"", "\"main\"", "\"white\""] {
            scene = scene.replace(name, &attack);
        }
        scene = scene.replacen("[[camera]]", "[[edit]]\nremove = \"tall-block\"\n\n[[camera]]", 1);
        std::fs::write(here.join("scene.toml"), scene).expect("written");
        let solution = "<script>alert(1)<!--.csv";
        ok(here, "reference scene.toml -o before.ref --state 0 --rays 512 --seed 5 --estimator rays");
        ok(here, "reference scene.toml -o after.ref --state 1 --rays 512 --seed 5 --estimator rays");
        ok(here, &format!("solve scene.toml --state 1 --method hemicube:resolution=20 -o {solution}"));
        ok(here, &format!("compare {solution} --reference after.ref --before before.ref --report page"));
        ok(here, "converge builtin:cornell-box-coarse --methods progressive --rays 256 --estimator rays -o film");
        Shop { place }
    })
}

/// A browser on the report's page, ready, in a window of 1400 by 1000.
fn opened(page: &Path) -> Option<Browser> {
    let b = browser(&[])?;
    b.resize(1400, 1000);
    b.prefer(&[("prefers-reduced-motion", "reduce")]);
    b.open(page);
    b.wait("window.etalonViewer && etalonViewer.ready");
    in_sight(&b);
    Some(b)
}

fn in_sight(b: &Browser) {
    b.run("document.getElementById('viewer').scrollIntoView()");
    still(b);
}

/// Waits until the scene has been drawn in full: in motion a slow machine shows it coarse.
fn still(b: &Browser) {
    b.settle();
    b.wait("!etalonViewer.coarse");
    b.settle();
}

fn numbers(b: &Browser, expression: &str) -> Vec<f64> {
    let value = b.value(expression);
    value.as_array().expect("a list").iter().map(|v| v.as_f64().expect("a number")).collect()
}

/// Left, top, width, height of the canvas in the window.
fn canvas(b: &Browser) -> [f64; 4] {
    let code =
        "(r => [r.left, r.top, r.width, r.height])(document.getElementById('viewer-canvas').getBoundingClientRect())";
    numbers(b, code).try_into().expect("four numbers")
}

/// What stands on the canvas.
fn pixels(b: &Browser) -> RgbaImage {
    let [x, y, width, height] = canvas(b).map(|v| v.max(0.0) as u32);
    let whole = image::load_from_memory(&b.screenshot()).expect("a picture");
    whole.crop_imm(x, y, width, height).to_rgba8()
}

/// Share of the pixels that differ.
fn changed(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let different = a.pixels().zip(b.pixels()).filter(|(p, q)| p != q).count();
    different as f64 / a.pixels().len() as f64
}

/// Where a camera of the scene puts a point on a canvas: by the rules of the scene file, not by the page.
fn projected(record: &Record, p: DVec3, [width, height]: [f64; 2]) -> [f64; 2] {
    let camera = &record.stage.cameras[0];
    let forward = (camera.target - camera.eye).normalize();
    let right = forward.cross(camera.up).normalize();
    let above = right.cross(forward);
    let (to, aspect) = (p - camera.eye, f64::from(camera.size[0]) / f64::from(camera.size[1]));
    // The whole picture of the camera fits into the canvas.
    let half = (0.5 * camera.fov.to_radians()).tan() * (aspect / (width / height)).max(1.0);
    let (x, y) = (to.dot(right) / to.dot(forward) / half, to.dot(above) / to.dot(forward) / half);
    [0.5 * width + 0.5 * height * x, 0.5 * height * (1.0 - y)]
}

/// True if a convex polygon with its front towards the eye stands between the eye and a point.
fn hides(corners: &[DVec3], normal: DVec3, eye: DVec3, p: DVec3) -> bool {
    let (to, height) = (p - eye, (corners[0] - eye).dot(normal));
    let t = height / to.dot(normal);
    let q = eye + to * t;
    let inside = |k: usize| normal.cross(corners[(k + 1) % corners.len()] - corners[k]).dot(q - corners[k]) >= 0.0;
    to.dot(normal) < 0.0 && t > 0.0 && t < 1.0 - 1e-6 && (0..corners.len()).all(inside)
}

/// Patches whose fronts the first camera sees, each with a point of it.
fn seen(record: &Record) -> Vec<(usize, DVec3)> {
    let (stage, eye) = (&record.stage, record.stage.cameras[0].eye);
    let middle = |i: usize| {
        let piece = stage.patches[i].region.pieces.first()?;
        Some((i, piece.iter().sum::<DVec3>() / piece.len() as f64))
    };
    let in_sight = |(i, p): &(usize, DVec3)| {
        let others = stage.patches.iter().enumerate().filter(|(k, patch)| k != i && patch.is_present());
        (eye - *p).dot(stage.patches[*i].normal) > 0.0
            && others
                .flat_map(|(_, o)| o.region.pieces.iter().map(|c| (c, o.normal)))
                .all(|(c, n)| !hides(c, n, eye, *p))
    };
    (0..stage.patch_count()).filter_map(middle).filter(in_sight).collect()
}

#[test]
fn the_page_opens_without_a_complaint_and_asks_for_nothing() {
    let shop = shop();
    let Some(b) = opened(&shop.page()) else { return };
    let colours: BTreeSet<_> = pixels(&b).pixels().map(|p| p.0).collect();
    assert!(colours.len() > 40, "{} colours", colours.len());
    assert_eq!((b.complaints(), b.requests()), (vec![], vec![]));
    let film = shop.film();
    b.open(&film);
    b.wait("window.etalonViewer && etalonViewer.ready");
    assert_eq!((b.complaints(), b.requests()), (vec![], vec![]));
}

#[test]
fn a_click_finds_the_patch_that_stands_there() {
    let shop = shop();
    let Some(b) = opened(&shop.page()) else { return };
    let record = shop.record();
    let [left, top, width, height] = canvas(&b);
    let all = seen(&record);
    assert!(all.len() > 60, "{} in sight", all.len());
    for (patch, point) in &all {
        let [x, y] = projected(&record, *point, [width, height]);
        let theirs = numbers(&b, &format!("etalonViewer.project([{}, {}, {}])", point.x, point.y, point.z));
        assert!((theirs[0] - x).abs() < 0.5 && (theirs[1] - y).abs() < 0.5, "{theirs:?} {x} {y}");
        assert_eq!(b.value(&format!("etalonViewer.pick({x}, {y})")), json!(patch));
    }
    assert_eq!(b.value("etalonViewer.pick(2, 2)"), json!(null));
    for (patch, point) in all.iter().step_by(17) {
        let [x, y] = projected(&record, *point, [width, height]);
        b.click([left + x, top + y]);
        assert_eq!(b.value("etalonViewer.selected"), json!(patch));
        let told = b.value("document.getElementById('viewer-panel').textContent");
        assert!(told.as_str().expect("text").starts_with(&format!("Patch {patch}")), "{told}");
    }
}

/// The colour on the screen is that of the picture: the map at the value, nothing lit, to two codes of 255.
#[test]
fn a_patch_has_the_colour_of_its_number() {
    let shop = shop();
    let Some(b) = opened(&shop.page()) else { return };
    let record = shop.record();
    let photometry = &record.stage.photometry;
    let [reference, solution] = [&record.reference, &record.solution].map(|r| luminance(photometry, r));
    let wrong = difference(&reference, &solution);
    let scale = Scale::symmetric(&wrong, &record.stage.areas(), 0.0);
    b.run("const box = document.getElementById('viewer-outlines'); if (box.checked) box.click()");
    still(&b);
    let shown = pixels(&b);
    for (patch, point) in seen(&record) {
        let [x, y] = projected(&record, point, [f64::from(shown.width()), f64::from(shown.height())]);
        let expected = scale.colour(wrong.values[patch].expect("a difference")).map(to_srgb8);
        let found = shown.get_pixel(x as u32, y as u32).0;
        let near = (0..3).all(|c| expected[c].abs_diff(found[c]) <= 2);
        assert!(near, "patch {patch}: {found:?}, not {expected:?}");
    }
}

#[test]
fn rows_of_the_tables_fly_to_their_patch() {
    let shop = shop();
    let Some(b) = opened(&shop.page()) else { return };
    let record = shop.record();
    let worst: Vec<usize> = record.comparison.worst.iter().map(|w| w.patch).collect();
    let before = b.value("etalonViewer.camera().eye");
    b.run("document.querySelectorAll('tr.flies')[1].click()");
    assert_eq!(b.value("etalonViewer.selected"), json!(worst[1]));
    assert_ne!(b.value("etalonViewer.camera().eye"), before);
    // It looks straight at the middle of the patch, from its front.
    let [eye, target] =
        ["eye", "target"].map(|v| DVec3::from_slice(&numbers(&b, &format!("etalonViewer.camera().{v}"))));
    let patch = &record.stage.patches[worst[1]];
    assert!((target - patch.region.centroid().expect("a middle")).length() < 1e-5);
    assert!((eye - target).normalize().dot(patch.normal) > 1.0 - 1e-6);
    let canvas = canvas(&b);
    assert_eq!(b.value(&format!("etalonViewer.pick({}, {})", canvas[2] / 2.0, canvas[3] / 2.0)), json!(worst[1]));
    // By keyboard: the next row, Enter.
    b.run("document.querySelectorAll('tr.flies')[2].focus()");
    b.keys("\u{e007}");
    assert_eq!(b.value("etalonViewer.selected"), json!(worst[2]));
}

/// With motion allowed the camera is on its way for a while, and arrives at the same place.
#[test]
fn a_flight_takes_time_only_where_motion_is_welcome() {
    let shop = shop();
    let Some(b) = opened(&shop.page()) else { return };
    let fly = "etalonViewer.select(etalonViewer.worst[0])";
    b.run(fly);
    let arrived = numbers(&b, "etalonViewer.camera().eye");
    b.prefer(&[("prefers-reduced-motion", "no-preference")]);
    b.run("document.getElementById('viewer-canvas').focus()");
    b.run(&format!("etalonViewer.select(etalonViewer.worst[1]); {fly};"));
    assert_eq!(b.value("etalonViewer.camera().flying"), json!(true));
    b.wait("!etalonViewer.camera().flying");
    let again = numbers(&b, "etalonViewer.camera().eye");
    assert!(arrived.iter().zip(&again).all(|(a, b)| (a - b).abs() < 1e-9), "{arrived:?} {again:?}");
}

#[test]
fn everything_goes_by_keyboard() {
    let shop = shop();
    let Some(b) = opened(&shop.page()) else { return };
    let worst: Vec<usize> = shop.record().comparison.worst.iter().map(|w| w.patch).collect();
    b.run("document.getElementById('viewer-canvas').focus()");
    let eye = || b.value("etalonViewer.camera()");
    let home = eye();
    // Arrow left, plus, w, page: each moves the eye; 0 brings it back.
    for key in ["\u{e012}", "+", "w", "d"] {
        let last = eye();
        b.keys(key);
        assert_ne!(eye(), last, "{key}");
    }
    b.keys("0");
    assert_eq!(eye(), home);
    b.keys("n");
    assert_eq!(b.value("etalonViewer.selected"), json!(worst[0]));
    b.keys("nnp");
    assert_eq!(b.value("etalonViewer.selected"), json!(worst[1]));
    b.keys("\u{e00c}");
    assert_eq!(b.value("etalonViewer.selected"), json!(null));
    let layers = b.value("etalonViewer.layers");
    let at = |k: usize| layers[k].clone();
    let first = layers.as_array().expect("a list").iter().position(|l| l == "difference").expect("shown first");
    b.keys("]");
    assert_eq!(b.value("etalonViewer.layer"), at(first + 1));
    b.keys("[[");
    assert_eq!(b.value("etalonViewer.layer"), at(first - 1));
    b.keys("?");
    assert_eq!(b.value("document.getElementById('viewer-keys').hidden"), json!(false));
}

#[test]
fn layers_ranges_and_the_divider_change_what_is_seen() {
    let shop = shop();
    let Some(b) = opened(&shop.page()) else { return };
    let look = || {
        still(&b);
        pixels(&b)
    };
    let mut last = look();
    for layer in ["natural-reference", "reference", "relative", "std_err", "z"] {
        b.run(&format!("etalonViewer.setLayer('{layer}')"));
        let now = look();
        assert!(changed(&last, &now) > 0.05, "{layer}");
        last = now;
    }
    let set = "const i = document.querySelectorAll('.viewer-range input')[1]; i.value = '1000'; i.dispatchEvent(new Event('change'))";
    b.run(set);
    let wide = look();
    assert!(changed(&last, &wide) > 0.05, "the range");
    // Before on the left, after on the right, each with what stood there.
    b.run("document.getElementById('viewer-split').click()");
    assert_eq!(b.value("etalonViewer.layer"), json!("natural-before"));
    let half = look();
    let [left, top, width, height] = canvas(&b);
    b.drag([left + 0.5 * width, top + 0.2 * height], [left + 0.9 * width, top + 0.2 * height]);
    let most = look();
    assert!(changed(&half, &most) > 0.02, "the divider");
    b.run("document.getElementById('viewer-divider').focus()");
    b.keys("\u{e011}");
    assert!(changed(&most, &look()) > 0.02, "the divider by keyboard");
    let record = shop.record();
    let before = &record.before.as_ref().expect("before").stage;
    let gone = |i: &usize| !record.stage.patches[*i].is_present() && before.patches[*i].is_present();
    let gone: BTreeSet<usize> = (0..before.patch_count()).filter(gone).collect();
    assert!(!gone.is_empty());
    let picked = |share: f64| {
        b.run("document.getElementById('viewer-divider').focus()");
        b.keys(if share > 0.5 { "\u{e010}" } else { "\u{e011}" });
        still(&b);
        let hit =
            |k: i32| b.value(&format!("etalonViewer.pick({}, {})", (0.35 + 0.03 * f64::from(k)) * width, 0.6 * height));
        (0..10).filter_map(|k| hit(k).as_u64()).any(|n| gone.contains(&(n as usize)))
    };
    assert!(picked(1.0), "the block stands before the edit");
    assert!(!picked(0.0), "and is gone after it");
    assert_eq!(b.complaints(), Vec::<String>::new());
}

#[test]
fn a_film_shows_the_steps_of_a_series() {
    let shop = shop();
    let Some(b) = opened(&shop.film()) else { return };
    let steps = b.value("Number(document.getElementById('viewer-step').max) + 1").as_u64().expect("a number");
    assert!((3..=24).contains(&steps), "{steps}");
    let first = pixels(&b);
    let label = "document.getElementById('viewer-step-label').textContent";
    let told = b.value(label);
    b.run(&format!("etalonViewer.step({})", steps - 1));
    still(&b);
    assert!(changed(&first, &pixels(&b)) > 0.1);
    assert_ne!(b.value(label), told);
    b.run("etalonViewer.step(0); document.getElementById('viewer-play').click()");
    b.wait("Number(document.getElementById('viewer-step').value) >= 2");
    assert_eq!(b.complaints(), Vec::<String>::new());
}

#[test]
fn whatever_things_are_called_stays_text() {
    let shop = shop();
    let Some(b) = opened(&shop.page()) else { return };
    assert!(!b.asks());
    assert_eq!(b.value("document.querySelector('h1').textContent"), json!(ATTACK));
    assert_eq!(
        // The charts keep their data in scripts that are none.
        b.value(
            "document.querySelectorAll('main script:not([type=\"application/json\"]), h1 b, .viewer-panel b').length"
        ),
        json!(0)
    );
    let camera = b.value("document.getElementById('viewer-camera').options[0].textContent");
    assert_eq!(camera, json!(format!("camera {ATTACK}")));
    // Patch 0 belongs to the floor, of the white material.
    b.run("etalonViewer.select(0)");
    let panel = b.value("document.getElementById('viewer-panel').textContent");
    assert_eq!(panel.as_str().expect("text").matches(ATTACK).count(), 2);
    assert!(!b.asks());
}

#[test]
fn the_dark_the_narrow_and_the_printed_page_work() {
    let shop = shop();
    let Some(b) = opened(&shop.page()) else { return };
    b.prefer(&[("prefers-color-scheme", "dark"), ("prefers-reduced-motion", "reduce")]);
    b.resize(500, 900);
    in_sight(&b);
    assert_eq!(b.value("document.documentElement.scrollWidth <= innerWidth"), json!(true));
    let colours: BTreeSet<_> = pixels(&b).pixels().map(|p| p.0).collect();
    assert!(colours.len() > 40, "{} colours", colours.len());
    assert!(b.print().starts_with(b"%PDF"));
    assert_eq!(b.complaints(), Vec::<String>::new());
}

#[test]
fn without_webgl_the_page_says_so_and_keeps_its_pictures() {
    let shop = shop();
    let Some(b) = browser(&["--disable-3d-apis"]) else { return };
    b.open(&shop.page());
    assert_eq!(b.value("document.getElementById('viewer-missing').hidden"), json!(false));
    assert_eq!(b.value("document.getElementById('viewer').hidden"), json!(true));
    assert_eq!(b.value("document.querySelectorAll('.figures img').length > 5"), json!(true));
    assert_eq!(b.complaints(), Vec::<String>::new());
}

/// `ETALON_PAGE=report.html cargo test --release --test browser -- --ignored --nocapture`: how long a page takes.
#[test]
#[ignore = "a measurement, not a check"]
fn how_long_a_page_takes() {
    let page = std::env::var_os("ETALON_PAGE").expect("ETALON_PAGE names the page to be timed");
    let Some(b) = browser(&[]) else { return };
    b.resize(1400, 1000);
    b.open(Path::new(&page));
    b.wait("window.etalonViewer && etalonViewer.ready");
    println!("ready after {} ms", b.value("Math.round(etalonViewer.readyAfter)"));
    let turn = "const t = []; for (let k = 0; k < 20; k++) { const a = performance.now(); etalonViewer.turn(0.05); \
                etalonViewer.pick(5, 5); t.push(performance.now() - a); } t.sort((x, y) => x - y); return t;";
    println!("a frame, ms: {}", b.run(turn));
}
