//! Right values at wrong numbers.

use super::jury::{Hypothesis, Jury};
use crate::scene::Grid;

const FAMILY: &str = "numbering";
/// Surfaces looked at one by one.
const SURFACES: usize = 24;
/// Surfaces of which all pairs are tried.
const EXCHANGED: usize = 12;

/// Another order of the cells of a grid: which cell's value stands at cell k of `na` by `nb`.
type Order = fn(usize, usize, usize) -> usize;

const ORDERS: [(&str, Order); 8] = [
    ("the columns are reversed", |k, na, _| (na - 1 - k % na) + k / na * na),
    ("the rows are reversed", |k, na, nb| k % na + (nb - 1 - k / na) * na),
    ("the order is reversed", |k, na, nb| na * nb - 1 - k),
    ("rows are taken for columns", |k, na, nb| k / nb + k % nb * na),
    ("rows are taken for columns, and reversed", |k, na, nb| (na - 1 - k / nb) + k % nb * na),
    ("columns are reversed and taken for rows", |k, na, nb| k / nb + (nb - 1 - k % nb) * na),
    ("every value stands one patch too early", |k, na, nb| (k + 1) % (na * nb)),
    ("every value stands one patch too late", |k, na, nb| (k + na * nb - 1) % (na * nb)),
];

pub(super) fn hear(jury: &mut Jury) {
    let case = jury.case;
    let all: Vec<Run> = runs(case);
    let surfaces = case.worst_surfaces(SURFACES);
    for (words, order) in ORDERS {
        say(jury, &all, order, None, format!("on every surface {words}"));
        for surface in &surfaces {
            let own: Vec<Run> = all.iter().filter(|r| r.surface == *surface).copied().collect();
            let name = &case.stage.surfaces[*surface as usize].name;
            say(jury, &own, order, Some(name.clone()), format!("on surface \"{name}\" {words}"));
        }
    }
    let whole = [Run { surface: 0, first: 0, na: case.areas.len(), nb: 1 }];
    for (words, order) in [ORDERS[2], ORDERS[6], ORDERS[7]] {
        say(jury, &whole, order, None, format!("over the whole list {words}"));
    }
    exchanged(jury, &surfaces[..surfaces.len().min(EXCHANGED)]);
}

/// Patches of one facet, or of a row of facets of one patch each.
#[derive(Clone, Copy)]
struct Run {
    surface: u32,
    first: usize,
    na: usize,
    nb: usize,
}

fn runs(case: &super::case::Case) -> Vec<Run> {
    let mut out: Vec<Run> = Vec::new();
    for facet in &case.stage.facets {
        let (na, nb) = match facet.grid {
            Grid::Quad { na, nb } => (na as usize, nb as usize),
            other => (other.count(), 1),
        };
        for first in [Some(facet.first_patch), facet.first_back_patch].into_iter().flatten() {
            let (first, surface) = (first as usize, facet.surface);
            match out.last_mut() {
                Some(r) if na * nb == 1 && r.nb == 1 && r.surface == surface && r.first + r.na == first => r.na += 1,
                _ => out.push(Run { surface, first, na, nb }),
            }
        }
    }
    out
}

fn say(jury: &mut Jury, runs: &[Run], order: Order, place: Option<String>, sentence: String) {
    let case = jury.case;
    let mut change = vec![0.0; case.truth.len()];
    for r in runs {
        for k in 0..r.na * r.nb {
            let (i, j) = (r.first + k, r.first + order(k, r.na, r.nb));
            if case.areas[i] > 0.0 {
                (0..case.bands).for_each(|c| {
                    change[i * case.bands + c] = case.truth[j * case.bands + c] - case.truth[i * case.bands + c];
                });
            }
        }
    }
    if change.iter().any(|d| *d != 0.0) {
        jury.hear(
            Hypothesis { family: FAMILY, kind: "numbering", place, parameters: 0, sentence, partly: true },
            change,
        );
    }
}

/// The values of two surfaces of as many patches, in each other's place.
fn exchanged(jury: &mut Jury, surfaces: &[u32]) {
    let case = jury.case;
    let numbers = |s: u32| case.patches_of(s);
    for (at, a) in surfaces.iter().enumerate() {
        for b in &surfaces[at + 1..] {
            let (one, two) = (numbers(*a), numbers(*b));
            if one.len() != two.len() {
                continue;
            }
            let mut change = vec![0.0; case.truth.len()];
            for (i, j) in one.iter().zip(&two).flat_map(|(i, j)| [(*i, *j), (*j, *i)]) {
                (0..case.bands).for_each(|c| {
                    change[i * case.bands + c] = case.truth[j * case.bands + c] - case.truth[i * case.bands + c];
                });
            }
            let [x, y] = [a, b].map(|s| case.stage.surfaces[*s as usize].name.as_str());
            let (x, y) = if a < b { (x, y) } else { (y, x) };
            let sentence = format!("the values of surfaces \"{x}\" and \"{y}\" are in each other's place");
            let place = Some(format!("{x}, {y}"));
            jury.hear(
                Hypothesis { family: FAMILY, kind: "surfaces-exchanged", place, parameters: 0, sentence, partly: true },
                change,
            );
        }
    }
}
