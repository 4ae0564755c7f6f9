//! Operators: from luminances of a scene to luminances of a screen. All of them are power laws; they differ in who chooses
//! factor and exponent.

use super::levels::above_the_mean;
use super::{Display, Drive, LAMBERT, Levels, Observer};
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// Photographers' middle grey: what the mean of a scene is exposed to, as a share of the peak.
const MIDDLE_GREY: f64 = 0.18;
/// Television's camera: exponent of eq. 4.
const CAMERA_GAMMA: f64 = 1.0 / 2.2;

/// How luminances of a scene become luminances of a screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Operator {
    /// Two observers back to back, as printed [TR93 eq. 13], the screen's adapted to its middle [TR93 eq. 14].
    Tr93,
    /// The same with one rule for both observers: the mean of either view lies 8.4 dB below its background [TR93 eq. 11].
    /// As printed, a third and more of a picture is blacker than the screen can show, and no error is seen there.
    #[default]
    Tr93Consistent,
    /// Film on a light table [TR93 eq. 3]: the mean exposed to middle grey.
    Film,
    /// Camera and tube [TR93 eq. 6]: the brightest surface exposed to the peak.
    Television,
    /// Scaled so that the brightest surface that is no lamp is at the peak [TR93 fig. A].
    Brightest,
}

/// The light around a screen, which settles the exponent that viewers of film and television prefer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Surround {
    /// A dark room: 1.5.
    Dark,
    /// About 14 cd/m^2: 1.2.
    #[default]
    Dim,
    /// Bright light: 1.0.
    Bright,
}

/// An operator made ready for one picture: `factor * L^exponent`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tone {
    /// Screen luminance for a scene luminance of 1 cd/m^2, cd/m^2.
    factor: f64,
    exponent: f64,
    /// The eye in the scene, where the operator has one.
    pub eye: Option<Observer>,
    /// What it would be adapted to if the model went as low, cd/m^2; `None` where the model holds.
    pub too_dark: Option<f64>,
}

impl Operator {
    /// All, the paper's first.
    pub const ALL: [Self; 5] = [Self::Tr93, Self::Tr93Consistent, Self::Film, Self::Television, Self::Brightest];

    /// Name as on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tr93 => "tr93",
            Self::Tr93Consistent => "tr93-consistent",
            Self::Film => "film",
            Self::Television => "television",
            Self::Brightest => "brightest",
        }
    }

    /// What it does, for the reader of a picture.
    pub fn title(self) -> &'static str {
        match self {
            Self::Tr93 => "as the eye would see it (Tumblin and Rushmeier 1993, as printed)",
            Self::Tr93Consistent => {
                "as the eye would see it (Tumblin and Rushmeier 1993, both observers adapted alike)"
            }
            Self::Film => "as on film, the mean at middle grey",
            Self::Television => "as by television, the brightest surface at the peak",
            Self::Brightest => "scaled to the brightest surface",
        }
    }

    /// The operator for a picture with these levels on a display.
    pub fn on(self, display: &Display, surround: Surround, levels: &Levels) -> Tone {
        let power = |anchor: f64, shown: f64, exponent: f64| Tone {
            factor: shown * anchor.powf(-exponent),
            exponent,
            eye: None,
            too_dark: None,
        };
        match self {
            Self::Tr93 => Tone::between(Observer::new(levels.adapts_to()), Observer::new(display.adapts_to())),
            Self::Tr93Consistent => {
                let viewer = Observer::new(above_the_mean(display.adapts_to()));
                Tone::between(Observer::new(levels.adapts_to()), viewer)
            }
            Self::Film => power(levels.log_mean, MIDDLE_GREY * display.peak, surround.gamma()),
            // The camera's exponent times the tube's is what viewers prefer: the tube's is chosen to make it so.
            Self::Television => power(levels.brightest_surface, display.peak, CAMERA_GAMMA * surround.tube()),
            Self::Brightest => power(levels.brightest_surface, display.peak, 1.0),
        }
    }
}

impl FromStr for Operator {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|o| o.name() == text).ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            format!("there is no operator \"{text}\"; there are {names}")
        })
    }
}

impl Surround {
    /// Exponent from scene to screen that viewers prefer.
    pub fn gamma(self) -> f64 {
        match self {
            Self::Dark => 1.5,
            Self::Dim => 1.2,
            Self::Bright => 1.0,
        }
    }

    /// Exponent of the tube [TR93 eq. 5] that makes it so behind television's camera.
    fn tube(self) -> f64 {
        self.gamma() / CAMERA_GAMMA
    }
}

impl Tone {
    /// Two observers back to back: the screen looks as bright to the one as the scene to the other [TR93 eq. 13]. Below
    /// 27 dB, where the model is upside down, the eye is left at 27 dB and [`Tone::too_dark`] says so.
    pub fn between(scene: Observer, screen: Observer) -> Self {
        let eye = scene.within_the_model();
        let exponent = eye.alpha() / screen.alpha();
        let log_factor = (eye.beta() - screen.beta()) / screen.alpha();
        let factor = LAMBERT.powf(1.0 - exponent) * 10f64.powf(log_factor);
        let too_dark = scene.is_inverted().then_some(scene.adapted_to);
        Self { factor, exponent, eye: Some(eye), too_dark }
    }

    /// Luminance of the screen for a luminance of the scene, cd/m^2; 0 for what gives no light.
    pub fn screen(&self, luminance: f64) -> f64 {
        if luminance > 0.0 { self.factor * luminance.powf(self.exponent) } else { 0.0 }
    }

    /// The other way round; `None` where every luminance looks alike.
    pub fn scene(&self, screen: f64) -> Option<f64> {
        (self.exponent > 1e-9).then(|| (screen / self.factor).powf(1.0 / self.exponent))
    }

    /// What a display is driven with for a luminance of the scene (cd/m^2) [TR93 eq. 15].
    pub fn drive(&self, display: &Display, luminance: f64) -> Drive {
        display.drive(self.screen(luminance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    fn number(row: &Value, key: &str) -> f64 {
        row[key].as_str().expect("a decimal").parse().expect("a number")
    }

    /// Forty rows of exact values: adaptation, scene, screen, frame buffer.
    #[test]
    fn the_table_of_exact_values() {
        let table: Value =
            serde_json::from_str(include_str!("../../../references/truth/display.json")).expect("the table");
        let crt = Display::crt();
        let rows = table["rows"].as_array().expect("rows");
        for row in rows {
            let (adapted_to, luminance) = (number(row, "L_w_rw_cd"), number(row, "L_rw_cd"));
            let eye = Observer::new(adapted_to);
            let tone = Tone::between(eye, Observer::new(crt.adapts_to()));
            let drive = tone.drive(&crt, luminance);
            // Half of the last digit that is printed; some luminances of the scene are rounded to nine digits.
            let close = |ours: f64, key: &str| {
                let text = row[key].as_str().expect("a decimal");
                let digits = text.split_once('.').map_or(0, |(_, d)| d.len()) as i32;
                let theirs = number(row, key);
                (ours - theirs).abs() <= 0.51 * 10f64.powi(-digits) + 1e-8 * theirs.abs()
            };
            assert!(close(eye.alpha(), "alpha_rw") && close(eye.beta(), "beta_rw"), "{row}");
            assert!(close(tone.screen(luminance), "L_d_cd"), "{row} {}", tone.screen(luminance));
            assert!(close(drive.light, "x") && close(drive.value.max(0.0), "n"), "{row} {drive:?}");
            assert!(close(drive.shown(), "n_clipped"), "{row}");
            let back = tone.scene(tone.screen(luminance)).expect("not dark");
            assert!((back / luminance - 1.0).abs() < 1e-9);
        }
        assert!(rows.len() >= 38, "{}", rows.len());
    }

    fn levels(log_mean: f64) -> Levels {
        Levels { log_mean, brightest_surface: 50.0 * log_mean, unseen: 0.0 }
    }

    #[test]
    fn four_pixels_as_printed() {
        let pixels = [1.0, 10.0, 100.0, 1000.0];
        let levels = Levels::of(pixels.map(|l| (l, 1.0, false))).unwrap();
        let crt = Display::crt();
        let tone = Operator::Tr93.on(&crt, Surround::Dim, &levels);
        for (l, (screen, n)) in pixels.into_iter().zip([
            (0.029_263_562, 0.0),
            (0.505_535_92, 0.0),
            (8.733_269_1, 0.112_891_441_1),
            (150.869_58, 1.575_710_862),
        ]) {
            assert!((tone.screen(l) / screen - 1.0).abs() < 1e-6);
            assert!((tone.drive(&crt, l).value - n).abs() < 1e-6);
        }
        // Other exponents of the tube: adaptation of 100 cd/m^2.
        let at_100 = Tone::between(Observer::new(100.0), Observer::new(crt.adapts_to()));
        for (display, expected) in [
            ("86:35:2.2", [0.0, 0.105_783_718_8, 0.309_289_253_5, 0.487_399_074]),
            ("crt-uncorrected", [0.0, 0.181_929_841_2, 0.410_563_385_8, 0.579_726_129_9]),
        ] {
            let display: Display = display.parse().unwrap();
            for (l, n) in [5.0, 20.0, 50.0, 100.0].into_iter().zip(expected) {
                assert!((at_100.drive(&display, l).value - n).abs() < 1e-8, "{display} {l}");
            }
        }
    }

    #[test]
    fn as_printed_the_mean_of_any_scene_is_black_and_with_one_rule_it_is_the_middle_of_the_screen() {
        let crt = Display::crt();
        for mean in [1e-2, 1.0, 300.0, 1e6] {
            let printed = Operator::Tr93.on(&crt, Surround::Dim, &levels(mean));
            assert!((printed.screen(mean) - 2.101_185_664_18).abs() < 1e-8 && printed.drive(&crt, mean).is_black());
            let consistent = Operator::Tr93Consistent.on(&crt, Surround::Dim, &levels(mean));
            assert!((consistent.screen(mean) / crt.adapts_to() - 1.0).abs() < 1e-9, "{}", consistent.screen(mean));
        }
    }

    #[test]
    fn an_eye_adapted_as_the_viewer_of_the_screen_sees_the_scene_itself() {
        let crt = Display::crt();
        let mean = crt.adapts_to() / 10f64.powf(0.84);
        let tone = Operator::Tr93.on(&crt, Surround::Dim, &levels(mean));
        assert!((tone.screen(20.0) - 20.0).abs() < 1e-10);
        assert!((tone.drive(&crt, 20.0).value - 0.265_869_322_955_434).abs() < 1e-10);
    }

    #[test]
    fn rivals_anchor_what_they_say() {
        let crt = Display::crt();
        let l = levels(10.0);
        let film = Operator::Film.on(&crt, Surround::Dark, &l);
        assert!((film.screen(10.0) - 0.18 * 86.0).abs() < 1e-9);
        assert!((film.screen(20.0) / film.screen(10.0) - 2f64.powf(1.5)).abs() < 1e-12);
        let television = Operator::Television.on(&crt, Surround::Dim, &l);
        assert!((television.screen(500.0) - 86.0).abs() < 1e-9);
        assert!((television.screen(50.0) - 86.0 * 0.1f64.powf(1.2)).abs() < 1e-9);
        let brightest = Operator::Brightest.on(&crt, Surround::Dim, &l);
        assert!((brightest.screen(250.0) - 43.0).abs() < 1e-9);
        assert!(film.eye.is_none() && film.too_dark.is_none() && brightest.screen(0.0) == 0.0);
    }

    #[test]
    fn too_dark_a_scene_is_told_and_stays_the_right_way_up() {
        let crt = Display::crt();
        let tone = Operator::Tr93.on(&crt, Surround::Dim, &levels(1e-6));
        assert!(tone.too_dark.is_some_and(|l| (l / 6.918e-6 - 1.0).abs() < 1e-3));
        assert!(tone.screen(2e-6) >= tone.screen(1e-6) * (1.0 - 1e-9));
        assert_eq!(tone.scene(1.0), None);
    }

    #[test]
    fn operators_are_read_by_name() {
        for operator in Operator::ALL {
            assert_eq!(operator.name().parse(), Ok(operator));
        }
        assert!("gamma".parse::<Operator>().unwrap_err().contains("tr93-consistent"));
    }
}
