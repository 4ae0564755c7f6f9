//! One version of the geometry, ready to be shot in.

use super::ShootingError;
use crate::estimate::{Emitter, patch_emitters};
use crate::methods::hemicube::World;
use crate::raycast::{ElementLocator, KernelKind, RayKernel, Tracer, open_kernels};
use crate::scene::{Facet, Stage};
use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

/// A stage with what it takes to shoot in it.
pub(super) struct Geometry {
    pub stage: Arc<Stage>,
    pub tracer: Tracer<'static>,
    pub elements: ElementLocator,
    /// Where the rays of each patch start; `None` for those that take no part.
    pub emitters: Vec<Option<Emitter>>,
    world: OnceLock<World>,
    /// Facet by the number of its first patch, which is the same in every version.
    facets: HashMap<u32, u32>,
}

impl Geometry {
    /// Opens kernels on a stage. `enclosure` is one decision for all versions: which rays are decided again in double
    /// precision must not depend on an edit elsewhere.
    pub fn open(stage: Stage, kernel: KernelKind, enclosure: bool) -> Result<Self, ShootingError> {
        let stage = Arc::new(stage);
        let kernels = open_kernels(kernel, &stage)?;
        let exact: Arc<dyn RayKernel> = kernels.exact;
        let facets = stage.facets.iter().enumerate().map(|(k, f)| (f.first_patch, k as u32)).collect();
        Ok(Self {
            tracer: Tracer::shared(stage.clone(), kernels.kernel, exact, enclosure),
            elements: ElementLocator::new(&stage),
            emitters: patch_emitters(&stage),
            world: OnceLock::new(),
            facets,
            stage,
        })
    }

    /// What hemi-cubes see: elements.
    pub fn world(&self) -> &World {
        self.world.get_or_init(|| World::of_elements(&self.stage))
    }

    /// True if a facet of another version stands here too, just as there.
    pub fn holds(&self, facet: &Facet) -> bool {
        self.facets.get(&facet.first_patch).is_some_and(|k| {
            let here = &self.stage.facets[*k as usize];
            here.vertices == facet.vertices
                && here.first_back_patch == facet.first_back_patch
                && here.grid == facet.grid
                && here.elements == facet.elements
        })
    }
}
