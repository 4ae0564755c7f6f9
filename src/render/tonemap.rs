//! From radiosities to the screen as an eye would see them: the luminance through an operator, the colour with it.

use super::{DisplayColour, LinearRgb};
use crate::view::{Photometry, Viewer};

/// A viewer with the bands it looks at.
#[derive(Debug, Clone, PartialEq)]
pub struct ToneMap {
    /// Who looks, and on what.
    pub viewer: Viewer,
    colour: DisplayColour,
    photometry: Photometry,
}

/// Shares of a picture that the screen cannot show.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct Clipped {
    /// As dark as the screen's black or darker, though it gives light.
    pub black: f64,
    /// Brighter than the screen's white.
    pub white: f64,
}

impl ToneMap {
    /// For a scene's bands.
    pub fn new(viewer: Viewer, photometry: &Photometry) -> Self {
        Self { viewer, colour: DisplayColour::of(photometry), photometry: photometry.clone() }
    }

    /// Light of the screen itself over its peak, per channel, before clamping: RGB scaled by screen over scene luminance,
    /// less the room's light on the screen.
    pub fn linear(&self, radiosity: &[f64]) -> LinearRgb {
        let weighted = self.photometry.luminance(radiosity);
        if weighted <= 0.0 {
            return [0.0; 3];
        }
        let display = &self.viewer.display;
        let shown = self.viewer.tone.screen(self.viewer.luminance(weighted)) / display.peak;
        self.colour.rgb(&self.photometry.weights, radiosity).map(|c| c / weighted * shown - 1.0 / display.contrast)
    }

    /// The same, clamped to what the screen can show.
    pub fn display(&self, radiosity: &[f64]) -> LinearRgb {
        self.linear(radiosity).map(|c| c.clamp(0.0, 1.0))
    }

    /// Shares of a picture, given as (luminance weighted by band in W/m^2, share), that the screen cannot show.
    pub fn clipped(&self, picture: impl IntoIterator<Item = (f64, f64)>) -> Clipped {
        let (mut clipped, mut all) = (Clipped::default(), 0.0);
        for (y, share) in picture {
            let drive = self.viewer.drive(y);
            all += share;
            clipped.black += if y > 0.0 && drive.is_black() { share } else { 0.0 };
            clipped.white += if drive.is_white() { share } else { 0.0 };
        }
        let of_all = |x: f64| if all > 0.0 { x / all } else { 0.0 };
        Clipped { black: of_all(clipped.black), white: of_all(clipped.white) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::{Display, Levels, Operator, Surround};

    fn map(display: Display) -> ToneMap {
        let levels = Levels { log_mean: 5.0, brightest_surface: 100.0, unseen: 0.0 };
        ToneMap::new(Viewer::new(Operator::Tr93, Surround::Dim, display, 179.0, levels), &Photometry::rec709())
    }

    #[test]
    fn grey_is_driven_as_the_operator_says_and_colour_keeps_its_luminance() {
        let map = map(Display::crt());
        for y in [0.2, 0.7, 1.5] {
            let drive = map.viewer.drive(y);
            let grey = map.linear(&[y; 3]);
            assert!(grey.iter().all(|c| (c - drive.light).abs() < 1e-12), "{grey:?} {drive:?}");
            let coloured = [1.4 * y, 0.9 * y, 0.5 * y];
            let shown = Photometry::rec709().luminance(&map.linear(&coloured));
            let expected = map.viewer.drive(Photometry::rec709().luminance(&coloured)).light;
            assert!((shown - expected).abs() < 1e-12);
        }
        assert_eq!(map.linear(&[0.0; 3]), [0.0; 3]);
    }

    #[test]
    fn what_the_screen_cannot_show_is_counted() {
        let map = map(Display::crt());
        let clipped = map.clipped([(0.0, 0.1), (0.01, 0.2), (1.0, 0.4), (50.0, 0.3)]);
        assert!((clipped.black - 0.2).abs() < 1e-12 && (clipped.white - 0.3).abs() < 1e-12, "{clipped:?}");
    }
}
