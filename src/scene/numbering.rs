//! Patch and element numbers: the same in every state.

use super::{Edit, Face, Scene, SceneError};
use std::ops::Range;

/// Most patches a scene may have: at some 700 bytes each they fill about 1.5 GB.
pub const MAX_PATCHES: u64 = 1 << 21;
/// Most elements a scene may have.
pub const MAX_ELEMENTS: u64 = 1 << 22;

/// First numbers of one face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FaceNumbers {
    pub first: u32,
    pub first_back: Option<u32>,
}

/// Which numbers each face has.
pub(super) struct Numbering {
    /// Per surface and face.
    pub faces: Vec<Vec<FaceNumbers>>,
    /// Element numbers of patch i: `elements[i] .. elements[i + 1]`.
    elements: Vec<u32>,
}

impl Numbering {
    /// Numbers the surfaces in order; those that take over an object's numbers get these.
    pub(super) fn of(scene: &Scene) -> Result<Self, SceneError> {
        scene.check_size()?;
        let taken_over = heirs(scene);
        let mut next = 0;
        let mut per_patch: Vec<u32> = Vec::new();
        let mut faces = Vec::with_capacity(scene.surfaces.len());
        for (index, surface) in scene.surfaces.iter().enumerate() {
            if taken_over.iter().any(|(by, _)| *by == index) {
                faces.push(Vec::new());
                continue;
            }
            let (numbers, end) = in_order(&surface.faces, next);
            per_patch.extend(surface.faces.iter().flat_map(counts));
            per_patch.extend(surface.faces.iter().filter(|f| f.two_sided).flat_map(counts));
            faces.push(numbers);
            next = end;
        }
        for (by, old) in taken_over {
            faces[by] = inherit(&scene.surfaces[by].faces, &patch_numbers(scene, &faces, &old)).unwrap_or_default();
        }
        let mut elements = vec![0];
        elements.extend(per_patch.iter().scan(0, |sum, n| {
            *sum += n;
            Some(*sum)
        }));
        Ok(Self { faces, elements })
    }

    pub(super) fn patch_count(&self) -> usize {
        self.elements.len() - 1
    }

    pub(super) fn element_count(&self) -> usize {
        self.elements.last().map_or(0, |n| *n as usize)
    }

    pub(super) fn elements_of(&self, patch: u32) -> Range<u32> {
        self.elements[patch as usize]..self.elements[patch as usize + 1]
    }
}

fn counts(face: &Face) -> impl Iterator<Item = u32> {
    std::iter::repeat_n(face.elements.count() as u32, face.patches.count())
}

/// Numbers faces from `front` on, then the backs of those that have one; and the number after the last.
fn in_order(faces: &[Face], mut front: u32) -> (Vec<FaceNumbers>, u32) {
    let mut back = front + faces.iter().map(|f| f.patches.count() as u32).sum::<u32>();
    let mut numbers = Vec::with_capacity(faces.len());
    for face in faces {
        let n = face.patches.count() as u32;
        numbers.push(FaceNumbers { first: front, first_back: face.two_sided.then_some(back) });
        front += n;
        back += if face.two_sided { n } else { 0 };
    }
    (numbers, back)
}

/// Surfaces that take over numbers, in the order of the edits, each with the surfaces it replaces.
fn heirs(scene: &Scene) -> Vec<(usize, Vec<usize>)> {
    let heir = |(at, edit): (usize, &Edit)| match edit {
        Edit::Replace { object, by, same_numbers: true } => Some((*by, live_before(scene, at, object))),
        _ => None,
    };
    scene.edits.iter().enumerate().filter_map(heir).collect()
}

/// Surfaces of an object before edit `at` (counted from 0).
fn live_before(scene: &Scene, at: usize, object: &str) -> Vec<usize> {
    let by_edit = |e: &Edit| match e {
        Edit::Replace { object: o, by, .. } if o == object => Some(*by),
        _ => None,
    };
    match scene.edits[..at].iter().rev().find_map(by_edit) {
        Some(by) => vec![by],
        None => (0..scene.surfaces.len())
            .filter(|i| scene.surfaces[*i].object == object && !scene.is_replacement(*i))
            .collect(),
    }
}

/// Numbers and element counts of the patches of some surfaces: fronts, backs.
fn patch_numbers(scene: &Scene, faces: &[Vec<FaceNumbers>], surfaces: &[usize]) -> [Vec<(u32, u32)>; 2] {
    let mut sides = [Vec::new(), Vec::new()];
    for index in surfaces {
        for (face, numbers) in scene.surfaces[*index].faces.iter().zip(&faces[*index]) {
            for (k, elements) in counts(face).enumerate() {
                sides[0].push((numbers.first + k as u32, elements));
                sides[1].extend(numbers.first_back.map(|b| (b + k as u32, elements)));
            }
        }
    }
    sides
}

/// Old numbers for new faces, one to one; `None` where they do not fit.
fn inherit(faces: &[Face], [fronts, backs]: &[Vec<(u32, u32)>; 2]) -> Option<Vec<FaceNumbers>> {
    let (mut fronts, mut backs) = (&fronts[..], &backs[..]);
    let mut numbers = Vec::with_capacity(faces.len());
    for face in faces {
        let first = take_run(face, &mut fronts)?;
        let first_back = if face.two_sided { Some(take_run(face, &mut backs)?) } else { None };
        numbers.push(FaceNumbers { first, first_back });
    }
    (fronts.is_empty() && backs.is_empty()).then_some(numbers)
}

/// Takes the numbers of one face off the front of a list, if they follow each other and have as many elements.
fn take_run(face: &Face, side: &mut &[(u32, u32)]) -> Option<u32> {
    let (run, rest) = side.split_at_checked(face.patches.count())?;
    let first = run.first()?.0;
    let fits = run.iter().enumerate().all(|(k, p)| *p == (first + k as u32, face.elements.count() as u32));
    *side = rest;
    fits.then_some(first)
}

impl Scene {
    /// True if a surface comes in by a `replace` edit only.
    pub fn is_replacement(&self, surface: usize) -> bool {
        self.edits.iter().any(|e| matches!(e, Edit::Replace { by, .. } if *by == surface))
    }

    /// Decides for every `replace` whether the new faces take over the numbers of the old: they do where there
    /// are as many patches (and elements in each, and backs), in one run of numbers per face.
    pub fn settle_replacements(&mut self) -> Result<(), SceneError> {
        for at in 0..self.edits.len() {
            let Edit::Replace { object, by, .. } = &self.edits[at] else { continue };
            let (by, old) = (*by, live_before(self, at, object));
            let numbering = Numbering::of(self)?;
            let sides = patch_numbers(self, &numbering.faces, &old);
            let fits = inherit(&self.surfaces[by].faces, &sides).is_some();
            if let Edit::Replace { same_numbers, .. } = &mut self.edits[at] {
                *same_numbers = fits;
            }
        }
        Ok(())
    }

    /// Patches and elements must fit into numbers and memory.
    fn check_size(&self) -> Result<(), SceneError> {
        let (mut patches, mut elements) = (0u64, 0u64);
        for surface in &self.surfaces {
            for face in &surface.faces {
                let n = face.patches.count() as u64 * if face.two_sided { 2 } else { 1 };
                patches = patches.saturating_add(n);
                elements = elements.saturating_add(n.saturating_mul(face.elements.count() as u64));
            }
        }
        let check = |what, count, limit| match count > limit {
            true => Err(SceneError::TooMany { what, count, limit }),
            false => Ok(()),
        };
        check("patches", patches, MAX_PATCHES)?;
        check("elements", elements, MAX_ELEMENTS)
    }
}
