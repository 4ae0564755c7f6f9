//! One of several lamps off, or too bright.

use super::jury::{Hypothesis, Jury};
use super::quick::Quick;
use super::words::{digits, too_bright};
use crate::scene::Material;

/// Emitting materials looked at.
const MOST: usize = 24;
/// A lamp that gives less than this share of its light is off.
const OFF: f64 = 0.02;

pub(super) fn hear(jury: &mut Jury, quick: &Quick) {
    let case = jury.case;
    let emits = |m: &&(u32, &Material)| m.1.emission.iter().any(|e| *e > 0.0);
    let all: Vec<(u32, &Material)> = (0..).zip(&case.stage.materials).collect();
    let lamps: Vec<&(u32, &Material)> = all.iter().filter(emits).take(MOST).collect();
    // With one lamp it is everything that is too bright.
    if lamps.len() < 2 {
        return;
    }
    for (number, material) in lamps {
        let own = |k: usize| case.stage.patches[k / case.bands].material == *number;
        let source = case.everywhere(|k| if own(k) { case.emission[k] } else { 0.0 });
        let Some(light) = quick.spread(&source) else { continue };
        let factor = 1.0 + case.amount(&light);
        let name = &material.name;
        let (kind, parameters, factor, sentence) = if factor.abs() < OFF {
            ("lamp-off", 0, 0.0, format!("the lamps of material \"{name}\" are off"))
        } else {
            let words = format!("the lamps of material \"{name}\" are {}", too_bright(factor));
            ("lamp", 1, factor, format!("{words} (emission times {})", digits(factor)))
        };
        if factor < 0.0 {
            continue;
        }
        let change = light.iter().map(|b| (factor - 1.0) * b).collect();
        let place = Some(name.clone());
        jury.hear(Hypothesis { family: "lamp", kind, place, parameters, sentence, partly: false }, change);
    }
}
