//! What an audit of compositing comes to, in words.

use super::record::{CompositingRecord, EdgeRow, LightRow};
use crate::scene::{Appearance, Stage};

pub(super) fn findings(record: &CompositingRecord, appearance: &Appearance, stage: &Stage) -> Vec<String> {
    let mut out = Vec::new();
    if let Some(at) = record.edges.iter().find(|r| r.sub_scanlines == record.judged_at) {
        out.push(edges(record, at));
    }
    let worst = record.scaled.iter().filter(|r| r.sub_scanlines == record.judged_at);
    if let Some(worst) = worst.max_by(|a, b| a.error.value.total_cmp(&b.error.value)) {
        out.push(format!(
            "Scaled pictures of {} sub-scanlines: at most {} off, at scale {}",
            worst.sub_scanlines,
            percent(worst.error.value),
            worst.scale
        ));
    }
    out.extend(record.lights.iter().map(light));
    if let Some(c) = &record.composite {
        let same = if c.same_segments { "the same segments to the bit" } else { "segments that differ" };
        out.push(format!(
            "{} clusters in one, in {} orders: {same} as the whole scene, pixels within {:.1e} of the brightest",
            c.clusters, c.orders, c.worst
        ));
    }
    let p = &record.picture;
    let mut words = format!(
        "The picture: {} off ({} to {}) the one by rays, whose own error is {} at {} samples a pixel",
        percent(p.error.value),
        percent(p.error.interval[0]),
        percent(p.error.interval[1]),
        percent(p.noise),
        record.samples
    );
    if let Some(samples) = p.equal_samples {
        words += &format!("; by the root of their number, {samples:.0} samples would do as well");
    }
    out.push(words);
    if p.traced > 0.0 {
        out.push(format!("Rays were traced for {} of the pixels, those with mirrors or glass", percent(p.traced)));
    }
    out.extend(models(appearance, stage));
    out
}

/// Where the two are not of one model, so that the picture differs by more than error.
fn models(appearance: &Appearance, stage: &Stage) -> Vec<String> {
    let mut out = Vec::new();
    let used = |name: &String| stage.materials.iter().any(|m| m.name == *name);
    let finishes = || appearance.finishes.iter().filter(|f| used(&f.material));
    if finishes().any(|f| f.transparency > 0.0) {
        out.push("Panes: shading lets all light through straight ones and none through those that bend it; the judge, by rays, \
                  their share");
    }
    if !appearance.trees.is_empty() {
        out.push(
            "Trees as pictures: in shading they throw no shadow under skies and turn to the middle of large lamps; the \
                  judge's hide the sky and turn to every place of a lamp",
        );
    }
    if finishes().any(|f| f.bump.is_some()) {
        out.push("Bumps: shading takes soft shadows of the plain face; the judge of the tilted one");
    }
    out.into_iter().map(String::from).collect()
}

fn edges(record: &CompositingRecord, at: &EdgeRow) -> String {
    let mut words = format!(
        "Edges: {} off at {} sub-scanlines ({} to {})",
        percent(at.error.value),
        at.sub_scanlines,
        percent(at.error.interval[0]),
        percent(at.error.interval[1])
    );
    if let (Some(first), Some(last)) = (record.edges.first(), record.edges.last()) {
        words += &format!(
            ", {} at {}, {} at {}",
            percent(first.error.value),
            first.sub_scanlines,
            percent(last.error.value),
            last.sub_scanlines
        );
    }
    if let Some(rate) = record.rate {
        words += &format!("; the error falls with the power {rate:.2} of their number");
    }
    words
}

fn light(row: &LightRow) -> String {
    let within = match (row.within, row.kind.as_str()) {
        (true, _) => "within the judge's errors",
        (false, "sky") => "beyond the judge's errors, as 24 half planes of sky may be",
        (false, _) => "BEYOND the judge's errors",
    };
    let mut words = format!(
        "Light \"{}\" ({}): {within} at {} points ({} lit, {} in penumbra, {} dark); off by {} of the irradiance",
        row.name,
        row.kind,
        row.points,
        row.lit,
        row.penumbra,
        row.dark,
        percent(row.error)
    );
    if row.with_error > 0 {
        words +=
            &format!(", largest difference {:.1} standard errors where {:.1} are allowed", row.worst_t, row.allowed_t);
    }
    if row.surely_off > 0 {
        words += &format!("; {} points differ where rays have no error", row.surely_off);
    }
    words
}

/// Two digits that count.
fn percent(share: f64) -> String {
    let p = 100.0 * share;
    match p.abs() {
        0.0 => "0 %".into(),
        a if a >= 10.0 => format!("{p:.0} %"),
        a if a >= 1.0 => format!("{p:.1} %"),
        a if a >= 0.1 => format!("{p:.2} %"),
        a if a >= 0.01 => format!("{p:.3} %"),
        _ => format!("{p:.1e} %"),
    }
}
