//! How many rays, in how many randomisations, and when to stop.

use serde::{Deserialize, Serialize};
use std::time::Duration;

/// What a run may spend.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Rays per patch over all randomisations; rounded up to R 2^m.
    pub rays: u64,
    /// Independent randomisations R of the whole scene, at least 8.
    pub randomisations: u16,
    /// Stop as soon as this relative error is reached, instead of at `rays`.
    pub target_error: Option<f64>,
    /// Stop when another doubling would not fit into this time.
    pub max_time: Option<Duration>,
    /// How pairs are settled before rays are cast for the others.
    #[serde(default)]
    pub estimator: Estimator,
}

/// Where form factors come from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Estimator {
    /// Whatever is most accurate: closed forms and exact shadows for pairs, rays for the rest.
    Auto,
    /// Hemisphere rays only.
    #[default]
    Rays,
}

impl Estimator {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Estimator::Auto => "auto",
            Estimator::Rays => "rays",
        }
    }
}

impl Default for Plan {
    fn default() -> Self {
        Self { rays: 16_384, randomisations: 16, target_error: None, max_time: None, estimator: Estimator::Rays }
    }
}

/// Rays per patch beyond which a target error is given up: 2^32.
pub const RAYS_CAP: u64 = 1 << 32;

impl Plan {
    /// Rays per patch and randomisation at which a run without target stops: a power of two.
    pub fn rays_per_randomisation(&self) -> u64 {
        let rays = if self.target_error.is_some() { RAYS_CAP } else { self.rays };
        rays.div_ceil(u64::from(self.randomisations)).max(1).next_power_of_two()
    }

    /// Rays per patch and randomisation after each wave: one wave where nothing can stop a run early, else
    /// doubling ones.
    pub fn waves(&self) -> Vec<u64> {
        let last = self.rays_per_randomisation();
        if self.target_error.is_none() && self.max_time.is_none() {
            return vec![last];
        }
        let mut waves = vec![last.min(64)];
        while waves[waves.len() - 1] < last {
            waves.push(waves[waves.len() - 1] * 2);
        }
        waves
    }
}

/// Why a run ended, and what it reached.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Reached {
    /// Rays per patch over all randomisations.
    pub rays_per_patch: u64,
    /// Relative error reached: one sigma, in the norm of `--target-error`.
    pub relative_error: f64,
    /// True if a target error was asked for and not reached.
    pub missed_target: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_are_rounded_up_to_powers_of_two() {
        let plan = Plan { rays: 10_000, ..Plan::default() };
        assert_eq!(plan.rays_per_randomisation(), 1024);
        assert_eq!(plan.waves(), [1024]);
        let timed = Plan { rays: 4096, max_time: Some(Duration::from_secs(1)), ..Plan::default() };
        assert_eq!(timed.waves(), [64, 128, 256]);
    }
}
