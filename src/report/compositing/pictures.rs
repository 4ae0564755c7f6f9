//! Where each picture stands, by its name.

use crate::report::gallery::{Group, PagePicture, named, taken};

/// The shaded picture, from left to right.
const SHADED: [&str; 3] = ["shaded", "rays", "off"];

/// Groups that have pictures, every picture in one of them.
pub(super) fn groups(all: &[PagePicture]) -> Vec<Group> {
    let mut left: Vec<&PagePicture> = all.iter().collect();
    let shaded: Vec<_> = SHADED.iter().filter_map(|n| named(&mut left, n)).collect();
    let truth = named(&mut left, "edges-rays");
    let mut edges = taken(&mut left, |n| n.starts_with("edges-"));
    // What ends in no number comes last; the order is kept among equals.
    let lines = |p: &&PagePicture| p.name.rsplit('-').next().and_then(|n| n.parse().ok()).unwrap_or(u32::MAX);
    edges.sort_by_key(lines);
    edges.extend(truth);
    let groups = [
        Group::of(
            "The picture",
            "From sub-scanlines and by rays, as one eye sees them, and the difference.",
            "three",
            shaded,
        ),
        Group::of(
            "Edges",
            "One colour a face: nothing but edges tells these apart. More sub-scanlines from left to right, rays last.",
            "flats",
            edges,
        ),
        Group::of("More pictures", "", "three", left),
    ];
    groups.into_iter().filter(|g| !g.is_empty()).collect()
}
