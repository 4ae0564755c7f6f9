//! From candidates to a conclusion: small entries looked up, rows drawn.

use super::axes::Axes;
use super::borders::BORDER_PICTURES;
use super::candidates::Candidate;
use super::lattice::Lattice;
use super::model::{Mistake, Model, Rule};
use super::pictures::{Camera, Confirmed};
use super::search::{CONFIRMED_ROWS, Found, Search, Work};
use super::sheets::Sheet;
use super::tables::Table;
use super::{Fingerprint, Likeness, words};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Rows that tell how the hemi-cubes are turned, at least; more where these do not tell all axes apart.
const TRIAL_ROWS: usize = 2;
/// Resolutions that fit a clue alike beyond which none of them is looked into.
const MOST_ALIKE: u32 = 64;
/// The highest resolution drawn.
const LAST_DRAWN: u32 = 1024;

impl Search<'_> {
    /// A candidate with its small entries looked up and its pixels drawn, and the like whose row sums are the same.
    pub(super) fn judged(&self, candidate: Candidate, work: &mut Work) -> Vec<Candidate> {
        let [low, high] = candidate.resolutions;
        if high - low > MOST_ALIKE {
            return vec![candidate];
        }
        let mut models = vec![candidate.model];
        if candidate.model.mistake == Mistake::None && candidate.model.rule != Rule::Exact {
            models.push(Model { mistake: Mistake::SidesUpsideDown, ..candidate.model });
        }
        let each = |n: u32| -> Vec<Candidate> {
            let lattice = Lattice::of(&self.small, &Table::new(n, candidate.model).deltas(), self.digits);
            let results = self.drawn(n, &models, work);
            let with = |(k, model): (usize, &Model)| {
                let confirmed = results.as_ref().map(|r| r[k].0);
                let axes = results.as_ref().filter(|r| r[k].0.holds()).map(|r| r[k].1);
                let (lattice, resolutions) = (Some(lattice), [n, n]);
                Candidate { model: *model, resolutions, lattice, confirmed, axes, ..candidate.clone() }
            };
            models.iter().enumerate().map(with).collect()
        };
        let mut drawn: Vec<Candidate> = (low..=high).step_by(2).flat_map(each).collect();
        if drawn.iter().any(Candidate::is_drawn) {
            drawn.retain(Candidate::is_drawn);
            return drawn;
        }
        // Nothing reproduced: the turn is unknown, and with it whether sides are upside down.
        let told = drawn.iter().find(|c| c.model == candidate.model).cloned();
        if low == high { told.into_iter().collect() } else { vec![candidate] }
    }

    /// The first rows, and those that tell axes apart which the rows before do not.
    fn trial_rows(&self) -> Vec<usize> {
        let distinct = |all: &[Vec<usize>]| all.iter().collect::<BTreeSet<_>>().len();
        let (mut chosen, mut known) = (Vec::new(), vec![Vec::new(); Axes::all().count()]);
        for row in &self.rows {
            let mut longer = known.clone();
            let classes = Axes::classes(&self.stage.patches[*row]);
            longer.iter_mut().zip(classes).for_each(|(list, class)| list.push(class));
            if chosen.len() < TRIAL_ROWS || distinct(&longer) > distinct(&known) {
                chosen.push(*row);
                known = longer;
            }
        }
        chosen
    }

    /// Draws models at a resolution: for each the turn that reproduces most, on all chosen rows. `None` where it
    /// cannot be drawn or would be too much work.
    fn drawn(&self, n: u32, models: &[Model], work: &mut Work) -> Option<Vec<(Confirmed, Axes)>> {
        if n > LAST_DRAWN || !models.iter().all(|m| m.mistake.is_pictured()) {
            return None;
        }
        let (camera, sheet) = (Camera::new(self.stage, &self.world, n), Sheet::new(n, models));
        let all: Vec<Axes> = Axes::all().collect();
        let trial = self.trial_rows();
        if !work.take(camera.cost(&sheet) * (all.len() * trial.len()) as f64) {
            return None;
        }
        let slack = |v| self.slack(v);
        let of = |axes: &Axes| camera.compare(self.f, &trial, *axes, &sheet, &slack, false);
        let tried: Vec<Vec<Confirmed>> = all.par_iter().map(of).collect();
        let judge = |model: usize| {
            let mut best = (Confirmed::default(), all[0], 0);
            for (axes, found) in all.iter().zip(&tried) {
                for (k, c) in found.iter().enumerate().filter(|(k, _)| sheet.views[*k].model == model) {
                    if c.entries > best.0.entries || best.0.of == 0 {
                        best = (*c, *axes, k);
                    }
                }
            }
            best
        };
        let confirmed = |(found, axes, view): (Confirmed, Axes, usize)| {
            // What reproduces next to nothing will not reproduce more on more rows.
            if 20 * found.entries < found.of
                || !work.take(BORDER_PICTURES * camera.cost(&sheet) * CONFIRMED_ROWS as f64)
            {
                return (found, axes);
            }
            let model = sheet.views[view].model;
            let one = sheet.only(model);
            // Axes that are alike but for quarter turns may differ by one from patch to patch.
            let best = |all: Vec<Confirmed>| all.into_iter().max_by_key(|c| (c.entries, c.by_borders));
            let of = |row: &usize| best(camera.compare(self.f, &[*row], axes, &one, &slack, true)).unwrap_or_default();
            let rows: Vec<Confirmed> = self.rows[..self.rows.len().min(CONFIRMED_ROWS)].par_iter().map(of).collect();
            (rows.into_iter().sum(), axes)
        };
        Some((0..models.len()).map(judge).map(confirmed).collect())
    }

    /// Puts the result together: what all candidates as good as the best agree on.
    pub(super) fn conclude(&self, likeness: Likeness, found: Found) -> Fingerprint {
        let Found { candidates, drawn_to } = found;
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
            drawn_to,
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
