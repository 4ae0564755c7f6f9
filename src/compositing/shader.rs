//! Light and radiance at points of faces: what shading and local rays ask for alike.

use super::background::Backdrop;
use super::batches::Batches;
use super::fog::{fogged, fogged_background};
use super::image::{SpanFace, SpanImage};
use super::light::{Casters, Lamp, Volumes};
use super::mapping::{Finished, finished};
use super::rays::LocalRays;
use super::shade::ShadeOptions;
use super::sunlit::{casters, parallel};
use super::texture::{PictureError, Sampler, to_bands};
use super::tree::{Grove, TreeHit, Turned, Viewer};
use crate::math::DVec3;
use crate::scene::{Finish, LightShape, Tree};
use std::f64::consts::PI;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Where radiosities come from.
pub trait Diffuse: Sync {
    /// Writes the radiosity, W/m^2 per band, of the side of a face that is seen (the front or the back) at a point of it;
    /// false where the face has none.
    fn radiosity(&self, face: &SpanFace, front: bool, point: DVec3, out: &mut [f64]) -> bool;
}

/// Where one looks from and where to, and how often the look was thrown back.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sight {
    pub(super) origin: DVec3,
    /// Unit vector.
    pub(super) direction: DVec3,
    pub(super) depth: u32,
}

/// Pictures made ready, and the trees that stand in an image: what shading borrows.
pub(super) struct Grown {
    pub(super) sampler: Sampler,
    /// Trees that have a face.
    trees: Vec<Tree>,
    /// Face of each of them.
    faces: Vec<u32>,
}

impl Grown {
    pub(super) fn new(image: &SpanImage) -> Result<Self, PictureError> {
        let standing = || image.faces.iter().zip(0..).filter_map(|(f, k)| Some((f.tree?, k)));
        Ok(Self {
            sampler: Sampler::new(&image.appearance.pictures)?,
            trees: standing().map(|(t, _)| image.appearance.trees[t as usize].clone()).collect(),
            faces: standing().map(|(_, f)| f).collect(),
        })
    }
}

/// A point of a face with the normal of the side that is looked at.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) face: u32,
    pub(super) point: DVec3,
    pub(super) normal: DVec3,
}

/// What is the same all over a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Side {
    /// Unit normal of the side that the eye sees.
    pub(super) normal: DVec3,
    /// False for backs of faces that radiate from one side.
    pub(super) radiates: bool,
    /// The normal changes from point to point.
    pub(super) bumpy: bool,
}

/// Everything that does not change while a picture is made.
pub(super) struct Shader<'a> {
    image: &'a SpanImage,
    pub(super) options: &'a ShadeOptions<'a>,
    grown: &'a Grown,
    lamps: Vec<Lamp>,
    /// Per lamp the trees turned to it; skies shine past them.
    groves: Vec<Option<Grove<'a>>>,
    /// Number of the parallel light that the segments are marked with.
    marked: Option<usize>,
    casters: Casters,
    sides: Vec<Side>,
    finishes: Vec<Option<&'a Finish>>,
    /// Number among the standing trees, of faces that are trees.
    tree_of: Vec<Option<u32>>,
    pub(super) rays: LocalRays,
    backdrop: Backdrop<'a>,
    batches: Batches,
    /// Shadow volumes of the batches that local rays have met.
    met: Vec<OnceLock<Vec<Volumes>>>,
    met_bytes: AtomicUsize,
}

impl<'a> Shader<'a> {
    pub(super) fn new(image: &'a SpanImage, grown: &'a Grown, options: &'a ShadeOptions<'a>) -> Self {
        let lights = &image.appearance.lights;
        let marked = parallel(lights).and_then(|p| lights.iter().position(|l| l.name == p.name));
        let finishes: Vec<Option<&Finish>> = image.materials.iter().map(|m| image.appearance.finish(&m.name)).collect();
        let eye = image.camera.eye;
        let side = |f: &SpanFace| {
            let front = f.normal();
            let seen = front.dot(eye - f.vertices[0]) >= 0.0;
            Side {
                normal: if seen { front } else { -front },
                radiates: seen || f.two_sided,
                bumpy: finishes[f.material as usize].is_some_and(|f| f.bump.is_some()),
            }
        };
        let lamps: Vec<Lamp> = lights.iter().map(Lamp::new).collect();
        let batches = Batches::new(&image.faces);
        let grove = |(lamp, light): (&Lamp, &crate::scene::Light)| {
            let (direction, distance) = lamp.towards(DVec3::ZERO);
            let viewer = match light.shape {
                LightShape::Sky { .. } => return None,
                LightShape::Parallel { .. } => Viewer::Direction(direction),
                _ => Viewer::Point(direction * distance),
            };
            (!grown.trees.is_empty()).then(|| Grove::new(&grown.trees, viewer))
        };
        let mut tree_of = vec![None; image.faces.len()];
        grown.faces.iter().zip(0..).for_each(|(f, k)| tree_of[*f as usize] = Some(k));
        Self {
            options,
            grown,
            groves: lamps.iter().zip(lights).map(grove).collect(),
            lamps,
            marked,
            casters: casters(image),
            sides: image.faces.iter().map(side).collect(),
            finishes,
            tree_of,
            rays: LocalRays::new(&image.faces),
            backdrop: Backdrop::new(
                &image.appearance.background,
                &grown.sampler,
                &image.photometry,
                &image.camera,
                image.appearance.zenith(),
            ),
            met: (0..batches.bounds.len()).map(|_| OnceLock::new()).collect(),
            batches,
            met_bytes: AtomicUsize::new(0),
            image,
        }
    }

    pub(super) fn image(&self) -> &'a SpanImage {
        self.image
    }

    pub(super) fn lamps(&self) -> &[Lamp] {
        &self.lamps
    }

    pub(super) fn casters(&self) -> &Casters {
        &self.casters
    }

    pub(super) fn side(&self, face: u32) -> Side {
        self.sides[face as usize]
    }

    /// True for the parallel light whose shadows the segments hold.
    pub(super) fn is_marked(&self, lamp: usize) -> bool {
        self.marked == Some(lamp)
    }

    pub(super) fn is_sky(&self, lamp: usize) -> bool {
        matches!(self.image.appearance.lights[lamp].shape, LightShape::Sky { .. })
    }

    /// True if there is a lamp with soft shadows that is a sky, or one that is none.
    pub(super) fn has_soft(&self, sky: bool) -> bool {
        self.lamps.iter().enumerate().any(|(k, l)| !l.is_hard() && self.is_sky(k) == sky)
    }

    pub(super) fn traced_bytes(&self) -> usize {
        self.met_bytes.load(Ordering::Relaxed)
    }

    pub(super) fn batches(&self) -> &Batches {
        &self.batches
    }

    /// Shadow volumes of a face that a local ray meets: made once for its batch.
    fn volumes_met(&self, face: u32) -> &[Volumes] {
        let batch = self.batches.of[face as usize];
        self.met[batch as usize].get_or_init(|| {
            let made = self.volumes(batch);
            self.met_bytes.fetch_add(made.iter().map(Volumes::bytes).sum(), Ordering::Relaxed);
            made
        })
    }

    /// Irradiance by lamps without sharp shadows, W/m^2 per band.
    pub(super) fn soft(&self, place: Place, volumes: &[Volumes], out: &mut [f64]) {
        out.fill(0.0);
        self.add_soft(place, volumes, None, out);
    }

    /// Adds the irradiance of skies alone, or of the others alone.
    pub(super) fn add_soft(&self, place: Place, volumes: &[Volumes], skies: Option<bool>, out: &mut [f64]) {
        let wanted = |k: usize| skies.is_none_or(|s| s == self.is_sky(k));
        for (k, lamp) in self.lamps.iter().enumerate().filter(|(k, l)| !l.is_hard() && wanted(*k)) {
            let factor = self.factor(k, lamp, place.point, place.normal, place.face, volumes);
            if factor > 0.0 {
                self.add(k, factor * self.past_trees(k, place.point, None), out);
            }
        }
    }

    /// Gentle light on a face's plain normal made that on a tilted one: by as much as it would change with nothing standing
    /// between, so that a bump costs no new shadow. Skies count as evenly bright here: what a clear one brings a tilted
    /// plane is an integral, and bumps ask for a new one in every pixel.
    pub(super) fn tilt(&self, plain: DVec3, place: Place, light: &mut [f64]) {
        let (mut before, mut after) = (Bands::new(light.len()), Bands::new(light.len()));
        for (k, lamp) in self.lamps.iter().enumerate().filter(|(_, l)| !l.is_hard()) {
            let open = |normal: DVec3| match self.image.appearance.lights[k].shape {
                LightShape::Sky { up, .. } => 0.5 * PI * (1.0 + normal.dot(up)),
                _ => lamp.open(place.point, normal),
            };
            self.add(k, open(plain), before.get());
            self.add(k, open(place.normal), after.get());
        }
        for ((l, b), a) in light.iter_mut().zip(before.get()).zip(after.get()) {
            *l *= if *b > 0.0 { *a / *b } else { 1.0 };
        }
    }

    fn factor(&self, k: usize, lamp: &Lamp, point: DVec3, normal: DVec3, own: u32, volumes: &[Volumes]) -> f64 {
        match self.options.shadows {
            true => lamp.seen(point, normal, own, &volumes[k]),
            false => lamp.open(point, normal),
        }
    }

    /// Adds the irradiance by lamps with sharp shadows; `lit` tells how much of one is seen.
    pub(super) fn hard(&self, place: Place, out: &mut [f64], lit: impl Fn(usize) -> f64) {
        for (k, lamp) in self.lamps.iter().enumerate().filter(|(_, l)| l.is_hard()) {
            let open = lamp.open(place.point, place.normal);
            // A tilted normal may see a lamp behind the face.
            let seen = if open > 0.0 && lamp.open(place.point, self.plain(&place)) > 0.0 { lit(k) } else { 0.0 };
            if seen > 0.0 {
                self.add(k, open * seen * self.past_trees(k, place.point, None), out);
            }
        }
    }

    /// Normal of the face on the side that a place's normal looks from.
    pub(super) fn plain(&self, place: &Place) -> DVec3 {
        let front = self.image.faces[place.face as usize].normal();
        if front.dot(place.normal) >= 0.0 { front } else { -front }
    }

    fn add(&self, lamp: usize, factor: f64, out: &mut [f64]) {
        let strength = &self.image.appearance.lights[lamp].strength;
        out.iter_mut().zip(strength).for_each(|(o, s)| *o += s * factor);
    }

    /// Share of a lamp's light that pictures of trees let through, turned to the lamp.
    fn past_trees(&self, lamp: usize, point: DVec3, but: Option<u32>) -> f64 {
        match &self.groves[lamp] {
            Some(grove) if self.options.shadows => grove.transmittance(point, but, &self.grown.sampler),
            _ => 1.0,
        }
    }

    /// The place with its normal tilted by a bump texture.
    pub(super) fn bumped(&self, place: Place) -> Place {
        let face = &self.image.faces[place.face as usize];
        match self.finishes[face.material as usize].filter(|f| f.bump.is_some()) {
            Some(finish) => {
                let front = face.normal();
                let turned = finished(finish, &self.grown.sampler, place.point, front, None).normal;
                Place { normal: if front.dot(place.normal) >= 0.0 { turned } else { -turned }, ..place }
            }
            None => place,
        }
    }

    /// Sides of the parallelogram of a face that a pixel covers, m: what textures are averaged over. Looks that were
    /// thrown back see it as sharp as a pixel at that distance.
    fn footprint(&self, point: DVec3, front: DVec3, sight: &Sight) -> [DVec3; 2] {
        let distance = point.distance(sight.origin);
        let across = front.cross(sight.direction).normalize_or(front.any_orthonormal_vector());
        let down = across.cross(front);
        let cosine = front.dot(sight.direction).abs().max(1e-3);
        let side = distance * self.pixel();
        [across * side, down * (side / cosine)]
    }

    /// Angle of a pixel of the shaded picture, radians.
    fn pixel(&self) -> f64 {
        let camera = &self.image.camera;
        2.0 * (0.5 * camera.fov.to_radians()).tan() / f64::from(camera.size[1]) / self.options.scale[1]
    }

    /// What the finish of a face makes of a point.
    fn finished(&self, face: u32, point: DVec3, sight: &Sight) -> Finished {
        let of = &self.image.faces[face as usize];
        let front = of.normal();
        match self.finishes[of.material as usize] {
            None => Finished::plain(front),
            Some(finish) => {
                let pixel = finish.colour.is_some().then(|| self.footprint(point, front, sight));
                finished(finish, &self.grown.sampler, point, front, pixel)
            }
        }
    }

    /// Writes the radiance towards the eye of a place under an irradiance, fog included; true if rays were traced for it.
    pub(super) fn surface(&self, place: Place, sight: &Sight, light: &[f64], out: &mut [f64]) -> bool {
        let finished = self.finished(place.face, place.point, sight);
        self.matt(place, sight, light, &finished, out);
        let traced = self.options.trace && self.shine(place, sight, &finished, self.index(place.face), out);
        self.fog(place.point.distance(sight.origin), out);
        traced
    }

    fn index(&self, face: u32) -> f64 {
        let material = self.image.faces[face as usize].material as usize;
        self.finishes[material].map_or(1.0, |f| f.refraction)
    }

    /// Radiance by diffuse reflection and emission.
    fn matt(&self, place: Place, sight: &Sight, light: &[f64], finished: &Finished, out: &mut [f64]) {
        let face = &self.image.faces[place.face as usize];
        let material = &self.image.materials[face.material as usize];
        let front = face.normal().dot(sight.origin - place.point) >= 0.0;
        out.fill(0.0);
        if !front && !face.two_sided {
            return;
        }
        let mut colour = Bands::new(out.len());
        to_bands(finished.colour, &self.image.photometry, colour.get());
        let colour = colour.get();
        let solved = self.options.diffuse.is_some_and(|d| d.radiosity(face, front, place.point, out));
        for b in 0..out.len() {
            let (rho, emitted) = (material.reflectance[b], material.emission[b]);
            let reflected = rho * light[b] + if solved { (out[b] - emitted).max(0.0) } else { 0.0 };
            out[b] = (emitted + colour[b] * reflected) / PI;
        }
    }

    pub(super) fn fog(&self, distance: f64, out: &mut [f64]) {
        if let Some(fog) = &self.image.appearance.fog {
            fogged(fog, distance, out);
        }
    }

    /// Opacity of a face that can be seen through at a point, whether rays were traced for it, and its radiance there;
    /// `volumes` is `None` where only the opacity is asked for.
    pub(super) fn over(
        &self,
        face: u32,
        point: DVec3,
        sight: &Sight,
        volumes: Option<&[Volumes]>,
        out: &mut [f64],
    ) -> (f64, bool) {
        let of = &self.image.faces[face as usize];
        if let Some(tree) = self.tree_of[face as usize] {
            let viewer = Viewer::Point(sight.origin);
            let turned = Turned::new(&self.grown.trees[tree as usize], viewer);
            let p = point - turned.corner;
            let s = p.dot(turned.breadth) / turned.breadth.length_squared();
            let t = p.dot(turned.height) / turned.height.length_squared();
            let hit = TreeHit { tree, distance: point.distance(sight.origin), s, t };
            return (self.tree(&hit, turned.normal, sight, volumes, out), false);
        }
        let finished = self.finished(face, point, sight);
        let opacity = 1.0 - finished.transparency;
        let Some(volumes) = volumes.filter(|_| opacity > 0.0) else { return (opacity, false) };
        let front = of.normal();
        let normal = if front.dot(sight.origin - point) >= 0.0 { front } else { -front };
        let place = self.bumped(Place { face, point, normal });
        let mut light = Bands::new(out.len());
        self.lit(place, volumes, light.get());
        self.matt(place, sight, light.get(), &finished, out);
        let mut traced = false;
        if self.options.trace {
            // What is let through is added by whoever draws what is behind: of the rest a part is mirrored.
            let mirrored = (finished.reflection / opacity).min(1.0);
            let rest = Finished { transparency: 0.0, reflection: mirrored, ..finished };
            traced = self.shine(place, sight, &rest, 1.0, out);
        }
        self.fog(point.distance(sight.origin), out);
        (opacity, traced)
    }

    /// All light at a place, with its shadows.
    pub(super) fn lit(&self, place: Place, volumes: &[Volumes], out: &mut [f64]) {
        self.soft(place, volumes, out);
        let seen = |k: usize| {
            let lamp = &self.lamps[k];
            !self.options.shadows || lamp.seen(place.point, place.normal, place.face, &volumes[k]) > 0.0
        };
        self.hard(place, out, |k| f64::from(u8::from(seen(k))));
    }

    /// A tree's texel: its opacity, and its colour under light from wherever it comes, since leaves look everywhere.
    fn tree(&self, hit: &TreeHit, facing: DVec3, sight: &Sight, volumes: Option<&[Volumes]>, out: &mut [f64]) -> f64 {
        let tree = &self.grown.trees[hit.tree as usize];
        let breadth = hit.distance * self.pixel();
        let sides = [[breadth / tree.size[0], 0.0], [0.0, breadth / tree.size[1]]];
        let (rgb, opacity) =
            self.grown.sampler.mean(tree.picture, [hit.s, hit.t], sides, super::texture::Beyond::Nothing);
        let Some(volumes) = volumes.filter(|_| opacity > 0.0) else { return f64::from(opacity) };
        let point = sight.origin + sight.direction * hit.distance;
        let own = self.grown.faces[hit.tree as usize];
        let mut light = Bands::new(out.len());
        let light = light.get();
        for (k, lamp) in self.lamps.iter().enumerate() {
            let seen = |normal: DVec3| self.factor(k, lamp, point, normal, own, volumes);
            let (to_lamp, distance) = lamp.towards(point);
            let factor = match distance.is_finite() || lamp.is_hard() {
                true => seen(to_lamp),
                false => 0.5 * (seen(tree.up) + seen(facing)),
            };
            if factor > 0.0 {
                self.add(k, factor * self.past_trees(k, point, Some(hit.tree)), light);
            }
        }
        to_bands(rgb, &self.image.photometry, out);
        out.iter_mut().zip(&*light).for_each(|(o, e)| *o *= e / PI);
        self.fog(hit.distance, out);
        f64::from(opacity)
    }

    /// Radiance of a place that a local ray meets.
    pub(super) fn met(&self, face: u32, point: DVec3, sight: &Sight, out: &mut [f64]) {
        let front = self.image.faces[face as usize].normal();
        let normal = if front.dot(sight.direction) <= 0.0 { front } else { -front };
        let place = self.bumped(Place { face, point, normal });
        let mut light = Bands::new(out.len());
        self.lit(place, self.volumes_met(face), light.get());
        self.surface(place, sight, light.get(), out);
    }

    /// The trees as they stand for whoever looks from a point.
    pub(super) fn grove(&self, from: DVec3) -> Grove<'a> {
        Grove::new(&self.grown.trees, Viewer::Point(from))
    }

    /// Radiance of a tree that a local ray meets, and its opacity.
    pub(super) fn met_tree(&self, hit: &TreeHit, facing: DVec3, sight: &Sight, out: &mut [f64]) -> f64 {
        let volumes = self.volumes_met(self.grown.faces[hit.tree as usize]);
        self.tree(hit, facing, sight, Some(volumes), out)
    }

    /// Radiance where nothing stands; `at` is the place in the picture (pixels), for eyes that look straight.
    pub(super) fn background(&self, sight: &Sight, at: Option<[f64; 2]>, out: &mut [f64]) {
        let skies = |d: DVec3, out: &mut [f64]| {
            for (lamp, light) in self.lamps.iter().zip(&self.image.appearance.lights) {
                let share = lamp.sky(d);
                out.iter_mut().zip(&light.strength).for_each(|(o, s)| *o += s * share);
            }
        };
        let [w, h] = self.image.camera.size.map(f64::from);
        let at = at.map(|[x, y]| [x / w, y / h]);
        let pixel = [1.0 / (w * self.options.scale[0]), 1.0 / (h * self.options.scale[1])];
        self.backdrop.radiance(sight.direction, at, pixel, self.pixel(), skies, out);
        if let Some(fog) = &self.image.appearance.fog {
            fogged_background(fog, out);
        }
    }
}

/// Room for one value per band: on the stack for the few bands that pictures have.
pub(super) struct Bands {
    few: [f64; 4],
    many: Vec<f64>,
    count: usize,
}

impl Bands {
    pub(super) fn new(count: usize) -> Self {
        Self { few: [0.0; 4], many: if count > 4 { vec![0.0; count] } else { Vec::new() }, count }
    }

    pub(super) fn get(&mut self) -> &mut [f64] {
        if self.count > 4 { &mut self.many } else { &mut self.few[..self.count] }
    }
}
