//! The operator of Tumblin and Rushmeier against exact values, and its law against Stevens' own [TR93 eq. 8c].

use crate::view::{Display, LAMBERT, Observer, Tone};
use serde::{Deserialize, Serialize};

/// Values are held to this, relative and absolute.
pub const DISPLAY_TOLERANCE: f64 = 1e-6;

/// The file, part of the program.
const TEXT: &str = include_str!("../../../references/truth/display.json");

#[derive(Deserialize)]
struct File {
    rows: Vec<Exact>,
}

/// Decimals of ten digits, cd/m^2.
#[derive(Deserialize)]
struct Exact {
    #[serde(rename = "L_w_rw_cd")]
    adapted_to: String,
    #[serde(rename = "L_rw_cd")]
    luminance: String,
    #[serde(rename = "L_d_cd")]
    screen: String,
    #[serde(rename = "n_clipped")]
    value: String,
}

/// One luminance through the operator, on the paper's screen.
#[derive(Debug, Clone, Serialize)]
pub struct DisplayRow {
    /// Background that the eye in the scene is adapted to, cd/m^2.
    pub adapted_to: f64,
    /// Luminance in the scene, cd/m^2.
    pub luminance: f64,
    /// Luminance on the screen, cd/m^2: exact, and ours.
    pub screen: [f64; 2],
    /// Frame-buffer value, 0 to 1: exact, and ours.
    pub value: [f64; 2],
    /// True if both are right.
    pub passed: bool,
}

/// Brightness of a target before backgrounds [TR93 fig. 4].
#[derive(Debug, Clone, Serialize)]
pub struct BrightnessCurve {
    /// Background, dB above 1e-10 lamberts.
    pub background: f64,
    /// (luminance of the target in dB, brightness in brils).
    pub points: Vec<(f64, f64)>,
}

/// The suite.
#[derive(Debug, Clone, Serialize)]
pub struct DisplaySuite {
    /// Exact values.
    pub rows: Vec<DisplayRow>,
    /// Stevens' curves.
    pub curves: Vec<BrightnessCurve>,
    /// Largest relative difference between the power law and Stevens' law in dB along them.
    pub law: f64,
}

/// Runs the suite. No rays, no randomness.
pub fn display() -> DisplaySuite {
    // The text is part of the program, and a test reads it.
    let rows = serde_json::from_str::<File>(TEXT).map(|f| f.rows).unwrap_or_default();
    let curves: Vec<BrightnessCurve> = (3..=10).map(|k| curve(10.0 * f64::from(k))).collect();
    let off = |c: &BrightnessCurve, (target, brils): &(f64, f64)| (brils / stevens(c.background, *target) - 1.0).abs();
    let law = curves.iter().flat_map(|c| c.points.iter().map(move |p| off(c, p))).fold(0.0, f64::max);
    DisplaySuite { rows: rows.iter().map(row).collect(), curves, law }
}

fn row(exact: &Exact) -> DisplayRow {
    let number = |text: &str| text.parse().unwrap_or(f64::NAN);
    let (adapted_to, luminance) = (number(&exact.adapted_to), number(&exact.luminance));
    let crt = Display::crt();
    let tone = Tone::between(Observer::new(adapted_to), Observer::new(crt.adapts_to()));
    let screen = [number(&exact.screen), tone.screen(luminance)];
    let value = [number(&exact.value), tone.drive(&crt, luminance).shown()];
    let right = |[exact, ours]: [f64; 2]| (ours - exact).abs() <= DISPLAY_TOLERANCE * exact.abs().max(1.0);
    DisplayRow { adapted_to, luminance, screen, value, passed: right(screen) && right(value) }
}

/// From 30 dB below the background, where black is, to the background itself.
fn curve(background: f64) -> BrightnessCurve {
    let luminance = |decibels: f64| LAMBERT * 10f64.powf((decibels - 100.0) / 10.0);
    let eye = Observer::new(luminance(background));
    let point = |k: i32| {
        let target = background - 30.0 + f64::from(k);
        (target, eye.brightness(luminance(target)))
    };
    BrightnessCurve { background, points: (0..=30).map(point).collect() }
}

/// Brils of a target before a background, both in dB [TR93 eq. 8c].
fn stevens(background: f64, target: f64) -> f64 {
    10f64.powf(0.004 * ((background - 27.0) * (8.4 - (background - target)) - 108.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_rows_are_there_and_right() {
        let suite = display();
        assert_eq!((suite.rows.len(), suite.curves.len()), (40, 8));
        assert!(suite.rows.iter().all(|r| r.passed));
        assert!(suite.law < 1e-10, "{}", suite.law);
        let wrong = row(&Exact {
            adapted_to: "100".into(),
            luminance: "50".into(),
            // Candela where lamberts belong.
            screen: "8.2181988".into(),
            value: "0.10511621".into(),
        });
        assert!(!wrong.passed);
    }
}
