//! Where all power is: the balance that holds after every step.

/// Power per band, W. `emitted + excess = absorbed + unshot + escaped + backs + left_behind`, whatever has been done.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Energy {
    /// What the patches present emit.
    pub emitted: Vec<f64>,
    /// What arrived at patches and was not reflected.
    pub absorbed: Vec<f64>,
    /// What patches have still to shoot; negative where they have shot too much.
    pub unshot: Vec<f64>,
    /// What left an open scene.
    pub escaped: Vec<f64>,
    /// What fell on black backs.
    pub backs: Vec<f64>,
    /// What the table of the hemi-cube handed out beyond what was shot (0.542 / N^2 of it by the midpoint rule).
    pub excess: Vec<f64>,
    /// What arrived at objects that have gone, less what these had shot: 0 once all is redistributed.
    pub left_behind: Vec<f64>,
    /// The most luminous power that was ever emitted, W: what rounding is measured by.
    pub brightest: f64,
}

impl Energy {
    /// The largest gap in the balance of a band, relative to the largest power of the band and to the most that was ever
    /// emitted: rounding alone leaves some 1e-13. 0 for a scene that was never lit.
    pub fn gap(&self) -> f64 {
        let gap = |c: usize| {
            let out = self.absorbed[c] + self.unshot[c] + self.escaped[c] + self.backs[c] + self.left_behind[c];
            let size = self.emitted[c].abs().max(self.absorbed[c].abs()).max(self.escaped[c].abs()).max(self.brightest);
            if size == 0.0 { out.abs() } else { (self.emitted[c] + self.excess[c] - out).abs() / size }
        };
        (0..self.emitted.len()).map(gap).fold(0.0, f64::max)
    }
}
