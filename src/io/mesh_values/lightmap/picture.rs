//! The channels of an EXR picture that are values.

use crate::io::FileError;
use crate::io::mesh_values::{bytes_of, shown};
use crate::io::scene::mesh::band_names;
use exr::prelude as ex;
use exr::prelude::{ReadChannels, ReadLayers};
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// Most texels that are read.
const MAX_TEXELS: u64 = 1 << 26;

/// A picture: rows from the top.
pub(super) struct Picture {
    path: PathBuf,
    pub width: usize,
    pub height: usize,
    pub bands: Vec<String>,
    channels: Vec<Vec<f32>>,
    alpha: Option<Vec<f32>>,
}

/// A texel with a value that cannot be used.
pub(super) struct BrokenTexel(FileError);

impl BrokenTexel {
    /// Says which face the texel lies on.
    pub(super) fn at_face(mut self, file: &str, face: &str) -> FileError {
        self.0.place += &format!(" (on {file}, {face})");
        self.0
    }
}

impl Picture {
    /// Reads R, G and B, or Y, or the channels named.
    pub(super) fn read(path: &Path, fields: Option<&[String]>) -> Result<Self, FileError> {
        let bytes = bytes_of(path)?;
        let broken = |e: exr::error::Error| {
            FileError::new(path, format!("is no sound EXR picture: {e}")).mend("save it again as OpenEXR, single part")
        };
        let meta = ex::MetaData::read_from_buffered(Cursor::new(&bytes), false).map_err(broken)?;
        check(path, &meta)?;
        let reader = ex::read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
        let picture = reader.all_attributes().non_parallel().from_buffered(Cursor::new(&bytes)).map_err(broken)?;
        let layer = picture.layer_data;
        let (width, height) = (layer.size.0, layer.size.1);
        let window = picture.attributes.display_window;
        if window.size != layer.size || window.position != layer.attributes.layer_position {
            let problem = "the data window is not the display window: parts of the picture are cut away";
            return Err(FileError::new(path, problem).at("header").mend("save the whole picture"));
        }
        let list = &layer.channel_data.list;
        let names: Vec<String> = list.iter().map(|c| c.name.to_string()).collect();
        let chosen = choose(path, &names, fields)?;
        let numbers = |name: &str| -> Result<Vec<f32>, FileError> {
            let samples: Option<Vec<f32>> =
                list.iter().find(|c| c.name == *name).map(|c| c.sample_data.values_as_f32().collect());
            match samples.filter(|s| s.len() == width * height) {
                Some(samples) => Ok(samples),
                None => Err(FileError::new(path, "the channel is subsampled or missing")
                    .at(format!("channel {}", shown(name)))
                    .mend("save every channel in full size")),
            }
        };
        let channels = chosen.iter().map(|n| numbers(n)).collect::<Result<Vec<_>, _>>()?;
        let alpha = names.iter().find(|n| *n == "A" && !chosen.contains(n)).map(|n| numbers(n)).transpose()?;
        Ok(Self { path: path.into(), width, height, bands: band_names(&chosen), channels, alpha })
    }

    /// Values of a texel; `None` if it is empty: alpha 0 or NaN.
    pub(super) fn texel(&self, column: usize, row: usize) -> Result<Option<Vec<f64>>, BrokenTexel> {
        let at = row * self.width + column;
        let values: Vec<f64> = self.channels.iter().map(|c| f64::from(c[at])).collect();
        if self.alpha.as_ref().is_some_and(|a| a[at] == 0.0 || a[at].is_nan()) || values.iter().any(|v| v.is_nan()) {
            return Ok(None);
        }
        match values.iter().find(|v| !v.is_finite()) {
            None => Ok(Some(values)),
            Some(v) => Err(BrokenTexel(
                FileError::new(&self.path, format!("a value is {v}"))
                    .at(format!("texel {column}, {row} from the top left"))
                    .mend("bake finite numbers, or mark empty texels by alpha 0 or NaN"),
            )),
        }
    }
}

/// Refuses what would not fit before any pixel is read.
fn check(path: &Path, meta: &ex::MetaData) -> Result<(), FileError> {
    let refuse = |problem: String, mend: &str| Err(FileError::new(path, problem).at("header").mend(mend));
    let Some(header) = meta.headers.iter().find(|h| !h.deep) else {
        return refuse("the picture is deep".into(), "save a flat picture");
    };
    let (width, height) = (header.layer_size.0 as u64, header.layer_size.1 as u64);
    if width.saturating_mul(height).saturating_mul(header.channels.list.len() as u64) > 4 * MAX_TEXELS {
        return refuse(format!("{width} x {height} texels are more than can be read"), "save a smaller picture");
    }
    Ok(())
}

/// The channels that hold values.
fn choose(path: &Path, names: &[String], fields: Option<&[String]>) -> Result<Vec<String>, FileError> {
    let has = |n: &str| names.iter().any(|m| m == n);
    let wanted: Vec<String> = match fields {
        Some(fields) => fields.to_vec(),
        None if ["R", "G", "B"].iter().all(|n| has(n)) => ["R", "G", "B"].map(String::from).to_vec(),
        None => vec!["Y".to_string()],
    };
    match wanted.iter().find(|n| !has(n)) {
        None if !wanted.is_empty() => Ok(wanted),
        missing => {
            let all: Vec<String> = names.iter().map(|n| shown(n)).collect();
            let missing = missing.map_or("values", |n| n);
            let asked = if fields.is_some() { shown(missing) } else { "R, G and B, or Y".into() };
            Err(FileError::new(path, format!("the picture has no channels {asked}"))
                .at("header")
                .mend(format!("name others (--fields); there are {}", all.join(", "))))
        }
    }
}
