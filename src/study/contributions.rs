//! What lights the worst receivers: their rows of form factors cast again, source by source.
//!
//! A reference keeps no form factors. The judge's rays are a function of their address, so casting the rows of a few
//! receivers again brings back the rows the reference was made of.

use super::Session;
use crate::estimate::{HitCounts, Plan, cast, element_emitters, patch_emitters};
use crate::io::StoredReference;
use crate::sampling::{Role, Stream};
use crate::scene::Stage;
use crate::solution::{Radiosity, Replicates};
use crate::stats::{Estimate, jackknife_interval, mean_interval};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Rays of a row beyond which nothing more is learnt for a table: a prefix of the reference's own is cast.
const MOST_RAYS: u64 = 1 << 20;
/// Sources named one by one.
const NAMED: usize = 6;

/// Where the light of one receiver comes from, and its error; luminances, W/m^2.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Contributions {
    /// Number of the patch, or of the element where elements are judged.
    pub receiver: usize,
    /// Name of its surface.
    pub surface: String,
    /// Rays of its row.
    pub rays: u64,
    /// The reference's luminance, emission included.
    pub reference: Estimate,
    /// Self-emitted.
    pub emission: f64,
    /// Reflected, by the surface it comes from; the brightest first.
    pub sources: Vec<Source>,
    /// All further surfaces together.
    pub others: Option<Source>,
    /// Emission and everything reflected: what the reference should be.
    pub sum: Estimate,
    /// Solution - reference.
    pub difference: f64,
    /// The part of the difference that the sources hand on, which are wrong themselves.
    pub handed_on: Estimate,
    /// The rest: made at the receiver itself, by its form factors or by the solver.
    pub own: Estimate,
}

/// What one surface, or several, send to a receiver.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// Name of the surface; empty for several.
    pub surface: String,
    /// Number of surfaces.
    pub surfaces: usize,
    /// Form factor from the receiver to it.
    pub form_factor: f64,
    /// Light that it brings: `rho sum F B` over its patches.
    pub luminance: Estimate,
    /// The same as a share of the sum, emission included; `None` where that is dark.
    pub share: Option<f64>,
    /// Error that it hands on: the same with the solution's error of B instead of B.
    pub handed_on: Estimate,
}

/// Rows to be explained.
pub struct Rows<'a> {
    /// Numbers of patches, or of elements.
    pub receivers: &'a [usize],
    /// True for elements.
    pub elements: bool,
    /// The solution at these receivers' level.
    pub solution: &'a Radiosity,
    /// The solution per patch: what sources send.
    pub sources: &'a Radiosity,
    /// Two-sided confidence of the intervals.
    pub confidence: f64,
}

/// Explains each receiver of `rows` by casting its rays again, as the reference did. Nothing in scenes with point lights:
/// their light comes by no row of form factors, and a sum without it would mislead.
pub fn contributions(session: &Session, reference: &StoredReference, rows: &Rows) -> Vec<Contributions> {
    let stage = session.stage();
    if !stage.lights.is_empty() {
        return Vec::new();
    }
    let by_element = rows.elements && reference.elements.is_some();
    let mut emitters = if by_element { element_emitters(stage) } else { patch_emitters(stage) };
    emitters.iter_mut().enumerate().filter(|(i, _)| !rows.receivers.contains(i)).for_each(|(_, e)| *e = None);
    let p = &reference.provenance;
    let plan = Plan { rays: p.rays_per_patch.min(MOST_RAYS), randomisations: p.randomisations, ..Plan::default() };
    let counts = cast(&session.tracer(), &emitters, Stream::new(Role::Judge, p.seed), &plan, &|_| 0.0, &|_| ()).counts;
    let receivers = reference.elements.as_ref().filter(|_| by_element).unwrap_or(&reference.patches);
    let explain = |&i: &usize| {
        let patch = if by_element { stage.elements[i].patch as usize } else { i };
        Row { stage, reference, rows, receivers, counts: &counts, receiver: i, patch }.explain()
    };
    rows.receivers.iter().filter(|i| emitters.get(**i).is_some_and(Option::is_some)).map(explain).collect()
}

/// One row with everything its explanation is made of.
struct Row<'a> {
    stage: &'a Stage,
    reference: &'a StoredReference,
    rows: &'a Rows<'a>,
    /// Replicates at the receivers' level.
    receivers: &'a Replicates,
    counts: &'a HitCounts,
    receiver: usize,
    patch: usize,
}

/// A statistic with its values where one replicate is left out.
#[derive(Clone)]
struct Jackknife {
    full: f64,
    left_out: Vec<f64>,
}

impl Jackknife {
    fn zero(replicates: usize) -> Self {
        Self { full: 0.0, left_out: vec![0.0; replicates] }
    }

    fn add(&mut self, other: &Self) {
        self.full += other.full;
        self.left_out.iter_mut().zip(&other.left_out).for_each(|(a, b)| *a += b);
    }

    fn estimate(&self, confidence: f64) -> Estimate {
        jackknife_interval(self.full, &self.left_out, confidence)
    }
}

/// Sums over the patches of a source.
#[derive(Clone)]
struct Sums {
    hits: u64,
    luminance: Jackknife,
    handed_on: Jackknife,
}

impl Sums {
    fn zero(replicates: usize) -> Self {
        Self { hits: 0, luminance: Jackknife::zero(replicates), handed_on: Jackknife::zero(replicates) }
    }

    fn add(&mut self, other: &Self) {
        self.hits += other.hits;
        self.luminance.add(&other.luminance);
        self.handed_on.add(&other.handed_on);
    }
}

impl Row<'_> {
    fn explain(&self) -> Contributions {
        let (replicates, confidence) = (self.receivers.count(), self.rows.confidence);
        let mut sources = self.by_surface();
        let mut total = Sums::zero(replicates);
        sources.iter().for_each(|(_, s)| total.add(s));
        let emission = self.stage.photometry.luminance(self.stage.emission(self.patch));
        let sum = shifted(total.luminance.estimate(confidence), emission);
        // The brightest first; equal ones in the order of their numbers.
        sources.sort_by(|a, b| b.1.luminance.full.total_cmp(&a.1.luminance.full));
        let mut rest = Sums::zero(replicates);
        sources.iter().skip(NAMED).for_each(|(_, s)| rest.add(s));
        let named =
            |(surface, s): &(u32, Sums)| self.source(&self.stage.surfaces[*surface as usize].name, 1, s, sum.value);
        let luminances = self.luminances_of_receiver();
        let solution = self.luminance(self.rows.solution.of(self.receiver));
        let difference = solution - mean(&luminances);
        let made_here = Jackknife {
            full: difference - total.handed_on.full,
            left_out: left_out(&luminances)
                .iter()
                .zip(&total.handed_on.left_out)
                .map(|(y, h)| solution - y - h)
                .collect(),
        };
        Contributions {
            receiver: self.receiver,
            surface: self.stage.surface_name(self.patch).to_string(),
            rays: self.counts.rays * replicates as u64,
            reference: mean_interval(&luminances, confidence),
            emission,
            others: (sources.len() > NAMED).then(|| self.source("", sources.len() - NAMED, &rest, sum.value)),
            sources: sources.iter().take(NAMED).map(named).collect(),
            sum,
            difference,
            handed_on: total.handed_on.estimate(confidence),
            own: made_here.estimate(confidence),
        }
    }

    fn source(&self, name: &str, surfaces: usize, sums: &Sums, whole: f64) -> Source {
        let confidence = self.rows.confidence;
        Source {
            surface: name.to_string(),
            surfaces,
            form_factor: sums.hits as f64 / (self.counts.rays * u64::from(self.counts.randomisations)) as f64,
            luminance: sums.luminance.estimate(confidence),
            share: (whole > 0.0).then(|| sums.luminance.full / whole),
            handed_on: sums.handed_on.estimate(confidence),
        }
    }

    /// Light and error by the surface they come from, in the order of surfaces.
    fn by_surface(&self) -> Vec<(u32, Sums)> {
        let replicates = self.receivers.count();
        let (rays, r) = (self.counts.rays as f64, replicates as f64);
        let mut groups: BTreeMap<u32, Sums> = BTreeMap::new();
        for (j, run) in self.counts.by_patch(self.receiver) {
            let sums = groups.entry(self.stage.patches[j].surface).or_insert_with(|| Sums::zero(replicates));
            let hits: u64 = run.iter().map(|e| e.count()).sum();
            let mut single = vec![0u64; replicates];
            run.iter().for_each(|e| single[e.randomisation()] = e.count());
            let bright: Vec<f64> =
                self.reference.patches.replicates.iter().map(|b| self.reflected(&b[self.span(j)])).collect();
            let claimed = self.reflected(self.rows.sources.of(j));
            let mut add = |of: fn(&mut Sums) -> &mut Jackknife, value: &dyn Fn(f64) -> f64| {
                let out = of(sums);
                out.full += hits as f64 / (r * rays) * value(mean(&bright));
                for ((out, own), b) in out.left_out.iter_mut().zip(&single).zip(left_out(&bright)) {
                    *out += (hits - own) as f64 / ((r - 1.0) * rays) * value(b);
                }
            };
            add(|s| &mut s.luminance, &|b| b);
            add(|s| &mut s.handed_on, &|b| claimed - b);
            sums.hits += hits;
        }
        groups.into_iter().collect()
    }

    fn span(&self, patch: usize) -> std::ops::Range<usize> {
        let bands = self.receivers.bands;
        patch * bands..(patch + 1) * bands
    }

    fn luminance(&self, radiosity: &[f64]) -> f64 {
        self.stage.photometry.luminance(radiosity)
    }

    /// Luminance that the receiver reflects of a radiosity that falls on it.
    fn reflected(&self, radiosity: &[f64]) -> f64 {
        let rho = self.stage.reflectance(self.patch);
        let weights = &self.stage.photometry.weights;
        weights.iter().zip(rho).zip(radiosity).map(|((w, rho), b)| w * rho * b).sum()
    }

    fn luminances_of_receiver(&self) -> Vec<f64> {
        self.receivers.replicates.iter().map(|b| self.luminance(&b[self.span(self.receiver)])).collect()
    }
}

fn mean(x: &[f64]) -> f64 {
    x.iter().sum::<f64>() / x.len() as f64
}

/// Means with one value left out.
fn left_out(x: &[f64]) -> Vec<f64> {
    let sum: f64 = x.iter().sum();
    x.iter().map(|x_r| (sum - x_r) / (x.len() as f64 - 1.0)).collect()
}

fn shifted(e: Estimate, by: f64) -> Estimate {
    Estimate { value: e.value + by, std_err: e.std_err, low: e.low + by, high: e.high + by }
}
