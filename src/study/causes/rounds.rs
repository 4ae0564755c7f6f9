//! A Gauss-Seidel iteration that was stopped early. (Jacobi's, begun at the emission, is a sum of bounces.)

use super::jury::{Hypothesis, Jury};
use super::quick::Quick;

/// Rounds looked at.
const MOST: usize = 6;

pub(super) fn hear(jury: &mut Jury, quick: &Quick) {
    let case = jury.case;
    // The error of an iteration is iterated like the solution, without a source; at the start it is `B - E`.
    let mut error = case.everywhere(|k| case.truth[k] - case.emission[k]);
    for round in 1..=MOST {
        sweep(quick, &mut error);
        let plural = if round == 1 { "" } else { "s" };
        let sentence = format!("not converged: the state of a Gauss-Seidel iteration after {round} round{plural}");
        let change = error.iter().map(|e| -e).collect();
        let hypothesis = Hypothesis {
            family: "bounces",
            kind: "not-converged",
            place: None,
            parameters: 0,
            sentence,
            partly: false,
        };
        jury.hear(hypothesis, change);
    }
}

/// One round over all patches in their order, in place.
fn sweep(quick: &Quick, error: &mut [f64]) {
    let case = quick.case;
    let mut arriving = vec![0.0; case.bands];
    for i in 0..case.areas.len() {
        arriving.fill(0.0);
        let mut own = 0.0;
        for (j, f) in quick.matrix.row(i) {
            if i == j {
                own = f;
                continue;
            }
            arriving.iter_mut().zip(&error[j * case.bands..]).for_each(|(a, e)| *a += f * e);
        }
        for (c, a) in arriving.iter().enumerate() {
            let k = i * case.bands + c;
            let rho = case.reflectance[k];
            error[k] = rho * a / (1.0 - rho * own);
        }
    }
}
