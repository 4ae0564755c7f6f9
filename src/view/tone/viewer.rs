//! Somebody who looks at a scene, and at its picture on a screen.

use super::{Display, Drive, Levels, Operator, Surround, Tone};
use serde::{Deserialize, Serialize};

/// Luminous efficacy unless stated otherwise, lm/W: that of Radiance's white.
pub const DEFAULT_EFFICACY: f64 = 179.0;

/// Frame-buffer steps between black and white: eight bits.
const STEPS: f64 = 255.0;

/// Everything that turns a radiosity into what is seen of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Viewer {
    /// Luminous efficacy, lm/W: a weighted radiosity of B W/m^2 has a luminance of `efficacy * B / pi`, cd/m^2.
    pub efficacy: f64,
    /// The operator.
    pub operator: Operator,
    /// The light around the screen.
    pub surround: Surround,
    /// The screen.
    pub display: Display,
    /// What the picture holds, cd/m^2.
    pub levels: Levels,
    /// The operator made ready.
    pub tone: Tone,
}

impl Viewer {
    /// Looks at a picture with these levels.
    pub fn new(operator: Operator, surround: Surround, display: Display, efficacy: f64, levels: Levels) -> Self {
        let tone = operator.on(&display, surround, &levels);
        Self { efficacy, operator, surround, display, levels, tone }
    }

    /// The same eye and screen with another operator.
    pub fn with(&self, operator: Operator) -> Self {
        Self::new(operator, self.surround, self.display.clone(), self.efficacy, self.levels)
    }

    /// Luminance of a diffuse surface, cd/m^2, of its radiosity weighted by band, W/m^2.
    pub fn luminance(&self, radiosity: f64) -> f64 {
        Self::luminance_of(self.efficacy, radiosity)
    }

    /// The same by an efficacy, lm/W.
    pub fn luminance_of(efficacy: f64, radiosity: f64) -> f64 {
        efficacy * radiosity / std::f64::consts::PI
    }

    /// How bright it looks to an eye in the scene, brils; whatever the operator.
    pub fn brightness(&self, radiosity: f64) -> f64 {
        self.eye().brightness(self.luminance(radiosity))
    }

    /// The eye in the scene, kept where its model holds.
    pub fn eye(&self) -> super::Observer {
        super::Observer::new(self.levels.adapts_to()).within_the_model()
    }

    /// What the screen is driven with.
    pub fn drive(&self, radiosity: f64) -> Drive {
        self.tone.drive(&self.display, self.luminance(radiosity))
    }

    /// The value shown, in steps of the frame buffer, 0 to 255, not rounded.
    pub fn steps(&self, radiosity: f64) -> f64 {
        STEPS * self.drive(radiosity).shown()
    }

    /// The radiosities that are shown within one step of this one: from the first to the second.
    pub fn alike(&self, radiosity: f64) -> (f64, f64) {
        let here = self.steps(radiosity);
        let radiosity_at = |steps: f64| {
            let scene = self.tone.scene(self.display.luminance(steps / STEPS));
            scene.map(|l| l / Self::luminance_of(self.efficacy, 1.0))
        };
        let below = if here > 1.0 { radiosity_at(here - 1.0) } else { None };
        let above = if here < STEPS - 1.0 { radiosity_at(here + 1.0) } else { None };
        (below.unwrap_or(f64::NEG_INFINITY), above.unwrap_or(f64::INFINITY))
    }

    /// The least change of this radiosity that moves the screen by one step, as a share of it. `None` where it gives no
    /// light, or none would.
    pub fn least_visible(&self, radiosity: f64) -> Option<f64> {
        let here = self.steps(radiosity);
        let luminance = self.luminance(radiosity);
        let at = |steps: f64| {
            let inside = (0.0..=STEPS).contains(&steps) && luminance > 0.0;
            let scene = inside.then(|| self.tone.scene(self.display.luminance(steps / STEPS)))??;
            Some((scene / luminance - 1.0).abs())
        };
        [at(here - 1.0), at(here + 1.0)].into_iter().flatten().filter(|x| x.is_finite()).min_by(f64::total_cmp)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn viewer(operator: Operator) -> Viewer {
        let levels = Levels { log_mean: 20.0, brightest_surface: 300.0, unseen: 0.0 };
        Viewer::new(operator, Surround::Dim, Display::srgb(), DEFAULT_EFFICACY, levels)
    }

    #[test]
    fn what_is_least_visible_moves_the_screen_by_one_step() {
        for operator in Operator::ALL {
            let v = viewer(operator);
            for radiosity in [0.2, 0.5, 1.0, 3.0] {
                let Some(least) = v.least_visible(radiosity) else { continue };
                let (here, more, less) =
                    (v.steps(radiosity), v.steps(radiosity * (1.0 + least)), v.steps(radiosity * (1.0 - least)));
                let moved = (more - here).max(here - less);
                assert!((moved - 1.0).abs() < 1e-3, "{operator:?} {radiosity} {least}: {less} {here} {more}");
            }
        }
    }

    #[test]
    fn luminance_is_radiosity_over_pi_times_the_efficacy() {
        assert!((viewer(Operator::Tr93).luminance(std::f64::consts::PI) - 179.0).abs() < 1e-12);
    }

    #[test]
    fn the_burnt_out_lamp_has_room_only_downwards() {
        let v = viewer(Operator::Brightest);
        let white = 300.0 / 179.0 * std::f64::consts::PI;
        assert_eq!(v.steps(10.0 * white), 255.0);
        let least = v.least_visible(10.0 * white).unwrap();
        assert!(least > 0.89 && least < 0.91, "{least}");
        assert_eq!(v.least_visible(0.0), None);
    }
}
