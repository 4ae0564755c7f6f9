//! What a solver tells: radiosities, energy, the log.

use super::Shooting;
use super::energy::Energy;
use super::fan::{EXCESS_SINK, back_sink, escaped_sink};
use super::field::{Field, Plane};
use super::preview::Preview;
use super::version::{LogEntry, Version};
use crate::math::compensated_sum;
use crate::scene::Stage;
use crate::solution::Radiosity;

impl Shooting {
    /// Radiosities per patch, W/m^2, as far as they are known, with the standard errors of the rays (none with
    /// hemi-cubes, which have no noise). Includes what a drag shows.
    pub fn radiosity(&self) -> Radiosity {
        let stage = self.seen_stage();
        let patches = stage.patches.iter().enumerate().map(|(i, p)| (i, p.area));
        self.radiosities(stage, patches, |plane| &plane.patches)
    }

    /// Radiosities per element, W/m^2.
    pub fn element_radiosity(&self) -> Radiosity {
        let stage = self.seen_stage();
        let elements = stage.elements.iter().map(|e| (e.patch as usize, e.area));
        self.radiosities(stage, elements, |plane| &plane.elements)
    }

    fn seen_stage(&self) -> &Stage {
        self.preview.as_ref().and_then(Preview::stage).unwrap_or(&self.stage)
    }

    /// Radiosities of receivers, each with its patch and its area.
    fn radiosities(
        &self,
        stage: &Stage,
        receivers: impl ExactSizeIterator<Item = (usize, f64)>,
        power: impl Fn(&Plane) -> &[f64],
    ) -> Radiosity {
        let (bands, channels, count) = (self.field.bands, self.field.channels(), receivers.len());
        let preview = self.preview.as_ref().and_then(Preview::field);
        let arrived = |field: &Field, channel: usize, at: usize| power(&field.planes[channel])[at];
        let mut values = vec![0.0; count * bands];
        let mut std_err = (channels > 1).then(|| vec![0.0; count * bands]);
        let ambient = if self.params.ambient { self.ambient() } else { vec![0.0; bands] };
        for (k, (patch, area)) in receivers.enumerate().filter(|(_, (_, area))| *area > 0.0) {
            let (emission, reflectance) = (stage.emission(patch), stage.reflectance(patch));
            for c in 0..bands {
                let at = k * bands + c;
                let received = |channel: usize| {
                    (arrived(&self.field, channel, at) + preview.map_or(0.0, |p| arrived(p, channel, at))) / area
                };
                values[at] = emission[c] + reflectance[c] * (received(0) + ambient[c]);
                if let Some(std_err) = &mut std_err {
                    std_err[at] = reflectance[c] * std_err_of_mean((1..channels).map(received));
                }
            }
        }
        Radiosity { bands, values, std_err }
    }

    /// What each patch has still to shoot, as radiosity, W/m^2: `B - U` is what it has shot.
    pub fn unshot(&self) -> Radiosity {
        let bands = self.field.bands;
        let of = |i: usize| {
            let area = self.stage.patches[i].area;
            (0..bands).map(move |c| if area > 0.0 { self.unshot_at(i, c) / area } else { 0.0 })
        };
        let values = (0..self.stage.patch_count()).flat_map(of).collect();
        Radiosity { bands, values, std_err: None }
    }

    /// Where all power is now.
    pub fn energy(&self) -> Energy {
        let (bands, width) = (self.field.bands, self.field.width());
        let patches = &self.stage.patches;
        let over = |present: bool, f: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            let chosen = |i: &usize| patches[*i].is_present() == present;
            (0..bands).map(|c| compensated_sum((0..patches.len()).filter(chosen).map(|i| f(i, c)))).collect()
        };
        let (e, rho) = (&self.vectors.emission, &self.vectors.reflectance);
        let arrived = |i: usize, c: usize| self.field.of_patch(i, c);
        let at = |sink: usize| (0..bands).map(|c| self.field.at(sink, c)).collect::<Vec<f64>>();
        Energy {
            emitted: over(true, &|i, c| patches[i].area * e[i * bands + c]),
            absorbed: over(true, &|i, c| (1.0 - rho[i * bands + c]) * arrived(i, c)),
            unshot: over(true, &|i, c| self.unshot_at(i, c)),
            escaped: at(escaped_sink(&self.stage)),
            backs: at(back_sink(&self.stage)),
            excess: at(self.stage.elements.len() + EXCESS_SINK).iter().map(|x| -x).collect(),
            left_behind: over(false, &|i, c| arrived(i, c) - self.shot[i * width + c]),
            brightest: self.brightest,
        }
    }

    /// What has not been redistributed, version by version, oldest first; empty if the log is drained.
    pub fn log(&self) -> Vec<LogEntry> {
        let (bands, width) = (self.field.bands, self.field.width());
        let entry = |v: &Version| {
            let holding = (0..self.stage.patch_count()).filter(|i| v.holds(*i, width));
            let patches: Vec<(usize, Vec<f64>)> = holding.map(|i| (i, v.shot[i * width..][..bands].to_vec())).collect();
            let amount = |i: usize| v.weight[i] * self.luminous(&v.shot[i * width..][..bands]);
            let largest = patches.iter().map(|(i, _)| (*i, amount(*i))).max_by(|a, b| a.1.total_cmp(&b.1));
            LogEntry { state: v.state, edits: v.edits.clone(), patches, largest }
        };
        self.versions[..self.versions.len() - 1].iter().map(entry).collect()
    }
}

/// `sqrt(sum (x_r - mean)^2 / (R (R - 1)))`.
fn std_err_of_mean(replicates: impl Iterator<Item = f64> + Clone) -> f64 {
    let r = replicates.clone().count() as f64;
    let mean = replicates.clone().sum::<f64>() / r;
    (replicates.map(|x| (x - mean).powi(2)).sum::<f64>() / (r * (r - 1.0))).sqrt()
}
