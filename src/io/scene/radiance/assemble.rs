//! From primitives to surfaces and materials.

use super::material::{Meaning, Modifiers};
use super::parse::{Primitive, shown};
use crate::io::scene::check::{Check, Checked};
use crate::io::scene::error::Refusal;
use crate::io::scene::pieces::{Cut, Palette, SurfaceNames, cut};
use crate::io::scene::polygon::Division;
use crate::math::DVec3;
use crate::scene::{Face, MAX_PATCHES, Surface};
use std::collections::BTreeMap;
use std::ops::Range;

/// What a file is read into.
#[derive(Default)]
pub(super) struct Parts {
    pub palette: Palette,
    pub surfaces: Vec<Surface>,
    pub notices: Vec<String>,
}

struct Assembly<'a> {
    check: Check<'a>,
    division: Division<'a>,
    modifiers: Modifiers,
    parts: Parts,
    names: SurfaceNames,
    faces: u64,
    /// What was mended or left out: how often, and where first.
    tally: BTreeMap<String, (usize, Range<usize>)>,
    two_sided: usize,
}

/// Polygons in file order, each a surface: those of plastic radiate from both sides, those of light from the front.
pub(super) fn assemble(check: Check, primitives: &[Primitive], division: Division) -> Checked<Parts> {
    let mut assembly = Assembly {
        check,
        division,
        modifiers: Modifiers::default(),
        parts: Parts::default(),
        names: SurfaceNames::default(),
        faces: 0,
        tally: BTreeMap::new(),
        two_sided: 0,
    };
    for primitive in primitives {
        match primitive.is_surface() {
            true => assembly.surface(primitive)?,
            false => assembly.modifiers.define(check, primitive)?,
        }
    }
    if assembly.parts.surfaces.is_empty() {
        let mend = "add polygons of plastic or light; octrees and pictures are not scenes";
        return check.refuse(Refusal::Empty, 0..0, "the file has no polygon that can be used", mend);
    }
    assembly.tell();
    Ok(assembly.parts)
}

impl Assembly<'_> {
    fn count(&mut self, what: String, primitive: &Primitive) {
        self.tally.entry(what).or_insert_with(|| (0, primitive.span.clone())).0 += 1;
    }

    fn surface(&mut self, primitive: &Primitive) -> Checked<()> {
        let meaning = self.modifiers.of(self.check, primitive)?;
        let kind = &primitive.kind;
        let (material, two_sided) = match meaning {
            _ if kind != "polygon" => {
                self.count(format!("surfaces of type {kind} are left out: only polygons are read"), primitive);
                return Ok(());
            }
            None => {
                self.count("polygons of void are left out: nothing is seen of them".into(), primitive);
                return Ok(());
            }
            Some(Meaning::Other { kind }) => {
                let what = format!("polygons of {kind} are left out: only plastic and light are diffuse here");
                self.count(what, primitive);
                return Ok(());
            }
            Some(Meaning::Diffuse { reflectance, specularity, pattern }) => {
                let name = shown(&primitive.modifier);
                if specularity > 0.0 {
                    let what = format!("the plastic \"{name}\" mirrors a share of {specularity}, which is left out");
                    self.count(what, primitive);
                }
                if let Some(pattern) = pattern {
                    let what = format!("the plastic \"{name}\" is even here: \"{}\" is left out", shown(&pattern));
                    self.count(what, primitive);
                }
                (self.parts.palette.number(&primitive.modifier, reflectance, [0.0; 3]), true)
            }
            Some(Meaning::Light { emission }) => {
                (self.parts.palette.number(&primitive.modifier, [0.0; 3], emission), false)
            }
        };
        self.two_sided += usize::from(two_sided);
        let mut faces = Vec::new();
        for vertices in self.outlines(primitive)? {
            let (patches, elements) = self.division.of(self.check, &vertices)?;
            faces.push(Face { vertices, material, patches, elements, two_sided, group: None });
        }
        self.faces += faces.len() as u64;
        if self.faces > MAX_PATCHES {
            let message = format!("the file has more faces than the {MAX_PATCHES} patches that fit");
            return self.check.refuse(Refusal::Counts, primitive.span.clone(), message, "use fewer polygons");
        }
        if !faces.is_empty() {
            let name = self.names.give(&primitive.name, self.parts.surfaces.len() + 1);
            let object = "scene".into();
            self.parts.surfaces.push(Surface { name, object, faces, groups: Vec::new(), from_mesh: true });
        }
        Ok(())
    }

    /// The polygon as convex pieces; corners written twice in a row are one.
    fn outlines(&mut self, primitive: &Primitive) -> Checked<Vec<Vec<DVec3>>> {
        let name = shown(&primitive.name);
        let reals = &primitive.reals;
        if reals.len() < 9 || !reals.len().is_multiple_of(3) {
            let message = format!("the polygon \"{name}\" has {} numbers", reals.len());
            let mend = "give x y z of three or more corners, and their count";
            return self.check.refuse(Refusal::Number, primitive.span.clone(), message, mend);
        }
        let mut corners: Vec<DVec3> = reals.chunks_exact(3).map(DVec3::from_slice).collect();
        corners.dedup();
        if corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        match cut(corners) {
            Cut::Whole(corners) => Ok(vec![corners]),
            Cut::Split(triangles) => {
                let what = "polygons that are not planar or not convex were split into triangles";
                self.count(what.into(), primitive);
                Ok(triangles)
            }
            Cut::NoArea => {
                self.count("polygons without area are left out".into(), primitive);
                Ok(Vec::new())
            }
            Cut::Hopeless(why) => {
                let message = format!("the polygon \"{name}\" {why}");
                let mend = "give its corners in order around it, or split it into triangles";
                self.check.refuse(Refusal::Geometry, primitive.span.clone(), message, mend)
            }
        }
    }

    /// Leaves notices about what was decided, mended or left out.
    fn tell(&mut self) {
        let file = &self.check.source.name;
        if self.two_sided > 0 {
            let count = self.two_sided;
            self.parts.notices.push(format!(
                "{file}: the {count} polygons of plastic radiate from both sides, as in Radiance: the patches of a back \
                 come after those of its front"
            ));
        }
        if self.names.renamed > 0 {
            let count = self.names.renamed;
            self.parts
                .notices
                .push(format!("{file}: {count} polygons share their names with others: \"#NUMBER\" is added"));
        }
        for (what, (count, span)) in &self.tally {
            let place = self.check.source.at(span);
            self.parts.notices.push(format!("{place}: {what} ({count} in all)"));
        }
    }
}
