//! Natural colours: through which eye, on which screen.

use super::Look;
use super::subject::Subject;
use crate::cli::args::ToneChoice;
use crate::render::{Clipped, Exposure, Mesh, Seen, Shade, ToneMap, Visibility, luminance};
use crate::solution::Radiosity;
use crate::study::Onlooker;
use serde_json::{Value, json};

/// How colours of all pictures are made.
pub(super) enum Natural {
    /// One linear scale for all of them.
    Linear(Exposure),
    /// By an eye that adapts to each of them.
    Eye(Eye),
}

/// An eye before it looks.
pub(super) struct Eye {
    onlooker: Onlooker,
    /// Luminance of every cell that it adapts to, weighted by band, W/m^2.
    luminances: Vec<f64>,
    is_lamp: Vec<bool>,
}

/// The colours of one picture.
pub(super) enum Shown {
    Linear(Exposure),
    Eye(Box<ToneMap>, Clipped),
}

impl Natural {
    /// As the options say, fitted to the reference where there is one, else to what is shown.
    pub(super) fn new(subject: &Subject, b: &Radiosity, look: &Look) -> Self {
        let (photometry, receivers) = (&subject.receivers.photometry, &subject.receivers);
        let is_lamp = receivers.lamps();
        let luminances = luminance(photometry, subject.yardstick.as_ref().unwrap_or(b));
        if let ToneChoice::Operator(operator) = look.tone {
            let onlooker = look.args.viewing.onlooker(operator);
            return Self::Eye(Eye { onlooker, luminances, is_lamp });
        }
        let fitted = Exposure::fit(photometry, &luminances, &receivers.areas, &is_lamp);
        Self::Linear(match (look.args.white, look.args.exposure) {
            (Some(white), _) => fitted.with_white(white),
            (None, Some(stops)) => fitted.brighter(stops),
            (None, None) => fitted,
        })
    }

    /// The colours of a picture.
    pub(super) fn through(&self, visibility: &Visibility, mesh: &Mesh) -> Shown {
        match self {
            Self::Linear(exposure) => Shown::Linear(exposure.clone()),
            Self::Eye(eye) => eye.look(visibility, mesh),
        }
    }
}

impl Eye {
    fn look(&self, visibility: &Visibility, mesh: &Mesh) -> Shown {
        let seen = Seen::of(mesh, [visibility]);
        let viewer = self.onlooker.look(&seen, &self.luminances, &self.is_lamp);
        let map = ToneMap::new(viewer, &mesh.stage().photometry);
        let clipped = map.clipped(self.luminances.iter().copied().zip(seen.shares));
        Shown::Eye(Box::new(map), clipped)
    }
}

impl Shown {
    pub(super) fn shade(&self) -> &dyn Shade {
        match self {
            Self::Linear(exposure) => exposure,
            Self::Eye(map, _) => map.as_ref(),
        }
    }

    /// What the colours mean.
    pub(super) fn words(&self) -> String {
        match self {
            Self::Linear(e) => format!(
                "Linear exposure, sRGB: a luminance of {} W/m^2 is shown white.",
                super::picture::figures(e.white_luminance)
            ),
            Self::Eye(map, clipped) => crate::report::tone_words(&map.viewer, *clipped),
        }
    }

    pub(super) fn json(&self) -> Value {
        match self {
            Self::Linear(e) => {
                json!({ "operator": "linear", "white_luminance": e.white_luminance, "scale": e.scale })
            }
            Self::Eye(map, clipped) => crate::report::tone_json(&map.viewer, *clipped),
        }
    }
}
