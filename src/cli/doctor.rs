//! `etalon doctor`: which ray kernels there are, and whether they can be trusted here.

use super::setup::layout_in_words;
use crate::math::DVec3;
use crate::raycast::specimen::{Numbers, clutter, rays_from, rotated};
use crate::raycast::{
    Agreement, BuiltinKernel, EmbreeKernel, KernelInfo, RayBatch, RayKernel, Refused, agree, find_embree,
};
use crate::scene::{NO_FACET, Stage};
use serde::Serialize;
use std::fmt;
use std::sync::Arc;

/// What the doctor finds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DoctorReport {
    /// Version of this program.
    pub version: String,
    /// Threads the machine offers.
    pub threads: usize,
    /// The kernels that can be used, the preferred one first.
    pub kernels: Vec<KernelInfo>,
    /// Memory layout of the Embree library, as probed, in words.
    pub embree_layout: Option<String>,
    /// Libraries that were found but are refused.
    pub refused: Vec<Refusal>,
    /// Places that were searched for Embree.
    pub looked_in: String,
    /// Cargo features of this build that add kernels.
    pub features: Vec<String>,
    /// What became of the rays.
    pub self_test: SelfTest,
}

/// A library that was refused.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Refusal {
    /// The library.
    pub path: String,
    /// Why.
    pub why: String,
}

/// Rays in a closed room with boxes in it: none may escape, and the kernels must agree.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SelfTest {
    /// Rays traced by each kernel.
    pub rays: usize,
    /// Rays that left the room, per kernel.
    pub escapes: Vec<usize>,
    /// Embree against the built-in kernel.
    pub agreement: Option<Agreement>,
    /// What could not be done, if anything.
    pub failure: Option<String>,
    /// True if no ray escaped the built-in kernel and the kernels agree.
    pub passed: bool,
}

/// Looks for kernels and tries them.
pub fn examine() -> DoctorReport {
    let search = find_embree();
    let stage = room();
    let exact = Arc::new(BuiltinKernel::new(&stage));
    let embree = search.library.map(|l| EmbreeKernel::new(l, &stage, exact.clone()));
    let (embree, failure) = match embree {
        Some(Ok(kernel)) => (Some(kernel), None),
        Some(Err(e)) => (None, Some(e.to_string())),
        None => (None, None),
    };
    let kernels = embree.iter().map(|e| e as &dyn RayKernel).chain([exact.as_ref() as &dyn RayKernel]);
    let kernels: Vec<&dyn RayKernel> = kernels.collect();
    DoctorReport {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        kernels: kernels.iter().map(|k| k.info().clone()).collect(),
        embree_layout: search.library.map(layout_in_words),
        refused: search.refused.iter().map(refusal).collect(),
        looked_in: search.looked_in,
        features: if cfg!(feature = "embree4-rs") { vec!["embree4-rs".to_owned()] } else { Vec::new() },
        self_test: self_test(&stage, &kernels, failure),
    }
}

fn refusal(r: &Refused) -> Refusal {
    Refusal { path: r.path.display().to_string(), why: r.why.clone() }
}

/// A closed room with four boxes, at an odd angle so that nothing is aligned with the axes.
fn room() -> Stage {
    let polygons = clutter(DVec3::new(4.0, 3.0, 2.5), 4, &mut Numbers::new(1));
    Stage::from_polygons(&rotated(&polygons, DVec3::new(1.0, 2.0, 3.0).normalize(), 0.4))
}

fn self_test(stage: &Stage, kernels: &[&dyn RayKernel], failure: Option<String>) -> SelfTest {
    let mut numbers = Numbers::new(2);
    let walls = 0..6;
    let batches: Vec<RayBatch> = walls.map(|f| rays_from(stage, f, 8_000, &mut numbers)).collect();
    let escapes: Vec<usize> = kernels.iter().map(|k| escapes(*k, &batches)).collect();
    let agreement = match kernels {
        [a, b] => Some(agree(*a, *b, stage, &batches)),
        _ => None,
    };
    let agreed = agreement.as_ref().is_none_or(Agreement::holds);
    let passed = agreed && failure.is_none() && escapes.last() == Some(&0);
    SelfTest { rays: batches.iter().map(RayBatch::len).sum(), escapes, agreement, failure, passed }
}

fn escapes(kernel: &dyn RayKernel, batches: &[RayBatch]) -> usize {
    let mut facets = Vec::new();
    let mut count = |rays: &RayBatch| {
        facets.resize(rays.len(), NO_FACET);
        kernel.intersect(rays, &mut facets);
        facets.iter().filter(|f| **f == NO_FACET).count()
    };
    batches.iter().map(&mut count).sum()
}

impl fmt::Display for DoctorReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "etalon {}, {} threads", self.version, self.threads)?;
        for kernel in &self.kernels {
            writeln!(f, "Kernel {}", in_words(kernel))?;
        }
        for r in &self.refused {
            writeln!(f, "Not usable: {}: {}", r.path, r.why)?;
        }
        match &self.embree_layout {
            Some(layout) => writeln!(f, "Embree's memory layout: {layout}")?,
            None => {
                writeln!(f, "No Embree. Searched: {}", self.looked_in)?;
                writeln!(f, "`etalon setup embree` provides one; until then the built-in kernel does the work.")?;
            }
        }
        write!(f, "{}", self.self_test)
    }
}

fn in_words(kernel: &KernelInfo) -> String {
    let set = kernel.instruction_set.as_ref().map(|s| format!(" ({s})")).unwrap_or_default();
    let path = kernel.path.as_ref().map(|p| format!(", {}", p.display())).unwrap_or_default();
    format!("{} {}{set}{path}", kernel.name, kernel.version)
}

impl fmt::Display for SelfTest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.passed { "passed" } else { "FAILED" };
        let escapes: Vec<String> = self.escapes.iter().map(ToString::to_string).collect();
        write!(f, "Self-test {verdict}: {} rays in a closed room, escaped {}", self.rays, escapes.join(" and "))?;
        if let Some(a) = &self.agreement {
            write!(f, "; kernels differ on {}, {:.4} % near an edge left out", a.disagreements, 100.0 * a.near_edge)?;
        }
        if let Some(failure) = &self.failure {
            write!(f, "; {failure}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_machine_without_embree_is_well() {
        let stage = room();
        let exact = BuiltinKernel::new(&stage);
        let test = self_test(&stage, &[&exact], None);
        assert!(test.passed && test.escapes == [0] && test.agreement.is_none());
    }

    #[test]
    fn a_kernel_that_loses_rays_is_not() {
        struct Blind(KernelInfo);
        impl RayKernel for Blind {
            fn info(&self) -> &KernelInfo {
                &self.0
            }
            fn intersect(&self, _: &RayBatch, facets: &mut [u32]) {
                facets.fill(NO_FACET);
            }
        }
        let stage = room();
        let exact = BuiltinKernel::new(&stage);
        let blind = Blind(exact.info().clone());
        let test = self_test(&stage, &[&blind, &exact], None);
        assert!(!test.passed && test.escapes == [test.rays, 0]);
    }
}
