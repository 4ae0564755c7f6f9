//! From a picture to a world map.

use super::faces::Faces;
use super::picture::Picture;
use crate::io::FileError;
use crate::world::{Layout, Shape, WorldMap};
use exr::meta::attribute::EnvironmentMap;
use std::path::Path;

/// What a picture shows, where its header and proportions do not say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LayoutHint {
    /// Latitude-longitude, 2:1, the front in the middle.
    LatLong,
    /// The same with sines of latitudes down.
    SineLatLong,
    /// Equidistant fish-eye, 1:1.
    Fisheye {
        /// Angle across the circle, degrees.
        field: f64,
    },
    /// Faces of a cube, 4:3: left, front, right, back; up above the front, down below it.
    HorizontalCross,
    /// Faces of a cube, 3:4: up; left, front, right; down; back upside down.
    VerticalCross,
    /// OpenEXR's cube, 1:6: +X, -X, +Y, -Y, +Z, -Z from the top.
    VerticalStrip,
    /// The same faces side by side, 6:1.
    HorizontalStrip,
}

/// A world map from a file.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadMap {
    /// The map.
    pub map: WorldMap,
    /// Names of its bands.
    pub bands: Vec<String>,
    /// What the picture was taken for, and why.
    pub how: String,
}

impl LayoutHint {
    /// Width and height of its pictures, in units of the map's size.
    fn extent(self) -> (usize, usize) {
        match self {
            Self::LatLong | Self::SineLatLong => (2, 1),
            Self::Fisheye { .. } => (1, 1),
            _ => self.faces().map_or((1, 1), Faces::extent),
        }
    }

    fn faces(self) -> Option<Faces> {
        match self {
            Self::HorizontalCross => Some(Faces::HorizontalCross),
            Self::VerticalCross => Some(Faces::VerticalCross),
            Self::VerticalStrip => Some(Faces::VerticalStrip),
            Self::HorizontalStrip => Some(Faces::HorizontalStrip),
            _ => None,
        }
    }

    fn layout(self) -> Layout {
        match self {
            Self::LatLong => Layout::LatLong,
            Self::SineLatLong => Layout::SineLatLong,
            Self::Fisheye { field } => Layout::Fisheye { field },
            _ => Layout::Cube,
        }
    }

    fn name(self) -> String {
        match self {
            Self::LatLong => "latitude-longitude map, its front in the middle".into(),
            Self::SineLatLong => "longitude and sine-of-latitude map, its front in the middle".into(),
            Self::Fisheye { field } => format!("equidistant fish-eye of {field} degrees"),
            Self::HorizontalCross => "cube unfolded to a horizontal cross".into(),
            Self::VerticalCross => "cube unfolded to a vertical cross, its back upside down".into(),
            Self::VerticalStrip => {
                "cube as a column of faces, +X, -X, +Y, -Y, +Z, -Z (+Z is the front, +X left)".into()
            }
            Self::HorizontalStrip => "cube as a row of faces, +X, -X, +Y, -Y, +Z, -Z (+Z is the front, +X left)".into(),
        }
    }

    /// What our own files write into their header.
    fn of_ours(words: &str) -> Option<Self> {
        match words {
            "cube" => Some(Self::HorizontalCross),
            "latlong" => Some(Self::LatLong),
            "sine-latlong" => Some(Self::SineLatLong),
            _ => Some(Self::Fisheye { field: words.strip_prefix("fisheye ")?.parse().ok()? }),
        }
    }
}

/// Reads a world map from an OpenEXR picture or a PNG photograph (sRGB, decoded to linear values). What the picture shows
/// is what `given` says; else what its header says (our own attribute, or OpenEXR's `envmap`); else what its proportions
/// mean: 2:1 latitude-longitude, 4:3 and 3:4 crosses, 1:6 and 6:1 strips. Alpha is not asked. Pixels are taken as areas, as
/// renderers do; OpenEXR's own latitude-longitude formulas put the middles of the outermost pixels onto the border, half a
/// pixel away.
///
/// # Errors
/// [`FileError`] with place and mend where there is no sound picture, its size is another or too large, or a value that
/// would be used is not finite.
pub fn read_world_map(path: &Path, given: Option<LayoutHint>) -> Result<ReadMap, FileError> {
    let picture = Picture::read(path)?;
    let (hint, why) = hint_of(path, &picture, given)?;
    let (across, down) = hint.extent();
    let (width, height) = (picture.width, picture.height);
    let size = height / down;
    if size == 0 || size * across != width || size * down != height {
        let problem = format!("{width} x {height} pixels are no {}, which is {across}:{down}", hint.name());
        return Err(FileError::new(path, problem).mend("cut or scale the picture, or say what it shows"));
    }
    if let LayoutHint::Fisheye { field } = hint
        && !(field > 0.0 && field <= 360.0)
    {
        let problem = format!("a fish-eye cannot show {field} degrees");
        return Err(FileError::new(path, problem).mend("give more than 0 and at most 360 degrees"));
    }
    let shape = Shape { layout: hint.layout(), size: size as u32 };
    let pixels = hint.faces().map(|f| f.pixels(shape.size));
    let mut values = Vec::with_capacity(shape.texels() * picture.bands.len());
    for texel in 0..shape.texels() {
        let at = pixels.as_ref().map_or(texel, |p| p[texel]);
        let shown = !matches!(hint, LayoutHint::Fisheye { .. }) || shape.middle(texel).is_some();
        for channel in &picture.channels {
            let value = channel[at];
            if shown && !value.is_finite() {
                let place = format!("pixel {}, {} from the top left", at % width, at / width);
                return Err(FileError::new(path, format!("a value is {value}"))
                    .at(place)
                    .mend("save finite numbers: brightest parts may have gone beyond what half floats hold"));
            }
            values.push(if shown { value } else { 0.0 });
        }
    }
    let bands = picture.bands.len();
    let how = format!("{width} x {height} pixels: {} ({why})", hint.name());
    Ok(ReadMap { map: WorldMap::new(shape, bands, values), bands: picture.bands, how })
}

/// What the picture shows, and how that is known.
fn hint_of(path: &Path, picture: &Picture, given: Option<LayoutHint>) -> Result<(LayoutHint, &'static str), FileError> {
    if let Some(hint) = given {
        return Ok((hint, "as given"));
    }
    if let Some(hint) = picture.layout.as_deref().and_then(LayoutHint::of_ours) {
        return Ok((hint, "as its header says"));
    }
    match picture.environment {
        Some(EnvironmentMap::LatitudeLongitude) => return Ok((LayoutHint::LatLong, "as its envmap attribute says")),
        Some(EnvironmentMap::Cube) => return Ok((LayoutHint::VerticalStrip, "as its envmap attribute says")),
        None => {}
    }
    let known = [
        LayoutHint::LatLong,
        LayoutHint::HorizontalCross,
        LayoutHint::VerticalCross,
        LayoutHint::VerticalStrip,
        LayoutHint::HorizontalStrip,
    ];
    let (width, height) = (picture.width, picture.height);
    let fits = |hint: &LayoutHint| {
        let (across, down) = hint.extent();
        width.is_multiple_of(across) && width / across * down == height
    };
    match known.into_iter().find(fits) {
        Some(hint) => Ok((hint, "by its proportions")),
        None if width == height => Err(FileError::new(path, format!("{width} x {height} pixels may be a fish-eye"))
            .mend("say so: --given fisheye, or sky-fisheye for a photograph of what is up")),
        None => Err(FileError::new(path, format!("{width} x {height} pixels are no world map that is known"))
            .mend("2:1 is latitude-longitude, 4:3 and 3:4 are crosses, 1:6 and 6:1 six faces in line, 1:1 a fish-eye")),
    }
}
