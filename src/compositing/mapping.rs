//! How textures lie on faces, and what they change there: colour, normal, mirrored and transmitted share.

use super::texture::{Beyond, Sampler};
use crate::math::DVec3;
use crate::scene::{Finish, Texture};

/// Faces whose normal is nearer to the z axis than this are floors.
const FLOOR: f64 = 0.9;

/// The two directions along which textures lie on a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mapping {
    /// Along the rows of the picture: level on a wall, to the right seen from its front.
    pub along: DVec3,
    /// Up the columns.
    pub up: DVec3,
}

impl Mapping {
    /// The directions on a face with the unit normal `normal`: x and y on floors, level and upward on walls.
    pub fn of(normal: DVec3) -> Self {
        if normal.z.abs() > FLOOR {
            return Self { along: DVec3::X, up: DVec3::Y };
        }
        let along = DVec3::Z.cross(normal).normalize_or_zero();
        Self { along, up: normal.cross(along) }
    }

    /// Place of a point (metres) in a texture, in repeats of the picture.
    pub fn place(&self, texture: &Texture, point: DVec3) -> [f64; 2] {
        self.step(texture, point - texture.origin)
    }

    /// The same for a difference of two points.
    pub fn step(&self, texture: &Texture, by: DVec3) -> [f64; 2] {
        [by.dot(self.along) / texture.tile[0], by.dot(self.up) / texture.tile[1]]
    }

    /// The normal that the height field `height` (metres of white above black) gives a face, by central differences of
    /// half a texel; unit vector.
    pub fn bumped(&self, sampler: &Sampler, bump: &Texture, height: f64, point: DVec3, normal: DVec3) -> DVec3 {
        let [s, t] = self.place(bump, point);
        let [w, h] = sampler.size(bump.picture).map(|n| n as f64);
        let at = |ds: f64, dt: f64| height * sampler.luminance(bump.picture, s + ds, t + dt);
        let (ds, dt) = (0.5 / w, 0.5 / h);
        let along = (at(ds, 0.0) - at(-ds, 0.0)) / (bump.tile[0] / w);
        let up = (at(0.0, dt) - at(0.0, -dt)) / (bump.tile[1] / h);
        let tilted = normal - self.along * along - self.up * up;
        tilted.try_normalize().unwrap_or(normal)
    }
}

/// What a finish makes of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finished {
    /// Linear red, green and blue that the material's reflectance is multiplied by.
    pub colour: [f32; 3],
    /// Unit normal on the front, tilted by the bump map.
    pub normal: DVec3,
    /// Share that is mirrored, 0 to 1.
    pub reflection: f64,
    /// Share that goes through, 0 to 1.
    pub transparency: f64,
}

impl Finished {
    /// A point of a face without a finish.
    pub fn plain(normal: DVec3) -> Self {
        Self { colour: [1.0; 3], normal, reflection: 0.0, transparency: 0.0 }
    }
}

/// What a finish makes of the point of a face with a unit normal. `pixel`: the sides of the parallelogram of the face
/// that a pixel covers, metres; the colour is then its mean, else that at the point.
pub fn finished(
    finish: &Finish,
    sampler: &Sampler,
    point: DVec3,
    normal: DVec3,
    pixel: Option<[DVec3; 2]>,
) -> Finished {
    let mapping = Mapping::of(normal);
    let map = |texture: &Option<Texture>| match texture {
        Some(t) => {
            let [s, u] = mapping.place(t, point);
            sampler.luminance(t.picture, s, u)
        }
        None => 1.0,
    };
    let mut out = Finished::plain(normal);
    if let Some(t) = &finish.colour {
        let place = mapping.place(t, point);
        out.colour = match pixel {
            Some(sides) => sampler.mean(t.picture, place, sides.map(|v| mapping.step(t, v)), Beyond::Again).0,
            None => sampler.sample(t.picture, place[0], place[1], Beyond::Again).0,
        };
    }
    if let Some(t) = &finish.bump {
        out.normal = mapping.bumped(sampler, t, finish.bump_height, point, normal);
    }
    out.reflection = (finish.reflection * map(&finish.reflection_map)).clamp(0.0, 1.0);
    out.transparency = (finish.transparency * map(&finish.transparency_map)).clamp(0.0, 1.0);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Picture;

    fn texture(tile: [f64; 2]) -> Texture {
        Texture { picture: 0, origin: DVec3::new(1.0, 2.0, 3.0), tile }
    }

    #[test]
    fn rows_run_level_on_walls_and_along_x_on_floors() {
        // A wall that faces -y: seen from its front, right is +x.
        let wall = Mapping::of(-DVec3::Y);
        assert_eq!((wall.along, wall.up), (DVec3::X, DVec3::Z));
        assert_eq!(Mapping::of(DVec3::X).along, DVec3::Y);
        // A roof: level along x, upward along its slope.
        let roof = Mapping::of(DVec3::new(0.0, -0.6, 0.8));
        assert!((roof.along - DVec3::X).length() < 1e-15 && (roof.up - DVec3::new(0.0, 0.8, 0.6)).length() < 1e-15);
        for z in [1.0, -1.0, 0.95] {
            let n = DVec3::new(0.0, (1.0f64 - z * z).sqrt(), z);
            assert_eq!(Mapping::of(n), Mapping { along: DVec3::X, up: DVec3::Y });
        }
        let place = wall.place(&texture([2.0, 4.0]), DVec3::new(2.0, -9.0, 5.0));
        assert_eq!(place, [0.5, 0.5]);
    }

    /// A ramp from black to white, whose slope is known, and what it does to the normal of a wall.
    #[test]
    fn a_ramp_tilts_the_normal_by_its_slope() {
        // Four columns of luminance 0, 1, 0, 1 would be a zigzag; two opaque texels make a triangle wave of slope
        // 1 per half a tile.
        let rgba = [[0, 0, 0, 255], [255, 255, 255, 255]].concat();
        let sampler = Sampler::new(&[Picture { name: "r".into(), size: [2, 1], rgba }]).expect("a picture");
        let bump = Texture { origin: DVec3::ZERO, ..texture([2.0, 1.0]) };
        let n = -DVec3::Y;
        // Between the centres at x = 0.5 and 1.5 the height climbs 0.3 m in 1 m; at x = 1 the differences see nothing else.
        let tilted = Mapping::of(n).bumped(&sampler, &bump, 0.3, DVec3::new(1.0, 0.0, 0.2), n);
        let wanted = DVec3::new(-0.3, -1.0, 0.0).normalize();
        assert!((tilted - wanted).length() < 1e-6, "{tilted} instead of {wanted}");
        // On the crest it is level.
        let crest = Mapping::of(n).bumped(&sampler, &bump, 0.3, DVec3::new(1.5, 0.0, 0.2), n);
        assert!((crest - n).length() < 1e-6);
        // Columns: 1 x 2, on a floor, white in the north.
        let rgba = [[255, 255, 255, 255], [0, 0, 0, 255]].concat();
        let sampler = Sampler::new(&[Picture { name: "r".into(), size: [1, 2], rgba }]).expect("a picture");
        let bump = Texture { origin: DVec3::ZERO, ..texture([1.0, 2.0]) };
        let tilted = Mapping::of(DVec3::Z).bumped(&sampler, &bump, 0.5, DVec3::new(0.0, 1.0, 0.0), DVec3::Z);
        assert!((tilted - DVec3::new(0.0, -0.5, 1.0).normalize()).length() < 1e-6, "{tilted}");
    }

    #[test]
    fn shares_are_multiplied_by_their_maps() {
        let rgba = [[0, 0, 0, 255], [255, 255, 255, 255]].concat();
        let sampler = Sampler::new(&[Picture { name: "r".into(), size: [2, 1], rgba }]).expect("a picture");
        let map = Some(Texture { origin: DVec3::ZERO, ..texture([1.0, 1.0]) });
        let finish = Finish {
            colour: map.clone(),
            reflection: 0.8,
            reflection_map: map,
            transparency: 0.1,
            refraction: 1.0,
            ..Finish::default()
        };
        for (x, shade) in [(0.25, 0.0), (0.5, 0.5), (0.75, 1.0)] {
            let f = finished(&finish, &sampler, DVec3::new(x, 0.0, 0.0), DVec3::Z, None);
            let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-7, "{a} instead of {b}");
            close(f.reflection, 0.8 * shade);
            close(f64::from(f.colour[2]), shade);
            close(f.transparency, 0.1);
            assert_eq!(f.normal, DVec3::Z);
        }
        // Seen from far away, the floor is its mean.
        let far = Some([DVec3::X * 64.0, DVec3::Y * 64.0]);
        let colour = finished(&finish, &sampler, DVec3::ZERO, DVec3::Z, far).colour;
        assert!((colour[0] - 0.5).abs() < 1e-6);
    }
}
