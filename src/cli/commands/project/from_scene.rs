//! A world projection of a scene.

use super::drawn::{Drawn, Kind, texels};
use super::{Made, shape, sky, turning};
use crate::cli::args::ProjectArgs;
use crate::cli::commands::{inputs, lit::Lit, standpoint};
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::math::DVec3;
use crate::raycast::{KernelKind, Tracer};
use crate::render::{Centre, Mesh, Seen as PictureShares, WorldView, luminance, resized};
use crate::scene::Stage;
use crate::solution::Radiosity;
use crate::study::Receivers;
use crate::view::Camera;
use crate::world::{DiffuseMap, Layout, Shape, WorldMap, exact_picture, resample};
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::time::Instant;

/// The smallest cube that a diffuse map is convolved from where its own size says nothing.
const LEAST_CUBE: u32 = 128;
/// The largest cube that is cast unasked.
const LARGEST_CUBE: u32 = 2048;

/// A scene that is looked at.
struct Scene<'a> {
    args: &'a ProjectArgs,
    tracer: Tracer<'a>,
    centre: Centre,
    radiosity: Radiosity,
    /// What is seen where nothing is.
    sky: Option<WorldMap>,
    /// Up in the scene, whichever way the observer looks.
    up: DVec3,
}

/// What of the scene is seen in a layout.
struct Seen {
    map: WorldMap,
    view: WorldView,
    seconds: f64,
}

pub(super) fn made(args: &ProjectArgs, kernel: KernelKind, console: &Console) -> Result<Made, Failure> {
    let Lit { stage, light } = Lit::read(&args.source, args.solution.as_deref(), args.state, args.max_edge, console)?;
    let stage = match &args.without {
        Some(name) => {
            let (surfaces, _, _) = crate::study::envmap::object(&stage, name)?;
            stage.without(&surfaces)
        }
        None => stage,
    };
    let bands = stage.band_count();
    let radiosity = Radiosity { bands, values: light.mean(), std_err: None };
    let session = inputs::session(&stage, kernel, console)?;
    let tracer = session.tracer();
    let camera = standpoint::camera(&tracer, args.camera.as_deref())?;
    let place = args.at.map_or(camera.eye, |p| p.0);
    let centre = standpoint::centre(&camera, place, args.towards.map(|d| d.0), args.up.map(|d| d.0))?;
    let sky = args.sky.as_deref().map(|file| sky::read(file, args.given, &stage.photometry.bands)).transpose()?;
    let up = args.up.map_or(camera.up, |u| u.0);
    let scene = Scene { args, tracer, centre, radiosity, sky, up };
    match shape(args) {
        Some(_) if args.diffuse => scene.diffuse(&stage),
        Some(shape) => scene.laid_out(&stage, shape),
        None => scene.perspective(&stage, &camera),
    }
}

impl Scene<'_> {
    fn look(&self, shape: Shape) -> Seen {
        let begin = Instant::now();
        let view = WorldView::cast(&self.tracer, &self.centre, shape, self.args.samples);
        let mut map = view.radiances(&self.radiosity.values, self.radiosity.bands);
        if let Some(sky) = &self.sky {
            map = sky::behind(&map, &view.open(), sky, &self.centre, self.up);
        }
        Seen { map, view, seconds: begin.elapsed().as_secs_f64() }
    }

    fn said(&self, seen: &Seen) -> (Vec<String>, Value) {
        let shape = seen.view.shape;
        let (texels, centre) = (shape.texels(), self.centre.point.to_array());
        let weights: Vec<f64> = (0..texels).map(|k| shape.solid_angle(k)).collect();
        let all: f64 = weights.iter().sum();
        let open: f64 =
            weights.iter().zip(seen.view.coverage()).map(|(w, c)| w * (1.0 - f64::from(c))).sum::<f64>() / all;
        let words = vec![
            format!("from {}, {}, {}: {} rays", centre[0], centre[1], centre[2], inputs::thousands(seen.view.rays)),
            format!("{:.3} % of what is drawn shows no front of a surface", 100.0 * open),
        ];
        let json = json!({
            "at": centre, "front": self.centre.frame.y.to_array(), "up": self.centre.frame.z.to_array(),
            "texels": texels, "rays": seen.view.rays, "open": open, "seconds": seen.seconds,
        });
        (words, json)
    }

    fn drawn(&self, stage: &Stage, kind: Kind, view: &WorldView, comments: &str) -> Drawn {
        let mut adapts_to = self.patches(stage, &view.shares(stage.patch_count()));
        if let (Some(_), Kind::Map(map)) = (&self.sky, &kind) {
            adapts_to = texels(map, &stage.photometry);
        }
        let p = self.centre.point;
        let comments = format!(
            "{comments} World centre {}, {}, {} m in \"{}\"; front {:?}, up {:?}.",
            p.x,
            p.y,
            p.z,
            stage.name,
            self.centre.frame.y.to_array(),
            self.centre.frame.z.to_array()
        );
        let photometry = stage.photometry.clone();
        Drawn { kind, photometry, adapts_to, comments, is_irradiance: false, more: Vec::new() }
    }

    /// In a layout: by rays, or filtered from a cube with its distance from rays.
    fn laid_out(&self, stage: &Stage, shape: Shape) -> Result<Made, Failure> {
        let seen = self.look(shape);
        let (mut words, mut json) = self.said(&seen);
        let mut map = seen.map;
        let mut comments = "Radiance, W/(m^2 sr) per band, linear.".to_string();
        let mut is_filtered = false;
        if let Some(size) = self.args.from_cube {
            let cube = self.look(Shape { layout: Layout::Cube, size }).map;
            let filtered = resample(&cube, shape);
            let weights = |k: usize| shape.solid_angle(k);
            let rms = relative(&filtered, &map, weights);
            words.push(format!("drawn from a cube of {size}: {:.3} % (rms) off what rays show", 100.0 * rms));
            json["from_cube"] = json!({ "size": size, "off_rays": rms });
            comments = format!("{comments} Filtered from a cube of {size}.");
            (map, is_filtered) = (filtered, true);
        }
        let mut drawn = self.drawn(stage, Kind::Map(map), &seen.view, &comments);
        if !is_filtered {
            drawn.more.push(("Z".into(), seen.view.distances.clone()));
            drawn.comments += " Z is the distance from the centre along the middle of the texel, m.";
        }
        Ok(Made { drawn, words, json })
    }

    /// Irradiance by normal.
    fn diffuse(&self, stage: &Stage) -> Result<Made, Failure> {
        let size = self.args.from_cube.unwrap_or(LEAST_CUBE.max(4 * self.args.size.min(256)));
        let seen = self.look(Shape { layout: Layout::Cube, size });
        let begin = Instant::now();
        let table = DiffuseMap::new(&seen.map, [2 * self.args.size, self.args.size]);
        let seconds = begin.elapsed().as_secs_f64();
        let values: Vec<f32> = table.values().iter().map(|e| *e as f32).collect();
        let shape = Shape { layout: Layout::LatLong, size: self.args.size };
        let (mut words, mut json) = self.said(&seen);
        words.push(format!("irradiance by normal, convolved from a cube of {size}"));
        json["diffuse"] = json!({ "from_cube": size, "seconds": seconds });
        let map = WorldMap::new(shape, table.bands(), values);
        let comments = "Irradiance over each normal, W/m^2 per band, linear: a diffuse illumination map.";
        let mut drawn = self.drawn(stage, Kind::Map(map), &seen.view, comments);
        drawn.shown_as_white_matt();
        Ok(Made { drawn, words, json })
    }

    /// As a pin-hole camera sees it: rays, or a cube whose camera only turns.
    fn perspective(&self, stage: &Stage, camera: &Camera) -> Result<Made, Failure> {
        let args = self.args;
        let fov = args.field.unwrap_or(if stage.cameras.is_empty() { 45.0 } else { camera.fov });
        let front = args.towards.map_or(camera.target - camera.eye, |t| t.0);
        let sized = resized(camera, false, [(args.size * 4).div_ceil(3), args.size]);
        let here = Camera {
            eye: self.centre.point,
            target: self.centre.point + front.normalize(),
            // Straight up or down, the top of the picture is where the observer's own is.
            up: if front.normalize().cross(self.up.normalize()).length() > 1e-6 {
                self.up
            } else {
                self.centre.frame.z
            },
            fov,
            ..sized
        };
        let visibility = crate::render::Visibility::cast(&self.tracer, &here, args.samples);
        let direct = self.rays(&here, &visibility);
        let shown = PictureShares::of(&Mesh::of_patches(stage), [&visibility]).shares;
        let side = u64::from(args.samples);
        let rays = u64::from(here.size[0]) * u64::from(here.size[1]) * side * side;
        let at = here.eye.to_array();
        let mut words = vec![format!("from {}, {}, {}: {} rays", at[0], at[1], at[2], inputs::thousands(rays))];
        let mut json = json!({ "at": at, "rays": rays, "fov": fov });
        let mut values = direct;
        if args.from_cube.is_some() || args.turning_to.is_some() {
            let own = (2.0 * f64::from(here.size[1]) / (0.5 * fov.to_radians()).tan()).ceil() as u32;
            let size = args.from_cube.unwrap_or(own.clamp(1, LARGEST_CUBE));
            let map = self.look(Shape { layout: Layout::Cube, size }).map;
            let local = |d: DVec3| self.centre.frame.to_local(d);
            if let Some(end) = args.turning_to {
                let blur = turning::blurred(&map, &here, end.0, local)?;
                words.push(turning::words(blur.off));
                json["blur"] = json!({ "from_cube": size, "off_instants": blur.off });
                values = blur.values;
            } else {
                let from_cube =
                    exact_picture(&map, here.size.map(|n| n as usize), |x, y| Some(local(here.direction(x, y))));
                let (d, t) = from_cube
                    .iter()
                    .zip(&values)
                    .fold((0.0, 0.0), |(d, t), (a, b)| (d + f64::from(a - b).powi(2), t + f64::from(*b).powi(2)));
                let off = if t > 0.0 { (d / t).sqrt() } else { 0.0 };
                words.push(format!("drawn from a cube of {size}: {:.3} % (rms) off what rays show", 100.0 * off));
                json["from_cube"] = json!({ "size": size, "off_rays": off });
                values = from_cube;
            }
        }
        let adapts_to = self.patches(stage, &shown);
        let comments = "Radiance, W/(m^2 sr) per band, linear.".to_string();
        let (kind, photometry) = (Kind::Flat(here.size, values), stage.photometry.clone());
        Ok(Made {
            drawn: Drawn { kind, photometry, adapts_to, comments, is_irradiance: false, more: Vec::new() },
            words,
            json,
        })
    }

    /// Luminances of patches with their shares of what is seen.
    fn patches(&self, stage: &Stage, shares: &[f64]) -> Vec<(f64, f64, bool)> {
        let lamps = Receivers::patches(stage).lamps();
        let patches = luminance(&stage.photometry, &self.radiosity).into_iter().zip(shares).zip(lamps);
        patches.map(|((y, s), lamp)| (y, *s, lamp)).collect()
    }

    /// Radiances through a camera, each sample of a pixel alike.
    fn rays(&self, camera: &Camera, visibility: &crate::render::Visibility) -> Vec<f32> {
        let side = self.args.samples;
        let sky = self.sky.as_ref().map(|s| sky::Behind::new(s, self.up));
        let (bands, width) = (self.radiosity.bands, camera.size[0] as usize);
        let pixel = |p: usize| {
            let samples = visibility.samples(p);
            let mut sum = vec![0.0; bands];
            for (k, landing) in samples.iter().enumerate() {
                if (*landing as usize) < self.radiosity.len() {
                    let b = self.radiosity.of(*landing as usize);
                    sum.iter_mut().zip(b).for_each(|(s, b)| *s += b / PI);
                } else if let (Some(sky), true) = (&sky, *landing == crate::raycast::ESCAPED) {
                    let (sx, sy) = (k as u32 % side, k as u32 / side);
                    let at = |whole: usize, part: u32| whole as f64 + (f64::from(part) + 0.5) / f64::from(side);
                    sky.add(camera.direction(at(p % width, sx), at(p / width, sy)), &mut sum);
                }
            }
            sum.into_iter().map(move |s| (s / samples.len() as f64) as f32)
        };
        (0..visibility.pixel_count()).flat_map(pixel).collect()
    }
}

/// Root mean square of `a - b` over that of b, weighted by solid angle.
fn relative(a: &WorldMap, b: &WorldMap, weight: impl Fn(usize) -> f64) -> f64 {
    let (mut d, mut t) = (0.0, 0.0);
    for k in 0..a.shape().texels() {
        let w = weight(k);
        for (a, b) in a.texel(k).iter().zip(b.texel(k)) {
            d += w * f64::from(a - b).powi(2);
            t += w * f64::from(*b).powi(2);
        }
    }
    if t > 0.0 { (d / t).sqrt() } else { 0.0 }
}
