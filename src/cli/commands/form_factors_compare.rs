//! `etalon form-factors compare`

use super::{form_factors::Work, form_factors_check as check, form_factors_compare_told as told, inputs};
use crate::cli::args::{FormFactorsCompareArgs, MatrixArgs};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::formfactor::Surroundings;
use crate::io::{read_by_surface, surface_rows};
use crate::metrics::{Decision, MatrixLimits, MatrixRequest, Verdict, decide_matrix};
use crate::raycast::KernelKind;
use crate::scene::{OBSTRUCTIONS, Stage};
use crate::solution::{FormFactors, SelfCheck};
use crate::stats::bonferroni_level;
use crate::study::{Session, compare_matrix};
use serde_json::json;

pub fn run(args: &FormFactorsCompareArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    let limits = MatrixLimits { max_rms: args.max_rms.map(|x| x.0), max_entry: args.max_entry.map(|x| x.0) };
    let request = request(args, &limits)?;
    let plan = inputs::plan(&args.rays)?;
    let stage = check::stage(&args.matrix, console)?;
    crate::reference::check_size(&stage, &plan)?;
    let given = read_theirs(args, &stage, console)?;
    let session = inputs::session(&stage, kernel, console)?;
    let judge = Judge::of(args, &session, console)?;
    let sides = Sides::of(&stage, given, judge.form_factors, session.is_enclosure(), console);
    let around = sides.surroundings(&stage);
    let run = compare_matrix(&sides.theirs, &sides.judge, &around, request);
    let decision = (limits.given() > 0).then(|| decide_matrix(&run.comparison, &limits));
    let subject =
        told::Subject { file: &args.matrix.file, judge: &judge.source, rows: sides.rows(), names: &sides.names };
    let json = json!({
        "file": args.matrix.file, "scene": stage.name, "scene_hash": stage.hash(), "patches": stage.patch_count(),
        "rows": sides.rows(), "judged_by": judge.source, "judge_relative_error": judge.relative_error,
        "comparison": run.comparison, "explanation": run.explanation, "witnesses": run.witnesses,
        "physics": { "theirs": run.theirs, "judge": run.judge },
        "verdict": decision.as_ref().map(|d| d.verdict), "limits": decision.as_ref().map(|d| &d.limits),
        "self_check": judge.checks.checks, "passed_self_check": judge.checks.passed(),
    });
    console.result(&told::run(&subject, &run, decision.as_ref()), &json);
    for c in judge.checks.failures() {
        console.notice(&format!("the judge's matrix failed its self-check of {}: {}", c.name, c.finding));
    }
    Ok(exit_code(&judge.checks, decision.as_ref()))
}

fn exit_code(checks: &SelfCheck, decision: Option<&Decision>) -> u8 {
    match decision.map(|d| d.verdict) {
        _ if !checks.passed() => exit::SELF_CHECK,
        None | Some(Verdict::Pass) => exit::DONE,
        Some(Verdict::Fail) => exit::FAIL,
        Some(Verdict::Inconclusive) => exit::INCONCLUSIVE,
    }
}

/// The confidence is shared out where both limits are given.
fn request(args: &FormFactorsCompareArgs, limits: &MatrixLimits) -> Result<MatrixRequest, Failure> {
    let confidence = args.confidence.0;
    // Below 0.8 the bound on the norm of the judge's error would not hold for all correlations.
    if !(0.8..1.0).contains(&confidence) {
        return Err(Failure::input(format!("--confidence {confidence} must be from 0.8 to below 1")));
    }
    Ok(MatrixRequest {
        confidence: 1.0 - bonferroni_level(1.0 - confidence, limits.given().max(1)),
        judge_freedom: f64::from(args.rays.randomisations - 1),
        their_freedom: f64::from(args.their_randomisations - 1),
    })
}

/// Their matrix, by patch or by surface.
enum Given {
    ByPatch(FormFactors),
    BySurface(FormFactors),
}

fn read_theirs(args: &FormFactorsCompareArgs, stage: &Stage, console: &Console) -> Result<Given, Failure> {
    let by_surface = read_by_surface(&args.matrix.file, stage)?;
    if by_surface.is_some() && args.matrix.std_err.is_some() {
        let message = "--std-err goes with a matrix that has a row per patch; this one has a row per surface";
        return Err(Failure::input(message).at(args.matrix.file.display().to_string()));
    }
    match by_surface {
        Some(f) => Ok(Given::BySurface(f)),
        None => check::matrix(&args.matrix, stage, console).map(Given::ByPatch),
    }
}

/// The judge's form factors by patch, and where they come from.
struct Judge {
    form_factors: FormFactors,
    source: String,
    relative_error: Option<f64>,
    checks: SelfCheck,
}

impl Judge {
    fn of(args: &FormFactorsCompareArgs, session: &Session, console: &Console) -> Result<Self, Failure> {
        let Some(file) = &args.reference else {
            return Self::computed(args, session, console);
        };
        let stored = MatrixArgs {
            file: file.clone(),
            scene: args.matrix.scene.clone(),
            state: args.matrix.state,
            max_edge: args.matrix.max_edge,
            std_err: args.reference_std_err.clone(),
        };
        let form_factors = check::matrix(&stored, session.stage(), console)?;
        if form_factors.std_err.is_none() {
            console.notice(&format!("{} states no errors: taken as exact", file.display()));
        }
        let checks = SelfCheck { checks: Vec::new() };
        Ok(Self { form_factors, source: file.display().to_string(), relative_error: None, checks })
    }

    fn computed(args: &FormFactorsCompareArgs, session: &Session, console: &Console) -> Result<Self, Failure> {
        let work = Work::of(session, &inputs::plan(&args.rays)?, args.rays.seed, console);
        let form_factors = work.blend().form_factors();
        let checks = work.checks(session, &form_factors);
        let error = work.relative_error;
        let source = format!("the judge (relative error {error:.1e}, seed {})", args.rays.seed);
        Ok(Self { form_factors, source, relative_error: Some(error), checks })
    }
}

/// Both matrices with the same rows.
struct Sides {
    theirs: FormFactors,
    judge: FormFactors,
    names: Vec<String>,
    areas: Vec<f64>,
    closed: bool,
    by_surface: bool,
}

impl Sides {
    fn of(stage: &Stage, given: Given, judge: FormFactors, closed: bool, console: &Console) -> Self {
        match given {
            Given::ByPatch(theirs) => {
                let (areas, left_out) = areas_stated(stage, &theirs);
                if left_out > 0 {
                    console.notice(&format!("{left_out} patches of obstructions have no rows in the file: left out"));
                }
                let names = (0..stage.patch_count()).map(|i| stage.surface_name(i).to_string()).collect();
                Self { theirs, judge, names, areas, closed: closed && left_out == 0, by_surface: false }
            }
            Given::BySurface(theirs) => {
                let rows = surface_rows(stage, &judge);
                let blocked = stage.surfaces.iter().any(|s| s.object == OBSTRUCTIONS);
                let (names, areas) = (rows.names, rows.areas);
                Self { theirs, judge: rows.form_factors, names, areas, closed: closed && !blocked, by_surface: true }
            }
        }
    }

    fn surroundings<'a>(&self, stage: &'a Stage) -> Surroundings<'a> {
        let patches = if self.by_surface { &[][..] } else { &stage.patches };
        Surroundings { areas: self.areas.clone(), closed: self.closed, patches }
    }

    fn rows(&self) -> &'static str {
        if self.by_surface { "surfaces" } else { "patches" }
    }
}

/// Areas, 0 for obstructions of which they state nothing; and how many those are.
fn areas_stated(stage: &Stage, theirs: &FormFactors) -> (Vec<f64>, usize) {
    let mut stated = vec![false; theirs.n];
    for i in 0..theirs.n {
        theirs.row(i).for_each(|(j, _)| (stated[i], stated[j]) = (true, true));
    }
    let blocks = |i: usize| stage.surfaces[stage.patches[i].surface as usize].object == OBSTRUCTIONS;
    let mut areas = stage.areas();
    let mut left_out = 0;
    for (i, area) in areas.iter_mut().enumerate() {
        if blocks(i) && !stated[i] && *area > 0.0 {
            *area = 0.0;
            left_out += 1;
        }
    }
    (areas, left_out)
}
