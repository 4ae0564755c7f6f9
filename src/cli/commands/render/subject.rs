//! What is shown: a scene at its state with the radiosities of its patches or elements.

use crate::cli::args::RenderArgs;
use crate::cli::commands::lit;
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::values::PerLevel;
use crate::io::is_reference;
use crate::scene::Stage;
use crate::solution::Radiosity;
use crate::study::Receivers;
use crate::view::Viewer;
use std::path::Path;

/// A scene with what is shown of it.
#[derive(Clone)]
pub(super) struct Subject {
    /// The scene at its state.
    pub stage: Stage,
    /// Patches or elements.
    pub receivers: Receivers,
    /// True if values belong to elements.
    pub per_element: bool,
    /// What is shown; `None` for the patches alone.
    pub radiosity: Option<Radiosity>,
    /// What the exposure is fitted to where it is not what is shown: the reference.
    pub yardstick: Option<Radiosity>,
    /// Where the radiosities come from.
    pub name: String,
}

impl Subject {
    /// Reads the scene, and unless `bare` the radiosities.
    pub(super) fn read(args: &RenderArgs, bare: bool, console: &Console) -> Result<Self, Failure> {
        let per_element = args.per == PerLevel::Element;
        let source = Path::new(&args.scene);
        let reference = match is_reference(source) {
            true => Some(lit::reference(source, args.state, args.max_edge, console)?),
            false => None,
        };
        let stage = match &reference {
            Some(r) => r.stage.clone(),
            None => lit::scene(&args.scene, args.state, args.max_edge, console)?,
        };
        let receivers = if per_element { Receivers::elements(&stage) } else { Receivers::patches(&stage) };
        let own = reference.as_ref().map(|r| lit::means(r, source, per_element)).transpose()?;
        let given = args.solution.as_deref().map(|p| lit::solution(p, &stage, &receivers, per_element)).transpose()?;
        if own.is_none() && given.is_none() && !bare {
            return Err(Failure::input(format!(
                "{0} says what stands there, not how bright it is: give --solution FILE (from `etalon solve {0} \
                 --method gather -o FILE`), name a reference directory instead, or ask for --style items",
                args.scene
            ))
            .at(args.scene.clone()));
        }
        let name = args.solution.as_ref().map_or_else(|| args.scene.clone(), |p| p.display().to_string());
        let (radiosity, yardstick) = if given.is_some() { (given, own) } else { (own, None) };
        let subject = Self { stage, receivers, per_element, radiosity, yardstick, name };
        match args.lamp.as_slice() {
            [lamp] => subject.lit(lamp.0, args.viewing.efficacy.0),
            _ => Ok(subject),
        }
    }

    /// The same with all light times the factor that gives the brightest lamp this luminance, cd/m^2.
    pub(super) fn lit(&self, luminance: f64, efficacy: f64) -> Result<Self, Failure> {
        let bands = self.receivers.photometry.bands.len();
        let brightest = (0..self.receivers.areas.len())
            .filter(|i| self.receivers.areas[*i] > 0.0)
            .map(|i| self.receivers.photometry.luminance(&self.receivers.emission[i * bands..(i + 1) * bands]))
            .fold(0.0, f64::max);
        if brightest <= 0.0 {
            return Err(Failure::input("--lamp: nothing in this scene emits light; leave it out"));
        }
        let factor = luminance / Viewer::luminance_of(efficacy, brightest);
        let mut lit = self.clone();
        for b in lit.radiosity.iter_mut().chain(&mut lit.yardstick) {
            b.values.iter_mut().chain(b.std_err.iter_mut().flatten()).for_each(|x| *x *= factor);
        }
        Ok(lit)
    }
}
