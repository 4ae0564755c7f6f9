//! From spectra to linear Rec. 709.
//!
//! The observer is CIE 1931 in the analytic fit of Wyman, Sloan and Shirley (JCGT 2(2), 2013, section 2.2, one-lobe
//! pieces of several Gaussians); D65 is CIE's table at 10 nm.

/// First and last wavelength that the observer sees, nm.
const SEEN: [f64; 2] = [360.0, 830.0];
/// Steps of 1 nm.
const STEPS: usize = 470;

/// D65 from 360 to 830 nm in steps of 10 nm, 100 at 560 nm.
const D65: [f64; 48] = [
    46.6383, 52.0891, 49.9755, 54.6482, 82.7549, 91.486, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861, 115.923,
    108.811, 109.354, 107.802, 104.79, 107.689, 104.405, 104.046, 100.0, 96.3342, 95.788, 88.6856, 90.0062, 89.5991,
    87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.349, 61.604, 69.8856, 75.087,
    63.5927, 46.4182, 66.8054, 63.3828, 64.304, 59.4519, 51.959, 57.4406, 60.3125,
];

/// From XYZ to Rec. 709, white D65.
const TO_REC709: [[f64; 3]; 3] = [
    [3.240_969_941_904_523, -1.537_383_177_570_094, -0.498_610_760_293_003],
    [-0.969_243_636_280_880, 1.875_967_501_507_721, 0.041_555_057_407_176],
    [0.055_630_079_696_993, -0.203_976_958_888_977, 1.056_971_514_242_879],
];

/// What a spectrum says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Use {
    /// A share, seen in daylight (D65): what reflects all alike is white.
    Reflectance,
    /// Power: seen as it is.
    Emission,
}

/// Wavelengths (nm, rising) with values; straight lines between, nothing beyond.
pub(super) struct Spectrum(pub Vec<(f64, f64)>);

impl Spectrum {
    fn at(&self, wavelength: f64) -> f64 {
        let next = self.0.partition_point(|(w, _)| *w <= wavelength);
        match (next.checked_sub(1).map(|i| self.0[i]), self.0.get(next)) {
            (Some((w0, v0)), Some((w1, v1))) => v0 + (v1 - v0) * (wavelength - w0) / (w1 - w0),
            (Some((w, v)), None) if w == wavelength => v,
            _ => 0.0,
        }
    }

    /// Red, green and blue; may be negative for saturated colours.
    pub(super) fn rec709(&self, what: Use) -> [f64; 3] {
        rec709(what, |w| self.at(w))
    }
}

/// A spectrum of one value at all wavelengths.
pub(super) fn even(value: f64, what: Use) -> [f64; 3] {
    rec709(what, |_| value)
}

fn rec709(what: Use, spectrum: impl Fn(f64) -> f64) -> [f64; 3] {
    let light = |w: f64| if what == Use::Reflectance { daylight(w) } else { 1.0 };
    let found = bands(|w| light(w) * spectrum(w));
    match what {
        // The fit's own white, band by band, so that grey stays grey.
        Use::Reflectance => {
            let white = bands(light);
            [0, 1, 2].map(|b| found[b] / white[b])
        }
        Use::Emission => {
            let seen: f64 = wavelengths().map(|w| observer(w)[1]).sum();
            found.map(|v| v / seen)
        }
    }
}

fn bands(power: impl Fn(f64) -> f64) -> [f64; 3] {
    let mut xyz = [0.0; 3];
    for w in wavelengths() {
        let p = power(w);
        xyz.iter_mut().zip(observer(w)).for_each(|(sum, seen)| *sum += p * seen);
    }
    TO_REC709.map(|row| row.iter().zip(xyz).map(|(m, v)| m * v).sum())
}

fn wavelengths() -> impl Iterator<Item = f64> {
    (0..STEPS).map(|i| SEEN[0] + 0.5 + i as f64)
}

fn daylight(wavelength: f64) -> f64 {
    let at = ((wavelength - SEEN[0]) / 10.0).clamp(0.0, D65.len() as f64 - 1.0);
    let i = (at as usize).min(D65.len() - 2);
    D65[i] + (D65[i + 1] - D65[i]) * (at - i as f64)
}

/// Matching functions of the CIE 1931 observer.
fn observer(w: f64) -> [f64; 3] {
    let lobe = |height: f64, middle: f64, below: f64, above: f64| {
        let t = (w - middle) / if w < middle { below } else { above };
        height * (-0.5 * t * t).exp()
    };
    [
        lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) + lobe(-0.065, 501.1, 20.4, 26.2),
        lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1),
        lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn daylight_has_the_white_point_of_rec709() {
        let mut xyz = [0.0; 3];
        for w in wavelengths() {
            xyz.iter_mut().zip(observer(w)).for_each(|(sum, seen)| *sum += daylight(w) * seen);
        }
        let sum: f64 = xyz.iter().sum();
        // CIE: (0.31272, 0.32903); the fit is good to a part in a hundred.
        assert!((xyz[0] / sum - 0.31272).abs() < 0.002 && (xyz[1] / sum - 0.32903).abs() < 0.002, "{xyz:?}");
    }

    #[test]
    fn grey_reflects_grey_and_even_power_looks_reddish() {
        assert!(even(0.3, Use::Reflectance).iter().all(|v| (v - 0.3).abs() < 1e-12));
        // Equal energy: X = Y = Z = 1.
        let rows = TO_REC709.map(|row| row.iter().sum::<f64>());
        let found = even(1.0, Use::Emission);
        assert!(rows.iter().zip(found).all(|(a, b)| (a - b).abs() < 0.01), "{found:?} {rows:?}");
    }

    #[test]
    fn a_lamp_is_seen_as_by_the_tabulated_observer() {
        let lamp = Spectrum(vec![(400.0, 0.0), (500.0, 8.0), (600.0, 15.6), (700.0, 18.4)]);
        // The same sums over CIE's table of 1 nm.
        for (found, exact) in lamp.rec709(Use::Emission).iter().zip([20.720_145, 10.854_297, 2.770_084]) {
            assert!((found / exact - 1.0).abs() < 0.01, "{found} {exact}");
        }
    }

    #[test]
    fn values_lie_on_straight_lines_and_nothing_lies_beyond() {
        let s = Spectrum(vec![(400.0, 0.0), (500.0, 8.0), (700.0, 4.0)]);
        assert_eq!([399.0, 450.0, 500.0, 600.0, 700.0, 701.0].map(|w| s.at(w)), [0.0, 4.0, 8.0, 6.0, 4.0, 0.0]);
    }
}
