//! The names that patches are listed under: a surface, or a group of its mesh.

use super::{Face, Scene, StageSurface};

/// Names of all surfaces and groups, in file order.
pub(super) struct Names {
    pub list: Vec<StageSurface>,
    /// Per name: index of the surface it belongs to.
    owners: Vec<u32>,
    /// Per surface: its own name, then those of its groups.
    first: Vec<u32>,
    /// Per surface: 1 if it is listed under its own name, 0 if every face is in a group.
    plain: Vec<u32>,
}

impl Names {
    pub(super) fn of(scene: &Scene) -> Self {
        let mut names = Self { list: Vec::new(), owners: Vec::new(), first: Vec::new(), plain: Vec::new() };
        for (index, surface) in scene.surfaces.iter().enumerate() {
            let plain = surface.groups.is_empty() || surface.faces.iter().any(|f| f.group.is_none());
            names.first.push(names.list.len() as u32);
            names.plain.push(u32::from(plain));
            let own = plain.then(|| surface.name.clone());
            let groups = surface.groups.iter().map(|g| format!("{}/{g}", surface.name));
            for name in own.into_iter().chain(groups) {
                names.list.push(StageSurface { name, object: surface.object.clone() });
                names.owners.push(index as u32);
            }
        }
        names
    }

    /// Number of the name that a face of a surface is listed under.
    pub(super) fn of_face(&self, surface: usize, face: &Face) -> u32 {
        self.first[surface] + face.group.map_or(0, |g| self.plain[surface] + g)
    }

    /// Index of the surface that a name belongs to.
    pub(super) fn owner(&self, name: u32) -> u32 {
        self.owners[name as usize]
    }
}
