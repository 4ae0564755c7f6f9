//! Pictures of a page, in groups.

use super::html::context::minus;
use super::{Artifact, ReportError};
use crate::io::image::png;
use crate::render::Raster;
use serde::Serialize;

/// A picture ready to be shown.
#[derive(Debug, Clone, PartialEq)]
pub struct PagePicture {
    /// Stem of its file; where it stands in the page follows from it.
    pub name: String,
    /// What it shows.
    pub title: String,
    /// The pixels.
    pub raster: Raster,
}

impl PagePicture {
    /// Name of its file.
    pub(super) fn file(&self) -> String {
        format!("{}.png", self.name)
    }

    pub(super) fn shown(&self) -> Shown {
        Shown { file: self.file(), title: minus(&self.title), width: self.raster.width, height: self.raster.height }
    }
}

/// A picture with what is written below it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(super) struct Shown {
    pub file: String,
    pub title: String,
    pub width: u32,
    pub height: u32,
}

/// Pictures that belong together.
#[derive(Debug, Serialize)]
pub(super) struct Group {
    pub title: &'static str,
    pub lead: &'static str,
    /// Class of its layout.
    pub class: &'static str,
    /// Row after row; `None` where a grid has no picture.
    pub pictures: Vec<Option<Shown>>,
}

impl Group {
    /// A group without gaps.
    pub(super) fn of(title: &'static str, lead: &'static str, class: &'static str, all: Vec<&PagePicture>) -> Self {
        Self { title, lead, class, pictures: all.into_iter().map(|p| Some(p.shown())).collect() }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.pictures.iter().all(Option::is_none)
    }
}

/// Takes what `chosen` holds for out of `left`, in order.
pub(super) fn taken<'a>(left: &mut Vec<&'a PagePicture>, chosen: impl Fn(&str) -> bool) -> Vec<&'a PagePicture> {
    let (mine, others) = left.drain(..).partition(|p| chosen(&p.name));
    *left = others;
    mine
}

/// The first of that name.
pub(super) fn named<'a>(left: &mut Vec<&'a PagePicture>, name: &str) -> Option<&'a PagePicture> {
    let at = left.iter().position(|p| p.name == name)?;
    Some(left.remove(at))
}

/// Files (.png), in order.
///
/// # Errors
/// [`ReportError::Image`] for a picture whose pixels do not fit its size.
pub(super) fn encoded(pictures: &[PagePicture]) -> Result<Vec<Artifact>, ReportError> {
    let encode = |p: &PagePicture| -> Result<Artifact, ReportError> {
        let r = &p.raster;
        Ok(Artifact::new(p.file(), png(r.width, r.height, &r.rgba)?))
    };
    pictures.iter().map(encode).collect()
}
