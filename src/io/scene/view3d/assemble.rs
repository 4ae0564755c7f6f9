//! From View3D surfaces to those of a scene: subsurfaces cut out of their bases, combined ones put together.

use super::parse::{Entry, File, Kind};
use crate::io::scene::check::{Check, Checked};
use crate::io::scene::error::Refusal;
use crate::io::scene::mesh::ears;
use crate::io::scene::polygon::{Division, Flaw, flaw};
use crate::math::{DVec3, area, diameter, intersect_convex, subtract_convex, unit_normal};
use crate::scene::{Face, MAX_PATCHES, Material, OBSTRUCTIONS, Surface};
use std::collections::HashSet;

/// Materials and surfaces of a scene.
#[derive(Default)]
pub(super) struct Parts {
    pub materials: Vec<Material>,
    pub surfaces: Vec<Surface>,
    pub notices: Vec<String>,
}

struct Assembly<'a> {
    check: Check<'a>,
    entries: &'a [Entry],
    /// Convex planar pieces of each entry, as written.
    outlines: Vec<Vec<Vec<DVec3>>>,
}

/// Surfaces in file order; combined ones are faces of the surface they are combined with, null surfaces are gone.
pub(super) fn assemble(check: Check, file: &File, division: &Division) -> Checked<Parts> {
    let mut parts = Parts::default();
    let outlines = outlines(check, &file.entries, &mut parts.notices)?;
    let assembly = Assembly { check, entries: &file.entries, outlines };
    for (index, entry) in file.entries.iter().enumerate() {
        assembly.check_links(index, entry)?;
    }
    let mut names = HashSet::new();
    let mut renamed = None;
    for (index, entry) in file.entries.iter().enumerate() {
        if entry.kind == Kind::Null || entry.combine > 0 {
            continue;
        }
        let mut faces = Vec::new();
        for (part, own) in file.entries.iter().enumerate().filter(|(k, e)| *k == index || e.combine == index + 1) {
            let material = material(&mut parts.materials, own);
            for vertices in assembly.without_subsurfaces(part)? {
                let (patches, elements) = division.of(check, &vertices)?;
                let two_sided = own.kind == Kind::Obstruction;
                faces.push(Face { vertices, material, patches, elements, two_sided, group: None });
            }
        }
        if faces.is_empty() {
            continue;
        }
        let mut name = entry.name.clone();
        if !names.insert(name.clone()) {
            name = format!("{}#{}", entry.name, index + 1);
            names.insert(name.clone());
            let (count, first) = renamed.unwrap_or((0, index));
            renamed = Some((count + 1, first));
        }
        let object = if entry.kind == Kind::Obstruction { OBSTRUCTIONS } else { "scene" };
        parts.surfaces.push(Surface { name, object: object.into(), faces, groups: Vec::new(), from_mesh: true });
    }
    if parts.surfaces.iter().map(|s| s.faces.len() as u64).sum::<u64>() > MAX_PATCHES {
        let message = format!("the file has more surfaces than the {MAX_PATCHES} patches that fit");
        return check.refuse(Refusal::Counts, 0..0, message, "use fewer surfaces");
    }
    if let Some((count, first)) = renamed {
        let place = check.source.at(&file.entries[first].span);
        parts.notices.push(format!("{place}: {count} surfaces share their names with others: \"#NUMBER\" is added"));
    }
    Ok(parts)
}

/// Every entry as convex planar polygons: itself, or triangles.
fn outlines(check: Check, entries: &[Entry], notices: &mut Vec<String>) -> Checked<Vec<Vec<Vec<DVec3>>>> {
    let mut outlines = Vec::with_capacity(entries.len());
    let mut split: Option<(usize, usize)> = None;
    for (index, entry) in entries.iter().enumerate() {
        let refuse = |message: &str, mend: &str| {
            let message = format!("surface {} ({}): {message}", index + 1, entry.name);
            check.refuse(Refusal::Geometry, entry.span.clone(), message, mend)
        };
        outlines.push(match flaw(&entry.corners) {
            None => vec![entry.corners.clone()],
            Some(Flaw::NoArea) => return refuse("it has no area", "check its vertices"),
            Some(_) => {
                let (count, first) = split.unwrap_or((0, index));
                split = Some((count + 1, first));
                match ears(&entry.corners) {
                    Some(triangles) => {
                        let sound = triangles.into_iter().map(|t| t.to_vec()).filter(|t| flaw(t).is_none());
                        sound.collect()
                    }
                    None => return refuse("it crosses itself", "give the vertices in order around the surface"),
                }
            }
        });
    }
    if let Some((count, first)) = split {
        let place = check.source.at(&entries[first].span);
        notices.push(format!("{place}: {count} surfaces that are not planar or not convex were split into triangles"));
    }
    Ok(outlines)
}

impl Assembly<'_> {
    fn refuse<T>(&self, index: usize, message: &str, mend: &str) -> Checked<T> {
        let entry = &self.entries[index];
        let message = format!("surface {} ({}): {message}", index + 1, entry.name);
        self.check.refuse(Refusal::Geometry, entry.span.clone(), message, mend)
    }

    /// View3D's rules for base and combination numbers.
    fn check_links(&self, index: usize, entry: &Entry) -> Checked<()> {
        let number = index + 1;
        if entry.combine > 0 {
            let lead = self.entries.get(entry.combine - 1);
            let sound = entry.combine < number && entry.kind == Kind::Radiating;
            if !sound || lead.is_none_or(|l| l.kind != Kind::Radiating || l.combine > 0) {
                let message = format!("it cannot be combined with surface {}", entry.combine);
                let mend = "combine with an earlier S surface that is not combined itself";
                return self.refuse(index, &message, mend);
            }
        }
        if entry.base == 0 {
            return match entry.kind {
                Kind::Null => self.refuse(index, "a null surface (N) needs a base", "give the surface it lies in"),
                _ => Ok(()),
            };
        }
        let base = self.entries.get(entry.base - 1);
        let earlier = entry.base < number || base.is_some_and(|b| b.kind == Kind::Obstruction);
        if base.is_none_or(|b| b.kind == Kind::Null) || !earlier {
            let message = format!("its base cannot be surface {}", entry.base);
            return self.refuse(index, &message, "name an earlier S surface, or an obstruction");
        }
        self.check_within(index, entry)
    }

    /// A subsurface lies in its base and faces the same way; a null surface faces the base.
    fn check_within(&self, index: usize, entry: &Entry) -> Checked<()> {
        let base = &self.entries[entry.base - 1].corners;
        let (normal, middle) = (unit_normal(base), base[0]);
        let off = entry.corners.iter().map(|c| (*c - middle).dot(normal).abs()).fold(0.0, f64::max);
        if off > 1e-5 * diameter(base) {
            let message = format!("it lies up to {off:.3e} m off the plane of its base, surface {}", entry.base);
            return self.refuse(index, &message, "move its vertices into the plane, or set the base to 0");
        }
        let along = unit_normal(&entry.corners).dot(normal);
        if entry.kind == Kind::Null && along > 0.0 || entry.kind == Kind::Radiating && along < 0.0 {
            let way = if entry.kind == Kind::Null { "the same way as" } else { "the other way than" };
            let message = format!("it faces {way} its base, surface {}", entry.base);
            return self.refuse(index, &message, "turn the order of its vertices around");
        }
        let common: f64 = self.pairs(index, entry.base - 1).map(|(a, b)| area(&intersect_convex(&a, b))).sum();
        let own: f64 = self.outlines[index].iter().map(|p| area(p)).sum();
        if common < (1.0 - 1e-6) * own {
            let message = format!("only {common:.6} of its {own:.6} m2 lie within its base, surface {}", entry.base);
            return self.refuse(index, &message, "keep it within the base, or set the base to 0");
        }
        Ok(())
    }

    /// Pieces of a subsurface, wound like its base, with those of the base.
    fn pairs(&self, index: usize, base: usize) -> impl Iterator<Item = (Vec<DVec3>, &Vec<DVec3>)> {
        self.wound_like(index, base)
            .into_iter()
            .flat_map(move |a| self.outlines[base].iter().map(move |b| (a.clone(), b)))
    }

    fn wound_like(&self, index: usize, base: usize) -> Vec<Vec<DVec3>> {
        let normal = unit_normal(&self.entries[base].corners);
        let turned = |p: &Vec<DVec3>| match unit_normal(p).dot(normal) < 0.0 {
            true => p.iter().rev().copied().collect(),
            false => p.clone(),
        };
        self.outlines[index].iter().map(turned).collect()
    }

    /// What is left of a surface beside its subsurfaces.
    fn without_subsurfaces(&self, index: usize) -> Checked<Vec<Vec<DVec3>>> {
        let mut left = self.outlines[index].clone();
        for (child, _) in self.entries.iter().enumerate().filter(|(_, e)| e.base == index + 1) {
            for hole in self.wound_like(child, index) {
                left = left.iter().flat_map(|piece| subtract_convex(piece, &hole)).collect();
            }
        }
        if left.is_empty() && self.entries[index].kind == Kind::Radiating {
            return self.refuse(index, "its subsurfaces leave nothing of it", "leave it out, or make them smaller");
        }
        Ok(left)
    }
}

/// One material per emittance; what only blocks is black.
fn material(list: &mut Vec<Material>, entry: &Entry) -> u32 {
    let name = match entry.kind {
        Kind::Obstruction => "obstruction".to_string(),
        _ => format!("emittance {}", entry.emittance),
    };
    let known = list.iter().position(|m| m.name == name);
    known.unwrap_or_else(|| {
        list.push(Material { name, reflectance: vec![1.0 - entry.emittance], emission: vec![0.0] });
        list.len() - 1
    }) as u32
}
