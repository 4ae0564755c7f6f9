//! From the elements of a scene to surfaces, materials, lights and cameras.

use super::bsdf::Bsdf;
use super::emitter::point;
use super::sensor::camera;
use super::shape::{Geometry, Shape, shape};
use super::tree::{Id, Tree, shown};
use crate::io::scene::check::{Check, Checked, LARGEST};
use crate::io::scene::error::Refusal;
use crate::io::scene::folder::Folder;
use crate::io::scene::mesh::{self, Fallback, Gathered, MeshFile, MeshSpec};
use crate::io::scene::pieces::{Cut, Palette, SurfaceNames, cut};
use crate::io::scene::polygon::Division;
use crate::math::DVec3;
use crate::scene::{Face, MAX_PATCHES, PointLight, Surface};
use crate::view::{Camera, Photometry};
use std::collections::BTreeMap;
use std::path::Path;
use toml::Spanned;

/// Corners of a face in the space of its shape, and its group.
type Outline = (Vec<DVec3>, Option<u32>);

/// What a file is read into.
#[derive(Default)]
pub(super) struct Parts {
    pub palette: Palette,
    pub surfaces: Vec<Surface>,
    pub lights: Vec<PointLight>,
    pub cameras: Vec<Camera>,
    pub notices: Vec<String>,
}

/// What the scene holds that says nothing about diffuse light, by tag.
const HARMLESS: [&str; 9] =
    ["integrator", "sampler", "film", "rfilter", "bsdf", "texture", "string", "integer", "boolean"];

struct Gatherer<'a> {
    tree: &'a Tree,
    folder: &'a Folder,
    division: Division<'a>,
    parts: Parts,
    names: SurfaceNames,
    faces: u64,
    tally: Tally,
}

/// What was mended or left out: how often, and where first.
#[derive(Default)]
struct Tally(BTreeMap<&'static str, (usize, String)>);

impl Tally {
    fn count(&mut self, what: &'static str, place: impl FnOnce() -> String) {
        self.0.entry(what).or_insert_with(|| (0, place())).0 += 1;
    }
}

/// Reads all shapes, emitters and sensors, in file order.
pub(super) fn gather(tree: &Tree, folder: &Folder, division: Division) -> Checked<Parts> {
    let mut gatherer = Gatherer {
        tree,
        folder,
        division,
        parts: Parts::default(),
        names: SurfaceNames::default(),
        faces: 0,
        tally: Tally::default(),
    };
    for at in &tree.top {
        gatherer.top(*at)?;
    }
    if gatherer.parts.surfaces.is_empty() {
        let check = Check { source: &tree.sources[0] };
        let mend = "add a <shape type=\"rectangle\"> (or cube, obj, ply)";
        return check.refuse(Refusal::Empty, 0..0, "the scene has no shape with an area", mend);
    }
    gatherer.tell();
    Ok(gatherer.parts)
}

impl Gatherer<'_> {
    fn top(&mut self, at: Id) -> Checked<()> {
        let tree = self.tree;
        match tree.tag(at) {
            "shape" => self.surface(at),
            "emitter" if tree.attribute(at, "type") == Some("area") => Ok(()),
            "emitter" => self.light(at),
            "sensor" => {
                self.sensor(at);
                Ok(())
            }
            "path" => {
                let mend = "take it out: files lie beside or below the scene";
                tree.refuse(at, Refusal::Path, "search paths (<path>) are not read", mend)
            }
            "integrator" => {
                self.tally.count("integrators are left out", || tree.place(at));
                Ok(())
            }
            tag if HARMLESS.contains(&tag) || matches!(tag, "float" | "rgb" | "spectrum" | "point" | "transform") => {
                Ok(())
            }
            tag => {
                let message = format!("<{}> is not read", shown(tag));
                let mend = "scenes hold shapes, bsdfs, emitters, sensors, defaults and includes: take it out";
                tree.refuse(at, Refusal::Reserved, message, mend)
            }
        }
    }

    fn sensor(&mut self, at: Id) {
        let name = self.tree.attribute(at, "id").unwrap_or("sensor");
        let taken = self.parts.cameras.iter().any(|c| c.name == name);
        let number = self.parts.cameras.len() + 1;
        let name = if taken { format!("{name}#{number}") } else { name.to_string() };
        match camera(self.tree, at, shown(&name)) {
            Ok(camera) => self.parts.cameras.push(camera),
            Err(why) => {
                self.parts.notices.push(format!("{}: the sensor is left out: {why}", self.tree.place(at)));
            }
        }
    }

    fn light(&mut self, at: Id) -> Checked<()> {
        let name = shown(self.tree.attribute(at, "id").unwrap_or("point"));
        let taken = self.parts.lights.iter().any(|l| l.name == name);
        let name = if taken { format!("{name}#{}", self.parts.lights.len() + 1) } else { name };
        let (light, raised) = point(self.tree, at, name)?;
        self.parts.lights.push(light);
        if raised {
            self.raised(at);
        }
        Ok(())
    }

    fn raised(&mut self, at: Id) {
        let place = || self.tree.place(at);
        self.tally.count("spectra outside of Rec. 709 have bands below zero, which are taken as 0", place);
    }

    fn surface(&mut self, at: Id) -> Checked<()> {
        let tree = self.tree;
        let shape = shape(tree, at)?;
        let wanted = self.wanted_name(at, &shape);
        let name = self.names.give(&wanted, self.parts.surfaces.len() + 1);
        if shape.bsdf.raised || shape.area.as_ref().is_some_and(|a| a.raised) {
            self.raised(at);
        }
        if shape.bare && shape.area.is_none() {
            self.tally.count("shapes without a BSDF are grey, reflectance 0.5, as in Mitsuba", || tree.place(at));
        }
        let (front, back) = self.materials_of(&shape);
        let (outlines, groups) = self.outlines(at, &shape, &name, front)?;
        // Rectangles and cubes keep their front under mirror images; meshes follow the winding, as their normals do.
        let mirrored = shape.to_world.mirrors();
        let turn = shape.flipped != (mirrored && matches!(shape.geometry, Geometry::Outlines(_)));
        if mirrored && matches!(shape.geometry, Geometry::Mesh(_)) {
            let what = "meshes are mirrored by to_world: their front follows the winding of the mirrored corners";
            self.tally.count(what, || tree.place(at));
        }
        let mut faces: Vec<Face> = Vec::new();
        for (outline, group) in outlines {
            let mut corners: Vec<DVec3> = outline.into_iter().map(|p| shape.to_world.point(p)).collect();
            if turn {
                corners.reverse();
            }
            for vertices in self.cut(at, corners)? {
                let (patches, elements) = self.division.of(tree.check(at), &vertices)?;
                let two_sided = shape.bsdf.two_sided && back == Some(front);
                faces.push(Face { vertices, material: front, patches, elements, two_sided, group });
            }
        }
        // A lamp shines from its front alone, so its back is a face of its own.
        if let Some(back) = back.filter(|b| *b != front) {
            let turned =
                |f: &Face| Face { material: back, vertices: f.vertices.iter().rev().copied().collect(), ..f.clone() };
            let backs: Vec<Face> = faces.iter().map(turned).collect();
            faces.extend(backs);
        }
        self.faces += faces.len() as u64;
        if self.faces > MAX_PATCHES {
            let message = format!("the scene has more faces than the {MAX_PATCHES} patches that fit");
            return tree.refuse(at, Refusal::Counts, message, "use coarser meshes");
        }
        if !faces.is_empty() {
            self.parts.surfaces.push(Surface { name, object: "scene".into(), faces, groups, from_mesh: true });
        }
        Ok(())
    }

    /// The id of a shape, else the name of its mesh, else its type.
    fn wanted_name(&self, at: Id, shape: &Shape) -> String {
        let file = match &shape.geometry {
            Geometry::Mesh(file) => self.tree.attribute(*file, "value"),
            Geometry::Outlines(_) => None,
        };
        let stem = file.and_then(|f| Path::new(f).file_stem()).map(|s| s.to_string_lossy().into_owned());
        self.tree.attribute(at, "id").map(String::from).or(stem).unwrap_or_else(|| self.tree.title(at).into())
    }

    /// Materials of the front and, where it reflects, of the back.
    fn materials_of(&mut self, shape: &Shape) -> (u32, Option<u32>) {
        let Bsdf { name, reflectance, two_sided, .. } = &shape.bsdf;
        let Some(area) = &shape.area else {
            let both = self.parts.palette.number(name, *reflectance, [0.0; 3]);
            return (both, two_sided.then_some(both));
        };
        let front = self.parts.palette.number(&format!("{name}, emitting"), *reflectance, area.emission);
        (front, two_sided.then(|| self.parts.palette.number(name, *reflectance, [0.0; 3])))
    }

    /// Outlines of a shape in its own space with their groups, and the names of these.
    fn outlines(&mut self, at: Id, shape: &Shape, name: &str, material: u32) -> Checked<(Vec<Outline>, Vec<String>)> {
        let file = match &shape.geometry {
            Geometry::Outlines(own) => return Ok((own.iter().map(|o| (o.clone(), None)).collect(), Vec::new())),
            Geometry::Mesh(file) => *file,
        };
        let (tree, check) = (self.tree, self.tree.check(file));
        let value = tree.needed(file, "value")?;
        let kind = tree.kind(at)?;
        if !Path::new(value).extension().is_some_and(|e| e.eq_ignore_ascii_case(kind)) {
            let message = format!("\"{}\" has not the ending .{kind} of its shape", shown(value));
            return tree.refuse(file, Refusal::Format, message, "correct the type or the name");
        }
        let named = Spanned::new(tree.elements[file].span.clone(), value.to_string());
        let spec = MeshSpec {
            surface: name,
            file: MeshFile::named(check, self.folder, &named)?,
            scale: 1.0,
            y_up: Some(false),
            two_sided: Some(false),
            material: Some(material),
            fallback: Fallback::Grey,
            // Divided after it is placed: lengths are those of the world.
            division: Division { max_edge: None, ..self.division },
        };
        let rgb = Photometry::rec709();
        let Parts { palette, notices, .. } = &mut self.parts;
        let materials = &mut palette.materials;
        let mut gathered = Gathered { materials, notices, bands: &rgb.bands, rgb: true };
        let (faces, groups) = mesh::faces(check, self.folder, &spec, &mut gathered)?;
        Ok((faces.into_iter().map(|f| (f.vertices, f.group)).collect(), groups))
    }

    /// Polygons in the world that are fit for a scene.
    fn cut(&mut self, at: Id, corners: Vec<DVec3>) -> Checked<Vec<Vec<DVec3>>> {
        let tree = self.tree;
        if corners.iter().any(|p| !(p.is_finite() && p.abs().max_element() <= LARGEST)) {
            let message = format!("a corner of the shape lies beyond {LARGEST:e} m");
            return tree.refuse(at, Refusal::Number, message, "coordinates are taken as metres; check to_world");
        }
        match cut(corners) {
            Cut::Whole(corners) => Ok(vec![corners]),
            Cut::Split(triangles) => {
                self.tally.count("faces that are not planar were split into triangles", || tree.place(at));
                Ok(triangles)
            }
            Cut::NoArea => {
                self.tally.count("faces without area are left out", || tree.place(at));
                Ok(Vec::new())
            }
            Cut::Hopeless(why) => {
                let message = format!("a face of the shape {why}");
                tree.refuse(at, Refusal::Geometry, message, "split it into triangles")
            }
        }
    }

    /// Leaves notices about what was mended or left out.
    fn tell(&mut self) {
        if self.names.renamed > 0 {
            let (file, count) = (&self.tree.sources[0].name, self.names.renamed);
            let what = format!("{file}: {count} surfaces share their names with others: \"#NUMBER\" is added");
            self.parts.notices.push(what);
        }
        for (what, (count, place)) in &self.tally.0 {
            self.parts.notices.push(format!("{place}: {what} ({count} in all)"));
        }
    }
}
