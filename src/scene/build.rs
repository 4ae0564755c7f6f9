//! From a scene and a state to the numbered patches that stand there.

use super::contact::{Covers, Overlap, Relation, coincidences};
use super::divide::{Divider, reversed};
use super::names::Names;
use super::numbering::{FaceNumbers, Numbering};
use super::states::Standing;
use super::{Element, Face, Facet, NO_FACET, Patch, Region, Scene, SceneError, Stage};
use crate::math::{DVec3, area, unit_normal};

impl Scene {
    /// The scene after its first `state` edits: divided, numbered, with what is in contact left out.
    ///
    /// Fails where the state does not exist, nothing stands in it, or polygons overlap that face the same way.
    pub fn at(&self, state: usize) -> Result<Stage, SceneError> {
        let standing = Standing::after(self, state)?;
        let numbering = Numbering::of(self)?;
        let names = Names::of(self);
        let (facets, overlaps) = self.coinciding(&standing, &numbering, &names, state)?;
        let (mut facets, overlaps) = without_hidden(facets, overlaps);
        for overlap in overlaps.iter().filter(|o| o.relation != Relation::SameFacing) {
            facets[overlap.first as usize].twins.push(overlap.second);
            facets[overlap.second as usize].twins.push(overlap.first);
        }
        let (mut patches, mut elements) = self.absent_patches(&numbering, &names);
        self.mark_standing(&standing, &numbering, &names, &mut patches);
        let covers = Covers::of(&facets, &overlaps);
        for (index, facet) in facets.iter().enumerate() {
            place_facet(facet, index as u32, &covers, &mut patches, &mut elements);
        }
        Ok(Stage {
            name: self.name.clone(),
            state,
            photometry: self.photometry.clone(),
            enclosure: self.enclosure,
            materials: standing.materials,
            surfaces: names.list,
            cameras: self.cameras.clone(),
            lights: self.lights.clone(),
            receivers: self.receivers.clone(),
            facets,
            patches,
            elements,
        })
    }

    /// The facets of a state and how they coincide.
    pub(super) fn coincidences(&self, state: usize) -> Result<(Vec<Facet>, Vec<Overlap>), SceneError> {
        self.coinciding(&Standing::after(self, state)?, &Numbering::of(self)?, &Names::of(self), state)
    }

    fn coinciding(
        &self,
        standing: &Standing,
        numbering: &Numbering,
        names: &Names,
        state: usize,
    ) -> Result<(Vec<Facet>, Vec<Overlap>), SceneError> {
        let facets = self.facets(standing, numbering, names);
        let overlaps = coincidences(&facets, &self.object_numbers(names));
        self.refuse_overlaps(&facets, &overlaps, names, state)?;
        Ok((facets, overlaps))
    }

    /// Number of the object that each name of a surface belongs to.
    fn object_numbers(&self, names: &Names) -> Vec<u32> {
        let objects = self.objects();
        let number = |name: &str| objects.binary_search(&name).unwrap_or_default() as u32;
        names.list.iter().map(|s| number(&s.object)).collect()
    }

    /// The polygons that stand there, in order of surface and face.
    fn facets(&self, standing: &Standing, numbering: &Numbering, names: &Names) -> Vec<Facet> {
        let mut facets = Vec::new();
        for (index, surface) in self.surfaces.iter().enumerate().filter(|(i, _)| standing.stands[*i]) {
            for (face, (corners, numbers)) in
                surface.faces.iter().zip(standing.corners[index].iter().zip(&numbering.faces[index]))
            {
                facets.push(Facet {
                    vertices: corners.clone(),
                    normal: unit_normal(corners),
                    surface: names.of_face(index, face),
                    grid: face.patches,
                    elements: face.elements,
                    first_patch: numbers.first,
                    first_back_patch: numbers.first_back,
                    twins: Vec::new(),
                });
            }
        }
        facets
    }

    /// All patches and elements as if no object were there.
    fn absent_patches(&self, numbering: &Numbering, names: &Names) -> (Vec<Patch>, Vec<Element>) {
        let mut patches = vec![nothing(); numbering.patch_count()];
        let mut elements = vec![no_element(); numbering.element_count()];
        // Heirs come last and change nothing here: a number is named after the surface that had it first.
        for (index, surface) in self.surfaces.iter().enumerate() {
            for (face, numbers) in surface.faces.iter().zip(&numbering.faces[index]) {
                for (number, k) in numbers_of(face, *numbers) {
                    let patch = &mut patches[number as usize];
                    if !patch.elements.is_empty() {
                        continue;
                    }
                    (patch.surface, patch.material) = (names.of_face(index, face), face.material);
                    (patch.a, patch.b) = face.patches.place(k);
                    patch.elements = numbering.elements_of(number);
                    for (k, e) in patch.elements.clone().enumerate() {
                        let (a, b) = face.elements.place(k);
                        elements[e as usize] = Element { patch: number, a, b, ..no_element() };
                    }
                }
            }
        }
        (patches, elements)
    }

    /// Names and materials of the surfaces that stand there, which may have taken over numbers of others.
    fn mark_standing(&self, standing: &Standing, numbering: &Numbering, names: &Names, patches: &mut [Patch]) {
        for (index, surface) in self.surfaces.iter().enumerate().filter(|(i, _)| standing.stands[*i]) {
            for (face, numbers) in surface.faces.iter().zip(&numbering.faces[index]) {
                for (number, _) in numbers_of(face, *numbers) {
                    let patch = &mut patches[number as usize];
                    (patch.surface, patch.material) = (names.of_face(index, face), face.material);
                }
            }
        }
    }

    /// Polygons of the file itself must not overlap facing the same way.
    fn refuse_overlaps(
        &self,
        facets: &[Facet],
        overlaps: &[Overlap],
        names: &Names,
        state: usize,
    ) -> Result<(), SceneError> {
        let surface = |facet: u32| names.owner(facets[facet as usize].surface);
        let written = |facet: u32| !self.surfaces[surface(facet) as usize].from_mesh;
        let refused = |o: &&Overlap| o.radiates_twice(facets) && written(o.first) && written(o.second);
        let Some(o) = overlaps.iter().find(refused) else { return Ok(()) };
        let name = |facet| self.surfaces[surface(facet) as usize].name.clone();
        Err(SceneError::SameFacing {
            first_index: surface(o.first),
            second_index: surface(o.second),
            first: name(o.first),
            second: name(o.second),
            area: area(&o.polygon),
            state,
        })
    }
}

/// Patch numbers of a face with their places in its grid: fronts, then backs.
fn numbers_of(face: &Face, numbers: FaceNumbers) -> impl Iterator<Item = (u32, usize)> {
    let n = face.patches.count();
    let run = move |first: u32| (0..n).map(move |k| (first + k as u32, k));
    run(numbers.first).chain(numbers.first_back.into_iter().flat_map(run))
}

/// Fills in the patches of one facet, front and back, and their elements.
fn place_facet(facet: &Facet, index: u32, covers: &Covers, patches: &mut [Patch], elements: &mut [Element]) {
    let cells = Divider::new(&facet.vertices, facet.grid);
    for k in 0..facet.grid.count() {
        let (a, b) = facet.grid.place(k);
        let corners = cells.corners(a, b);
        for back in [false, true] {
            let first = if back { facet.first_back_patch } else { Some(facet.first_patch) };
            let Some(first) = first else { continue };
            let patch = &mut patches[first as usize + k];
            patch.facet = index;
            (patch.a, patch.b) = (a, b);
            patch.normal = if back { -facet.normal } else { facet.normal };
            patch.corners = if back { reversed(corners.clone()) } else { corners.clone() };
            patch.region = covers.uncovered(index, back, &patch.corners);
            patch.area = patch.region.area();
            let range = patch.elements.start as usize..patch.elements.end as usize;
            let elements = &mut elements[range];
            place_elements(facet, (index, back), &corners, covers, elements);
            if !patch.is_present() {
                elements.iter_mut().for_each(|e| (e.area, e.region) = (0.0, Region::default()));
            }
        }
    }
}

fn place_elements(facet: &Facet, side: (u32, bool), patch: &[DVec3], covers: &Covers, elements: &mut [Element]) {
    let cells = Divider::new(patch, facet.elements);
    for (k, element) in elements.iter_mut().enumerate() {
        (element.a, element.b) = facet.elements.place(k);
        let corners = cells.corners(element.a, element.b);
        element.corners = if side.1 { reversed(corners) } else { corners };
        element.region = covers.uncovered(side.0, side.1, &element.corners);
        element.area = element.region.area();
    }
}

/// Takes out facets that lie wholly under earlier ones facing the same way: rays would meet either of them.
fn without_hidden(facets: Vec<Facet>, overlaps: Vec<Overlap>) -> (Vec<Facet>, Vec<Overlap>) {
    let (same, others): (Vec<Overlap>, Vec<Overlap>) =
        overlaps.into_iter().partition(|o| o.relation == Relation::SameFacing);
    if same.is_empty() {
        return (facets, others);
    }
    let covers = Covers::of(&facets, &same);
    let hidden: Vec<bool> = (0..facets.len() as u32).map(|i| covers.hides(&facets, i)).collect();
    let mut next = 0;
    let renumbered: Vec<Option<u32>> = hidden
        .iter()
        .map(|hidden| {
            (!hidden).then(|| {
                next += 1;
                next - 1
            })
        })
        .collect();
    let place = |i: u32| renumbered[i as usize];
    let kept = same
        .into_iter()
        .chain(others)
        .filter_map(|o| Some(Overlap { first: place(o.first)?, second: place(o.second)?, ..o }));
    let kept = kept.collect();
    let facets = facets.into_iter().zip(hidden).filter(|(_, hidden)| !hidden).map(|(f, _)| f).collect();
    (facets, kept)
}

fn nothing() -> Patch {
    Patch {
        surface: 0,
        material: 0,
        facet: NO_FACET,
        a: 0,
        b: 0,
        corners: Vec::new(),
        normal: DVec3::ZERO,
        area: 0.0,
        region: Region::default(),
        elements: 0..0,
    }
}

fn no_element() -> Element {
    Element { patch: 0, a: 0, b: 0, corners: Vec::new(), area: 0.0, region: Region::default() }
}
