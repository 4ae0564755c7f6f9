//! Values that went through a curve, and bands in another order.

use super::jury::{Hypothesis, Jury};

/// Bands up to which every order is tried.
const MOST_BANDS: usize = 4;

pub(super) fn hear(jury: &mut Jury) {
    curves(jury);
    orders(jury);
    grey(jury);
}

/// The transfer function of IEC 61966-2-1, continued beyond 1.
fn encode(x: f64) -> f64 {
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

/// Its inverse.
fn decode(x: f64) -> f64 {
    if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

fn curves(jury: &mut Jury) {
    type Curve = fn(f64) -> f64;
    let known: [(&str, &str, Curve); 8] = [
        ("srgb", "the values are sRGB-encoded instead of linear", encode),
        ("srgb", "the values are sRGB-encoded instead of linear, and cut off at 1", |x| encode(x.clamp(0.0, 1.0))),
        ("srgb-decoded", "the values went through the sRGB decoding, though they were linear", decode),
        (
            "srgb-decoded",
            "the values were cut off at 1 and went through the sRGB decoding, though they were linear",
            |x| decode(x.clamp(0.0, 1.0)),
        ),
        ("gamma", "the values are gamma-encoded (power 1/2.2) instead of linear", |x| x.max(0.0).powf(1.0 / 2.2)),
        ("gamma", "the values are gamma-encoded (power 1/2.2) instead of linear, and cut off at 1", |x| {
            x.clamp(0.0, 1.0).powf(1.0 / 2.2)
        }),
        ("gamma-decoded", "the values went through a gamma of 2.2, though they were linear", |x| x.max(0.0).powf(2.2)),
        ("clipped", "the values are cut off at 1", |x| x.min(1.0)),
    ];
    let case = jury.case;
    for (kind, sentence, curve) in known {
        let change = case.everywhere(|k| curve(case.truth[k]) - case.truth[k]);
        let sentence = sentence.to_string();
        jury.hear(Hypothesis { family: "encoding", kind, place: None, parameters: 0, sentence, partly: true }, change);
    }
}

fn orders(jury: &mut Jury) {
    let case = jury.case;
    if !(2..=MOST_BANDS).contains(&case.bands) {
        return;
    }
    let names = &case.stage.photometry.bands;
    for order in permutations(case.bands).into_iter().skip(1) {
        let of = |k: usize| case.truth[k - k % case.bands + order[k % case.bands]];
        let change = case.everywhere(|k| of(k) - case.truth[k]);
        let given: Vec<&str> = order.iter().map(|c| names[*c].as_str()).collect();
        let sentence =
            format!("the bands are in another order: {} where {} is expected", given.join(", "), names.join(", "));
        jury.hear(
            Hypothesis { family: "bands", kind: "bands-swapped", place: None, parameters: 0, sentence, partly: true },
            change,
        );
    }
}

/// All bands alike: their mean, or the luminance.
fn grey(jury: &mut Jury) {
    let case = jury.case;
    if case.bands < 2 {
        return;
    }
    let of = |k: usize| &case.truth[k - k % case.bands..][..case.bands];
    let mean = case.everywhere(|k| of(k).iter().sum::<f64>() / case.bands as f64 - case.truth[k]);
    let luminance = case.everywhere(|k| case.stage.photometry.luminance(of(k)) - case.truth[k]);
    for (change, what) in [(mean, "the mean of the bands"), (luminance, "the luminance")] {
        let sentence = format!("every band holds {what}");
        jury.hear(
            Hypothesis { family: "bands", kind: "bands-alike", place: None, parameters: 0, sentence, partly: true },
            change,
        );
    }
}

/// All orders of `0 .. n`, the plain one first.
fn permutations(n: usize) -> Vec<Vec<usize>> {
    if n == 0 {
        return vec![Vec::new()];
    }
    let mut all = Vec::new();
    for first in 0..n {
        for rest in permutations(n - 1) {
            let others = rest.iter().map(|k| if *k < first { *k } else { *k + 1 });
            all.push(std::iter::once(first).chain(others).collect());
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plain_order_comes_first_and_none_twice() {
        let all = permutations(3);
        assert_eq!(all[0], [0, 1, 2]);
        let mut sorted = all.clone();
        sorted.dedup();
        assert_eq!(sorted.len(), 6);
    }

    #[test]
    fn decoding_undoes_encoding() {
        for x in [0.0, 0.001, 0.0031308, 0.2, 1.0, 5.0] {
            assert!((decode(encode(x)) - x).abs() < 1e-6 * (1.0 + x), "{x}");
        }
    }
}
