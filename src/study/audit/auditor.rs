//! What every part of an audit needs: the stage, the judge, the truth, and hemi-cubes in their form.

use super::judging::Bench;
use super::record::{Form, Wrong};
use super::request::{AuditError, AuditRequest, unsolved};
use crate::audit::{Effect, FirstBounce, Split, Truth, View, from_shooters, radiosity, source_error, views};
use crate::math::{DVec3, Frame};
use crate::methods::PatchVectors;
use crate::methods::hemicube::{self, HemicubeError, Params};
use crate::metrics::Verdict;
use crate::reference::{Progress, Reference};
use crate::scene::Stage;
use crate::solution::FormFactors;
use std::borrow::Cow;

/// What everybody needs.
pub(super) struct Auditor<'a> {
    pub(super) stage: &'a Stage,
    pub(super) request: &'a AuditRequest<'a>,
    pub(super) progress: &'a dyn Progress,
    pub(super) bench: Bench,
    pub(super) truth: &'a Reference,
    pub(super) stands: Vec<Option<(DVec3, Frame)>>,
}

/// What the hemi-cube came to.
pub(super) struct Context<'a> {
    pub(super) split: &'a Split,
    pub(super) effect: &'a Effect,
    pub(super) first: &'a FirstBounce,
    pub(super) reflected: &'a [f64],
}

impl Auditor<'_> {
    pub(super) fn rows(&self, params: &Params) -> Result<FormFactors, HemicubeError> {
        self.progress.begin("hemi-cubes", Some(self.stage.patch_count() as u64));
        let done = std::cell::Cell::new(0);
        let told = |rows: usize| self.progress.advance((rows - done.replace(rows)) as u64);
        hemicube::form_factors(self.stage, params, &told)
    }

    /// Every pair taken apart, as the hemi-cubes stand.
    pub(super) fn split(&self, cube: &FormFactors) -> Split {
        self.progress.begin("taking pairs apart", Some(self.stage.patch_count() as u64));
        let counts = &self.truth.counts;
        let one_hit = 1.0 / (counts.rays as f64 * f64::from(counts.randomisations)).max(1.0);
        let settled = self.truth.settled.as_ref();
        let unseen_error = |i: usize, j: usize| match settled {
            Some(pairs) if !pairs.left.holds(i, j) => 0.0,
            _ => one_hit,
        };
        let truth = Truth { form_factors: &self.truth.form_factors, unseen_error: &unseen_error };
        Split::of(self.stage, &self.stands, cube, truth, &|rows| self.progress.advance(rows))
    }

    pub(super) fn in_form(&self, split: Split) -> Split {
        match self.request.form {
            Form::Receiver => split,
            Form::Shooter => split.from_shooters(self.stage),
        }
    }

    /// Luminance that a unit of form factor to patch j brings to patch i.
    pub(super) fn unit<'a>(&'a self, context: &'a Context) -> impl Fn(usize, usize) -> f64 + Sync + 'a {
        let vectors = PatchVectors::of(self.stage);
        let weights = &self.stage.photometry.weights;
        move |i, j| {
            let band = |b: usize| {
                weights[b] * vectors.reflectance[i * vectors.bands + b] * context.effect.cube[j * vectors.bands + b]
            };
            (0..vectors.bands).map(band).sum()
        }
    }

    pub(super) fn views(&self, context: &Context, source: &[u32], resolution: u32) -> Vec<View> {
        let unit = self.unit(context);
        let at_source = self.request.form == Form::Shooter;
        views(self.stage, context.split, &self.stands, source, resolution, at_source, &unit)
    }

    /// First-bounce error that a matrix (or, `difference`, one that is a difference already) brings from some patches.
    pub(super) fn error_of(&self, context: &Context, source: &[u32], f: &FormFactors, difference: bool) -> f64 {
        let unit = self.unit(context);
        let truth = (!difference).then_some(context.split);
        source_error(self.stage, f, truth, source, &unit, context.reflected)
    }

    pub(super) fn matrix_in_form<'f>(&self, f: &'f FormFactors) -> Cow<'f, FormFactors> {
        match self.request.form {
            Form::Receiver => Cow::Borrowed(f),
            Form::Shooter => Cow::Owned(from_shooters(self.stage, f)),
        }
    }

    /// A matrix of rows as the hemi-cubes stand, solved and judged.
    pub(super) fn judged(&self, f: &FormFactors, what: &str) -> Result<(Wrong, Option<Verdict>), AuditError> {
        let f = self.matrix_in_form(f);
        let solved = radiosity(self.stage, &f).map_err(|source| unsolved(what, source))?;
        Ok(self.bench.judge(&solved)?)
    }
}
