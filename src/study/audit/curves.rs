//! Error against resolution, and under rotation about the normal.

use super::auditor::{Auditor, Context};
use super::record::At;
use super::request::AuditError;
use crate::methods::hemicube::Params;
use std::time::Instant;

impl Auditor<'_> {
    /// The curve over resolutions; the one audited among them.
    pub(super) fn resolutions(&self, context: &Context) -> Result<Vec<At>, AuditError> {
        let mut all = self.request.resolutions.clone();
        if self.request.theirs.is_none() {
            all.push(self.request.params.resolution);
        }
        all.sort_unstable();
        all.dedup();
        let of = |resolution: u32| {
            let params = Params { resolution, ..self.request.params }.validated()?;
            self.at(context, f64::from(resolution), &params)
        };
        all.into_iter().map(of).collect()
    }

    pub(super) fn rotations(&self, context: &Context) -> Result<Vec<At>, AuditError> {
        let step = 90.0 / f64::from(self.request.rotations.max(1));
        let of = |k: u32| {
            let rotation = self.request.params.rotation + f64::from(k) * step;
            self.at(context, f64::from(k) * step, &Params { rotation, ..self.request.params })
        };
        (0..self.request.rotations).map(of).collect()
    }

    fn at(&self, context: &Context, x: f64, params: &Params) -> Result<At, AuditError> {
        let begin = Instant::now();
        let f = self.rows(params)?;
        let seconds = begin.elapsed().as_secs_f64();
        let aliasing = context.split.aliasing_of(self.stage, &self.matrix_in_form(&f));
        let wrong = self.judged(&f, &format!("the hemi-cube at {params}"))?.0;
        Ok(At { x, wrong, aliasing, seconds })
    }
}
