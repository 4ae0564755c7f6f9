//! Bounces that are missing, or counted twice. A bounce is one reflection: bounce 1 is the direct light of the lamps,
//! reflected once.

use super::jury::{Hypothesis, Jury};
use super::quick::Quick;

/// Bounces up to which a sum may have been cut off.
const MOST: usize = 8;
/// Bounces looked at one by one.
const SINGLE: usize = 4;

/// What needs no matrix: nothing is reflected at all.
pub(super) fn hear_emission_alone(jury: &mut Jury) {
    let case = jury.case;
    let sentence = "no light is reflected: the values are the emission alone".to_string();
    say(jury, "missing-bounces", sentence, case.everywhere(|k| case.emission[k] - case.truth[k]));
}

pub(super) fn hear(jury: &mut Jury, quick: &Quick) {
    let case = jury.case;
    // What is left beyond k bounces: `B - E` beyond none, and each reflected once more. Only the light that has been
    // reflected goes through the matrix, so its noise is small.
    let mut beyond = vec![case.everywhere(|k| case.truth[k] - case.emission[k])];
    for k in 0..MOST {
        beyond.push(quick.reflected(&beyond[k]));
    }
    for (k, rest) in beyond.iter().enumerate().skip(1) {
        let sentence = match k {
            1 => "only direct light: bounces after the first are missing".to_string(),
            _ => format!("bounces are missing: the solution is the sum of {k}"),
        };
        say(jury, "missing-bounces", sentence, rest.iter().map(|b| -b).collect());
    }
    let bounce = |k: usize| -> Vec<f64> { beyond[k - 1].iter().zip(&beyond[k]).map(|(a, b)| a - b).collect() };
    for k in 1..=SINGLE {
        let one = bounce(k);
        let missing = one.iter().map(|b| -b).collect();
        say(jury, "one-bounce-missing", format!("bounce {k} alone is missing"), missing);
        say(jury, "bounce-twice", format!("bounce {k} is counted twice"), one);
    }
    for k in 1..=MOST {
        let doubled = bounce(k).iter().zip(&beyond[k]).map(|(b, rest)| b - rest).collect();
        let sentence = format!("the solution is the sum of {k} bounces, the last of them counted twice");
        say(jury, "last-bounce-twice", sentence, doubled);
    }
}

fn say(jury: &mut Jury, kind: &'static str, sentence: String, change: Vec<f64>) {
    jury.hear(Hypothesis { family: "bounces", kind, place: None, parameters: 0, sentence, partly: true }, change);
}
