//! Fog by distance alone: it asks nothing but how far away a thing is.

use crate::scene::Fog;

/// Puts `distance` metres of fog before a radiance, W/(m^2 sr) per band: `L exp(-k d) + L_fog (1 - exp(-k d))`.
pub fn fogged(fog: &Fog, distance: f64, radiance: &mut [f64]) {
    let optical = fog.extinction * distance;
    // The difference to 1 by itself: thin fog would be rounded away.
    let (through, added) = if optical.is_nan() { (1.0, 0.0) } else { ((-optical).exp(), -(-optical).exp_m1()) };
    for (band, l) in radiance.iter_mut().enumerate() {
        *l = *l * through + fog.radiance.get(band).copied().unwrap_or(0.0) * added;
    }
}

/// The same for the background, which stands where the fog says, or before all fog.
pub fn fogged_background(fog: &Fog, radiance: &mut [f64]) {
    if let Some(distance) = fog.background_at {
        fogged(fog, distance, radiance);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weakens_by_the_length_and_ends_in_itself() {
        let fog = Fog { extinction: 0.01, radiance: vec![2.0, 3.0], background_at: None };
        let mut l = [8.0, 8.0];
        fogged(&fog, 100.0 * 2f64.ln(), &mut l);
        assert!((l[0] - 5.0).abs() < 1e-12 && (l[1] - 5.5).abs() < 1e-12, "{l:?}");
        // Two lengths one after the other are one length.
        let (mut once, mut twice) = ([8.0, 1.0], [8.0, 1.0]);
        fogged(&fog, 30.0, &mut once);
        fogged(&fog, 12.0, &mut twice);
        fogged(&fog, 18.0, &mut twice);
        assert!((once[0] - twice[0]).abs() < 1e-13 && (once[1] - twice[1]).abs() < 1e-13);
        fogged(&fog, f64::INFINITY, &mut l);
        assert_eq!(l, [2.0, 3.0]);
        let mut far = [7.0];
        fogged_background(&fog, &mut far);
        assert_eq!(far, [7.0]);
        fogged_background(&Fog { background_at: Some(f64::INFINITY), ..fog }, &mut far);
        assert_eq!(far, [2.0]);
    }
}
