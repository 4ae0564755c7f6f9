//! The tables of an audit.

use crate::audit::{Cause, Pair};
use crate::report::Artifact;
use crate::scene::Stage;
use crate::study::audit::{AuditRecord, Audited};
use std::fmt::Write;

/// pairs.csv, patches.csv, sources.csv, cures.csv, curves.csv.
pub fn all(stage: &Stage, audited: &Audited, most_pairs: usize) -> Vec<Artifact> {
    let record = &audited.record;
    let table = |name: &str, text: String| Artifact { name: name.into(), bytes: text.into_bytes() };
    vec![
        table("pairs.csv", pairs(stage, audited, most_pairs)),
        table("patches.csv", patches(stage, record)),
        table("sources.csv", sources(record)),
        table("cures.csv", cures(record)),
        table("curves.csv", curves(record)),
    ]
}

/// The pairs that bring the largest errors, by receiver and source. Errors of form factors by cause with their standard
/// errors, and what they bring in luminance at the first bounce, times the square root of the receiver's area.
fn pairs(stage: &Stage, audited: &Audited, most: usize) -> String {
    let bands = stage.band_count();
    let reflectance = stage.reflectances();
    let weight = |i: usize, j: usize| -> f64 {
        let light =
            |b: usize| stage.photometry.weights[b] * reflectance[i * bands + b] * audited.effect.cube[j * bands + b];
        (0..bands).map(light).sum()
    };
    let mut list: Vec<(f64, usize, usize, &Pair)> = Vec::new();
    for i in 0..audited.split.len() {
        let row = audited.split.row(i).filter(|(_, p)| p.error() != 0.0);
        list.extend(row.map(|(j, p)| (weight(i, j) * p.error(), i, j, p)));
    }
    let size = |x: &(f64, usize, usize, &Pair)| x.0 * x.0 * stage.patches[x.1].area;
    list.sort_by(|a, b| size(b).total_cmp(&size(a)).then((a.1, a.2).cmp(&(b.1, b.2))));
    list.truncate(most);
    let mut out = String::from(
        "receiver,source,cube,point,mean,mean_error,aliasing,aliasing_error,proximity,proximity_error,visibility,\
         visibility_error,luminance\n",
    );
    for (light, i, j, p) in list {
        let _ = write!(out, "{i},{j},{},{},{},{}", p.cube, p.point, p.mean, p.mean_error);
        for c in Cause::ALL {
            let _ = write!(out, ",{},{}", p.part(c), p.std_err(c));
        }
        let _ = writeln!(out, ",{light}");
    }
    out
}

fn patches(stage: &Stage, record: &AuditRecord) -> String {
    let mut out = String::from("patch,surface,row_sum,reflected");
    for kind in ["first", "first_error", "carried"] {
        Cause::ALL.iter().for_each(|c| out += &format!(",{kind}_{}", c.name()));
    }
    out += "\n";
    for (i, r) in record.receivers.iter().enumerate().filter(|(i, _)| stage.patches[*i].is_present()) {
        let surface = quoted(&stage.surfaces[stage.patches[i].surface as usize].name);
        let _ = write!(out, "{i},{surface},{},{}", r.row_sum, r.reflected);
        [r.first, r.std_err, r.carried].iter().flatten().for_each(|x| _ = write!(out, ",{x}"));
        out += "\n";
    }
    out
}

fn sources(record: &AuditRecord) -> String {
    let mut out = String::from("source,patches,luminance,error,aliasing,proximity,visibility\n");
    for s in &record.ranking {
        let [a, p, v] = s.by_cause;
        let _ = writeln!(out, "{},{},{},{},{a},{p},{v}", quoted(&s.name), s.patches.len(), s.luminance, s.error);
    }
    out
}

fn cures(record: &AuditRecord) -> String {
    let mut out = String::from("cure,rms,rms_low,rms_high,top1,top1_low,top1_high,hemicubes,pixels,points,seconds");
    record.sources.iter().for_each(|s| out += &format!(",{}", quoted(&format!("error of {}", s.source.name))));
    out += "\n";
    for c in &record.cures {
        out += &quoted(&c.words);
        for e in [c.wrong.rms, c.wrong.top1] {
            out += &e.map_or(",,,".into(), |e| format!(",{},{},{}", e.value, e.low, e.high));
        }
        let _ = write!(out, ",{},{},{},{}", c.hemicubes, c.pixels, c.points, c.seconds);
        c.by_source.iter().for_each(|e| out += &format!(",{e}"));
        out += "\n";
    }
    out
}

fn curves(record: &AuditRecord) -> String {
    let mut out = String::from("over,x,rms,rms_low,rms_high,top1,top1_low,top1_high,aliasing,seconds\n");
    for (over, list) in [("resolution", &record.resolutions), ("rotation", &record.rotations)] {
        for at in list {
            let _ = write!(out, "{over},{}", at.x);
            for e in [at.wrong.rms, at.wrong.top1] {
                out += &e.map_or(",,,".into(), |e| format!(",{},{},{}", e.value, e.low, e.high));
            }
            let _ = writeln!(out, ",{},{}", at.aliasing, at.seconds);
        }
    }
    out
}

/// A field of a table.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.into() }
}

/// The cures for a terminal.
pub fn cures_text(record: &AuditRecord) -> String {
    let mut out = format!("{:>9}  {:>9}  {:>8}  cure\n", "error", "top 1 %", "seconds");
    for c in &record.cures {
        let percent = |e: Option<crate::stats::Estimate>| e.map_or("-".into(), |e| format!("{:.3} %", 100.0 * e.value));
        let verdict = c.verdict.map_or(String::new(), |v| format!("  [{}]", format!("{v:?}").to_lowercase()));
        let _ = writeln!(
            out,
            "{:>9}  {:>9}  {:>8.2}  {}{verdict}",
            percent(c.wrong.rms),
            percent(c.wrong.top1),
            c.seconds,
            c.words
        );
    }
    out
}
