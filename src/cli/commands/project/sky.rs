//! A picture of a world behind a scene: what is seen where nothing else is.

use crate::cli::args::GivenLayout;
use crate::cli::exit::Failure;
use crate::io::world_map::{LayoutHint, ReadMap, read_world_map};
use crate::math::DVec3;
use crate::render::Centre;
use crate::world::{Cone, Pyramid, Spot, WorldMap, half_cube};
use std::path::Path;

/// The layout that a user says a picture has.
fn given(layout: Option<GivenLayout>) -> Option<LayoutHint> {
    layout.map(|layout| match layout {
        GivenLayout::Latlong => LayoutHint::LatLong,
        GivenLayout::SineLatlong => LayoutHint::SineLatLong,
        GivenLayout::Cross => LayoutHint::HorizontalCross,
        GivenLayout::VerticalCross => LayoutHint::VerticalCross,
        GivenLayout::Strip => LayoutHint::VerticalStrip,
        GivenLayout::Fisheye | GivenLayout::SkyFisheye => LayoutHint::Fisheye { field: 180.0 },
    })
}

/// A picture of a world; a photograph of the sky becomes the upper half of a cube [G86 fig. 10].
pub(super) fn open(file: &Path, layout: Option<GivenLayout>) -> Result<ReadMap, Failure> {
    let mut read = read_world_map(file, given(layout))?;
    if layout == Some(GivenLayout::SkyFisheye) {
        read.map = half_cube(&read.map);
        read.how += ", about what is up: the upper half of a cube";
    }
    Ok(read)
}

/// The same in the bands of a scene.
pub(super) fn read(file: &Path, layout: Option<GivenLayout>, bands: &[String]) -> Result<WorldMap, Failure> {
    let ReadMap { map, bands: own, .. } = open(file, layout)?;
    let same = |a: &str, b: &str| a.eq_ignore_ascii_case(b);
    let places: Option<Vec<usize>> = bands.iter().map(|b| own.iter().position(|o| same(o, b))).collect();
    let places = match (places, own.len()) {
        (Some(places), _) => places,
        // One band stands for all.
        (None, 1) => vec![0; bands.len()],
        (None, _) => {
            let message = format!(
                "{}: it has the bands {}, the scene has {}; name its channels like those",
                file.display(),
                own.join(", "),
                bands.join(", ")
            );
            return Err(Failure::input(message).at(file.display().to_string()));
        }
    };
    Ok(WorldMap::filled(map.shape(), bands.len(), |k, v| {
        let texel = map.texel(k);
        v.iter_mut().zip(&places).for_each(|(v, p)| *v = texel[*p]);
    }))
}

/// A sky that stands still while the observer turns: up is the scene's, the front its +y (-z where y is up).
pub(super) struct Behind<'a> {
    map: &'a WorldMap,
    axes: Centre,
}

impl<'a> Behind<'a> {
    pub(super) fn new(map: &'a WorldMap, up: DVec3) -> Self {
        let up = up.normalize_or(DVec3::Z);
        let front = if up.dot(DVec3::Y).abs() > 0.99 { -DVec3::Z } else { DVec3::Y };
        Self { map, axes: Centre::new(DVec3::ZERO, front, up) }
    }

    /// Adds the radiance in a direction of the scene.
    pub(super) fn add(&self, direction: DVec3, sum: &mut [f64]) {
        if let Some(spot) = self.map.shape().place(self.axes.frame.to_local(direction)) {
            self.map.add_bilinear(spot, 1.0, sum);
        }
    }
}

/// A map with the sky in the open share of each texel, filtered to its size.
pub(super) fn behind(map: &WorldMap, open: &[f32], sky: &WorldMap, centre: &Centre, up: DVec3) -> WorldMap {
    let (shape, behind) = (map.shape(), Behind::new(sky, up));
    let pyramid = Pyramid::new(sky.clone());
    WorldMap::filled(shape, map.bands(), |k, v| {
        v.copy_from_slice(map.texel(k));
        if open[k] <= 0.0 {
            return;
        }
        let (panel, x, y) = shape.texel(k);
        let corner = |dx: f64, dy: f64| {
            let d = shape.direction(Spot { panel, x: x as f64 + dx, y: y as f64 + dy })?;
            Some(behind.axes.frame.to_local(centre.frame.to_world(d)))
        };
        let corners = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
        let Some(cone) = Cone::given(&corners) else { return };
        // What a half world does not show is dark.
        let covered = cone.axis().is_some_and(|a| sky.shape().place(a).is_some());
        if covered {
            pyramid.ewa(&cone).iter().zip(v).for_each(|(l, v)| *v += open[k] * *l as f32);
        }
    })
}
