//! The observer: how bright a luminance looks to an eye adapted to another.

use serde::{Deserialize, Serialize};

/// One lambert, cd/m^2.
pub const LAMBERT: f64 = 1e4 / std::f64::consts::PI;

/// The least adaptation the model is good for, dB above 1e-10 lamberts: below it, more light would look darker.
pub const LEAST_STEVENS: f64 = 27.0;

/// An eye adapted to a white background, after Stevens and Stevens [TR93 eq. 7].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Observer {
    /// Luminance of the background that it is adapted to, cd/m^2.
    pub adapted_to: f64,
}

impl Observer {
    /// Adapted to a background of this luminance, cd/m^2 and above 0.
    pub fn new(adapted_to: f64) -> Self {
        Self { adapted_to }
    }

    /// The same, but not below [`LEAST_STEVENS`].
    pub fn within_the_model(self) -> Self {
        if self.is_inverted() { Self { adapted_to: from_decibels(LEAST_STEVENS) } } else { self }
    }

    fn log_background(&self) -> f64 {
        (self.adapted_to / LAMBERT).log10()
    }

    /// The background in dB above 1e-10 lamberts [TR93 eq. 8a].
    pub fn stevens(&self) -> f64 {
        100.0 + 10.0 * self.log_background()
    }

    /// True where the model says that more light looks darker: below 27 dB [TR93 eq. 8c].
    pub fn is_inverted(&self) -> bool {
        self.stevens() < LEAST_STEVENS
    }

    /// Exponent of the power law [TR93 eq. 9]; 0 at [`LEAST_STEVENS`].
    pub fn alpha(&self) -> f64 {
        0.4 * self.log_background() + 2.92
    }

    /// Logarithm of its factor, luminances in lamberts [TR93 eq. 10].
    pub fn beta(&self) -> f64 {
        let w = self.log_background();
        -0.4 * w * w - 2.584 * w + 2.0208
    }

    /// Brightness of a luminance (cd/m^2), brils. What gives no light has none.
    pub fn brightness(&self, luminance: f64) -> f64 {
        if luminance > 0.0 { 10f64.powf(self.beta() + self.alpha() * (luminance / LAMBERT).log10()) } else { 0.0 }
    }
}

/// The luminance so many dB above 1e-10 lamberts, cd/m^2.
fn from_decibels(decibels: f64) -> f64 {
    LAMBERT * 10f64.powf((decibels - 100.0) / 10.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn by_decibels(background: f64, target: f64) -> f64 {
        let s = 100.0 + 10.0 * (background / LAMBERT).log10();
        let r = 10.0 * (background / target).log10();
        10f64.powf(0.004 * ((s - 27.0) * (8.4 - r) - 108.0))
    }

    #[test]
    fn the_power_law_is_stevens_in_decibels() {
        for background in [1e-3, 0.1, 3.0, 100.0, 1e5] {
            for ratio in [1e-3, 0.05, 1.0, 8.0] {
                let (ours, his) = (
                    Observer::new(background).brightness(background * ratio),
                    by_decibels(background, background * ratio),
                );
                assert!((ours / his - 1.0).abs() < 1e-11, "{background} {ratio}: {ours} {his}");
            }
        }
        // Figure 4: 8.4 dB below the background, brightness is the same whatever the background.
        for background in [0.01, 1.0, 1e4] {
            let constant = Observer::new(background).brightness(background * 10f64.powf(-0.84));
            assert!((constant - 0.369_828_179_780).abs() < 1e-11);
        }
    }

    #[test]
    fn below_27_decibels_the_model_is_upside_down() {
        // 10^-7.3 lamberts.
        let edge = 1.595_328_5e-4;
        let (dim, dark) = (Observer::new(edge * 1.001), Observer::new(edge * 0.999));
        assert!(!dim.is_inverted() && dark.is_inverted());
        assert!(dim.brightness(2e-4) > dim.brightness(1e-4) && dark.brightness(2e-4) < dark.brightness(1e-4));
        assert!((dark.within_the_model().adapted_to / edge - 1.0).abs() < 1e-7);
        assert!(dark.within_the_model().alpha().abs() < 1e-12);
        assert_eq!((dim.within_the_model(), dim.brightness(0.0)), (dim, 0.0));
    }
}
