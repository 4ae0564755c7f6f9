//! The sources that are looked at closely.

use super::auditor::{Auditor, Context};
use super::record::SourceAudit;
use super::request::{AuditError, patches_named};
use crate::audit::{Cause, Source, resolution_by_pixels, seen};

/// Sources that are looked at closely, at most.
const MOST_SOURCES: usize = 5;

/// And those alone that bring at least this share of the first one's error.
const LEAST_ERROR: f64 = 0.1;

impl Auditor<'_> {
    /// The sources asked for, or those that bring the largest errors.
    pub(super) fn sources(&self, context: &Context, resolution: u32) -> Result<Vec<SourceAudit>, AuditError> {
        let all = &context.first.sources;
        let chosen: Vec<Source> = if self.request.sources.is_empty() {
            let least = all.first().map_or(0.0, |s| LEAST_ERROR * s.error);
            all.iter().take(MOST_SOURCES).filter(|s| s.error >= least && s.error > 0.0).cloned().collect()
        } else {
            self.request.sources.iter().map(|name| self.source_named(context, name)).collect()
        };
        let limit = self.request.limit.unwrap_or(0.05);
        let of = |source: Source| {
            let views = self.views(context, &source.patches, resolution);
            SourceAudit {
                seen: seen(self.stage, &views),
                main_cause: source.main_cause(),
                resolution_by_pixels: resolution_by_pixels(&views, resolution, limit),
                mended_by: None,
                source,
            }
        };
        Ok(chosen.into_iter().map(of).collect())
    }

    /// A surface, or an object as one source.
    fn source_named(&self, context: &Context, name: &str) -> Source {
        if let Some(found) = context.first.sources.iter().find(|s| s.name == name) {
            return found.clone();
        }
        let patches = patches_named(self.stage, name);
        let error = |cause: Option<Cause>| {
            let part = |p: &crate::audit::Pair| cause.map_or(p.error(), |c| p.part(c));
            self.error_of(context, &patches, &context.split.matrix(part), true)
        };
        let parts: Vec<&Source> =
            context.first.sources.iter().filter(|s| s.patches.iter().any(|p| patches.contains(p))).collect();
        let area = |s: &Source| s.patches.iter().map(|j| self.stage.patches[*j as usize].area).sum::<f64>();
        let whole: f64 = parts.iter().map(|s| area(s)).sum();
        Source {
            name: name.into(),
            luminance: parts.iter().map(|s| s.luminance * area(s) / whole.max(f64::MIN_POSITIVE)).sum(),
            error: error(None),
            by_cause: Cause::ALL.map(|c| error(Some(c))),
            patches,
        }
    }
}
