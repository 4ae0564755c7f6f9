//! Putting a solution before the judge: data for the metrics, the comparison, the decision.

use crate::io::StoredReference;
use crate::math::DVec3;
use crate::metrics::{
    self, AsSeen, Beside, Breakdown, Comparison, Decision, Judged, Limits, MetricsError, Truth, Viewing, compare,
    decide, look, measure, shared_confidence,
};
use crate::scene::{Material, NO_FACET, Patch, Region, Stage, StageSurface};
use crate::solution::Radiosity;
use crate::view::Photometry;

/// Who is judged: the patches or the elements of a stage.
#[derive(Debug, Clone)]
pub struct Receivers {
    /// Areas that take part, m^2.
    pub areas: Vec<f64>,
    /// Self-emitted radiosity, receiver-major.
    pub emission: Vec<f64>,
    /// Surface of each.
    pub surfaces: Vec<String>,
    /// Object of each.
    pub objects: Vec<String>,
    /// Bands and weights.
    pub photometry: Photometry,
    /// The reflectance that everything that reflects has in every band, if it is one.
    pub uniform_reflectance: Option<f64>,
}

impl Receivers {
    /// The patches of a stage.
    pub fn patches(stage: &Stage) -> Self {
        Self::of(stage, &(0..stage.patch_count()).map(|i| (i, stage.patches[i].area)).collect::<Vec<_>>())
    }

    /// The elements of a stage.
    pub fn elements(stage: &Stage) -> Self {
        Self::of(stage, &stage.elements.iter().map(|e| (e.patch as usize, e.area)).collect::<Vec<_>>())
    }

    fn of(stage: &Stage, receivers: &[(usize, f64)]) -> Self {
        let surface = |i: usize| &stage.surfaces[stage.patches[i].surface as usize];
        Self {
            areas: receivers.iter().map(|(_, area)| *area).collect(),
            emission: receivers.iter().flat_map(|(i, _)| stage.emission(*i)).copied().collect(),
            surfaces: receivers.iter().map(|(i, _)| surface(*i).name.clone()).collect(),
            objects: receivers.iter().map(|(i, _)| surface(*i).object.clone()).collect(),
            photometry: stage.photometry.clone(),
            uniform_reflectance: uniform_reflectance(stage),
        }
    }

    /// As the metrics take them.
    pub(super) fn judged<'a>(&'a self, surfaces: &'a [&'a str]) -> Judged<'a> {
        Judged {
            areas: &self.areas,
            emission: &self.emission,
            surfaces,
            bands: &self.photometry.bands,
            weights: &self.photometry.weights,
        }
    }

    /// Which of them emit.
    pub fn lamps(&self) -> Vec<bool> {
        self.emission.chunks(self.photometry.bands.len()).map(|e| e.iter().any(|e| *e > 0.0)).collect()
    }

    /// Which of them take part.
    pub fn present(&self) -> Vec<bool> {
        self.areas.iter().map(|a| *a > 0.0).collect()
    }
}

/// The one reflectance of all that reflects.
fn uniform_reflectance(stage: &Stage) -> Option<f64> {
    let all = stage.reflectances();
    let mut reflecting = all.iter().copied().filter(|rho| *rho > 0.0);
    let first = reflecting.next()?;
    reflecting.all(|rho| (rho - first).abs() <= 1e-9).then_some(first)
}

/// A stage that knows nothing but how many receivers there are, all of equal weight: for two solutions that come
/// without their scene.
pub fn anonymous_stage(n: usize, photometry: Photometry) -> Stage {
    let zeros = vec![0.0; photometry.bands.len()];
    let patch = |i: usize| Patch {
        surface: 0,
        material: 0,
        facet: NO_FACET,
        a: i as u32,
        b: 0,
        corners: Vec::new(),
        normal: DVec3::ZERO,
        area: 1.0,
        region: Region::default(),
        elements: i as u32..i as u32,
    };
    Stage {
        name: "(no scene given)".into(),
        state: 0,
        enclosure: None,
        materials: vec![Material { name: String::new(), reflectance: zeros.clone(), emission: zeros }],
        surfaces: vec![StageSurface { name: String::new(), object: String::new() }],
        facets: Vec::new(),
        patches: (0..n).map(patch).collect(),
        elements: Vec::new(),
        cameras: Vec::new(),
        lights: Vec::new(),
        receivers: Vec::new(),
        photometry,
    }
}

/// What a solution is held against.
#[derive(Debug, Clone)]
pub enum Against {
    /// A stored reference.
    Reference(Box<StoredReference>),
    /// Another solution.
    Solution(Radiosity),
}

/// Why a judgement cannot be given.
#[derive(Debug, thiserror::Error)]
pub enum JudgeError {
    /// The metrics refuse.
    #[error(transparent)]
    Metrics(#[from] MetricsError),
    /// Element values are asked for and the reference has none.
    #[error("the reference holds no element values: its scene has one element per patch; use --per patch")]
    NoElements,
}

/// What is asked of the judge.
#[derive(Debug, Clone, Default)]
pub struct Question {
    /// Limits; none for a mere comparison.
    pub limits: Option<Limits>,
    /// Confidence over all limits together.
    pub confidence: f64,
    /// Metrics on B - E.
    pub reflected: bool,
    /// Elements instead of patches.
    pub per_element: bool,
    /// The solution of the baseline, for a limit on becoming worse.
    pub baseline: Option<Radiosity>,
    /// Who looks, for what can be seen of the error.
    pub viewing: Option<Viewing>,
}

impl Question {
    /// Confidence of each interval.
    fn shared_confidence(&self) -> f64 {
        self.limits.as_ref().map_or(self.confidence, |l| shared_confidence(self.confidence, l))
    }
}

/// The answer.
#[derive(Debug, Clone)]
pub struct Judgement {
    /// All metrics.
    pub comparison: Comparison,
    /// The verdict, where limits were given.
    pub decision: Option<Decision>,
    /// What can be seen of the error, where somebody looks.
    pub as_seen: Option<AsSeen>,
}

impl Against {
    /// As the metrics take it.
    pub fn truth(&self, per_element: bool) -> Result<Truth, JudgeError> {
        match self {
            Self::Solution(b) => Ok(Truth::Given(b.clone())),
            Self::Reference(r) if per_element => match &r.elements {
                Some(e) => Ok(Truth::Sampled(e.clone())),
                None if r.stage.has_elements() => Err(JudgeError::NoElements),
                None => Ok(Truth::Sampled(r.patches.clone())),
            },
            Self::Reference(r) => Ok(Truth::Sampled(r.patches.clone())),
        }
    }
}

/// Judges a solution.
pub fn judge(
    solution: &Radiosity,
    reference: &Against,
    before: Option<&Against>,
    receivers: &Receivers,
    question: &Question,
) -> Result<Judgement, JudgeError> {
    let truth = reference.truth(question.per_element)?;
    let before = before.map(|b| b.truth(question.per_element)).transpose()?;
    let (surfaces, objects) = (names(&receivers.surfaces), names(&receivers.objects));
    let judged = receivers.judged(&surfaces);
    let confidence = question.shared_confidence();
    let mut comparison = compare(solution, &truth, before.as_ref(), &judged, confidence, question.reflected)?;
    if let (Some(scale), Some(rms), Some(rho)) =
        (&mut comparison.scale, comparison.rms_reflected, receivers.uniform_reflectance)
    {
        scale.name_by_reflectance(rho, rms.value);
    }
    let beside = Beside {
        before: before.as_ref(),
        baseline: question.baseline.as_ref(),
        objects: &objects,
        viewing: question.viewing.as_ref(),
    };
    let held = |limits| measure(solution, &truth, &judged, beside, limits, confidence, question.reflected);
    let measured = question.limits.as_ref().map(held).transpose()?;
    let decision = measured.map(|m| decide(&m));
    let seen = |v| look(solution, &truth, &judged, v, confidence);
    let as_seen = question.viewing.as_ref().map(seen).transpose()?.flatten();
    Ok(Judgement { comparison, decision, as_seen })
}

/// How the error of a solution is spread, for a report; intervals as in [`judge`].
pub fn break_down(
    solution: &Radiosity,
    reference: &Against,
    receivers: &Receivers,
    question: &Question,
) -> Result<Breakdown, JudgeError> {
    let truth = reference.truth(question.per_element)?;
    let (surfaces, objects) = (names(&receivers.surfaces), names(&receivers.objects));
    let judged = receivers.judged(&surfaces);
    let confidence = question.shared_confidence();
    Ok(metrics::break_down(solution, &truth, &judged, &objects, confidence, question.reflected)?)
}

fn names(all: &[String]) -> Vec<&str> {
    all.iter().map(String::as_str).collect()
}
