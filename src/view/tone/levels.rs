//! What an operator has to know of a picture: its mean logarithm and its brightest surface.

use serde::{Deserialize, Serialize};

/// Decibels, as a power of ten, by which the eye's background lies above the mean of the picture [TR93 eq. 11].
const BRIGHTNESS_CONSTANCY: f64 = 0.84;

/// What is below 0 dB, 1e-10 lamberts, nobody sees: it takes no part in the adaptation, cd/m^2.
const THRESHOLD: f64 = 1e-10 * super::LAMBERT;

/// Luminances of a picture, summed up.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Levels {
    /// Geometric mean of what can be seen at all, cd/m^2.
    pub log_mean: f64,
    /// The brightest surface that is no lamp; the brightest of all where there are only lamps, cd/m^2.
    pub brightest_surface: f64,
    /// Share of the picture that is too dark to count in the mean (0 dB and below).
    pub unseen: f64,
}

impl Levels {
    /// Of (luminance in cd/m^2, share of the picture, true for lamps). `None` where nothing can be seen.
    pub fn of(picture: impl IntoIterator<Item = (f64, f64, bool)>) -> Option<Self> {
        let (mut logs, mut seen, mut all) = (Vec::new(), 0.0, 0.0);
        let (mut surface, mut lamp) = (0f64, 0f64);
        for (luminance, share, is_lamp) in picture.into_iter().filter(|(_, s, _)| *s > 0.0) {
            all += share;
            if luminance > THRESHOLD {
                seen += share;
                logs.push(share * luminance.log10());
                let brightest = if is_lamp { &mut lamp } else { &mut surface };
                *brightest = brightest.max(luminance);
            }
        }
        (seen > 0.0).then(|| Self {
            log_mean: 10f64.powf(crate::math::compensated_sum(logs) / seen),
            brightest_surface: if surface > 0.0 { surface } else { lamp },
            unseen: 1.0 - seen / all,
        })
    }

    /// Nothing but what can just not be seen.
    pub fn dark() -> Self {
        Self { log_mean: THRESHOLD, brightest_surface: THRESHOLD, unseen: 1.0 }
    }

    /// The same picture for an eye adapted to this background, cd/m^2 and above 0.
    pub fn adapted_to(&self, background: f64) -> Self {
        Self { log_mean: background / above_the_mean(1.0), ..*self }
    }

    /// The background that an eye in the picture is adapted to, cd/m^2 [TR93 eq. 11].
    pub fn adapts_to(&self) -> f64 {
        above_the_mean(self.log_mean)
    }

    /// The same picture with all light times a factor above 0.
    pub fn times(&self, factor: f64) -> Self {
        Self { log_mean: factor * self.log_mean, brightest_surface: factor * self.brightest_surface, ..*self }
    }
}

/// A luminance as much above another as the eye's background above the mean.
pub(super) fn above_the_mean(luminance: f64) -> f64 {
    luminance * 10f64.powf(BRIGHTNESS_CONSTANCY)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_pixels_by_hand() {
        let pixels = [1.0, 10.0, 100.0, 1000.0].map(|l| (l, 0.25, l > 500.0));
        let levels = Levels::of(pixels).unwrap();
        assert!((levels.adapts_to() - 218.776_162_4).abs() < 1e-6);
        assert_eq!((levels.brightest_surface, levels.unseen), (100.0, 0.0));
    }

    #[test]
    fn black_takes_no_part_and_lamps_alone_are_surfaces() {
        let levels = Levels::of([(0.0, 0.5, false), (4.0, 0.25, true), (1.0, 0.25, true), (9.0, 0.0, false)]).unwrap();
        assert!((levels.log_mean - 2.0).abs() < 1e-12);
        assert_eq!((levels.brightest_surface, levels.unseen), (4.0, 0.5));
        assert_eq!(Levels::of([(0.0, 1.0, false), (-1.0, 1.0, false)]), None);
        assert_eq!(Levels::of([]), None);
    }
}
