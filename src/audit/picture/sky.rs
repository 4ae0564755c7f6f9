//! Radiance of skies by direction, relative to the zenith.

use crate::math::DVec3;
use crate::scene::SkyModel;

/// Relative radiance of a sky in a unit direction; 0 below the horizon of the unit vector `up`.
///
/// CIE overcast sky: (1 + 2 sin g) / 3 at elevation g. CIE clear sky (Kittler 1967): indicatrix 0.91 + 10 exp(-3 c) +
/// 0.45 cos^2 c of the angle c to the sun, gradation 1 - exp(-0.32 / sin g), over the same at the zenith.
pub(super) fn relative_radiance(model: &SkyModel, up: DVec3, direction: DVec3) -> f64 {
    let sine = direction.dot(up);
    if sine.is_nan() || sine <= 0.0 {
        return 0.0;
    }
    match model {
        SkyModel::Uniform => 1.0,
        SkyModel::Overcast => (1.0 + 2.0 * sine) / 3.0,
        SkyModel::Clear { sun } => {
            let at = |d: DVec3, sine: f64| {
                let c = angle(d, *sun);
                (0.91 + 10.0 * (-3.0 * c).exp() + 0.45 * c.cos().powi(2)) * (1.0 - (-0.32 / sine).exp())
            };
            at(direction, sine) / at(up, 1.0)
        }
    }
}

/// Angle between two vectors, radians: exact also where it is small.
pub(super) fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}
