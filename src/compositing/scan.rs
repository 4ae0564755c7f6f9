//! The scan: what is visible on every sub-scanline [NINT89 fig. 2].

use super::image::{Cluster, DepthPlane, Line, Span, SpanFace, SpanImage};
use super::merge::{Depths, front, in_front};
use super::project::{Outline, Projection};
use super::sunlit::light_up;
use super::tree::{Viewer, turned};
use crate::scene::{Appearance, Material, Stage};
use crate::view::Camera;
use rayon::prelude::*;
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};

/// Material of trees: their colour is their picture.
const TREE: &str = "(picture of a tree)";

/// Why a scan cannot be made.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ScanError {
    /// No such object.
    #[error("there is no object \"{name}\" in this state of the scene; there are: {known}")]
    Object {
        /// The name asked for.
        name: String,
        /// Those that exist.
        known: String,
    },
    /// More sub-scanlines than a file holds.
    #[error("{0} sub-scanlines per scanline: from 1 to 64 can be kept")]
    SubScanlines(u32),
}

/// What is to be scanned.
#[derive(Debug, Clone)]
pub struct ScanRequest<'a> {
    /// The scene in one state.
    pub stage: &'a Stage,
    /// Lights, fog, finishes, trees.
    pub appearance: &'a Appearance,
    /// From where.
    pub camera: &'a Camera,
    /// Sub-scanlines per scanline, n0.
    pub per_line: u32,
    /// Objects to scan as one cluster; `None` scans all, each object a cluster of its own.
    pub cluster: Option<&'a [String]>,
}

impl ScanRequest<'_> {
    /// Everything but the lines: enough to tell by the hashes of the clusters whether a scan is still good.
    pub fn outset(&self) -> Result<SpanImage, ScanError> {
        if !(1..=64).contains(&self.per_line) {
            return Err(ScanError::SubScanlines(self.per_line));
        }
        let groups = self.groups()?;
        let mut image = SpanImage {
            camera: self.camera.clone(),
            per_line: self.per_line,
            photometry: self.stage.photometry.clone(),
            materials: self.stage.materials.clone(),
            clusters: Vec::new(),
            faces: Vec::new(),
            appearance: self.appearance.clone(),
            lines: Vec::new(),
        };
        let bands = self.stage.band_count();
        image.materials.push(Material { name: TREE.into(), reflectance: vec![1.0; bands], emission: vec![0.0; bands] });
        let of_object: BTreeMap<&str, u32> =
            groups.iter().zip(0..).flat_map(|((_, objects), k)| objects.iter().map(move |o| (o.as_str(), k))).collect();
        image.faces = self.faces(&of_object, image.materials.len() as u32 - 1);
        image.faces.sort_by(|a, b| a.key.cmp(&b.key));
        let hashes: Vec<String> = (0..groups.len() as u32).map(|k| hash(&image, k)).collect();
        image.clusters =
            groups.into_iter().zip(hashes).map(|((name, objects), hash)| Cluster { name, objects, hash }).collect();
        Ok(image)
    }

    /// Names and objects of the clusters.
    fn groups(&self) -> Result<Vec<(String, Vec<String>)>, ScanError> {
        let surfaces = self.stage.facets.iter().map(|f| &self.stage.surfaces[f.surface as usize].object);
        let known: BTreeSet<&String> = surfaces.chain(self.appearance.trees.iter().map(|t| &t.object)).collect();
        let Some(asked) = self.cluster else {
            return Ok(known.into_iter().map(|o| (o.clone(), vec![o.clone()])).collect());
        };
        let asked: BTreeSet<&String> = asked.iter().collect();
        if let Some(name) = asked.iter().find(|a| !known.contains(**a)) {
            let known = known.iter().map(|k| k.as_str()).collect::<Vec<_>>().join(", ");
            return Err(ScanError::Object { name: name.to_string(), known });
        }
        let objects: Vec<String> = asked.into_iter().cloned().collect();
        Ok(vec![(objects.join("+"), objects)])
    }

    fn faces(&self, of_object: &BTreeMap<&str, u32>, tree_material: u32) -> Vec<SpanFace> {
        let mut numbers = vec![0; self.stage.surfaces.len()];
        let mut faces = Vec::new();
        for facet in &self.stage.facets {
            let surface = &self.stage.surfaces[facet.surface as usize];
            let number = numbers[facet.surface as usize];
            numbers[facet.surface as usize] += 1;
            let Some(cluster) = of_object.get(surface.object.as_str()) else { continue };
            faces.push(SpanFace {
                key: (surface.name.clone(), number),
                vertices: facet.vertices.clone(),
                material: self.stage.patches[facet.first_patch as usize].material,
                cluster: *cluster,
                two_sided: facet.first_back_patch.is_some(),
                tree: None,
            });
        }
        for (tree, k) in self.appearance.trees.iter().zip(0..) {
            let Some(cluster) = of_object.get(tree.object.as_str()) else { continue };
            faces.push(SpanFace {
                key: (format!("{TREE} {}", tree.name), k),
                vertices: turned(tree, Viewer::Point(self.camera.eye)).to_vec(),
                material: tree_material,
                cluster: *cluster,
                two_sided: true,
                tree: Some(k),
            });
        }
        faces
    }

    /// Scans.
    pub fn scan(&self) -> Result<SpanImage, ScanError> {
        self.outset().map(scanned)
    }
}

/// An image with its lines, from one that has faces only.
pub(super) fn scanned(mut image: SpanImage) -> SpanImage {
    image.lines = lines(&image);
    light_up(&mut image);
    image
}

/// SHA-256 of everything that decides what a cluster's segments are.
fn hash(image: &SpanImage, cluster: u32) -> String {
    let mut sha = Sha256::new();
    let faces: Vec<_> = image.faces.iter().filter(|f| f.cluster == cluster).collect();
    let text = serde_json::json!({
        "camera": image.camera, "per_line": image.per_line, "photometry": image.photometry,
        "materials": image.materials, "appearance": image.appearance, "faces": faces,
    });
    sha.update(text.to_string());
    image.appearance.pictures.iter().for_each(|p| sha.update(&p.rgba));
    sha.finalize().iter().map(|b| format!("{b:02x}")).collect()
}

/// Depth planes of all faces, and which faces turn their back to the eye.
pub(super) fn planes(image: &SpanImage) -> (Vec<DepthPlane>, Vec<bool>) {
    let eye = image.camera.eye;
    let back = |f: &SpanFace| f.tree.is_none() && f.normal().dot(eye - f.vertices[0]) < 0.0 && !f.two_sided;
    (image.faces.iter().map(|f| f.depth(&image.camera)).collect(), image.faces.iter().map(back).collect())
}

/// True for faces that let see what is behind them.
pub(super) fn see_through(image: &SpanImage) -> Vec<bool> {
    let clear: Vec<bool> = image
        .materials
        .iter()
        .map(|m| image.appearance.finish(&m.name).is_some_and(|f| f.transparency > 0.0 && f.refraction == 1.0))
        .collect();
    image.faces.iter().map(|f| f.tree.is_some() || clear[f.material as usize]).collect()
}

/// All sub-scanlines of an image that has only faces yet.
fn lines(image: &SpanImage) -> Vec<Line> {
    let projection = Projection::of(&image.camera);
    let (planes, backs) = planes(image);
    let open = see_through(image);
    let [width, height] = image.camera.size;
    let (last, per_line) = (image.per_line * height, f64::from(image.per_line));
    let seen = |(face, k): (&SpanFace, u32)| {
        planes[k as usize].is_seen().then(|| Outline::of(k, &face.vertices, &projection)).flatten()
    };
    let outlines: Vec<Outline> = image.faces.iter().zip(0..).filter_map(seen).collect();
    let mut of_row: Vec<Vec<u32>> = vec![Vec::new(); last as usize + 1];
    for (outline, k) in outlines.iter().zip(0..) {
        if let Some((first, end)) = outline.rows(&projection, per_line, last) {
            of_row[first as usize..=end as usize].iter_mut().for_each(|row| row.push(k));
        }
    }
    let line = |(j, active): (usize, &Vec<u32>)| {
        let y = j as f64 / per_line;
        let depths = Depths::at_row(&planes, &backs, y);
        let segment = |k: &u32| outlines[*k as usize].segment(&projection, y, f64::from(width));
        let (over, solid): (Vec<Span>, Vec<Span>) =
            active.iter().filter_map(segment).partition(|s| open[s.face as usize]);
        let mut line = Line { solid: front(&solid, &depths), over: Vec::new() };
        over.iter().for_each(|s| in_front(s, &line.solid, &depths, &mut line.over));
        line.sort_over();
        line
    };
    of_row.par_iter().enumerate().map(line).collect()
}

impl Line {
    /// Puts what can be seen through in order.
    pub(super) fn sort_over(&mut self) {
        self.over.sort_by(|a, b| a.from.total_cmp(&b.from).then(a.face.cmp(&b.face)));
    }
}
