//! From clues to candidates: row sums first, then small entries, then drawing.

use super::axes::Axes;
use super::candidates::Candidate;
use super::clues::{Digits, RowSums};
use super::lattice::Lattice;
use super::model::{Mistake, Model, Rule};
use super::pictures::{Camera, picture_cost};
use super::sheets::Sheet;
use super::tables::Table;
use super::totals::resolutions;
use crate::methods::hemicube::World;
use crate::scene::Stage;
use crate::solution::FormFactors;
use rayon::prelude::*;

/// Rows on which a hemi-cube is confirmed.
pub(super) const CONFIRMED_ROWS: usize = 24;
/// Resolutions tried by drawing where no clue names one.
const LAST_DRAWN: u32 = 256;
/// The same for tables with mistakes.
const LAST_DRAWN_WRONG: u32 = 64;
/// Resolutions tried by their small entries: all even ones up to the first, then some that people use.
const LAST_SCANNED: u32 = 512;
const LARGE: [u32; 8] = [600, 640, 720, 768, 800, 1000, 1024, 2048];
/// Small entries looked at, with some to spare for those that turn out equal.
const SMALL_ENTRIES: usize = 64;

/// Pixels that may be touched by drawing, in all. Counted rather than timed: the same matrix gets the same answer on
/// any machine.
#[derive(Debug)]
pub(super) struct Work(f64);

impl Work {
    /// Some seconds on one core.
    const ALL: f64 = 1.5e9;

    pub fn new() -> Self {
        Self(Self::ALL)
    }

    /// True if there is so much left, which is then spent.
    pub fn take(&mut self, pixels: f64) -> bool {
        let enough = pixels <= self.0;
        self.0 -= if enough { pixels } else { 0.0 };
        enough
    }
}

/// A matrix under examination.
pub(super) struct Search<'a> {
    pub stage: &'a Stage,
    pub f: &'a FormFactors,
    pub world: World,
    pub row_sums: RowSums,
    pub digits: Digits,
    /// Entries above zero, ascending.
    pub entries: Vec<f64>,
    /// The smallest of them, different ones.
    pub small: Vec<f64>,
    /// Rows with most entries first, spread over the scene.
    pub rows: Vec<usize>,
}

/// What was found, and how far it was looked for.
#[derive(Debug)]
pub(super) struct Found {
    /// Best first.
    pub candidates: Vec<Candidate>,
    /// Right tables were drawn at all resolutions up to this one; `None` where a clue made that needless.
    pub drawn_to: Option<u32>,
}

impl<'a> Search<'a> {
    pub fn new(stage: &'a Stage, f: &'a FormFactors) -> Self {
        let mut entries: Vec<f64> = f.values.iter().copied().filter(|v| *v > 0.0).collect();
        entries.sort_unstable_by(f64::total_cmp);
        let mut small = entries.clone();
        small.dedup_by(|b, a| (*b - *a) <= 1e-11 * *a);
        small.truncate(SMALL_ENTRIES);
        Self {
            stage,
            f,
            world: World::new(stage),
            row_sums: RowSums::of(stage, f),
            digits: Digits::of(&entries),
            rows: spread_rows(stage, f),
            entries,
            small,
        }
    }

    /// Digits too few to tell pixels.
    pub fn is_coarse(&self) -> bool {
        let smallest = self.entries.first().copied().unwrap_or(0.0);
        self.digits.error(smallest) > 1e-4 * smallest
    }

    /// Candidates, best first.
    pub fn run(&self) -> Found {
        let (mut work, mut drawn_to) = (Work::new(), None);
        let mut found = self.by_row_sum();
        let open = found.is_empty();
        if open || found.iter().all(|c| c.resolution().is_none()) {
            let models: Vec<Model> = match open {
                true => [Rule::Midpoint, Rule::Exact].map(Model::right).to_vec(),
                false => found.iter().map(|c| c.model).collect(),
            };
            let named = self.named_by_small_entries(&models);
            found = if named.is_empty() { self.drawn_all(&models, found, &mut work, &mut drawn_to) } else { named };
        }
        let mut judged: Vec<Candidate> = found.into_iter().flat_map(|c| self.judged(c, &mut work)).collect();
        judged.retain(|c| !c.is_refuted());
        judged.sort_by(|a, b| b.rank().partial_cmp(&a.rank()).unwrap_or(std::cmp::Ordering::Equal));
        Found { candidates: judged, drawn_to }
    }

    /// Models whose total is what the rows share.
    fn by_row_sum(&self) -> Vec<Candidate> {
        let Some(common) = self.row_sums.common else { return Vec::new() };
        let slack = self.row_sums.slack + 1e-12 * common;
        let fit = |model| resolutions(model, common, slack).map(|(a, b)| Candidate::new(model, [a, b], true));
        let models: Vec<Model> = Model::all().collect();
        models.into_par_iter().filter_map(fit).collect()
    }

    /// Resolutions whose tables hold the small entries.
    fn named_by_small_entries(&self, models: &[Model]) -> Vec<Candidate> {
        let by_row_sum = self.row_sums.common.is_some();
        let judge = |n: u32| -> Vec<Candidate> {
            let lattice = |m: &Model| (*m, Lattice::of(&self.small, &Table::new(n, *m).deltas(), self.digits));
            let held = models.iter().map(lattice).filter(|(_, lattice)| lattice.holds());
            held.map(|(model, lattice)| Candidate {
                lattice: Some(lattice),
                ..Candidate::new(model, [n, n], by_row_sum)
            })
            .collect()
        };
        let mut out: Vec<Candidate> = Vec::new();
        let even = |from: u32, to: u32| (from..=to).step_by(2).collect::<Vec<_>>();
        for mut scanned in [even(4, LAST_SCANNED / 2), even(LAST_SCANNED / 2 + 2, LAST_SCANNED), LARGE.to_vec()] {
            scanned.retain(|n| could_be_pixels(&self.small, *n));
            // Large tables take long: only where no smaller one fits.
            if out.is_empty() {
                out = scanned.par_iter().flat_map_iter(|n| judge(*n)).collect();
            }
        }
        let most = out.iter().filter_map(|c| c.lattice).map(|l| l.single + l.double).max().unwrap_or(0);
        out.retain(|c| c.lattice.is_some_and(|l| 2 * (l.single + l.double) > most));
        out
    }

    /// No clue names a resolution: draws all of them on one row.
    fn drawn_all(
        &self,
        models: &[Model],
        otherwise: Vec<Candidate>,
        work: &mut Work,
        drawn_to: &mut Option<u32>,
    ) -> Vec<Candidate> {
        let normalised = self.sums_to_one();
        let wrong: Vec<Model> = Mistake::ALL
            .into_iter()
            .chain([Mistake::SidesUpsideDown])
            .filter(|m| m.is_pictured() && *m != Mistake::None && !(normalised && m.is_factor()))
            .flat_map(|mistake| [Rule::Midpoint, Rule::Exact, Rule::Normalised].map(|rule| Model { rule, mistake }))
            .filter(|m| m.rule != Rule::Exact || m.mistake.leaves_out())
            .filter(|m| (m.rule == Rule::Normalised) == normalised)
            .collect();
        let (mut out, last) = self.drawn_up_to(LAST_DRAWN, models, work);
        *drawn_to = Some(last);
        if out.is_empty() {
            out = self.drawn_up_to(LAST_DRAWN_WRONG, &wrong, work).0;
        }
        if out.is_empty() { otherwise } else { out }
    }

    fn sums_to_one(&self) -> bool {
        self.row_sums.common.is_some_and(|s| (s - 1.0).abs() <= self.row_sums.slack + 1e-11)
    }

    /// Draws one row at all resolutions to the last, or as far as the work allows; tells how far.
    fn drawn_up_to(&self, last: u32, models: &[Model], work: &mut Work) -> (Vec<Candidate>, u32) {
        let Some(row) = self.rows.first() else { return (Vec::new(), last) };
        let axes = Axes::different(&self.stage.patches[*row]);
        let by_row_sum = self.row_sums.common.is_some();
        let at = |n: u32| -> Vec<Candidate> {
            let camera = Camera::new(self.stage, &self.world, n);
            let sheet = Sheet::new(n, models);
            let mut best = vec![0; models.len()];
            for axes in &axes {
                let found = camera.compare(self.f, &[*row], *axes, &sheet, &|v| self.slack(v), false);
                for (view, c) in sheet.views.iter().zip(found) {
                    let best = &mut best[view.model];
                    *best = (*best).max(if c.share() >= 0.4 { c.entries } else { 0 });
                }
            }
            let fits = models.iter().zip(best).filter(|(_, entries)| *entries >= 4);
            fits.map(|(m, _)| Candidate::new(*m, [n, n], by_row_sum)).collect()
        };
        let tables = Sheet::new(4, models).tables();
        let cost = |n: &u32| axes.len() as f64 * picture_cost(*n, tables, self.stage.patches.len());
        let tried: Vec<u32> = (4..=last).step_by(2).take_while(|n| work.take(cost(n))).collect();
        let reached = tried.last().copied().unwrap_or(0);
        (tried.par_iter().flat_map_iter(|n| at(*n)).collect(), reached)
    }

    /// How far an entry reproduced may be off.
    pub fn slack(&self, value: f64) -> f64 {
        2.0 * self.digits.error(value) + 1e-10 * value + 1e-14
    }
}

/// Up to [`CONFIRMED_ROWS`] rows: the one with most entries, then evenly through the scene.
fn spread_rows(stage: &Stage, f: &FormFactors) -> Vec<usize> {
    let length = |i: usize| f.row_starts[i + 1] - f.row_starts[i];
    let all: Vec<usize> = (0..f.n).filter(|i| stage.patches[*i].is_present() && length(*i) > 0).collect();
    let Some(longest) = all.iter().copied().rev().max_by_key(|i| length(*i)) else { return Vec::new() };
    let wanted = CONFIRMED_ROWS.min(all.len());
    let mut rows: Vec<usize> =
        (0..wanted).rev().map(|k| all[k * all.len() / wanted]).filter(|i| *i != longest).collect();
    rows.insert(0, longest);
    rows
}

/// True if the smallest entries can be one pixel or two at a resolution, by the sizes of its pixels.
fn could_be_pixels(entries: &[f64], n: u32) -> bool {
    use std::f64::consts::PI;
    let h = 2.0 / f64::from(n);
    let (smallest, largest) = (0.9 * h.powi(3) / (8.0 * PI), 1.05 * h * h / PI);
    entries.len() >= 2 && entries[0] >= smallest && entries[1] <= 2.0 * largest
}
