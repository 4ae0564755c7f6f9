//! Cures: each is run, solved and judged.

use super::auditor::{Auditor, Context};
use super::record::{CureRun, SourceAudit, Wrong};
use super::request::AuditError;
use crate::audit::{Cure, POINTS, cured, subdivision_distance};
use std::time::Instant;

/// A cure by resolution draws no more pixels than this.
const MOST_PIXELS: u64 = 4_000_000_000;

/// Parts of a divided patch along an edge, tried one after the other.
const CELLS: [u32; 2] = [2, 4];

impl Auditor<'_> {
    /// Runs the cures: what the sources call for, in turn.
    pub(super) fn cures(&self, context: &Context, sources: &[SourceAudit]) -> Result<Vec<CureRun>, AuditError> {
        let mut patches: Vec<u32> = sources.iter().flat_map(|s| s.source.patches.iter().copied()).collect();
        patches.sort_unstable();
        patches.dedup();
        let run = |cure: Cure| self.cure(context, sources, &patches, cure);
        let mut runs = vec![run(Cure::None)?, run(Cure::Rotation)?, run(Cure::Jitter)?];
        let present = self.stage.patches.iter().filter(|p| p.is_present()).count() as u64;
        let enough = |wrong: &Wrong| match (self.request.limit, wrong.rms) {
            (Some(limit), Some(rms)) => rms.high <= limit,
            _ => false,
        };
        let infinite = self.bench.judge(&context.effect.point)?.0.rms.map_or(0.0, |e| e.low);
        // Where no resolution will do, two steps show it.
        let most_doublings = if self.request.limit.is_none_or(|limit| infinite > limit) { 2 } else { 5 };
        for doubling in 1..=5 {
            let resolution = self.request.params.resolution << doubling;
            if resolution > 4096 || present * 3 * u64::from(resolution).pow(2) > MOST_PIXELS {
                break;
            }
            runs.push(run(Cure::Resolution { resolution })?);
            if enough(&runs[runs.len() - 1].wrong) || doubling == most_doublings {
                break;
            }
        }
        let spatial: Vec<f64> = context.first.receivers.iter().map(|r| r[1] + r[2]).collect();
        let analytic = Cure::Analytic { points: POINTS };
        runs.push(run(analytic)?);
        if let Some(distance) = subdivision_distance(self.stage, &patches, &spatial) {
            for cells in CELLS {
                runs.push(run(Cure::Subdivision { cells, distance })?);
            }
            let best = Cure::SubdivisionAndAnalytic { cells: CELLS[0], distance, points: POINTS };
            runs.push(run(best)?);
        }
        Ok(runs)
    }

    fn cure(
        &self,
        context: &Context,
        sources: &[SourceAudit],
        patches: &[u32],
        cure: Cure,
    ) -> Result<CureRun, AuditError> {
        let words = cure.words();
        self.progress.begin(&words, Some(self.stage.patch_count() as u64));
        let done = std::cell::Cell::new(0);
        let told = |rows: usize| self.progress.advance((rows - done.replace(rows)) as u64);
        let begin = Instant::now();
        let made = cured(self.stage, &self.request.params, patches, &cure, self.request.reference.seed, &told)?;
        let seconds = begin.elapsed().as_secs_f64();
        let (wrong, verdict) = self.judged(&made.form_factors, &words)?;
        let f = self.matrix_in_form(&made.form_factors);
        let by_source = sources.iter().map(|s| self.error_of(context, &s.source.patches, &f, false)).collect();
        let (hemicubes, pixels, points, work) = (made.hemicubes, made.pixels, made.points, made.work());
        Ok(CureRun { words, cure, wrong, verdict, by_source, seconds, hemicubes, pixels, points, work })
    }
}
