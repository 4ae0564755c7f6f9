//! The charts of pages as a reader has them: in a browser, with the mouse and with keys alone.

#[path = "common/browser.rs"]
mod browser;

use browser::{Browser, browser};
use etalon::report::curves::{About, CURVES_PAGE, CurvesReport, convergence_files, read_curves};
use etalon::report::save;
use etalon::study::converge::digest;
use std::path::Path;
use std::process::Command;

/// A name that would be markup, a template of the library and the end of a script at once.
const NAME: &str = "<b>mine</b></script>%{y}&amp;";
/// Keys of WebDriver.
const ENTER: &str = "\u{e007}";
const RIGHT: &str = "\u{e014}";

/// Two methods whose errors are known: 1.5 / shots and 0.3 / shots, 2 % wide.
fn write_curves(folder: &Path) {
    let mut table = String::from(
        "method,edit,shots,rays,seconds,shots_since_edit,rays_since_edit,seconds_since_edit,rms,rms_std_err,rms_low,\
         rms_high,top1,top1_std_err,top1_low,top1_high,noise_floor,top1_noise_floor\n",
    );
    for (method, scale) in [(NAME, 1.5), ("redistribution", 0.3)] {
        for shots in [0u32, 5, 10, 20, 50, 100, 200, 500, 1000] {
            let e = scale / f64::from(shots.max(3));
            let (rays, seconds) = (64 * shots, 0.01 * f64::from(shots));
            let costs = format!("{shots},{rays},{seconds}");
            table += &format!("{method},0,{costs},{costs},{e},{},{},{},,,,,1e-4,\n", 0.005 * e, 0.99 * e, 1.01 * e);
        }
    }
    let curves = read_curves(table.as_bytes()).expect("curves");
    let about = About { scene: NAME.into(), confidence: 0.95, replay: "etalon converge".into(), ..About::default() };
    let report = CurvesReport { digest: digest(&curves, 0.95), about, curves, pictures: Vec::new(), film: None };
    save(folder, &convergence_files(&report).expect("files")).expect("a folder");
}

/// A page of curves in a browser.
fn opened(browser: &Browser) -> tempfile::TempDir {
    let place = tempfile::tempdir().expect("a folder");
    write_curves(place.path());
    browser.resize(1400, 1000);
    browser.open(&place.path().join(CURVES_PAGE));
    browser.run(
        "window.chart = document.getElementById('rms-shots-edit-0'); window.stage = chart.querySelector('.stage');",
    );
    browser.run("stage.scrollIntoView({ block: 'center' });");
    browser.settle();
    place
}

/// The point of the window where the chart has so many shots, in the middle of its height.
fn at_shots(browser: &Browser, shots: f64) -> [f64; 2] {
    let x = browser.value(&format!(
        "stage.getBoundingClientRect().left + stage._fullLayout._size.l + stage._fullLayout.xaxis.d2p({shots})"
    ));
    let y = browser.value("stage.getBoundingClientRect().top + stage._fullLayout._size.t + 90");
    [x.as_f64().expect("a place"), y.as_f64().expect("a place")]
}

fn text(browser: &Browser, expression: &str) -> String {
    browser.value(expression).as_str().unwrap_or_default().to_string()
}

#[test]
fn pointing_at_a_hundred_shots_says_what_the_table_says() {
    let Some(browser) = browser(&[]) else { return };
    let place = opened(&browser);
    assert_eq!(browser.value("document.querySelectorAll('.chart.drawn').length"), 3);
    assert_eq!(browser.value("document.querySelectorAll('.chart:not(.drawn)').length"), 0);
    browser.click(at_shots(&browser, 103.0));
    browser.wait("stage.querySelector('.hoverlayer .legend, .hoverlayer .hovertext')");
    let said = text(&browser, "stage.querySelector('.hoverlayer').textContent");
    let table = std::fs::read(place.path().join("rms-shots-edit-0.csv")).expect("a table");
    let mut rows = csv::Reader::from_reader(table.as_slice());
    let at_hundred: Vec<csv::StringRecord> =
        rows.records().map(|r| r.expect("a row")).filter(|r| &r[1] == "100.0").collect();
    assert_eq!(at_hundred.len(), 2);
    for row in &at_hundred {
        let per_cent = |k: usize| 100.0 * row[k].parse::<f64>().expect("a number");
        let places = if per_cent(2) > 1.0 { 3 } else { 4 };
        let shown = format!(
            "{:.places$}\u{202f}% ({:.places$} to {:.places$}\u{202f}%)",
            per_cent(2),
            per_cent(4),
            per_cent(5)
        );
        assert!(said.contains(&shown), "{shown}: {said}");
        assert!(said.contains(&row[0]), "{}: {said}", &row[0]);
    }
    assert!(said.contains("at 100 shots, 6,400 rays"), "{said}");
    assert_eq!(browser.complaints(), Vec::<String>::new());
    assert_eq!(browser.requests(), Vec::<String>::new());
}

#[test]
fn methods_are_taken_out_and_put_back_and_axes_switch() {
    let Some(browser) = browser(&[]) else { return };
    let _place = opened(&browser);
    let shown = "stage._fullData.filter(t => t.visible === true && t.text).map(t => t.meta).join()";
    assert_eq!(text(&browser, shown), "0,1");
    let lines = "stage.querySelectorAll('.scatterlayer .trace').length";
    let all = browser.value(lines);
    // By key alone.
    browser.run("chart.querySelector('[data-series=\"0\"]').focus();");
    browser.keys(ENTER);
    browser.settle();
    assert_eq!(text(&browser, shown), "1");
    assert_eq!(text(&browser, "chart.querySelector('[data-series=\"0\"]').getAttribute('aria-pressed')"), "false");
    assert!(browser.value(lines).as_u64() < all.as_u64());
    browser.keys(ENTER);
    browser.settle();
    assert_eq!((text(&browser, shown).as_str(), browser.value(lines)), ("0,1", all));
    for wanted in ["0", "0,1"] {
        browser.run(
            "chart.querySelector('[data-series=\"0\"]').dispatchEvent(new MouseEvent('dblclick', { bubbles: true }));",
        );
        browser.settle();
        assert_eq!(text(&browser, shown), wanted);
    }
    for (axis, name) in [("y", "yaxis"), ("x", "xaxis")] {
        for kind in ["linear", "log"] {
            browser.run(&format!("chart.querySelector('.log-{axis}').click();"));
            browser.settle();
            assert_eq!(text(&browser, &format!("stage._fullLayout.{name}.type")), kind);
        }
    }
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn arrow_keys_go_from_snapshot_to_snapshot_and_say_them() {
    let Some(browser) = browser(&[]) else { return };
    let _place = opened(&browser);
    browser.run("stage.focus();");
    browser.keys(&RIGHT.repeat(3));
    browser.settle();
    let said = text(&browser, "chart.querySelector('.said').textContent");
    assert!(said.contains("redistribution 3.00") && said.contains("at 10 shots, 640 rays"), "{said}");
    assert!(said.contains("%{y}"), "{said}");
    let before = browser.value("stage.layout.xaxis.range[1] - stage.layout.xaxis.range[0]").as_f64();
    browser.keys("+");
    browser.settle();
    assert!(browser.value("stage.layout.xaxis.range[1] - stage.layout.xaxis.range[0]").as_f64() < before);
    browser.keys("0");
    browser.settle();
    assert_eq!(browser.value("stage.layout.xaxis.range[1] - stage.layout.xaxis.range[0]").as_f64(), before);
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn names_stay_text_in_light_and_in_dark() {
    let Some(browser) = browser(&[]) else { return };
    let _place = opened(&browser);
    assert_eq!(text(&browser, "chart.querySelector('.keys span').textContent"), NAME);
    assert_eq!(browser.value("document.querySelectorAll('.keys b, .hoverlayer b, svg b, h1 b').length"), 0);
    let line = "stage._fullData.find(t => t.meta === 0 && t.text).line.color.toLowerCase()";
    assert_eq!(text(&browser, line), "#0072b2");
    browser.prefer(&[("prefers-color-scheme", "dark")]);
    browser.wait(&format!("{line} === '#58aee8'"));
    browser.resize(500, 900);
    // Nothing is wider than a narrow window.
    browser.wait("innerWidth === 500 && document.documentElement.scrollWidth <= 500");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

fn etalon(folder: &Path, arguments: &str) {
    let run = Command::new(env!("CARGO_BIN_EXE_etalon")).args(arguments.split(' ')).current_dir(folder).output();
    let run = run.expect("the program");
    assert!(run.status.code().is_some_and(|c| c <= 1), "{}", String::from_utf8_lossy(&run.stderr));
}

/// A real check: its histograms and the budget of its error, by the marks they are drawn with.
#[test]
fn a_report_draws_its_histograms_and_its_budget() {
    let Some(browser) = browser(&[]) else { return };
    let place = tempfile::tempdir().expect("a folder");
    let scene = "builtin:cube-one-emitter";
    etalon(place.path(), &format!("reference {scene} --rays 256 --estimator rays -o ref"));
    etalon(
        place.path(),
        &format!("solve {scene} --method hemicube:resolution=10 -o sol.csv --save-form-factors ff.npz"),
    );
    etalon(place.path(), "check sol.csv --reference ref --form-factors ff.npz --max-rms 90% --report rep");
    browser.open(&place.path().join("rep/report.html"));
    browser.settle();
    let bars = |stem: &str| {
        browser.value(&format!("document.querySelectorAll('#{stem} .barlayer .point path').length")).as_u64()
    };
    assert!(bars("errors") > Some(1) && bars("noise") > Some(1), "{:?} {:?}", bars("errors"), bars("noise"));
    let rows =
        std::fs::read_to_string(place.path().join("rep/budget.csv")).expect("a table").lines().count() as u64 - 1;
    assert!(rows >= 3 && bars("budget") == Some(rows), "{rows} {:?}", bars("budget"));
    assert_eq!(browser.complaints(), Vec::<String>::new());
    assert_eq!(browser.requests(), Vec::<String>::new());
}
