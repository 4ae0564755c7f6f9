//! From rays to patches: a kernel finds the facet, double precision finds the rest.

use super::locate::{ASK, BACK, ESCAPED, Locator, Side, contains, locators, sides};
use super::{KernelInfo, RayBatch, RayKernel};
use crate::math::DVec3;
use crate::scene::{NO_FACET, Stage};
use serde::{Deserialize, Serialize};
use std::ops::{AddAssign, Deref};
use std::sync::Arc;

/// Rays counted by what became of them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Tally {
    /// Rays cast.
    pub rays: u64,
    /// Rays that met nothing.
    pub escapes: u64,
    /// Rays that met a black back.
    pub back_hits: u64,
    /// Rays of an enclosure that the first kernel let escape or hit a back, decided again in double precision.
    pub decided_again: u64,
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.escapes += other.escapes;
        self.back_hits += other.back_hits;
        self.decided_again += other.decided_again;
    }
}

/// Working memory of one thread.
#[derive(Debug, Default)]
pub struct TraceScratch {
    facets: Vec<u32>,
    doubtful: Vec<u32>,
    again: RayBatch,
}

/// The stage a tracer casts in: lent, or shared with whoever keeps it.
enum Held<'a> {
    Lent(&'a Stage),
    Shared(Arc<Stage>),
}

impl Deref for Held<'_> {
    type Target = Stage;

    fn deref(&self) -> &Stage {
        match self {
            Held::Lent(stage) => stage,
            Held::Shared(stage) => stage,
        }
    }
}

/// Casts rays in a stage and says in which patch each lands.
pub struct Tracer<'a> {
    stage: Held<'a>,
    kernel: Arc<dyn RayKernel>,
    /// Double-precision kernel that decides doubtful rays again.
    second: Arc<dyn RayKernel>,
    sides: Vec<Side>,
    locators: Vec<Locator>,
    present: Vec<bool>,
    enclosure: bool,
}

impl<'a> Tracer<'a> {
    /// A tracer on `kernel`. In an enclosure every escape and back hit is decided again by `second`.
    pub fn new(stage: &'a Stage, kernel: Arc<dyn RayKernel>, second: Arc<dyn RayKernel>, enclosure: bool) -> Self {
        Self::on(Held::Lent(stage), kernel, second, enclosure)
    }

    fn on(stage: Held<'a>, kernel: Arc<dyn RayKernel>, second: Arc<dyn RayKernel>, enclosure: bool) -> Self {
        let (sides, locators) = (sides(&stage), locators(&stage));
        let present = stage.patches.iter().map(|p| p.is_present()).collect();
        Self { stage, kernel, second, sides, locators, present, enclosure }
    }

    /// The stage rays are cast in.
    pub fn stage(&self) -> &Stage {
        &self.stage
    }

    /// The kernel that finds facets.
    pub fn kernel(&self) -> &KernelInfo {
        self.kernel.info()
    }

    /// True if escapes and back hits count as doubtful.
    pub fn is_enclosure(&self) -> bool {
        self.enclosure
    }

    /// Patch in which each ray lands, or [`ESCAPED`], or [`BACK`].
    pub fn trace(&self, rays: &RayBatch, landings: &mut [u32], scratch: &mut TraceScratch) -> Tally {
        scratch.facets.clear();
        scratch.facets.resize(rays.len(), NO_FACET);
        self.kernel.intersect(rays, &mut scratch.facets);
        scratch.doubtful.clear();
        let mut tally = Tally { rays: rays.len() as u64, ..Tally::default() };
        for k in 0..rays.len() {
            landings[k] = self.landing(rays, k, scratch.facets[k]);
            if landings[k] >= BACK {
                scratch.doubtful.push(k as u32);
            }
        }
        if self.enclosure && !scratch.doubtful.is_empty() {
            tally.decided_again = scratch.doubtful.len() as u64;
            self.decide_again(rays, landings, scratch);
        }
        for k in &scratch.doubtful {
            tally.escapes += u64::from(landings[*k as usize] == ESCAPED);
            tally.back_hits += u64::from(landings[*k as usize] == BACK);
        }
        tally
    }

    /// The facet and the point each camera ray meets, with its landing; for pictures.
    pub fn look(&self, rays: &RayBatch) -> Vec<Option<(u32, DVec3, u32)>> {
        let mut facets = vec![NO_FACET; rays.len()];
        self.kernel.intersect(rays, &mut facets);
        let hit = |(k, f): (usize, &u32)| {
            let locator = self.locators.get(*f as usize)?;
            let point = locator.point(rays.origin_of(k), rays.direction_of(k));
            Some((*f, point, self.landing(rays, k, *f)))
        };
        facets.iter().enumerate().map(hit).collect()
    }

    #[inline]
    fn landing(&self, rays: &RayBatch, k: usize, facet: u32) -> u32 {
        if facet == NO_FACET {
            return ESCAPED;
        }
        let direction = rays.direction_of(k);
        let patch = self.sides[facet as usize].patch(direction);
        if patch == ASK { self.landing_within(facet, rays.origin_of(k), direction) } else { patch }
    }

    /// The landing on a facet that is divided, black behind, or partly covered.
    fn landing_within(&self, facet: u32, origin: DVec3, direction: DVec3) -> u32 {
        let patch = self.locators[facet as usize].patch(origin, direction);
        if patch == BACK {
            return self.twin_front(facet, origin, direction);
        }
        if self.present[patch as usize] { patch } else { BACK }
    }

    /// At equal distance a front beats a back: a thin plate made of two coincident surfaces.
    fn twin_front(&self, facet: u32, origin: DVec3, direction: DVec3) -> u32 {
        for twin in &self.stage.facets[facet as usize].twins {
            let locator = &self.locators[*twin as usize];
            if (locator.meets_front(direction) || locator.is_two_sided())
                && contains(&self.stage.facets[*twin as usize], locator.point(origin, direction))
            {
                let patch = locator.patch(origin, direction);
                if self.present[patch as usize] {
                    return patch;
                }
            }
        }
        BACK
    }

    fn decide_again(&self, rays: &RayBatch, landings: &mut [u32], scratch: &mut TraceScratch) {
        let again = &mut scratch.again;
        again.resize(scratch.doubtful.len());
        again.from = rays.from;
        for (slot, k) in scratch.doubtful.iter().enumerate() {
            again.set(slot, rays.origin_of(*k as usize), rays.direction_of(*k as usize));
        }
        let facets = &mut scratch.facets[..scratch.doubtful.len()];
        facets.fill(NO_FACET);
        self.second.intersect(again, facets);
        for (slot, k) in scratch.doubtful.iter().enumerate() {
            landings[*k as usize] = self.landing(again, slot, facets[slot]);
        }
    }
}

impl Tracer<'static> {
    /// A tracer that keeps its stage.
    pub fn shared(stage: Arc<Stage>, kernel: Arc<dyn RayKernel>, second: Arc<dyn RayKernel>, enclosure: bool) -> Self {
        Self::on(Held::Shared(stage), kernel, second, enclosure)
    }
}
