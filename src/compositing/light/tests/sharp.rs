//! Sharp shadows against rays.

use super::*;
use crate::scene::Distribution;

fn hard() -> [Lamp; 2] {
    let position = DVec3::new(0.3, -0.2, 4.0);
    [
        lamp(LightShape::Parallel { direction: DVec3::new(0.2, 0.5, -0.8).normalize() }),
        lamp(LightShape::Point { position, distribution: Distribution::Isotropic, curve: None }),
    ]
}

/// Far enough along the way to a lamp.
fn end(lamp: &Lamp, point: DVec3) -> DVec3 {
    let (direction, distance) = lamp.towards(point);
    point + direction * distance.min(1e3)
}

#[test]
fn all_or_nothing_as_rays_find_it() {
    let mut dice = Dice(2);
    for lamp in hard() {
        let polygons = dice.triangles(60, DVec3::new(-2.0, -2.0, 0.5), DVec3::new(2.0, 2.0, 3.0), 0.6);
        let all = volumes(&lamp, &polygons, 3.0);
        let mut dark = 0;
        for _ in 0..4000 {
            let point = dice.point(-3.0, 3.0);
            let normal = (end(&lamp, point) - point).normalize();
            let seen = lamp.seen(point, normal, 7, &all);
            let hidden = blocked(&polygons, 7, point, end(&lamp, point));
            dark += usize::from(hidden);
            assert_eq!(seen, if hidden { 0.0 } else { lamp.open(point, normal) });
        }
        assert!(dark > 400 && dark < 3600, "{dark}");
    }
}

#[test]
fn hidden_parts_of_segments_as_rays_find_them() {
    let mut dice = Dice(3);
    for lamp in hard() {
        let polygons = dice.triangles(40, DVec3::new(-2.0, -2.0, 0.5), DVec3::new(2.0, 2.0, 3.0), 0.6);
        let all = volumes(&lamp, &polygons, 3.0);
        let (mut out, mut inner, mut lit, mut dark) = (Vec::new(), 0, 0, 0);
        for _ in 0..60 {
            let (a, b) = (dice.point(-3.0, 3.0), dice.point(-3.0, 3.0));
            lamp.hidden(a, b, 3, &all, &mut out);
            assert!(
                out.windows(2).all(|w| w[0].1 < w[1].0) && out.iter().all(|p| 0.0 <= p.0 && p.0 < p.1 && p.1 <= 1.0)
            );
            inner += out.len();
            for k in 0..1000 {
                let t = (k as f64 + 0.5) / 1000.0;
                if out.iter().any(|p| (t - p.0).abs() < 1e-9 || (t - p.1).abs() < 1e-9) {
                    continue;
                }
                let point = a.lerp(b, t);
                let hidden = blocked(&polygons, 3, point, end(&lamp, point));
                assert_eq!(out.iter().any(|p| p.0 < t && t < p.1), hidden, "{t} {out:?}");
                if hidden { dark += 1 } else { lit += 1 }
            }
        }
        assert!(inner > 60 && dark > 5000 && lit > 5000, "{inner} {dark} {lit}");
    }
}

#[test]
fn culled_for_a_box_nothing_is_lost_in_it() {
    let mut dice = Dice(4);
    for lamp in hard() {
        let polygons = dice.triangles(800, DVec3::splat(-3.0), DVec3::splat(3.5), 0.3);
        let receivers = Bounds { lo: DVec3::new(0.2, -0.5, -1.0), hi: DVec3::new(0.9, 0.4, -0.8) };
        let few = Volumes::new(&lamp, &Casters::new(polygons.clone()), &receivers);
        assert!(few.count() < 80 && few.count() > 1, "{}", few.count());
        for _ in 0..2000 {
            let point = receivers.lo + (receivers.hi - receivers.lo) * dice.point(0.0, 1.0);
            let normal = (end(&lamp, point) - point).normalize();
            let lit = lamp.seen(point, normal, crate::compositing::NO_CASTER, &few) > 0.0;
            assert_eq!(lit, !blocked(&polygons, u32::MAX, point, end(&lamp, point)));
        }
    }
}
