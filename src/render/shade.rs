//! What gives radiosities their colour on the screen.

use super::{Exposure, LinearRgb, ToneMap};
use crate::view::Response;

/// From radiosities to a screen.
pub trait Shade: Sync {
    /// Display colour, linear, of one patch's radiosities (one per band), before clamping: colours that are mixed or
    /// interpolated are clamped afterwards.
    fn linear(&self, radiosity: &[f64]) -> LinearRgb;

    /// How the screen turns bytes into light.
    fn response(&self) -> Response;

    /// Display colour, linear, clamped to 0 to 1.
    fn display(&self, radiosity: &[f64]) -> LinearRgb {
        self.linear(radiosity).map(|c| c.clamp(0.0, 1.0))
    }
}

impl Shade for Exposure {
    fn linear(&self, radiosity: &[f64]) -> LinearRgb {
        Exposure::linear(self, radiosity)
    }

    fn response(&self) -> Response {
        Response::Srgb
    }
}

impl Shade for ToneMap {
    fn linear(&self, radiosity: &[f64]) -> LinearRgb {
        ToneMap::linear(self, radiosity)
    }

    fn response(&self) -> Response {
        self.viewer.display.response
    }
}
