//! Which shot comes next [GSG90 fig. 4].

use super::row::Row;
use super::{Shooting, Strategy};
use crate::methods::MethodInfo;

/// The next shot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Next {
    /// What patch i has unshot.
    Propagate(usize),
    /// What patch i has shot in version v.
    Redistribute(usize, usize),
    /// What patch i has shot, towards an object that is being dragged.
    Preview(usize),
}

/// A patch with the luminous power it would shoot, W.
type Ranked<T> = Option<(f64, T)>;

fn larger<T>(best: Ranked<T>, key: f64, what: T) -> Ranked<T> {
    match best {
        Some((k, _)) if k >= key => best,
        _ => Some((key, what)),
    }
}

impl Shooting {
    /// The next shot; `None` if there is nothing to shoot at all.
    pub(super) fn next(&mut self) -> Option<Next> {
        if let Some(i) = self.next_preview(false) {
            return Some(Next::Preview(i));
        }
        while let Some(i) = self.lamps.pop() {
            // What rounding leaves is no light.
            if self.unshot[i] > 1e-12 * self.emitted {
                return Some(Next::Propagate(i));
            }
        }
        if self.is_settled() {
            return self.next_preview(true).map(Next::Preview);
        }
        // A patch that lacks no more than rounding of all the light has nothing to shoot: else `unshot=0` never ends.
        let propagate = self.most_unshot().filter(|(u, _)| *u > f64::EPSILON * self.emitted);
        let redistribute = self.most_to_redistribute();
        let Some((energy, (v, i))) = redistribute else {
            return propagate.map(|(_, i)| Next::Propagate(i)).or_else(|| self.next_preview(true).map(Next::Preview));
        };
        // Where the estimates see nothing more to redistribute, all that is left in the log goes at once. Each shot brings a
        // little that is unshot, and to shoot that before the next one would be to converge once for each of them.
        let may_stay = self.params.stop.unshot * self.emitted;
        self.drains |= self.unshot_share() <= self.params.stop.unshot && self.left_in_log() <= may_stay;
        self.redistribute_first &= self.params.threshold == 0.0 || energy > self.params.threshold * self.emitted;
        let first = self.drains || (self.params.strategy == Strategy::One && self.redistribute_first);
        match propagate {
            // Below what may stay unshot only the log is left.
            Some((unshot, j)) if !first && unshot > energy && self.unshot_share() > self.params.stop.unshot => {
                Some(Next::Propagate(j))
            }
            _ => Some(Next::Redistribute(v, i)),
        }
    }

    fn luminous_unshot(&self, i: usize) -> f64 {
        self.weights.iter().enumerate().map(|(c, w)| w * self.unshot_at(i, c).abs()).sum()
    }

    /// Looks again at what patches have unshot: those that a shot reached, or all.
    pub(super) fn refresh(&mut self, reached: Option<&Row>) {
        let patches = self.stage.patch_count();
        match reached {
            // Elements of a patch are mostly reached by one shot: beyond this, all patches are less to look at.
            Some(row) if row.sinks.len() < patches / 2 => {
                for sink in &row.sinks {
                    if let Some(e) = self.stage.elements.get(*sink as usize) {
                        let i = e.patch as usize;
                        self.unshot[i] = self.luminous_unshot(i);
                    }
                }
            }
            Some(_) => (0..patches).for_each(|i| self.unshot[i] = self.luminous_unshot(i)),
            None => {
                self.unshot = (0..patches).map(|i| self.luminous_unshot(i)).collect();
                self.emitted = self.luminous_emission();
                if self.emitted == 0.0 {
                    // All lamps are out: what is still to be taken back is measured by what they gave.
                    self.emitted = self.brightest;
                }
                self.brightest = self.brightest.max(self.emitted);
            }
        }
    }

    /// Looks again at one patch.
    pub(super) fn refresh_one(&mut self, i: usize) {
        self.unshot[i] = self.luminous_unshot(i);
    }

    fn most_unshot(&self) -> Ranked<usize> {
        self.unshot.iter().enumerate().fold(None, |best, (i, u)| larger(best, *u, i))
    }

    /// Luminous power to be redistributed as estimated, W.
    fn left_in_log(&self) -> f64 {
        self.versions.iter().flat_map(|v| &v.queue).map(|(key, _)| key).sum()
    }

    fn most_to_redistribute(&self) -> Ranked<(usize, usize)> {
        let heads = self.versions.iter().enumerate().filter_map(|(v, version)| Some((v, *version.queue.last()?)));
        heads.fold(None, |best, (v, (key, i))| larger(best, key, (v, i as usize)))
    }

    /// Luminous power emitted, W.
    fn luminous_emission(&self) -> f64 {
        let bands = self.field.bands;
        let of = |i: usize| self.stage.patches[i].area * self.luminous(&self.vectors.emission[i * bands..][..bands]);
        (0..self.stage.patch_count()).map(of).sum()
    }

    /// Luminous power unshot as a share of what is emitted (of the most that was ever emitted, where all lamps are
    /// out); signs do not cancel.
    pub fn unshot_share(&self) -> f64 {
        let unshot: f64 = self.unshot.iter().sum();
        if unshot == 0.0 { 0.0 } else { unshot / self.emitted }
    }

    /// True if the log is drained and no more is unshot than may be.
    pub(super) fn is_settled(&self) -> bool {
        self.is_drained() && self.unshot_share() <= self.params.stop.unshot
    }

    /// True if no power is left in old versions.
    pub fn is_drained(&self) -> bool {
        self.versions.len() == 1
    }

    /// How far it has come: shots, and what is unshot relative to what is emitted, in the area-weighted RMS of each
    /// band.
    pub fn info(&self) -> MethodInfo {
        let bands = self.field.bands;
        let unshot = self.unshot();
        let norm = |values: &[f64], c: usize| {
            let patches = self.stage.patches.iter().enumerate();
            patches.map(|(i, p)| p.area * values[i * bands + c].powi(2)).sum::<f64>().sqrt()
        };
        let residual = |c: usize| match norm(&self.vectors.emission, c) {
            0.0 => norm(&unshot.values, c),
            emitted => norm(&unshot.values, c) / emitted,
        };
        MethodInfo {
            iterations: vec![self.costs.shots as usize; bands],
            residual: (0..bands).map(residual).collect(),
            row_sums: None,
        }
    }

    /// Bound on what unshot power may still bring, as a share of all luminous power: unshot / (1 - rho). Says nothing
    /// of form factors, and nothing before the log is drained and a dragged object is shown in full (`None`). Of what
    /// was shot: no ambient estimate, no drag.
    pub fn error_bound(&self) -> Option<f64> {
        if !self.is_drained() || self.next_preview(true).is_some() {
            return None;
        }
        let brightest = self.vectors.reflectance.iter().copied().fold(0.0, f64::max);
        let bands = self.field.bands;
        // A B = A E + rho P, band by band.
        let leaving = |i: usize, c: usize| {
            let at = i * bands + c;
            self.stage.patches[i].area * self.vectors.emission[at]
                + self.vectors.reflectance[at] * self.field.of_patch(i, c)
        };
        let of = |i: usize| self.weights.iter().enumerate().map(|(c, w)| w * leaving(i, c).abs()).sum::<f64>();
        let all: f64 = (0..self.stage.patch_count()).map(of).sum();
        let missing = self.unshot.iter().sum::<f64>() / (1.0 - brightest);
        (all > 0.0).then(|| missing / all)
    }

    /// What unshot power would bring if it lit everything alike, as irradiance per band, W/m^2: for display. The mean
    /// of the unshot power over the area, multiplied by reflections off the mean reflectance.
    pub fn ambient(&self) -> Vec<f64> {
        let bands = self.field.bands;
        let area: f64 = self.stage.patches.iter().map(|p| p.area).sum();
        if area == 0.0 {
            return vec![0.0; bands];
        }
        let of = |c: usize| {
            let patches = || self.stage.patches.iter().enumerate();
            let unshot: f64 = patches().map(|(i, _)| self.unshot_at(i, c)).sum();
            let rho = patches().map(|(i, p)| p.area * self.vectors.reflectance[i * bands + c]).sum::<f64>() / area;
            unshot / area / (1.0 - rho)
        };
        (0..bands).map(of).collect()
    }
}
