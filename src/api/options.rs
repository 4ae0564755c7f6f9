//! What a reference may spend.

use crate::estimate::{Estimator, Plan};
use crate::raycast::KernelKind;
use crate::reference::Options;
use std::time::Duration;

/// How a reference is computed; the defaults are those of the command line.
///
/// ```
/// use etalon::ReferenceOptions;
/// let options = ReferenceOptions::default().rays(65_536).seed(7);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct ReferenceOptions {
    pub(super) options: Options,
    pub(super) kernel: KernelKind,
}

impl Default for ReferenceOptions {
    fn default() -> Self {
        let plan = Plan { estimator: Estimator::Auto, ..Plan::default() };
        Self { options: Options { plan, seed: 0 }, kernel: KernelKind::default() }
    }
}

impl ReferenceOptions {
    /// Rays per patch over all randomisations; default 16,384, rounded up to R times a power of two.
    pub fn rays(mut self, rays: u64) -> Self {
        self.options.plan.rays = rays;
        self
    }

    /// Independent randomisations R of the whole scene; default 16, at least 8.
    pub fn randomisations(mut self, r: u16) -> Self {
        self.options.plan.randomisations = r.max(8);
        self
    }

    /// Stop at this relative error (one sigma, norm of eq. 7) instead of at a number of rays.
    pub fn target_error(mut self, error: f64) -> Self {
        self.options.plan.target_error = Some(error);
        self
    }

    /// Stop when another doubling of the rays would not fit into this time.
    pub fn max_time(mut self, time: Duration) -> Self {
        self.options.plan.max_time = Some(time);
        self
    }

    /// Where form factors come from; default: whatever is most accurate.
    pub fn estimator(mut self, estimator: Estimator) -> Self {
        self.options.plan.estimator = estimator;
        self
    }

    /// Seed; default 0. Same scene, options, kernel and seed: same bytes.
    pub fn seed(mut self, seed: u64) -> Self {
        self.options.seed = seed;
        self
    }

    /// Ray kernel; default Embree where there is one, else the built-in.
    pub fn kernel(mut self, kernel: KernelKind) -> Self {
        self.kernel = kernel;
        self
    }

    /// Rays, randomisations, target and time.
    pub fn plan(&self) -> &Plan {
        &self.options.plan
    }
}
