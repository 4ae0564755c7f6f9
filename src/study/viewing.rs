//! Looking at a scene: through its cameras, adapted to what they show.

use super::Receivers;
use crate::metrics::Viewing;
use crate::render::{Mesh, Seen, View, picture_levels};
use crate::scene::Stage;
use crate::view::{DEFAULT_EFFICACY, Display, Operator, Surround, Viewer};

/// Somebody who is going to look: everything but the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Onlooker {
    /// How luminances get to the screen.
    pub operator: Operator,
    /// The light around the screen.
    pub surround: Surround,
    /// The screen.
    pub display: Display,
    /// Luminous efficacy, lm/W.
    pub efficacy: f64,
    /// Background that the eye is adapted to, cd/m^2; `None`: by the picture.
    pub adapt: Option<f64>,
}

impl Default for Onlooker {
    fn default() -> Self {
        Self {
            operator: Operator::default(),
            surround: Surround::default(),
            display: Display::srgb(),
            efficacy: DEFAULT_EFFICACY,
            adapt: None,
        }
    }
}

impl Onlooker {
    /// Looks at a picture of cells with these luminances (weighted by band, W/m^2).
    pub fn look(&self, seen: &Seen, luminances: &[f64], is_lamp: &[bool]) -> Viewer {
        let in_candela = luminances.iter().map(|y| Viewer::luminance_of(self.efficacy, *y));
        let fitted = picture_levels(seen, in_candela, is_lamp);
        let levels = self.adapt.map_or(fitted, |background| fitted.adapted_to(background));
        Viewer::new(self.operator, self.surround, self.display.clone(), self.efficacy, levels)
    }
}

/// Looks at the pictures of a stage, all of them together, with these luminances (weighted by band, W/m^2) of its receivers.
pub fn viewing(
    onlooker: &Onlooker,
    stage: &Stage,
    per_element: bool,
    views: &[View],
    receivers: &Receivers,
    luminances: &[f64],
) -> Viewing {
    let mesh = if per_element { Mesh::of_elements(stage) } else { Mesh::of_patches(stage) };
    let seen = Seen::of(&mesh, views.iter().map(|v| &v.visibility));
    let viewer = onlooker.look(&seen, luminances, &receivers.lamps());
    Viewing { viewer, shares: seen.shares }
}
