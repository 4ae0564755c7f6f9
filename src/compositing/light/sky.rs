//! Skies: their radiance, and the irradiance of a tilted plane under an open sky.
//!
//! What a plane sees of the sky is a lune between its own horizon and that of the ground. Both horizons cross in one
//! axis; half planes about it meet neither, so that every half plane sees a whole half circle of the sky.

use super::dome::HalfPlane;
use super::quadrature::{Rule, SIX, THREE, WHOLE_SKY};
use crate::math::DVec3;
use crate::scene::SkyModel;
use std::cell::Cell;
use std::f64::consts::PI;

/// Arcs below this, rad, take fewer points.
const SHORT: f64 = 0.2;

/// A sky made ready.
pub(super) struct Sky {
    pub model: SkyModel,
    pub up: DVec3,
    /// One over what the clear sky's formula gives at the zenith.
    unit: f64,
}

/// The lune above two horizons: directions `cos psi k + sin psi (cos phi q + sin phi up)`, 0 < phi < pi - tilt.
pub(super) struct Lune {
    /// The axis both horizons share, and the horizontal direction at right angles to it.
    pub axis: DVec3,
    pub level: DVec3,
    pub up: DVec3,
    /// Angle between the normal and the zenith, rad.
    pub tilt: f64,
}

impl Lune {
    pub fn new(normal: DVec3, up: DVec3) -> Self {
        let across = normal - up * normal.dot(up);
        let tilt = across.length().atan2(normal.dot(up));
        let any = if up == DVec3::ZERO { DVec3::X } else { up.any_orthonormal_vector() };
        let level = if across.length_squared() > 1e-24 { across.normalize() } else { any };
        Self { axis: level.cross(up), level, up, tilt }
    }

    /// Coordinates along axis, level and zenith.
    pub fn place(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.axis), v.dot(self.level), v.dot(self.up))
    }

    /// The last half plane, rad; the first is 0.
    pub fn end(&self) -> f64 {
        PI - self.tilt
    }
}

thread_local! {
    /// The clear sky and normal asked last, and the answer.
    static LAST: Cell<([DVec3; 3], f64)> = const { Cell::new(([DVec3::ZERO; 3], 0.0)) };
}

impl Sky {
    pub fn new(model: SkyModel, up: DVec3) -> Self {
        let up = up.normalize_or_zero();
        let model = match model {
            SkyModel::Clear { sun } => SkyModel::Clear { sun: sun.normalize_or_zero() },
            other => other,
        };
        let mut sky = Self { model, up, unit: 1.0 };
        if let SkyModel::Clear { sun } = model {
            sky.unit = 1.0 / sky.clear(up, 1.0, sun);
        }
        sky
    }

    /// Radiance in a unit direction relative to the zenith; 0 below the horizon.
    pub fn radiance(&self, direction: DVec3) -> f64 {
        let sine = direction.dot(self.up);
        if sine.is_nan() || sine <= 0.0 {
            return 0.0;
        }
        match self.model {
            SkyModel::Uniform => 1.0,
            SkyModel::Overcast => (1.0 + 2.0 * sine) / 3.0,
            SkyModel::Clear { sun } => self.clear(direction, sine, sun),
        }
    }

    /// Kittler's formula. At the zenith the angle to the sun is the sun's zenith distance.
    fn clear(&self, direction: DVec3, sine: f64, sun: DVec3) -> f64 {
        let cosine = direction.dot(sun).clamp(-1.0, 1.0);
        let glow = 0.91 + 10.0 * (-3.0 * cosine.acos()).exp() + 0.45 * cosine * cosine;
        glow * (1.0 - (-0.32 / sine).exp()) * self.unit
    }

    /// The factor of the open sky.
    pub fn open(&self, normal: DVec3) -> f64 {
        let lune = Lune::new(normal, self.up);
        if !lune.tilt.is_finite() {
            return f64::NAN;
        }
        let (sine, cosine) = lune.tilt.sin_cos();
        // Integrals of the cosine to the normal over the lune, without and with the sine of the elevation.
        let plain = 0.5 * PI * (1.0 + cosine);
        let raised = 2.0 / 3.0 * (lune.end() * cosine + sine);
        match self.model {
            SkyModel::Uniform => plain,
            SkyModel::Overcast => ((plain + 2.0 * raised) / 3.0).max(0.0),
            SkyModel::Clear { sun } => {
                let key = [normal, self.up, sun];
                let (last, value) = LAST.get();
                if last == key {
                    return value;
                }
                let value = self.integral(&lune, sun);
                LAST.set((key, value));
                value
            }
        }
    }

    /// The clear sky over a lune. Four parts meet in the sun, where the radiance has a tip; nodes crowd there, and at the
    /// horizons, where it falls steeply.
    fn integral(&self, lune: &Lune, sun: DVec3) -> f64 {
        let at = lune.place(sun);
        let phi = at.z.atan2(at.y);
        // A sun below the horizon of the back stands nearer to the other end.
        let phi = if phi < -0.5 * PI { lune.end() } else { phi.clamp(0.0, lune.end()) };
        let psi = at.x.clamp(-1.0, 1.0).acos();
        let mut sum = 0.0;
        for phi_end in [0.0, lune.end()] {
            for (u, wu) in WHOLE_SKY.iter() {
                let f = phi + (phi_end - phi) * u;
                let (up, level) = f.sin_cos();
                let outer = wu * (phi_end - phi).abs() * (f + lune.tilt).sin();
                if outer <= 0.0 {
                    continue;
                }
                for psi_end in [0.0, PI] {
                    for (v, wv) in WHOLE_SKY.iter() {
                        let (sine, cosine) = (psi + (psi_end - psi) * v).sin_cos();
                        let direction = lune.axis * cosine + (lune.level * level + lune.up * up) * sine;
                        let inner = wv * (psi_end - psi).abs() * sine * sine;
                        sum += outer * inner * self.clear(direction, (sine * up).max(f64::MIN_POSITIVE), sun);
                    }
                }
            }
        }
        sum
    }

    /// Integrals over an arc of the half plane phi, a stretch of x = cot(psi).
    pub fn arc(&self, lune: &Lune, plane: &HalfPlane, arc: (f64, f64)) -> Moments {
        // The arc runs from the larger x to the smaller.
        let (a, b) = (Cotangent::new(arc.1), Cotangent::new(arc.0));
        let turned = if arc.0.is_finite() && arc.1.is_finite() {
            (a.x - b.x).atan2(1.0 + a.x * b.x)
        } else {
            1f64.atan2(b.x) - 1f64.atan2(a.x)
        };
        let plain = 0.5 * (turned - b.sine * b.cosine + a.sine * a.cosine);
        match self.model {
            SkyModel::Uniform => Moments { plain, raised: 0.0 },
            SkyModel::Overcast => {
                let (ca, cb) = (a.cosine, b.cosine);
                let raised = (ca - cb) * (1.0 - (ca * ca + ca * cb + cb * cb) / 3.0);
                Moments { plain: plain / 3.0, raised: 2.0 / 3.0 * raised }
            }
            SkyModel::Clear { sun } => {
                let from = 1f64.atan2(a.x);
                let across = lune.level * plane.cosine + lune.up * plane.sine;
                let rule: &Rule = if turned < SHORT { &THREE } else { &SIX };
                let panels = (turned / (PI / 3.0)).ceil().max(1.0);
                let step = turned / panels;
                let mut sum = 0.0;
                for panel in 0..panels as usize {
                    for (t, w) in rule {
                        let (sine, cosine) = (from + step * (panel as f64 + t)).sin_cos();
                        let direction = lune.axis * cosine + across * sine;
                        let bright = self.clear(direction, (sine * plane.sine).max(f64::MIN_POSITIVE), sun);
                        sum += w * step * sine * sine * bright;
                    }
                }
                Moments { plain: sum, raised: 0.0 }
            }
        }
    }
}

/// An angle psi, 0 to pi, by its cotangent.
struct Cotangent {
    x: f64,
    sine: f64,
    cosine: f64,
}

impl Cotangent {
    fn new(x: f64) -> Self {
        if x.abs() > 1e150 {
            return Self { x, sine: 0.0, cosine: x.signum() };
        }
        let sine = 1.0 / (1.0 + x * x).sqrt();
        Self { x, sine, cosine: x * sine }
    }
}

/// What arcs of one half plane bring: to be multiplied with sin(phi + tilt), and with sin(phi) sin(phi + tilt).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Moments {
    pub plain: f64,
    pub raised: f64,
}
