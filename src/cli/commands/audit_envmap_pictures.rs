//! Pictures of an audit of environment maps: the world in its layouts, footprints, spheres, the object.

use crate::cli::args::EnvmapArgs;
use crate::cli::exit::Failure;
use crate::math::DVec3;
use crate::raycast::KernelKind;
use crate::render::{ColourMap, Raster, Seen, ToneMap, WorldView, luminance, paint_radiances, paint_world, to_srgb8};
use crate::report::envmap::EnvmapPicture;
use crate::scene::Stage;
use crate::solution::Radiosity;
use crate::study::envmap::{Audited, EnvmapRequest, Light, Picture, object};
use crate::study::{Receivers, Session};
use crate::view::Operator;
use crate::world::{Cone, DiffuseMap, Layout, Shape, WorldMap, outline, resample, unfolded};
use std::f64::consts::PI;

/// Edge of the faces that are drawn.
const DRAWN: u32 = 128;

/// All pictures, through one eye that is adapted to the world around the first centre.
pub fn pictures(
    stage: &Stage,
    kernel: KernelKind,
    request: &EnvmapRequest,
    light: &Light,
    audited: &Audited,
    args: &EnvmapArgs,
) -> Result<Vec<EnvmapPicture>, Failure> {
    let (surfaces, middle, _) = object(stage, &request.object)?;
    let bare = stage.without(&surfaces);
    let session = Session::open(&bare, kernel)?;
    let centre = request.axes.moved(request.centres.first().copied().unwrap_or(middle));
    let shape = Shape { layout: Layout::Cube, size: DRAWN };
    let view = WorldView::cast(&session.tracer(), &centre, shape, request.samples);
    let (values, bands) = (light.mean(), light.radiosities.bands);
    let map = view.radiances(&values, bands);
    let lit = Radiosity { bands, values, std_err: None };
    let seen = Seen { shares: view.shares(stage.patch_count()) };
    let onlooker = args.viewing.onlooker(Operator::default());
    let viewer = onlooker.look(&seen, &luminance(&stage.photometry, &lit), &Receivers::patches(stage).lamps());
    let shade = ToneMap::new(viewer, &stage.photometry);
    let latlong = resample(&map, Shape { layout: Layout::LatLong, size: DRAWN });
    let picture =
        |name: &str, title: &str, raster: Raster| EnvmapPicture { name: name.into(), title: title.into(), raster };
    let diffuse = DiffuseMap::new(&map, request.table);
    let mut all = vec![
        picture("world-cube", "The world around the centre, the cube unfolded", paint_world(&map, &shade)),
        picture(
            "world-latlong",
            "The same in latitude-longitude, filtered from the cube",
            paint_world(&latlong, &shade),
        ),
        picture("footprints-cube", FOOTPRINTS, footprints(&map, &shade)),
        picture("footprints-latlong", "The same cones in latitude-longitude", footprints(&latlong, &shade)),
        picture("world-diffuse", "Its diffuse illumination map, magnified", magnified(&diffuse, &shade)),
    ];
    for found in &audited.pictures {
        all.push(picture(&found.name, &found.title, paint(found, &shade)));
        if let Some(base) = found.name.strip_suffix("-rays").or(found.name.strip_suffix("-hybrid")) {
            let of = |how: &str| audited.pictures.iter().find(|p| p.name == format!("{base}-{how}"));
            if let (true, Some(map), Some(rays)) = (found.name.ends_with("-rays"), of("map"), of("rays")) {
                all.push(picture(&format!("{base}-off"), "map less rays", off(map, rays, stage)));
            }
        }
    }
    Ok(all)
}

/// What [`footprints`] draws.
const FOOTPRINTS: &str = "What a wide cone (red) and a narrow one (blue) take of the cube: the quadrilateral of a pixel, and \
                          concentric ellipses";

/// A map with the outlines of two cones, quadrilateral [G86 fig. 4] and elliptical, three of them in one another
/// [G86 fig. 6].
fn footprints(map: &WorldMap, shade: &ToneMap) -> Raster {
    let mut raster = paint_world(map, shade);
    let shape = map.shape();
    let mut pixel_of = vec![0; shape.texels()];
    for (pixel, texel) in unfolded(shape).texels.iter().enumerate() {
        texel.iter().for_each(|t| pixel_of[*t] = pixel);
    }
    // Up and to the right of the front: across an edge of the cube, and not far from the pole.
    let cones = [(DVec3::new(0.5, 0.7, 0.75), 0.35, [225, 40, 30]), (DVec3::new(-0.75, 0.6, 0.1), 0.06, [40, 90, 255])];
    for (axis, half, colour) in cones {
        let axis = axis.normalize();
        let (a, b) = axis.any_orthonormal_pair();
        let ellipse = Cone::Ellipse { axis, a: a * (1.6 * half), b: b * half };
        let lines = [(Cone::Quad(ellipse.quad()), 1.0), (ellipse, 1.0), (ellipse, 2.0 / 3.0), (ellipse, 1.0 / 3.0)];
        for (cone, scale) in lines {
            for (panel, line) in outline(shape, &cone, scale) {
                for ends in line.windows(2) {
                    let steps = ((ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1]) * 3.0).ceil().max(1.0);
                    for k in 0..=steps as usize {
                        let at = |i: usize| ends[0][i] + (ends[1][i] - ends[0][i]) * k as f64 / steps;
                        let texel = |v: f64, n: usize| (v.max(0.0) as usize).min(n - 1);
                        let index = shape.index(panel, texel(at(0), shape.width()), texel(at(1), shape.height()));
                        raster.rgba[4 * pixel_of[index]..4 * pixel_of[index] + 3].copy_from_slice(&colour);
                    }
                }
            }
        }
    }
    raster
}

/// A table of irradiances as it is looked up, four pixels an entry.
fn magnified(table: &DiffuseMap, shade: &ToneMap) -> Raster {
    let [w, h] = table.size().map(|n| 8 * n);
    let shape = Shape { layout: Layout::LatLong, size: h };
    let bands = table.bands();
    if w != 2 * h {
        // Other shapes are shown entry by entry.
        let values: Vec<f32> = table.values().iter().map(|e| (e / PI) as f32).collect();
        return paint_radiances(table.size()[0], table.size()[1], bands, &values, shade);
    }
    let map = WorldMap::filled(shape, bands, |k, v| {
        if let Some(d) = shape.middle(k) {
            table.diffuse_radiance(d).iter().zip(v).for_each(|(l, v)| *v = *l as f32);
        }
    });
    paint_world(&map, shade)
}

/// A picture; what is not drawn is transparent.
fn paint(picture: &Picture, shade: &ToneMap) -> Raster {
    let values: Vec<f32> = picture.values.iter().map(|v| if v.is_nan() { 0.0 } else { *v }).collect();
    let mut raster = paint_radiances(picture.width, picture.height, picture.bands, &values, shade);
    for (pixel, v) in raster.rgba.chunks_mut(4).zip(picture.values.chunks(picture.bands)) {
        if v[0].is_nan() {
            pixel.copy_from_slice(&[0; 4]);
        }
    }
    raster
}

/// The difference in luminance: red where the map is too bright, blue where it is too dark, full at the mean luminance
/// of the truth.
fn off(map: &Picture, rays: &Picture, stage: &Stage) -> Raster {
    let luminance = |v: &[f32]| stage.photometry.luminance(&v.iter().map(|x| f64::from(*x)).collect::<Vec<_>>());
    let drawn = rays.values.chunks(rays.bands).filter(|v| !v[0].is_nan());
    let (sum, count) = drawn.fold((0.0, 0.0), |(s, n), v| (s + luminance(v), n + 1.0));
    let mean = if sum > 0.0 { sum / count } else { 1.0 };
    let pixel = |(m, r): (&[f32], &[f32])| -> [u8; 4] {
        if m[0].is_nan() {
            return [0; 4];
        }
        let [r, g, b] = ColourMap::Diverging.colour((luminance(m) - luminance(r)) / mean).map(to_srgb8);
        [r, g, b, 255]
    };
    let pixels = map.values.chunks(map.bands).zip(rays.values.chunks(rays.bands));
    let rgba: Vec<u8> = pixels.flat_map(pixel).collect();
    Raster { width: map.width, height: map.height, rgba }
}
