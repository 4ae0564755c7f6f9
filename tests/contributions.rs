//! What lights a patch, against closed forms: a cube whose 6 x 6 system has an exact solution.

use etalon::estimate::Plan;
use etalon::io::StoredReference;
use etalon::io::scene::builtin;
use etalon::raycast::KernelKind;
use etalon::reference::{Options, Progress};
use etalon::scene::Stage;
use etalon::solution::Radiosity;
use etalon::study::{self, Contributions, Rows, Session, Source, contributions};

/// Form factors of the faces of a cube: opposite, adjacent.
const OPPOSITE: f64 = 0.199_824_895_698_387_38;
const ADJACENT: f64 = 0.200_043_776_075_403_15;

struct Silent;

impl Progress for Silent {
    fn begin(&self, _: &str, _: Option<u64>) {}
    fn advance(&self, _: u64) {}
}

/// Radiosities of lamp, ceiling and walls at reflectance 1/2, by iterating the 3 x 3 system that symmetry leaves.
fn exact() -> [f64; 3] {
    let [mut lamp, mut ceiling, mut wall] = [1.0, 0.0, 0.0];
    for _ in 0..200 {
        let walls = 4.0 * ADJACENT * wall;
        let next_wall = 0.5 * (ADJACENT * (lamp + ceiling + 2.0 * wall) + OPPOSITE * wall);
        (lamp, ceiling, wall) = (1.0 + 0.5 * (OPPOSITE * ceiling + walls), 0.5 * (OPPOSITE * lamp + walls), next_wall);
    }
    [lamp, ceiling, wall]
}

fn cube() -> Stage {
    builtin("cube-one-emitter").expect("a built-in scene").at(0).expect("a state")
}

fn explained(stage: &Stage, solution: &dyn Fn(&[f64]) -> Vec<f64>) -> (StoredReference, Contributions) {
    let session = Session::open(stage, KernelKind::Builtin).expect("kernels");
    let options = Options { plan: Plan { rays: 32_768, ..Plan::default() }, seed: 3 };
    let (stored, _) = study::reference(&session, &options, &Silent).expect("a reference");
    let values = solution(&stored.patches.mean().values);
    let solution = Radiosity { bands: 1, values, std_err: None };
    let rows = Rows { receivers: &[1], elements: false, solution: &solution, sources: &solution, confidence: 0.999 };
    let mut all = contributions(&session, &stored, &rows);
    assert_eq!(all.len(), 1);
    (stored, all.remove(0))
}

fn source<'a>(c: &'a Contributions, name: &str) -> &'a Source {
    c.sources.iter().find(|s| s.surface == name).expect("a source")
}

#[test]
fn every_source_brings_what_the_closed_form_says() {
    let stage = cube();
    let [lamp, ceiling, wall] = exact();
    let (stored, c) = explained(&stage, &|b| b.to_vec());
    assert_eq!((c.surface.as_str(), c.receiver, c.emission, c.sources.len()), ("ceiling", 1, 0.0, 5));
    assert_eq!(c.sources[0].surface, "floor");
    for s in &c.sources {
        let (f, b) = if s.surface == "floor" { (OPPOSITE, lamp) } else { (ADJACENT, wall) };
        let (low, high) = (s.luminance.low, s.luminance.high);
        assert!(low <= 0.5 * f * b && 0.5 * f * b <= high, "{}: {} in [{low}, {high}]", s.surface, 0.5 * f * b);
        assert!(s.luminance.std_err.expect("an error") < 0.01 * s.luminance.value);
        assert!((s.form_factor / f - 1.0).abs() < 0.02);
    }
    assert!(c.sum.low <= ceiling && ceiling <= c.sum.high);
    // The same rays as the reference's: the sum is the reference but for the bias of order 1/R that it has shed.
    let reference = stored.patches.mean().values[1];
    assert!((c.sum.value / reference - 1.0).abs() < 1e-5, "{} {reference}", c.sum.value);
    assert!((c.sources.iter().filter_map(|s| s.share).sum::<f64>() - 1.0).abs() < 1e-12);
    assert!(c.difference.abs() < 1e-15 && c.handed_on.value.abs() < 1e-15 && c.own.value.abs() < 1e-15);
}

#[test]
fn an_error_is_told_apart_by_where_it_is_made() {
    let stage = cube();
    let (_, own) = explained(&stage, &|b| {
        let mut b = b.to_vec();
        b[1] += 0.1;
        b
    });
    assert!((own.difference - 0.1).abs() < 1e-12 && (own.own.value - 0.1).abs() < 1e-12, "{own:?}");
    assert!(own.handed_on.value.abs() < 1e-12);
    // A lamp 10 % too bright hands on a tenth of its light; the ceiling does not follow, so it errs the other way.
    let (stored, lamp) = explained(&stage, &|b| {
        let mut b = b.to_vec();
        b[0] *= 1.1;
        b
    });
    let floor = source(&lamp, "floor");
    assert!((floor.handed_on.value - 0.1 * floor.luminance.value).abs() < 1e-12);
    assert!((lamp.own.value + floor.handed_on.value).abs() < 1e-12 && lamp.difference.abs() < 1e-15);
    let exact = 0.5 * OPPOSITE * 0.1 * stored.patches.mean().values[0];
    assert!((floor.handed_on.value / exact - 1.0).abs() < 0.02);
}
