//! Seeded random numbers for tests.

/// A splitmix64 stream.
pub struct Random(pub u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in (0, 1).
    pub fn uniform(&mut self) -> f64 {
        ((self.bits() >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    /// Standard normal.
    pub fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }

    /// Hits in `trials` independent trials of small probability `p`: jumps from hit to hit.
    pub fn binomial(&mut self, trials: u64, p: f64) -> u64 {
        let (mut at, mut hits) = (0.0, 0);
        loop {
            at += 1.0 + (self.uniform().ln() / (-p).ln_1p()).floor();
            if at > trials as f64 {
                return hits;
            }
            hits += 1;
        }
    }
}
