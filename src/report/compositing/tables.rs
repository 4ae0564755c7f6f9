//! Tables of edges, lights, clusters, their composite, and the picture.

use super::rows::{Cell, Table, clock, counted, dash, error, name, num, share, yes_or_no};
use crate::report::format::{round_number, significant, with_error};
use crate::report::html::context::minus;
use crate::study::compositing::{ClusterRow, CompositeRow, CompositingRecord, EdgeRow, LightRow, PictureRow};

/// Three figures.
fn three(x: f64) -> String {
    significant(x, 3)
}

/// How many times as long as the other; none of no time.
fn over(a: f64, b: f64) -> Option<f64> {
    (b > 0.0).then(|| a / b)
}

/// A table of which nothing is left without rows.
fn table(
    title: &'static str,
    lead: &'static str,
    head: &[(&'static str, bool)],
    rows: Vec<Vec<Cell>>,
) -> Option<Table> {
    (!rows.is_empty()).then(|| Table { title, lead, head: head.to_vec(), rows })
}

/// Every scan at every scale.
pub(super) fn edges(record: &CompositingRecord) -> Option<Table> {
    let head = [
        ("Sub-scanlines", true),
        ("Scale", true),
        ("Error", true),
        ("Pixels off by a step", true),
        ("Segments", true),
        ("Bytes", true),
        ("Scan, ms", true),
        ("Drawing, ms", true),
    ];
    let row = |r: &EdgeRow| {
        vec![
            counted(r.sub_scanlines as usize),
            num(round_number(r.scale)),
            error(&r.error),
            share(r.off_by_a_step),
            counted(r.segments),
            counted(r.bytes),
            clock(Some(1e3 * r.scan_seconds), ""),
            clock(Some(1e3 * r.draw_seconds), ""),
        ]
    };
    let lead = "A scan is made once and drawn at every scale. A step is one of 256 of a display whose white is the \
                brightest pixel.";
    table("Every scan", lead, &head, record.edges.iter().chain(&record.scaled).map(row).collect())
}

/// Every light at points in sight.
pub(super) fn lights(record: &CompositingRecord) -> Option<Table> {
    let head = [
        ("Light", false),
        ("Points", true),
        ("Lit", true),
        ("Penumbra", true),
        ("Dark", true),
        ("Error", true),
        ("Judge\u{2019}s noise", true),
        ("Largest |t| (allowed)", true),
        ("Mean t\u{b2}", true),
        ("With noise", true),
        ("Surely off", true),
        ("Within", false),
        ("A point, \u{b5}s", true),
        ("By rays, \u{b5}s", true),
        ("Times as fast", true),
    ];
    let row = |r: &LightRow| {
        vec![
            name(&r.name, Some(&r.kind)),
            counted(r.points),
            counted(r.lit),
            counted(r.penumbra),
            counted(r.dark),
            Cell { class: "num big", ..share(r.error) },
            share(r.noise),
            num(format!("{} ({})", three(r.worst_t), three(r.allowed_t))),
            r.mean_squared_t.map_or(dash(), |t| num(three(t))),
            counted(r.with_error),
            counted(r.surely_off),
            yes_or_no(r.within),
            clock(Some(1e6 * r.point_seconds), ""),
            clock(Some(1e6 * r.judge_point_seconds), ""),
            clock(over(r.judge_point_seconds, r.point_seconds), ""),
        ]
    };
    let lead = "Each light by itself, irradiance at points in sight against rays to places of the lamp.";
    table("Lights", lead, &head, record.lights.iter().map(row).collect())
}

/// The parts that were scanned by themselves.
pub(super) fn clusters(record: &CompositingRecord) -> Option<Table> {
    let head = [
        ("Cluster", false),
        ("Faces", true),
        ("In sight", true),
        ("Segments", true),
        ("Bytes", true),
        ("Scan, ms", true),
    ];
    let row = |r: &ClusterRow| {
        vec![
            name(&r.name, None),
            counted(r.faces),
            counted(r.visible_faces),
            counted(r.segments),
            counted(r.bytes),
            clock(Some(1e3 * r.seconds), ""),
        ]
    };
    let lead = "Each part scanned as if the others were not there.";
    table("Clusters", lead, &head, record.clusters.iter().map(row).collect())
}

/// All parts in one against the whole scene.
pub(super) fn composite(record: &CompositingRecord) -> Option<Table> {
    let head = [
        ("Clusters", true),
        ("Orders", true),
        ("Same to the bit", false),
        ("Largest difference of a pixel, of the brightest", true),
        ("Bytes", true),
        ("Compositing, ms", true),
    ];
    let row = |r: &CompositeRow| {
        vec![
            counted(r.clusters),
            counted(r.orders),
            yes_or_no(r.same_segments),
            share(r.worst),
            counted(r.bytes),
            clock(Some(1e3 * r.seconds), ""),
        ]
    };
    let lead = "The clusters put together by depth, in several orders, against one scan of everything: faces and segments \
                but for shadow edges, then the pixels of the shaded pictures.";
    table("All in one against the whole", lead, &head, record.composite.iter().map(row).collect())
}

/// The shaded picture and the one by rays.
pub(super) fn picture(record: &CompositingRecord) -> Option<Table> {
    let p: &PictureRow = &record.picture;
    let head = [("", false), ("From sub-scanlines", true), ("By rays", true)];
    let row = |what: &str, ours: Cell, theirs: Cell| vec![name(what, None), ours, theirs];
    let seconds = |x: Option<f64>| clock(x, "\u{202f}s");
    let rows = vec![
        row("Error; of rays their own noise", error(&p.error), Cell { class: "num big", ..share(p.noise) }),
        row("Mean difference", num(minus(&format!("{} %", with_error(100.0 * p.bias, None)))), dash()),
        row("Pixels off by a step", share(p.off_by_a_step), dash()),
        row("Sub-scanlines; samples a pixel", counted(p.sub_scanlines as usize), counted(record.samples as usize)),
        row("Pixels that rays were traced for", share(p.traced), share(1.0)),
        row("Rays", dash(), counted(p.judge_rays as usize)),
        row("Most bytes of shadow volumes", counted(p.shadow_bytes), dash()),
        row("Passes over the image", counted(p.passes), dash()),
        row("Time", seconds(Some(p.seconds)), seconds(Some(p.judge_seconds))),
        row(
            "Samples a pixel whose noise alone would be that error",
            dash(),
            p.equal_samples.map_or(dash(), |n| num(three(n))),
        ),
        row("Time of as good a picture", seconds(Some(p.seconds)), seconds(p.equal_seconds)),
    ];
    let lead = "The whole scene, lit and shaded, against the same cast by rays alone.";
    table("The picture against rays", lead, &head, rows)
}
