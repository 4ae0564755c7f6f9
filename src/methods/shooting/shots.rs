//! The two kinds of shots, and their books.

use super::Shooting;
use super::row::Row;

impl Shooting {
    /// Shoots all that patch i has unshot.
    pub(super) fn propagate(&mut self, i: usize) -> usize {
        let g = self.newest().geometry.clone();
        let row = self.whole(&g, i);
        let power = self.unshot_of(i);
        self.field.add(&row, &power);
        let (width, last) = (self.field.width(), self.versions.len() - 1);
        for (c, p) in power.iter().enumerate() {
            self.shot[i * width + c] += p;
            self.versions[last].shot[i * width + c] += p;
        }
        self.account(&row, i);
        row.sinks.len()
    }

    /// Books a shot of patch i.
    pub(super) fn account(&mut self, row: &Row, i: usize) {
        self.costs.shots += 1;
        self.costs.receivers += row.sinks.len() as u64;
        self.refresh(Some(row));
        self.refresh_one(i);
    }

    /// Redistributes what patch i has shot in an old version [GSG90 fig. 2].
    pub(super) fn redistribute(&mut self, version: usize, i: usize) -> usize {
        let row = self.difference(version, i);
        let (width, last) = (self.field.width(), self.versions.len() - 1);
        let range = i * width..(i + 1) * width;
        let power: Vec<f64> = self.versions[version].shot[range.clone()].to_vec();
        self.field.add(&row, &power);
        self.versions[version].shot[range.clone()].fill(0.0);
        let stands = self.stage.patches[i].is_present();
        for (at, p) in range.zip(&power) {
            if stands {
                self.versions[last].shot[at] += p;
            } else {
                // What is not there has shot nothing.
                self.shot[at] -= p;
            }
        }
        let queue = &mut self.versions[version].queue;
        if queue.pop_if(|(_, patch)| *patch as usize == i).is_none() {
            queue.retain(|(_, patch)| *patch as usize != i);
        }
        self.costs.redistributions += 1;
        self.account(&row, i);
        row.sinks.len()
    }

    /// Power that patch i has to shoot, per channel and band, W; nothing for what is not there.
    pub(super) fn unshot_of(&self, i: usize) -> Vec<f64> {
        let width = self.field.width();
        (0..width).map(|c| self.unshot_at(i, c)).collect()
    }

    #[inline]
    pub(super) fn unshot_at(&self, i: usize, channel: usize) -> f64 {
        let area = self.stage.patches[i].area;
        if area == 0.0 {
            return 0.0;
        }
        let bands = self.vectors.bands;
        let at = i * self.field.width() + channel;
        let c = i * bands + channel % bands;
        area * self.vectors.emission[c] + self.vectors.reflectance[c] * self.field.of_patch(i, channel) - self.shot[at]
    }
}
