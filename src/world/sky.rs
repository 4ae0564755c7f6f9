//! Skies and backgrounds: half cubes from fish-eye photographs, maps turned, maps over maps [G86 fig. 10].

use super::layout::{Layout, Shape, Spot};
use super::map::WorldMap;
use crate::math::{DMat3, DVec3};

/// Points across a texel that a turned map is asked at.
const ACROSS: usize = 4;

/// A map seen from a turned observer, in any layout: `rotation` takes directions of the new map to those of `map`. Each
/// texel is the mean of 4 x 4 points of it, interpolated bilinearly; points that `map` does not show are dark, so that
/// what it shows keeps its light. For layouts of like resolution; where texels become much larger, filter.
pub fn rotated(map: &WorldMap, rotation: DMat3, to: Shape) -> WorldMap {
    WorldMap::filled(to, map.bands(), |index, values| {
        let (panel, x, y) = to.texel(index);
        let mut sum = vec![0.0; map.bands()];
        let at = |corner: usize, k: usize| corner as f64 + (k as f64 + 0.5) / ACROSS as f64;
        for k in 0..ACROSS * ACROSS {
            let from = Spot { panel, x: at(x, k % ACROSS), y: at(y, k / ACROSS) };
            if let Some(spot) = to.direction(from).and_then(|d| map.shape().place(rotation * d)) {
                add_shown(map, spot, 1.0 / (ACROSS * ACROSS) as f64, &mut sum);
            }
        }
        values.iter_mut().zip(sum).for_each(|(v, s)| *v = s as f32);
    })
}

/// [`WorldMap::add_bilinear`], but near the border of a fish-eye's circle, beyond which its texels are not part of the
/// picture, the texel alone that the point lies in, or the nearest one towards the middle.
fn add_shown(map: &WorldMap, spot: Spot, weight: f64, sum: &mut [f64]) {
    let shape = map.shape();
    if let Layout::Fisheye { .. } = shape.layout {
        let half = 0.5 * shape.size as f64;
        let (dx, dy) = (spot.x - half, spot.y - half);
        let r = dx.hypot(dy);
        // Two texels inwards all four neighbours have their middles within the circle.
        let within = (half - 2.0).max(0.0);
        if r > within {
            let inwards = if r > 0.0 { within / r } else { 0.0 };
            let spot = Spot { panel: spot.panel, x: half + dx * inwards, y: half + dy * inwards };
            return map.add_bilinear(spot, weight, sum);
        }
    }
    map.add_bilinear(spot, weight, sum);
}

/// The sky on the upper half of a cube, from a fish-eye photograph taken straight up [G86 fig. 10]: the direction at the
/// photograph's lower edge becomes the front, as on the face up. Its faces have half as many texels as the photograph is
/// wide (an even number), and are dark below the horizon.
pub fn half_cube(fisheye: &WorldMap) -> WorldMap {
    let size = (fisheye.shape().width() as u32 / 2).max(1).next_multiple_of(2);
    // Of the photograph, y is the axis and z the upper edge: away from the front.
    let rotation = DMat3::from_cols(DVec3::X, -DVec3::Z, DVec3::Y);
    rotated(fisheye, rotation, Shape { layout: Layout::Cube, size })
}

/// A map before another: where `coverage` (of each texel of the foreground, 0 to 1) leaves something free, the
/// background is seen, looked up bilinearly. `None` where bands differ, or `coverage` has not one entry a texel. A
/// background that does not show a direction is dark there.
pub fn over(background: &WorldMap, foreground: &WorldMap, coverage: &[f32]) -> Option<WorldMap> {
    let shape = foreground.shape();
    if background.bands() != foreground.bands() || coverage.len() != shape.texels() {
        return None;
    }
    Some(WorldMap::filled(shape, foreground.bands(), |index, values| {
        let free = 1.0 - f64::from(coverage[index]).clamp(0.0, 1.0);
        let mut sum = vec![0.0; foreground.bands()];
        if free > 0.0
            && let Some(spot) = shape.middle(index).and_then(|d| background.shape().place(d))
        {
            add_shown(background, spot, free, &mut sum);
        }
        for ((v, s), front) in values.iter_mut().zip(sum).zip(foreground.texel(index)) {
            // A texel with nothing before it may hold anything.
            *v = if free < 1.0 { (f64::from(*front) * (1.0 - free) + s) as f32 } else { s as f32 };
        }
    }))
}

#[cfg(test)]
mod tests {
    use super::super::irradiance::irradiance_exact;
    use super::*;
    use std::f64::consts::PI;

    fn map(shape: Shape, f: impl Fn(DVec3) -> f64 + Sync) -> WorldMap {
        WorldMap::filled(shape, 1, |k, v| v[0] = shape.middle(k).map_or(0.0, |d| f(d) as f32))
    }

    #[test]
    fn a_turned_map_shows_the_same_world() {
        let f = |d: DVec3| 2.0 + d.x + 0.5 * d.y * d.z;
        let rotation = DMat3::from_rotation_z(0.7) * DMat3::from_rotation_x(-0.4);
        for (from, to) in
            [(Layout::Cube, Layout::LatLong), (Layout::LatLong, Layout::Cube), (Layout::Cube, Layout::Cube)]
        {
            let off = |size: u32| {
                let map = map(Shape { layout: from, size }, f);
                let to = Shape { layout: to, size };
                let turned = rotated(&map, rotation, to);
                let one = |k: usize| (f64::from(turned.texel(k)[0]) - f(rotation * to.middle(k).expect("whole"))).abs();
                (0..to.texels()).map(one).fold(0.0, f64::max)
            };
            let (coarse, fine) = (off(16), off(64));
            assert!(fine < 0.02 && fine < 0.4 * coarse, "{from:?} {to:?}: {coarse} {fine}");
        }
    }

    #[test]
    fn a_photograph_straight_up_becomes_the_upper_half_of_a_cube() {
        // A sky that brightens towards the front: the photograph's lower edge.
        let sky = |d: DVec3| 1.0 + d.z + 0.5 * d.y + 0.25 * d.x;
        let shape = Shape { layout: Layout::Fisheye { field: 180.0 }, size: 128 };
        let photo = map(shape, |p| sky(DVec3::new(p.x, -p.z, p.y)));
        let half = half_cube(&photo);
        assert_eq!(half.shape(), Shape { layout: Layout::Cube, size: 64 });
        for k in 0..half.shape().texels() {
            let d = half.shape().middle(k).expect("whole");
            let expected = if d.z > 0.0 { sky(d) } else { 0.0 };
            // Near the horizon values come from two texels inwards.
            assert!((f64::from(half.texel(k)[0]) - expected).abs() < 0.06, "{d}: {} {expected}", half.texel(k)[0]);
        }
        let uniform = half_cube(&map(shape, |_| 1.0));
        assert!((irradiance_exact(&uniform, DVec3::Z)[0] - PI).abs() < 1e-6);
        assert!((irradiance_exact(&uniform, DVec3::X)[0] - PI / 2.0).abs() < 1e-6);
    }

    #[test]
    fn what_is_free_shows_the_background() {
        let sky = map(Shape { layout: Layout::LatLong, size: 32 }, |d| 3.0 + d.z);
        let shape = Shape { layout: Layout::Cube, size: 8 };
        let front = map(shape, |_| 7.0);
        let coverage: Vec<f32> = (0..shape.texels()).map(|k| [0.0, 0.25, 1.0][k % 3]).collect();
        let both = over(&sky, &front, &coverage).expect("alike");
        for k in 0..shape.texels() {
            let c = f64::from(coverage[k]);
            let expected = 7.0 * c + (1.0 - c) * (3.0 + shape.middle(k).expect("whole").z);
            assert!((f64::from(both.texel(k)[0]) - expected).abs() < 5e-3, "{k}");
        }
        assert!(over(&sky, &front, &coverage[1..]).is_none());
        assert!(over(&WorldMap::filled(shape, 2, |_, _| ()), &front, &coverage).is_none());
    }
}
