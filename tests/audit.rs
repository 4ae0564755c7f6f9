//! The audit of hemi-cubes: errors add up, published numbers come out, causes are told apart, cures mend.

use etalon::audit::{Cause, Cure};
use etalon::estimate::{Estimator, Plan};
use etalon::io::scene::builtin;
use etalon::methods::hemicube::Params;
use etalon::methods::shooting::{self, Factors, Shooting};
use etalon::raycast::KernelKind;
use etalon::reference::{Options, Progress};
use etalon::scene::Stage;
use etalon::study::Session;
use etalon::study::audit::{AuditRequest, Audited, Form, audit};

struct Silent;

impl Progress for Silent {
    fn begin(&self, _: &str, _: Option<u64>) {}
    fn advance(&self, _: u64) {}
}

fn stage(name: &str, state: usize) -> Stage {
    builtin(name).expect("built in").at(state).expect("a state")
}

fn request<'a>(resolution: u32) -> AuditRequest<'a> {
    AuditRequest {
        scene: "test".into(),
        params: Params { resolution, ..Params::default() },
        resolutions: Vec::new(),
        rotations: 0,
        sources: Vec::new(),
        limit: None,
        confidence: 0.95,
        form: Form::Receiver,
        theirs: None,
        cures: false,
        reference: Options { plan: Plan { estimator: Estimator::Auto, ..Plan::default() }, ..Options::default() },
    }
}

fn audited(stage: &Stage, request: &AuditRequest) -> Audited {
    let session = Session::open(stage, KernelKind::Builtin).expect("a kernel");
    audit(&session, request, &Silent).expect("an audit")
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).fold(0.0, f64::max)
}

/// Of every pair, and of every radiosity: the parts are the whole, in both forms.
#[test]
fn causes_add_up() {
    for (name, form) in [("furnished-room", Form::Receiver), ("cornell-box-coarse", Form::Shooter)] {
        let stage = stage(name, 0);
        let a = audited(&stage, &AuditRequest { form, ..request(50) });
        let off = |p: &etalon::audit::Pair| Cause::ALL.iter().map(|c| p.part(*c)).sum::<f64>() - p.error();
        assert!(largest(a.split.pairs.iter().map(off)) < 1e-15, "{name}");
        let e = &a.effect;
        let difference = |k: usize| e.cube[k] - e.truth[k] - e.parts.iter().map(|p| p[k]).sum::<f64>();
        let scale = largest(e.truth.iter().copied());
        let worst = largest((0..e.truth.len()).map(difference));
        println!("{name}: {} pairs, parts of radiosities off by {:.1e}", a.split.pairs.len(), worst / scale);
        assert!(worst < 1e-9 * scale, "{name}: {worst}");
    }
}

/// A lamp of 0.5, 0.4 and 0.2 m, 10 m above patches whose hemi-cubes see it at known places: the counts are those
/// that a pencil finds, the form factors those of closed forms.
#[test]
fn one_small_lamp() {
    // State, probe, resolution, pixels counted, exact value at the centre.
    let known = [
        (2, "probe-axis", 50, 0.0, 1.273_069_803_2e-4),
        (2, "probe-centred-50", 50, 1.0, 1.271_035_874_7e-4),
        (2, "probe-off-centre", 50, 1.0, 1.272_337_027_0e-4),
        (0, "probe-axis", 50, 4.0, 7.951_121_495_8e-4),
        (0, "probe-centred-50", 50, 1.0, 7.938_436_062_3e-4),
        (0, "probe-axis", 100, 4.0, 7.951_121_495_8e-4),
        (0, "probe-centred-100", 100, 9.0, 7.947_947_290_7e-4),
        (1, "probe-axis", 100, 4.0, 5.090_243_454_8e-4),
    ];
    for (state, probe, resolution, pixels, exact) in known {
        let stage = stage("small-lamp", state);
        let a = audited(&stage, &AuditRequest { sources: vec!["lamp".into()], ..request(resolution) });
        let view = a.record.views.iter().find(|v| v.surface == probe).expect("the probe sees the lamp");
        assert!((view.point / exact - 1.0).abs() < 1e-9, "{probe} at {resolution}: {} {exact}", view.point);
        // The table of 1985 at the axis: h^2 / pi.
        let delta = (2.0 / f64::from(resolution)).powi(2) / std::f64::consts::PI;
        assert!((view.cube / delta - pixels).abs() < 2e-2 * pixels.max(0.1), "{probe}: {} pixels", view.cube / delta);
        let (source, seen) = (&a.record.sources[0], &a.record.sources[0].seen);
        assert_eq!(source.main_cause, Cause::Aliasing, "{probe}");
        assert!(seen.distance[0] < 3.0 && seen.distance[2] > 11.0);
        if state == 2 && resolution == 50 {
            // A quarter of a pixel at 10 m: most miss it, some count it four times.
            assert!(seen.missed > 0 && seen.doubled > 0 && seen.ratio[2] > 3.9, "{seen:?}");
        }
    }
}

/// The pixels beat with the patches: 1.25 pixels from one patch to the next come into step every four patches.
#[test]
fn beats_have_the_length_that_the_grids_give() {
    let stage = stage("small-lamp", 2);
    let a = audited(&stage, &AuditRequest { sources: vec!["lamp".into()], ..request(50) });
    let beats = &a.record.sources[0].seen.beats;
    let floor = beats.iter().find(|b| b.surface.starts_with("floor")).expect("beats on the floor");
    assert!((floor.patches - 4.0).abs() < 0.35 && (floor.period - 2.0).abs() < 0.2, "{floor:?}");
}

/// Each cause alone, in a scene where the others have nothing to do.
#[test]
fn each_cause_alone() {
    for (name, resolution, cause) in [
        ("aliasing-only", 50, Cause::Aliasing),
        ("proximity-only", 1024, Cause::Proximity),
        ("visibility-only", 1024, Cause::Visibility),
    ] {
        let stage = stage(name, 0);
        let a = audited(&stage, &request(resolution));
        let of = |c: Cause| a.record.alone[Cause::ALL.iter().position(|d| *d == c).expect("a cause")];
        let others = Cause::ALL.into_iter().filter(|c| *c != cause).map(of).fold(0.0, f64::max);
        println!("{name}: {cause:?} {:.3e}, others at most {others:.1e}", of(cause));
        assert!(of(cause) > 0.01 && others < 0.02 * of(cause), "{name}: {} {others}", of(cause));
        assert_eq!(a.record.sources[0].main_cause, cause, "{name}");
        assert!(a.record.findings.iter().any(|f| f.about == "source" && f.text.contains(cause.name())), "{name}");
        // Switched off, it takes the error with it.
        let k = Cause::ALL.iter().position(|d| *d == cause).expect("a cause");
        let (with, without) = (a.record.wrong.rms.expect("lit").value, a.record.without[k].rms.expect("lit").value);
        assert!(without < 0.03 * with, "{name}: {with} {without}");
    }
}

/// Two unit squares: what the centre has instead of the mean, with digits from elsewhere.
#[test]
fn proximity_of_known_size() {
    let stage = stage("proximity-only", 0);
    let a = audited(&stage, &request(1024));
    let pair = a.split.pairs.iter().find(|p| p.mean > 0.0).expect("they see each other");
    assert!((pair.mean - 0.415_253_283_577).abs() < 1e-11 && (pair.point - 0.554_126_423_980).abs() < 1e-11);
    assert!((pair.part(Cause::Proximity) - (0.554_126_423_980 - 0.415_253_283_577)).abs() < 1e-11);
    assert!(pair.part(Cause::Visibility).abs() < 1e-12 && pair.part(Cause::Aliasing).abs() < 2e-6);
}

/// The matrix of shooters is what progressive refinement converges to.
#[test]
fn shooters_are_progressive_refinement() {
    let stage = stage("cornell-box-coarse", 0);
    let a = audited(&stage, &AuditRequest { form: Form::Shooter, ..request(50) });
    let factors = Factors::Hemicube(Params { resolution: 50, ..Params::default() });
    let stop = shooting::Stop { unshot: 1e-9, ..shooting::Params::default().stop };
    let params = shooting::Params { factors, stop, ..shooting::Params::default() };
    let mut solver = Shooting::on(stage.clone(), params, KernelKind::Builtin, 0).expect("a solver");
    solver.converge();
    let b = solver.radiosity().values;
    let scale = largest(b.iter().copied());
    let worst = largest(b.iter().zip(&a.effect.cube).map(|(x, y)| x - y));
    assert!(worst < 1e-6 * scale, "{worst} of {scale}");
}

/// Cures do what they are for.
#[test]
fn cures_mend_their_cause() {
    let run = |name: &str, resolution| {
        let stage = stage(name, 0);
        audited(&stage, &AuditRequest { cures: true, limit: Some(0.01), ..request(resolution) }).record
    };
    let rms = |r: &etalon::study::audit::AuditRecord, holds: &dyn Fn(&Cure) -> bool| {
        let run = r.cures.iter().find(|c| holds(&c.cure)).expect("it was run");
        run.wrong.rms.expect("lit").value
    };
    let aliasing = run("aliasing-only", 50);
    let as_it_is = rms(&aliasing, &|c| *c == Cure::None);
    assert!((as_it_is / aliasing.wrong.rms.expect("lit").value - 1.0).abs() < 1e-9);
    assert!(rms(&aliasing, &|c| matches!(c, Cure::Analytic { .. })) < 1e-3);
    let finest = aliasing.cures.iter().filter_map(|c| match c.cure {
        Cure::Resolution { resolution } => Some((resolution, c.wrong.rms?.value)),
        _ => None,
    });
    let (_, finest) = finest.max_by_key(|f| f.0).expect("it was run");
    assert!(finest < 0.3 * as_it_is, "{finest} {as_it_is}");
    assert!(aliasing.sources[0].mended_by.is_some());

    let proximity = run("proximity-only", 256);
    let as_it_is = rms(&proximity, &|c| *c == Cure::None);
    let divided = rms(&proximity, &|c| matches!(c, Cure::Subdivision { cells: 4, .. }));
    let finer = rms(&proximity, &|c| matches!(c, Cure::Resolution { .. }));
    // No resolution helps a centre that stands for all.
    assert!(divided < 0.2 * as_it_is && finer > 0.95 * as_it_is, "{as_it_is} {divided} {finer}");
}

/// A point of the aliasing-free limit: the exact values at the centres are what fine hemi-cubes come to.
#[test]
fn infinite_resolution_is_the_limit() {
    let stage = stage("cornell-box-coarse", 0);
    let a = audited(&stage, &AuditRequest { resolutions: vec![50, 100, 200, 400, 800], ..request(50) });
    let errors: Vec<f64> = a.record.resolutions.iter().map(|r| r.aliasing).collect();
    let rate = a.record.rate.expect("a rate");
    println!("{errors:?} {rate:?}");
    assert!(errors.windows(2).all(|w| w[1] < w[0]));
    let (limit, last) = (a.record.infinite.rms.expect("lit").value, a.record.resolutions[4].wrong.rms.expect("lit"));
    assert!((last.value - limit).abs() < 2e-3, "{} {limit}", last.value);
}
