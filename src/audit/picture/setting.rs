//! A stage with its appearance, ready to be asked what a surface is made of.

use super::PictureFault;
use super::backdrop::Backdrop;
use super::cast::PictureOptions;
use super::grove::Grove;
use super::lamp::Lamp;
use super::texel::{Outside, Texels, apart, band, place};
use crate::math::DVec3;
use crate::raycast::{BACK, Tracer};
use crate::scene::{Appearance, Facet, Finish, Material, Stage, Texture};
use crate::view::Camera;

/// Everything that does not change while a picture is cast.
pub(super) struct Setting<'a> {
    pub tracer: &'a Tracer<'a>,
    pub stage: &'a Stage,
    pub appearance: &'a Appearance,
    pub options: &'a PictureOptions<'a>,
    pub pictures: &'a [Texels],
    pub lamps: Vec<Lamp<'a>>,
    pub grove: Grove<'a>,
    pub backdrop: Backdrop<'a>,
    pub bands: usize,
    in_rgb: bool,
    /// By material.
    finishes: Vec<Option<&'a Finish>>,
}

/// A point of a surface as a ray sees it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spot<'a> {
    pub facet: u32,
    /// Patch that is seen; `None` on black backs.
    pub patch: Option<u32>,
    pub point: DVec3,
    /// Unit normal of the facet's front.
    pub front: DVec3,
    /// The ray meets the front.
    pub at_front: bool,
    /// Unit normal on the ray's side, tilted by a bump texture.
    pub normal: DVec3,
    pub material: &'a Material,
    pub finish: Option<&'a Finish>,
}

impl<'a> Setting<'a> {
    pub fn new(
        tracer: &'a Tracer<'a>,
        appearance: &'a Appearance,
        camera: &Camera,
        options: &'a PictureOptions<'a>,
        pictures: &'a [Texels],
    ) -> Result<Self, PictureFault> {
        let stage = tracer.stage();
        let in_rgb = stage.photometry.bands == ["r", "g", "b"];
        Ok(Self {
            tracer,
            stage,
            appearance,
            options,
            pictures,
            lamps: appearance.lights.iter().map(Lamp::new).collect(),
            grove: Grove::new(&appearance.trees, pictures)?,
            backdrop: Backdrop::new(appearance, pictures, camera, in_rgb),
            bands: stage.band_count(),
            in_rgb,
            finishes: stage.materials.iter().map(|m| appearance.finish(&m.name)).collect(),
        })
    }

    fn facet(&self, facet: u32) -> &'a Facet {
        &self.stage.facets[facet as usize]
    }

    fn material(&self, facet: &Facet) -> u32 {
        self.stage.patches[facet.first_patch as usize].material
    }

    /// What a ray meets that hits this facet at this point and lands there.
    pub fn spot(&self, (facet, point, landing): (u32, DVec3, u32), direction: DVec3) -> Spot<'a> {
        let patch = (landing < BACK).then_some(landing);
        // At equal distance a front stands before a back: the patch may belong to the other facet.
        let facet = patch.map_or(facet, |p| self.stage.patches[p as usize].facet);
        let of = self.facet(facet);
        let material = self.material(of) as usize;
        let finish = self.finishes[material];
        let at_front = of.normal.dot(direction) < 0.0;
        let tilted = match finish.and_then(|f| Some((f, f.bump.as_ref()?))) {
            Some((f, bump)) => self.pictures[bump.picture].tilted(bump, f.bump_height, point, of.normal),
            None => of.normal,
        };
        let normal = if at_front { tilted } else { -tilted };
        let material = &self.stage.materials[material];
        Spot { facet, patch, point, front: of.normal, at_front, normal, material, finish }
    }

    /// Share of light that a facet lets through at a point.
    pub fn let_through(&self, facet: u32, point: DVec3) -> f64 {
        let of = self.facet(facet);
        let finish = self.finishes[self.material(of) as usize];
        finish.map_or(0.0, |f| self.share(f.transparency, &f.transparency_map, point, of.normal))
    }

    /// The mirrored and the transmitted share of a spot.
    pub fn shares(&self, spot: &Spot) -> (f64, f64) {
        let Some(f) = spot.finish else { return (0.0, 0.0) };
        let mirrored = self.share(f.reflection, &f.reflection_map, spot.point, spot.front);
        let through = self.share(f.transparency, &f.transparency_map, spot.point, spot.front);
        (mirrored, through.min(1.0 - mirrored))
    }

    fn share(&self, share: f64, map: &Option<Texture>, point: DVec3, front: DVec3) -> f64 {
        let of = |t: &Texture| self.pictures[t.picture].luminance_on(t, point, front);
        (share * map.as_ref().map_or(1.0, of)).clamp(0.0, 1.0)
    }

    /// What a spot's reflectance is multiplied by, per band.
    pub fn colour(&self, spot: &Spot, out: &mut [f64]) {
        match spot.finish.and_then(|f| f.colour.as_ref()) {
            None => out.fill(1.0),
            Some(texture) => {
                let [s, t] = place(texture, spot.point, spot.front);
                let rgb = apart(self.pictures[texture.picture].at(s, t, Outside::Repeat));
                self.in_bands(rgb, out);
            }
        }
    }

    /// A colour in the scene's bands.
    pub fn in_bands(&self, rgb: [f64; 3], out: &mut [f64]) {
        out.iter_mut().enumerate().for_each(|(b, o)| *o = band(rgb, self.in_rgb, b));
    }

    /// What is left of light after a stretch of fog.
    pub fn clear(&self, distance: f64) -> f64 {
        self.appearance.fog.as_ref().map_or(1.0, |f| (-f.extinction * distance).exp())
    }
}

/// Every picture, decoded; all that finishes and the background refer to have to be there.
pub(super) fn decoded(appearance: &Appearance) -> Result<Vec<Texels>, PictureFault> {
    let textures = |f: &Finish| -> Vec<usize> {
        let all = [&f.colour, &f.bump, &f.reflection_map, &f.transparency_map];
        all.into_iter().flatten().map(|t| t.picture).collect()
    };
    let background = &appearance.background;
    let clouds = background.clouds.as_ref().map(|c| c.picture);
    let used = appearance.finishes.iter().flat_map(textures).chain(background.picture).chain(clouds);
    for picture in used {
        if picture >= appearance.pictures.len() {
            return Err(PictureFault::Missing(picture));
        }
    }
    appearance.pictures.iter().map(Texels::new).collect()
}
