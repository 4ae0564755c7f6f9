//! `etalon check --residual` and `etalon compare --residual`: a solution judged without a reference.

use super::bench::{Input, fit};
use super::check::exit_code;
use super::inputs;
use crate::cli::args::{CheckArgs, CompareArgs, Kernel};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::cli::values::PerLevel;
use crate::io::{BandNames, SolutionFormat, write_solution};
use crate::metrics::{
    ErrorBounds, Judged, Rebounded, Remedy, ResidualDecision, ResidualMetrics, Verdict, bound_error, decide_residual,
};
use crate::scene::Stage;
use crate::solution::Radiosity;
use crate::study::{Receivers, ResidualRequest, ResidualRun, Session, residual};
use serde_json::{Value, json};
use std::fmt::Write;
use std::time::{Duration, Instant};

/// How many of the causes people are shown.
const SHOWN: usize = 5;
/// Share of the denominator of eq. 7 above which emitters hide what is reflected.
const EMITTERS_DOMINATE: f64 = 0.5;

/// Bounds, no verdict.
pub fn compare(args: &CompareArgs, kernel: Kernel, console: &Console) -> Result<u8, Failure> {
    let run = Run::new(args, kernel, None, console)?;
    console.result(&run.text(None), &run.json(None));
    Ok(exit::DONE)
}

/// Bounds, limit, verdict.
pub fn check(args: &CheckArgs, kernel: Kernel, console: &Console) -> Result<u8, Failure> {
    if args.max_top1.is_some() {
        return Err(Failure::input(
            "--max-top1 needs a reference: a residual bounds the error of the whole scene, not of some patches; use \
             --max-rms, or --reference instead of --residual",
        ));
    }
    let Some(limit) = args.max_rms else {
        return Err(Failure::input("a check needs a limit: give --max-rms"));
    };
    if args.junit.is_some() {
        return Err(Failure::input("--junit cannot be written with --residual; use --json"));
    }
    let run = Run::new(&args.compare, kernel, args.max_time.map(|t| t.0), console)?;
    let decision = decide_residual(&run.metrics, limit.0);
    console.result(&run.text(Some(&decision)), &run.json(Some(&decision)));
    Ok(exit_code(decision.verdict, args.on_inconclusive))
}

/// A finished judgement.
struct Run<'a> {
    args: &'a CompareArgs,
    stage: Stage,
    kernel: (String, String),
    cast: ResidualRun,
    metrics: ResidualMetrics,
    seconds: f64,
}

impl<'a> Run<'a> {
    /// Reads, casts, bounds, and writes the map where one is asked for.
    fn new(
        args: &'a CompareArgs,
        kernel: Kernel,
        max_time: Option<Duration>,
        console: &Console,
    ) -> Result<Self, Failure> {
        let begin = Instant::now();
        check_options(args)?;
        let scene = args.scene.as_deref().ok_or_else(|| Failure::input("--residual needs --scene SCENE"))?;
        let stage = inputs::stage_of(&inputs::scene(scene, args.max_edge, console)?, args.state)?;
        if !stage.lights.is_empty() {
            let message =
                "point lights are not taken by --residual in this version: judge by a reference, --reference DIR";
            return Err(Failure::input(message).at(scene.to_string()));
        }
        let receivers = Receivers::patches(&stage);
        let solution = solution(args, &receivers, &stage)?;
        let session = inputs::session(&stage, inputs::kernel_kind(kernel), console)?;
        let options = &args.residual;
        let request = ResidualRequest {
            rays: options.rays,
            randomisations: options.randomisations,
            bounces: options.bounces,
            seed: options.seed,
            max_time,
        };
        let cast = residual(&session, &solution, &request, console)?;
        console.end();
        let metrics = bounds(&solution, &cast, &receivers, &stage, args)?;
        tell(&cast, &metrics, &session, args, console);
        let kernel = (session.kernel().name.clone(), session.kernel().version.clone());
        drop(session);
        let run = Self { args, stage, kernel, cast, metrics, seconds: begin.elapsed().as_secs_f64() };
        run.save_map(&receivers)?;
        Ok(run)
    }

    fn save_map(&self, receivers: &Receivers) -> Result<(), Failure> {
        let Some(path) = &self.args.residual.save_residual else { return Ok(()) };
        let (hash, present) = (self.stage.hash(), receivers.present());
        let bands = &self.stage.photometry.bands;
        let names = BandNames { scene: &self.stage.name, scene_hash: &hash, bands, present: &present };
        inputs::write(path, &write_solution(&self.cast.residual.mean(), names, SolutionFormat::of(path)?))
    }

    fn text(&self, decision: Option<&ResidualDecision>) -> String {
        let (m, name) = (&self.metrics, self.args.solution.display());
        let light = if self.args.reflected { "reflected luminance" } else { "luminance" };
        let error = format!("the error of its {light} is {}", between(&m.error_bounds));
        let mut out = match decision {
            None => format!("COMPARED  {name}: {error}; no limit was given.\n"),
            Some(d) => format!("{}  {name} {}: {error}{}.\n", word(d.verdict), verb(d.verdict), against(d)),
        };
        let _ = writeln!(out, "  bounds hold at {} confidence; no reference, no system solved", percent(m.confidence));
        if let Some(r) = m.residual {
            let noise = r.std_err.map_or(String::new(), |e| format!(" \u{b1} {}", percent(e)));
            let _ = writeln!(out, "  residual E + rho F B - B: {}{noise} of the solution (area RMS)", percent(r.value));
        }
        let _ = writeln!(
            out,
            "  {} bounces, brightest reflectance {:.3}: {} of any error is left open",
            m.bounces,
            m.rho_max,
            percent(m.left_over)
        );
        let _ = writeln!(
            out,
            "  {} patches, {} rays each in {} randomisations ({} in all), kernel {} {}",
            inputs::thousands(m.patches as u64),
            inputs::thousands(self.cast.rays_per_patch),
            self.cast.residual.count(),
            inputs::thousands(self.cast.tally.rays),
            self.kernel.0,
            self.kernel.1
        );
        out + self.causes().trim_end()
    }

    /// Where the residual is made.
    fn causes(&self) -> String {
        let mut out = String::from("\nwhere it is made (residual above zero: too dark for the light it receives)\n");
        for s in self.metrics.surfaces.iter().take(SHOWN).filter(|s| s.share > 0.0) {
            let mean = with_error(s.mean, s.std_err);
            let _ = writeln!(out, "  surface {:<20} {:>7} of it, mean {mean} W/m^2", s.surface, percent(s.share));
        }
        for w in self.metrics.worst.iter().take(SHOWN) {
            let residual = with_error(w.residual, w.std_err);
            let _ = writeln!(out, "  patch {:<8} of {:<14} {residual} W/m^2", w.patch, w.surface);
        }
        out
    }

    fn json(&self, decision: Option<&ResidualDecision>) -> Value {
        let mut out = json!({ "solution": self.args.solution.display().to_string(), "scene": self.stage.name });
        if let Some(d) = decision {
            out["verdict"] = json!(d.verdict);
            out["max_rms"] = json!(d.limit);
            out["remedy"] = json!(d.remedy);
        }
        let metrics = serde_json::to_value(&self.metrics).expect("metrics serialise");
        for (key, value) in metrics.as_object().into_iter().flatten() {
            out[key] = value.clone();
        }
        out["truth"] = json!("patch-system");
        out["reflected"] = json!(self.args.reflected);
        out["rays_per_patch"] = json!(self.cast.rays_per_patch);
        out["randomisations"] = json!(self.cast.residual.count());
        out["seed"] = json!(self.args.residual.seed);
        out["rays"] = json!(self.cast.tally.rays);
        out["escapes"] = json!(self.cast.tally.escapes);
        out["back_hits"] = json!(self.cast.tally.back_hits);
        out["shortened_by_max_time"] = json!(self.cast.shortened);
        out["kernel"] = json!(self.kernel.0);
        out["kernel_version"] = json!(self.kernel.1);
        out["seconds"] = json!(self.seconds);
        out
    }
}

/// Refuses what a residual cannot answer, before any work.
fn check_options(args: &CompareArgs) -> Result<(), Failure> {
    if args.per == PerLevel::Element {
        return Err(Failure::input(
            "--residual judges patches: an element value is one gather and has no residual of its own; use --per patch",
        ));
    }
    if !(0.0..1.0).contains(&args.confidence.0) || args.confidence.0 == 0.0 {
        return Err(Failure::input("--confidence must lie between 0 and 1: 0.95 for example"));
    }
    if let Some(path) = &args.residual.save_residual {
        SolutionFormat::of(path)?;
        inputs::check_writable(path)?;
    }
    Ok(())
}

/// The solution, which must belong to the scene.
fn solution(args: &CompareArgs, receivers: &Receivers, stage: &Stage) -> Result<Radiosity, Failure> {
    let path = &args.solution;
    let input = Input::read(path)?;
    if let Input::Reference(r) = &input
        && r.scene_hash != stage.hash()
    {
        let message = format!("{}: this reference does not belong to --scene in this state", path.display());
        return Err(Failure::input(message + "; name the scene it was computed for").at(path.display().to_string()));
    }
    fit(path, input, receivers, false, stage)
}

fn bounds(
    solution: &Radiosity,
    cast: &ResidualRun,
    receivers: &Receivers,
    stage: &Stage,
    args: &CompareArgs,
) -> Result<ResidualMetrics, Failure> {
    let surfaces: Vec<&str> = receivers.surfaces.iter().map(String::as_str).collect();
    let judged = Judged {
        areas: &receivers.areas,
        emission: &receivers.emission,
        surfaces: &surfaces,
        bands: &receivers.photometry.bands,
        weights: &receivers.photometry.weights,
    };
    let reflectance = stage.reflectances();
    let rebounded =
        Rebounded { residual: &cast.residual, series: &cast.series, bounces: cast.bounces, reflectance: &reflectance };
    Ok(bound_error(solution, &rebounded, &judged, args.confidence.0, args.reflected)?)
}

/// Things the user should know.
fn tell(cast: &ResidualRun, metrics: &ResidualMetrics, session: &Session, args: &CompareArgs, console: &Console) {
    if cast.shortened {
        let rays = inputs::thousands(cast.rays_per_patch);
        console.notice(&format!("--max-time left room for {rays} rays per patch; the bounds hold for these"));
    }
    let lost = cast.tally.escapes + cast.tally.back_hits;
    if session.stage().enclosure == Some(true) && lost > 0 {
        let lost = inputs::thousands(lost);
        console
            .notice(&format!("the scene says it is closed, but {lost} rays found no front; see `etalon scene check`"));
    }
    if metrics.emitter_share > EMITTERS_DOMINATE && !args.reflected {
        let share = percent(metrics.emitter_share);
        console.notice(&format!("emitters hold {share} of what the error is measured against; see --reflected"));
    }
}

fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "PASS",
        Verdict::Fail => "FAIL",
        Verdict::Inconclusive => "INCONCLUSIVE",
    }
}

fn verb(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "passes",
        Verdict::Fail => "fails",
        Verdict::Inconclusive => "is not decided",
    }
}

fn between(b: &ErrorBounds) -> String {
    match b.high {
        Some(high) => format!("between {} and {}", percent(b.low), percent(high)),
        None => format!("at least {} (it may be as large as the light itself)", percent(b.low)),
    }
}

/// What the bounds are held against, and what would decide an open case.
fn against(d: &ResidualDecision) -> String {
    let remedy = match d.remedy {
        None => String::new(),
        Some(Remedy::MoreRays(factor)) => format!("; about {factor} times the rays would decide (--rays)"),
        Some(Remedy::MoreBounces(n)) => format!("; the bounds are too far apart: --bounces {n} would decide"),
        Some(Remedy::Reference) => {
            "; more rays would not tell: a residual cannot come closer, judge it with --reference".into()
        }
    };
    format!(", limit {}{remedy}", percent(d.limit))
}

/// Three significant figures.
fn percent(x: f64) -> String {
    let p = 100.0 * x;
    let decimals = if p == 0.0 { 0 } else { (2.0 - p.abs().log10().floor()).clamp(0.0, 9.0) as usize };
    if p != 0.0 && p.abs() < 1e-6 { format!("{p:.1e} %") } else { format!("{p:.decimals$} %") }
}

fn with_error(value: f64, std_err: Option<f64>) -> String {
    match std_err {
        Some(e) if e > 0.0 => format!("{value:+.3e} \u{b1} {e:.1e}"),
        _ => format!("{value:+.3e}"),
    }
}
