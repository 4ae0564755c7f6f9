//! `etalon audit hemicube`: the audit, its tables, its pictures and its page.

use super::check::exit_code;
use super::{audit_tables, inputs};
use crate::audit::unfold;
use crate::cli::args::{AuditArgs, AuditForm};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::io::{atomic, read_form_factors_of};
use crate::methods::hemicube::Params;
use crate::raycast::KernelKind;
use crate::reference::{Options, check_size};
use crate::render::views;
use crate::report::audit::{AuditExtras, AuditPicture, audit_files};
use crate::report::{Artifact, Phase, save};
use crate::scene::Stage;
use crate::study::Session;
use crate::study::audit::{AuditError, AuditRequest, Audited, Form, audit};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::time::Instant;

/// Item buffers drawn where nobody names patches: the worst receiver of so many sources.
const DRAWN: usize = 3;

impl From<AuditError> for Failure {
    fn from(e: AuditError) -> Self {
        match e {
            AuditError::Reference(e) => e.into(),
            AuditError::Judge(e) => e.into(),
            other => Self::input(other.to_string()),
        }
    }
}

pub fn run(args: &AuditArgs, kernel: KernelKind, console: &Console) -> Result<u8, Failure> {
    let begin = Instant::now();
    let params = params(args)?;
    if !(0.0..1.0).contains(&args.confidence.0) || args.confidence.0 == 0.0 {
        return Err(Failure::input("--confidence must lie between 0 and 1: 0.95 for example"));
    }
    atomic::check_folder(&args.output)?;
    let reference = Options { plan: inputs::plan(&args.rays)?, seed: args.rays.seed };
    let stage = inputs::stage(&args.scene, console)?;
    check_size(&stage, &reference.plan)?;
    check_patches(args, &stage)?;
    let theirs = args.form_factors.as_deref().map(|f| read_form_factors_of(f, &stage)).transpose()?;
    let session = inputs::session(&stage, kernel, console)?;
    let name = args.form_factors.as_ref().map(|f| f.display().to_string());
    let request = AuditRequest {
        scene: stage.name.clone(),
        params,
        resolutions: args.resolution.clone(),
        rotations: args.rotations,
        sources: args.source.clone(),
        limit: args.max_error.map(|f| f.0),
        confidence: args.confidence.0,
        form: match args.method {
            AuditForm::Matrix => Form::Receiver,
            AuditForm::Progressive => Form::Shooter,
        },
        theirs: theirs.as_ref().zip(name),
        cures: !args.no_cures,
        reference,
    };
    let audited = audit(&session, &request, console)?;
    console.end();
    let computed = Phase { name: "audit".into(), seconds: begin.elapsed().as_secs_f64() };
    write(args, &session, &params, &audited, computed)?;
    let record = &audited.record;
    console.result(&text(args, &audited), &summary(args, &audited)?);
    if !record.self_check_failures.is_empty() {
        return Ok(exit::SELF_CHECK);
    }
    Ok(record.verdict.map_or(exit::DONE, |v| exit_code(v, args.on_inconclusive)))
}

fn params(args: &AuditArgs) -> Result<Params, Failure> {
    if args.settings.contains("resolution") {
        return Err(Failure::input("--settings: the resolution is given by --resolution"));
    }
    let bad = |e: crate::methods::hemicube::HemicubeError| Failure::input(e.to_string());
    let settings = Params::parse(&args.settings).map_err(bad)?;
    for resolution in &args.resolution {
        Params { resolution: *resolution, ..settings }.validated().map_err(bad)?;
    }
    Ok(Params { resolution: args.resolution[0], ..settings })
}

fn check_patches(args: &AuditArgs, stage: &Stage) -> Result<(), Failure> {
    match args.patch.iter().find(|i| stage.patches.get(**i).is_none_or(|p| !p.is_present())) {
        Some(i) => Err(Failure::input(format!(
            "--patch {i}: no such patch takes part in this scene; `etalon scene patches` lists those that do"
        ))),
        None => Ok(()),
    }
}

/// Everything into the folder, at once.
fn write(
    args: &AuditArgs,
    session: &Session,
    params: &Params,
    audited: &Audited,
    computed: Phase,
) -> Result<(), Failure> {
    let stage = session.stage();
    let begin = Instant::now();
    let pictures = pictures(args, stage, params, audited)?;
    let views = views(&session.tracer());
    let drawn = Phase { name: "pictures".into(), seconds: begin.elapsed().as_secs_f64() };
    let timing = [computed, drawn];
    let extras = AuditExtras { stage, views: &views, pictures: &pictures, timing: &timing };
    let mut files = audit_files(&audited.record, &extras)?;
    let record = serde_json::to_vec_pretty(&audited.record).map_err(|e| Failure::input(e.to_string()))?;
    files.push(Artifact { name: "audit.json".into(), bytes: record });
    files.extend(audit_tables::all(stage, audited, args.pairs));
    save(&args.output, &files)?;
    Ok(())
}

/// Item buffers of the patches asked for, or of the worst receivers.
fn pictures(args: &AuditArgs, stage: &Stage, params: &Params, audited: &Audited) -> Result<Vec<AuditPicture>, Failure> {
    let sources = &audited.record.sources;
    let worst = |s: &crate::study::audit::SourceAudit| s.seen.worst.first().map(|v| v.patch as usize);
    let wanted: Vec<(usize, usize)> = if args.patch.is_empty() {
        sources.iter().take(DRAWN).enumerate().filter_map(|(k, s)| Some((worst(s)?, k))).collect()
    } else {
        args.patch.iter().map(|i| (*i, 0)).collect()
    };
    let params = Params { resolution: audited.record.resolution, ..*params };
    let mut out = Vec::new();
    for (patch, k) in wanted {
        let Some(source) = sources.get(k) else { continue };
        let set: BTreeSet<u32> = source.source.patches.iter().copied().collect();
        let failed = |e: crate::methods::hemicube::HemicubeError| Failure::input(e.to_string());
        let Some(mut unfolded) = unfold(stage, patch, &params, &set).map_err(failed)? else { continue };
        let surface = &stage.surfaces[stage.patches[patch].surface as usize].name;
        let exact: f64 = match audited.record.form {
            // Pairs of progressive refinement are turned about; the hemi-cube itself is where it stands.
            Form::Shooter => unfolded.finer,
            Form::Receiver => source
                .source
                .patches
                .iter()
                .filter_map(|j| audited.split.get(patch, *j as usize))
                .map(|p| p.point)
                .sum(),
        };
        let caption =
            unfolded.caption(&format!("Patch {patch} ({surface})"), &source.source.name, Some((exact, "exact")));
        unfolded.picture.caption.clone_from(&caption);
        out.push(AuditPicture { name: format!("unfolded-{patch}.png"), caption, image: unfolded.picture.paint() });
    }
    Ok(out)
}

fn text(args: &AuditArgs, audited: &Audited) -> String {
    let record = &audited.record;
    let mut out: String = record.findings.iter().map(|f| format!("- {}\n", f.text)).collect();
    if !record.cures.is_empty() {
        out += "\n";
        out += &audit_tables::cures_text(record);
    }
    out + &format!("\nthe page: {}", args.output.join("index.html").display())
}

fn summary(args: &AuditArgs, audited: &Audited) -> Result<Value, Failure> {
    // Everything but the long lists, which are in the files.
    let mut json = serde_json::to_value(&audited.record).map_err(|e| Failure::input(e.to_string()))?;
    if let Some(object) = json.as_object_mut() {
        object.remove("receivers");
        object.remove("views");
        object.remove("ranking");
        object.insert("output".into(), json!(args.output));
    }
    Ok(json)
}
