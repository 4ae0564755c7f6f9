//! From clues to candidates, from candidates to a conclusion.

use super::clues::{Digits, RowSums};
use super::lattice::Lattice;
use super::pictures::{Axes, Camera, Confirmed};
use super::tables::{Mistake, Model, Rule, Table, resolutions};
use super::{Candidate, Fingerprint, Likeness, words};
use crate::methods::hemicube::World;
use crate::scene::Stage;
use crate::solution::FormFactors;
use rayon::prelude::*;

/// Rows that tell how the hemi-cubes are turned, and rows on which that is confirmed.
const TRIAL_ROWS: usize = 2;
const CONFIRMED_ROWS: usize = 24;
/// Resolutions tried by drawing where no clue names one.
const LAST_DRAWN: u32 = 256;
/// The same for tables with mistakes.
const LAST_DRAWN_WRONG: u32 = 64;
/// Resolutions tried by their small entries: all even ones up to the first, then some that people use.
const LAST_SCANNED: u32 = 512;
const LARGE: [u32; 8] = [600, 640, 720, 768, 800, 1000, 1024, 2048];

impl Candidate {
    fn new(model: Model, resolutions: [u32; 2], by_row_sum: bool) -> Self {
        Self { model, resolutions, by_row_sum, lattice: None, confirmed: None, axes: None }
    }

    /// The one resolution that fits, if it is one.
    pub(super) fn resolution(&self) -> Option<u32> {
        (self.resolutions[0] == self.resolutions[1]).then_some(self.resolutions[0])
    }

    fn is_drawn(&self) -> bool {
        self.confirmed.is_some_and(|c| c.holds())
    }

    fn is_on_lattice(&self) -> bool {
        self.lattice.is_some_and(|l| l.holds())
    }

    /// True if more than accident speaks for it: entries reproduced, small entries on its table, or a row sum that
    /// only one resolution has and that is not 1, which every closed matrix may have.
    pub(super) fn is_sure(&self, sums: &RowSums) -> bool {
        let distinct =
            if self.model.is_constant() { self.model.mistake.leaves_out() } else { self.resolution().is_some() };
        let told = self.by_row_sum && distinct && sums.slack < 1e-7;
        self.is_drawn() || self.is_on_lattice() || told
    }

    /// Order of belief, best first.
    fn rank(&self) -> (bool, bool, bool, f64) {
        let share = self.confirmed.map_or(0.0, |c| c.share());
        (self.is_drawn(), self.is_on_lattice(), self.by_row_sum, share)
    }
}

/// A matrix under examination.
pub(super) struct Search<'a> {
    stage: &'a Stage,
    f: &'a FormFactors,
    world: World,
    pub row_sums: RowSums,
    pub digits: Digits,
    /// Entries above zero, ascending.
    pub entries: Vec<f64>,
    /// Rows with most entries first, spread over the scene.
    rows: Vec<usize>,
}

impl<'a> Search<'a> {
    pub fn new(stage: &'a Stage, f: &'a FormFactors) -> Self {
        let mut entries: Vec<f64> = f.values.iter().copied().filter(|v| *v > 0.0).collect();
        entries.sort_unstable_by(f64::total_cmp);
        Self {
            stage,
            f,
            world: World::new(stage),
            row_sums: RowSums::of(stage, f),
            digits: Digits::of(&entries),
            rows: spread_rows(stage, f),
            entries,
        }
    }

    /// Digits too few to tell pixels.
    pub fn is_coarse(&self) -> bool {
        let smallest = self.entries.first().copied().unwrap_or(0.0);
        self.digits.error(smallest) > 1e-4 * smallest
    }

    /// Candidates, best first.
    pub fn run(&self) -> Vec<Candidate> {
        let mut found = self.by_row_sum();
        let open = found.is_empty();
        if open || found.iter().all(|c| c.resolution().is_none()) {
            let models: Vec<Model> = match open {
                true => [Rule::Midpoint, Rule::Exact].map(Model::right).to_vec(),
                false => found.iter().map(|c| c.model).collect(),
            };
            let named = self.named_by_small_entries(&models);
            found = if named.is_empty() { self.drawn_all(&models, found) } else { named };
        }
        let mut judged: Vec<Candidate> = found.into_iter().flat_map(|c| self.judged(c)).collect();
        judged.sort_by(|a, b| b.rank().partial_cmp(&a.rank()).unwrap_or(std::cmp::Ordering::Equal));
        judged
    }

    /// Models whose total is what the rows share.
    fn by_row_sum(&self) -> Vec<Candidate> {
        let Some(common) = self.row_sums.common else { return Vec::new() };
        let slack = self.row_sums.slack + 1e-12 * common;
        let fit = |model| resolutions(model, common, slack).map(|(a, b)| Candidate::new(model, [a, b], true));
        Model::all().filter_map(fit).collect()
    }

    /// Resolutions whose tables hold the small entries.
    fn named_by_small_entries(&self, models: &[Model]) -> Vec<Candidate> {
        let mut entries = self.entries.clone();
        entries.dedup_by(|b, a| (*b - *a) <= 1e-11 * *a);
        entries.truncate(64);
        let by_row_sum = self.row_sums.common.is_some();
        let judge = |n: u32| -> Vec<Candidate> {
            let lattice = |m: &Model| (*m, Lattice::of(&entries, &Table::new(n, *m).deltas(), self.digits));
            let held = models.iter().map(lattice).filter(|(_, lattice)| lattice.holds());
            held.map(|(model, lattice)| Candidate {
                lattice: Some(lattice),
                ..Candidate::new(model, [n, n], by_row_sum)
            })
            .collect()
        };
        let scanned: Vec<u32> =
            (4..=LAST_SCANNED).step_by(2).chain(LARGE).filter(|n| could_be_pixels(&entries, *n)).collect();
        let mut out: Vec<Candidate> = scanned.par_iter().flat_map_iter(|n| judge(*n)).collect();
        let most = out.iter().filter_map(|c| c.lattice).map(|l| l.single + l.double).max().unwrap_or(0);
        out.retain(|c| c.lattice.is_some_and(|l| 2 * (l.single + l.double) > most));
        out
    }

    /// No clue names a resolution: draws all of them on one row.
    fn drawn_all(&self, models: &[Model], otherwise: Vec<Candidate>) -> Vec<Candidate> {
        let wrong: Vec<Model> = Mistake::ALL
            .into_iter()
            .chain([Mistake::SidesUpsideDown])
            .filter(|m| m.is_pictured() && *m != Mistake::None)
            .flat_map(|mistake| [Rule::Midpoint, Rule::Exact, Rule::Normalised].map(|rule| Model { rule, mistake }))
            .filter(|m| m.rule != Rule::Exact || m.mistake.leaves_out())
            .filter(|m| (m.rule == Rule::Normalised) == self.sums_to_one())
            .collect();
        let mut out = self.drawn_up_to(LAST_DRAWN, models);
        if out.is_empty() {
            out = self.drawn_up_to(LAST_DRAWN_WRONG, &wrong);
        }
        if out.is_empty() { otherwise } else { out }
    }

    fn sums_to_one(&self) -> bool {
        self.row_sums.common.is_some_and(|s| (s - 1.0).abs() <= self.row_sums.slack + 1e-11)
    }

    fn drawn_up_to(&self, last: u32, models: &[Model]) -> Vec<Candidate> {
        let Some(row) = self.rows.first() else { return Vec::new() };
        let axes = Axes::different(&self.stage.patches[*row]);
        let by_row_sum = self.row_sums.common.is_some();
        let at = |n: u32| -> Vec<Candidate> {
            let camera = Camera::new(self.stage, &self.world, n);
            // Which side is missing depends on where their axes point.
            let mut tables: Vec<Table> = models.iter().map(|m| Table::new(n, *m)).collect();
            for k in 0..3 * models.len() {
                tables.push(tables[k].clone().turned());
            }
            let tables: Vec<&Table> = tables.iter().collect();
            let mut best = vec![0; models.len()];
            for axes in &axes {
                let confirmed = camera.compare(self.f, &[*row], *axes, &tables, &|v| self.slack(v));
                for (k, c) in confirmed.iter().enumerate() {
                    let best = &mut best[k % models.len()];
                    *best = (*best).max(if c.share() >= 0.4 { c.entries } else { 0 });
                }
            }
            let fits = models.iter().zip(best).filter(|(_, entries)| *entries >= 4);
            fits.map(|(m, _)| Candidate::new(*m, [n, n], by_row_sum)).collect()
        };
        let tried: Vec<u32> = (4..=last).step_by(2).collect();
        tried.par_iter().flat_map_iter(|n| at(*n)).collect()
    }

    /// How far an entry reproduced may be off.
    fn slack(&self, value: f64) -> f64 {
        2.0 * self.digits.error(value) + 1e-10 * value + 1e-14
    }

    /// A candidate with its small entries looked up and its pixels drawn, and the like whose row sums are the same.
    fn judged(&self, candidate: Candidate) -> Vec<Candidate> {
        let [low, high] = candidate.resolutions;
        if high - low > 64 {
            return vec![candidate];
        }
        let mut entries = self.entries.clone();
        entries.dedup_by(|b, a| (*b - *a) <= 1e-11 * *a);
        entries.truncate(64);
        let mut drawn = Vec::new();
        for n in (low..=high).step_by(2) {
            let table = Table::new(n, candidate.model);
            let lattice = Lattice::of(&entries, &table.deltas(), self.digits);
            let mut models = vec![candidate.model];
            if candidate.model.mistake == Mistake::None {
                models.push(Model { mistake: Mistake::SidesUpsideDown, ..candidate.model });
            }
            for model in models.into_iter().filter(|m| m.rule != Rule::Exact || m.mistake != Mistake::SidesUpsideDown) {
                let mut one = Candidate { model, resolutions: [n, n], ..candidate.clone() };
                one.lattice = Some(lattice);
                if model.mistake.is_pictured() && n <= 1024 {
                    let (confirmed, axes) = self.drawn(n, model);
                    (one.confirmed, one.axes) = (Some(confirmed), confirmed.holds().then_some(axes));
                }
                drawn.push(one);
            }
        }
        if drawn.iter().any(Candidate::is_drawn) {
            drawn.retain(Candidate::is_drawn);
            return drawn;
        }
        // Nothing reproduced: the turn is unknown, and with it whether sides are upside down.
        let told = drawn.iter().find(|c| c.model == candidate.model).cloned();
        if low == high { told.into_iter().collect() } else { vec![candidate] }
    }

    /// Draws a model at a resolution: the turn that reproduces most, on all chosen rows.
    fn drawn(&self, n: u32, model: Model) -> (Confirmed, Axes) {
        let camera = Camera::new(self.stage, &self.world, n);
        let mut tables = vec![Table::new(n, model)];
        if matches!(model.mistake, Mistake::MissingSide | Mistake::MissingTwoSides) {
            for k in 0..3 {
                tables.push(tables[k].clone().turned());
            }
        }
        let refs: Vec<&Table> = tables.iter().collect();
        let trial = &self.rows[..self.rows.len().min(TRIAL_ROWS)];
        let mut best = (0, Axes::all().next(), 0);
        for axes in Axes::all() {
            let found = camera.compare(self.f, trial, axes, &refs, &|v| self.slack(v));
            for (which, c) in found.iter().enumerate() {
                if c.entries > best.0 {
                    best = (c.entries, Some(axes), which);
                }
            }
        }
        let axes = best.1.unwrap_or(Axes { axis: super::Axis::FirstEdge, diagonal: false });
        let rows = &self.rows[..self.rows.len().min(CONFIRMED_ROWS)];
        let confirmed = camera.compare(self.f, rows, axes, &refs[best.2..=best.2], &|v| self.slack(v));
        (confirmed.first().copied().unwrap_or_default(), axes)
    }

    /// Puts the result together: what all candidates as good as the best agree on.
    pub fn conclude(&self, likeness: Likeness, candidates: Vec<Candidate>) -> Fingerprint {
        let told = likeness == Likeness::Hemicube;
        let best = candidates.first().filter(|_| told);
        let rivals: Vec<&Candidate> = candidates.iter().filter(|c| best.is_some_and(|b| c.is_as_good_as(b))).collect();
        let agreed = |same: &dyn Fn(&Candidate, &Candidate) -> bool| best.filter(|b| rivals.iter().all(|c| same(b, c)));
        let mut out = Fingerprint {
            likeness,
            resolution: agreed(&|a, b| a.resolutions == b.resolutions).and_then(Candidate::resolution),
            rule: agreed(&|a, b| a.model.rule == b.model.rule).map(|c| c.model.rule),
            mistake: agreed(&|a, b| a.model.mistake == b.model.mistake).map(|c| c.model.mistake),
            axes: best.and_then(|c| c.axes),
            confirmed: best.and_then(|c| c.confirmed),
            row_sums: self.row_sums.clone(),
            smallest_entry: self.entries.first().copied(),
            digits: self.digits,
            candidates,
            reasons: Vec::new(),
        };
        out.reasons = words::reasons(&out);
        out
    }
}

impl Candidate {
    fn is_as_good_as(&self, best: &Self) -> bool {
        let share = |c: &Self| c.confirmed.map_or(0.0, |c| c.share());
        let same = self.is_drawn() == best.is_drawn()
            && self.by_row_sum == best.by_row_sum
            && (best.is_drawn() || self.is_on_lattice() == best.is_on_lattice());
        same && (!best.is_drawn() || share(self) >= share(best) - 0.02)
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
