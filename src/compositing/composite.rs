//! Compositing by depth, sub-scanline by sub-scanline [NINT89 fig. 4], [NINT89 fig. 5].

use super::image::{Line, Span, SpanFace, SpanImage};
use super::merge::{Depths, in_front, merge};
use super::scan::planes;
use super::sunlit::light_up;
use crate::scene::{Appearance, Background, Material, Picture};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Why images cannot be composited.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CompositeError {
    /// They are not of one view.
    #[error(
        "{what} of the two is not the same: segments lie on each other only where camera, size, sub-scanlines and bands agree; scan both with the same"
    )]
    View {
        /// What differs.
        what: &'static str,
    },
    /// Both hold the same face.
    #[error(
        "both hold face {number} of surface \"{surface}\": a cluster goes in once (with scenes of different files, name surfaces apart)"
    )]
    Twice {
        /// Surface.
        surface: String,
        /// Number of the face.
        number: u32,
    },
    /// Both speak of the same thing in different words.
    #[error("{what} \"{name}\" is not the same in both: scan them from one scene, or name them apart")]
    Differs {
        /// Material, tree or picture.
        what: &'static str,
        /// Its name.
        name: String,
    },
}

/// What is seen of both images: any number of images is composited two by two, in any order.
///
/// Depth decides, crossing faces included; the background lies behind everything. Where the scene has a parallel light,
/// shadows of each image's faces on the other's are found. Materials, lights and pictures of both are kept.
pub fn composite(a: &SpanImage, b: &SpanImage) -> Result<SpanImage, CompositeError> {
    agree(a, b)?;
    let mut out = SpanImage {
        clusters: a.clusters.clone(),
        faces: Vec::new(),
        lines: Vec::new(),
        materials: a.materials.clone(),
        appearance: a.appearance.clone(),
        ..a.clone()
    };
    let materials = join_materials(&mut out.materials, &b.materials)?;
    let trees = join_appearance(&mut out.appearance, &b.appearance)?;
    let clusters: Vec<u32> = b.clusters.iter().zip(out.clusters.len() as u32..).map(|(_, k)| k).collect();
    out.clusters.extend(b.clusters.iter().cloned());
    let moved = |f: &SpanFace| SpanFace {
        material: materials[f.material as usize],
        cluster: clusters[f.cluster as usize],
        tree: f.tree.map(|t| trees[t as usize]),
        ..f.clone()
    };
    let numbers = join_faces(&mut out.faces, &a.faces, b.faces.iter().map(moved).collect())?;
    in_order(&mut out);
    let (planes, backs) = planes(&out);
    let row = |(j, (la, lb)): (usize, (&Line, &Line))| {
        let depths = Depths::at_row(&planes, &backs, j as f64 / f64::from(out.per_line));
        let renumber = |spans: &[Span], of: usize| -> Vec<Span> {
            spans.iter().map(|s| Span { face: numbers[of][s.face as usize], lit: true, ..*s }).collect()
        };
        let (sa, sb) = (renumber(&la.solid, 0), renumber(&lb.solid, 1));
        let mut line = Line::default();
        merge(&sa, &sb, &depths, &mut line.solid);
        for over in renumber(&la.over, 0).iter().chain(&renumber(&lb.over, 1)) {
            in_front(over, &line.solid, &depths, &mut line.over);
        }
        line.sort_over();
        line
    };
    out.lines = a.lines.par_iter().zip(&b.lines).enumerate().map(row).collect();
    light_up(&mut out);
    Ok(out)
}

fn agree(a: &SpanImage, b: &SpanImage) -> Result<(), CompositeError> {
    let mut cameras = [a.camera.clone(), b.camera.clone()];
    // What a camera is called changes nothing.
    cameras.iter_mut().for_each(|c| c.name.clear());
    let differs = |what| Err(CompositeError::View { what });
    match () {
        _ if cameras[0] != cameras[1] => differs("the camera"),
        _ if a.per_line != b.per_line => differs("the number of sub-scanlines"),
        _ if a.photometry != b.photometry => differs("the list of bands"),
        _ => Ok(()),
    }
}

/// Adds what is new; returns where each of `more` is now.
fn join_materials(list: &mut Vec<Material>, more: &[Material]) -> Result<Vec<u32>, CompositeError> {
    join(list, more, "material", |m| &m.name)
}

fn join<T: Clone + PartialEq>(
    list: &mut Vec<T>,
    more: &[T],
    what: &'static str,
    name: impl Fn(&T) -> &String,
) -> Result<Vec<u32>, CompositeError> {
    let place = |item: &T| match list.iter().position(|l| name(l) == name(item)) {
        Some(k) if list[k] == *item => Ok(k as u32),
        Some(_) => Err(CompositeError::Differs { what, name: name(item).clone() }),
        None => {
            list.push(item.clone());
            Ok(list.len() as u32 - 1)
        }
    };
    more.iter().map(place).collect()
}

/// Joins pictures, lights, finishes, trees, fog and background; what both have must be the same. Returns where each tree of
/// `more` is now.
fn join_appearance(to: &mut Appearance, more: &Appearance) -> Result<Vec<u32>, CompositeError> {
    let mut more = more.clone();
    let pictures: Vec<u32> = more.pictures.iter().map(|p| place_of(&mut to.pictures, p)).collect();
    let moved = |k: &mut usize| *k = pictures[*k] as usize;
    let textures = more.finishes.iter_mut().flat_map(|f| {
        [&mut f.colour, &mut f.bump, &mut f.reflection_map, &mut f.transparency_map].into_iter().flatten()
    });
    textures.for_each(|t| moved(&mut t.picture));
    more.trees.iter_mut().for_each(|t| moved(&mut t.picture));
    more.background.picture.iter_mut().for_each(moved);
    more.background.clouds.iter_mut().for_each(|c| moved(&mut c.picture));
    join(&mut to.lights, &more.lights, "light", |l| &l.name)?;
    join(&mut to.finishes, &more.finishes, "finish", |f| &f.material)?;
    let differs = |what, name: &str| Err(CompositeError::Differs { what, name: name.into() });
    match (&to.fog, more.fog) {
        (Some(a), Some(b)) if *a != b => return differs("the fog", "[fog]"),
        (None, Some(b)) => to.fog = Some(b),
        _ => {}
    }
    let none = Background::default();
    if to.background == none {
        to.background = more.background;
    } else if more.background != none && more.background != to.background {
        return differs("the background", "[background]");
    }
    join(&mut to.trees, &more.trees, "tree", |t| &t.name)
}

/// Where a picture is, by what it shows.
fn place_of(list: &mut Vec<Picture>, picture: &Picture) -> u32 {
    let known = list.iter().position(|p| p == picture);
    known.unwrap_or_else(|| {
        list.push(picture.clone());
        list.len() - 1
    }) as u32
}

/// Both lists of faces in order of their keys, and where each face went.
fn join_faces(out: &mut Vec<SpanFace>, a: &[SpanFace], b: Vec<SpanFace>) -> Result<[Vec<u32>; 2], CompositeError> {
    let mut order: BTreeMap<&(String, u32), (usize, usize)> = BTreeMap::new();
    for (k, f) in a.iter().enumerate() {
        order.insert(&f.key, (0, k));
    }
    for (k, f) in b.iter().enumerate() {
        if order.insert(&f.key, (1, k)).is_some() {
            return Err(CompositeError::Twice { surface: f.key.0.clone(), number: f.key.1 });
        }
    }
    let mut numbers = [vec![0; a.len()], vec![0; b.len()]];
    for (of, k) in order.values() {
        numbers[*of][*k] = out.len() as u32;
        out.push(if *of == 0 { a[*k].clone() } else { b[*k].clone() });
    }
    Ok(numbers)
}

/// Puts clusters in order of their names, so that the order of compositing leaves no trace.
fn in_order(image: &mut SpanImage) {
    let mut order: Vec<u32> = (0..image.clusters.len() as u32).collect();
    order.sort_by(|a, b| image.clusters[*a as usize].cmp(&image.clusters[*b as usize]));
    let mut place = vec![0; order.len()];
    order.iter().zip(0..).for_each(|(from, to)| place[*from as usize] = to);
    image.clusters = order.iter().map(|k| image.clusters[*k as usize].clone()).collect();
    image.faces.iter_mut().for_each(|f| f.cluster = place[f.cluster as usize]);
}
