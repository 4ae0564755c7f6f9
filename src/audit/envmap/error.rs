//! Relative errors over many places, with what is known of them from replicates.

use crate::stats::{Estimate, jackknife_interval, two_sided_t};

/// Differences of one quantity, place by place and replicate by replicate, each place of the same weight.
pub type Weighted = [Vec<f64>];

/// Groups of places that are left out in turn.
const GROUPS: usize = 16;

/// `sqrt(sum d^2 / sum t^2)` over places: `d[k][r]` the difference at place k in replicate r, `t` what it is held
/// against. Squares of means, without the noise in them: products of different replicates only.
///
/// The interval holds both what rays leave open (jackknife over replicates) and that these places stand for all others
/// (jackknife over 16 groups of places, every 16th in one), in quadrature, by Student t with the fewer degrees of freedom.
/// What lies below 0 before the root is 0. `None` where there are fewer than three places or replicates, or no light.
pub fn relative_error(d: &Weighted, t: &Weighted, confidence: f64) -> Option<Estimate> {
    let (places, count) = (d.len(), d.first()?.len());
    let groups = places.min(GROUPS);
    let ratio = |without: Without| {
        let light = squared(t, without).filter(|t| *t > 0.0)?;
        Some(squared(d, without)? / light)
    };
    let all = ratio(Without::Nothing)?;
    let by_replicate: Option<Vec<f64>> = (0..count).map(|r| ratio(Without::Replicate(r))).collect();
    let by_place: Option<Vec<f64>> = (0..groups).map(|g| ratio(Without::Places(g, groups))).collect();
    if groups < 3 {
        return None;
    }
    let error = |left_out: Vec<f64>| jackknife_interval(all, &left_out, confidence).std_err;
    let (rays, chosen) = (error(by_replicate?)?, error(by_place?)?);
    let std_err = rays.hypot(chosen);
    let half = two_sided_t(confidence, groups.min(count) as f64 - 1.0) * std_err;
    let root = |x: f64| x.max(0.0).sqrt();
    let value = root(all);
    let of_root = if value > 0.0 { std_err / (2.0 * value) } else { root(std_err) };
    Some(Estimate { value, std_err: Some(of_root), low: root(all - half), high: root(all + half) })
}

/// `sum a d / sum t^2` likewise, where `d` is one part of a whole difference `a`: the shares of parts that add up to `a`
/// add up to the square of its relative error.
pub fn weighted_share(a: &Weighted, d: &Weighted, t: &Weighted) -> Option<f64> {
    let n = d.first()?.len() as f64;
    let cross = |a: &[f64], d: &[f64]| {
        let (sa, sd) = (a.iter().sum::<f64>(), d.iter().sum::<f64>());
        (sa * sd - a.iter().zip(d).map(|(a, d)| a * d).sum::<f64>()) / (n * (n - 1.0))
    };
    let sum: f64 = a.iter().zip(d).map(|(a, d)| cross(a, d)).sum();
    (n > 1.0).then(|| sum / squared(t, Without::Nothing).unwrap_or(f64::NAN)).filter(|x| x.is_finite())
}

/// What is left out of a sum.
#[derive(Debug, Clone, Copy)]
enum Without {
    Nothing,
    Replicate(usize),
    /// Every n-th place from the g-th on.
    Places(usize, usize),
}

/// Sum over places of the squared mean, its noise taken out.
fn squared(d: &Weighted, without: Without) -> Option<f64> {
    let replicate = if let Without::Replicate(r) = without { Some(r) } else { None };
    let n = d.first()?.len() as f64 - if replicate.is_some() { 1.0 } else { 0.0 };
    let of = |(k, v): (usize, &Vec<f64>)| {
        if matches!(without, Without::Places(g, groups) if k % groups == g) {
            return 0.0;
        }
        let out = replicate.map_or(0.0, |r| v[r]);
        let sum = v.iter().sum::<f64>() - out;
        (sum * sum - (v.iter().map(|x| x * x).sum::<f64>() - out * out)) / (n * (n - 1.0))
    };
    (n > 1.0).then(|| d.iter().enumerate().map(of).sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{Role, Stream};

    /// Differences of 3 % under noise ten times as large: the noise is taken out, and 95 % intervals hold the truth.
    #[test]
    fn noise_is_no_error() {
        let (places, replicates, runs) = (60, 16, 400);
        let (mut held, mut mean) = (0, 0.0);
        for run in 0..runs {
            let stream = Stream::new(Role::Witness, run);
            let noise = |k: usize, r: usize, c: u64| {
                let s = stream.child(k as u64).child(r as u64).child(c);
                (0..4).map(|i| s.unit(i) - 0.5).sum::<f64>() * 3f64.sqrt()
            };
            let d: Vec<Vec<f64>> =
                (0..places).map(|k| (0..replicates).map(|r| 0.03 + 0.3 * noise(k, r, 0)).collect()).collect();
            let t: Vec<Vec<f64>> =
                (0..places).map(|k| (0..replicates).map(|r| 1.0 + 0.01 * noise(k, r, 1)).collect()).collect();
            let e = relative_error(&d, &t, 0.95).expect("light");
            held += usize::from(e.low <= 0.03 && 0.03 <= e.high);
            mean += (e.value * e.value) / runs as f64;
        }
        // 20 of 400 misses expected; 40 are four standard deviations and more away.
        assert!(held >= 360, "{held}");
        // Cut off at 0, squares are a little too large.
        assert!(mean > 0.0008 && mean < 0.0016, "{mean}");
    }

    /// Differences that change from place to place, known exactly at each: the interval holds what all places have.
    #[test]
    fn places_stand_for_others() {
        let mut held = 0;
        for run in 0..400 {
            let stream = Stream::new(Role::Witness, 1000 + run);
            // Uniform from -0.1 to 0.1: a mean square of 0.01 / 3.
            let d: Vec<Vec<f64>> = (0..64).map(|k| vec![0.2 * (stream.unit(k) - 0.5); 8]).collect();
            let e = relative_error(&d, &vec![vec![1.0; 8]; 64], 0.95).expect("light");
            let truth = (0.01f64 / 3.0).sqrt();
            held += usize::from(e.low <= truth && truth <= e.high);
        }
        // 20 misses expected of 400; more than 40 by chance in less than one of 10^4.
        assert!(held >= 360, "{held}");
    }

    #[test]
    fn parts_share_the_whole() {
        let t = vec![vec![2.0; 3]; 3];
        let (a, b) = (vec![vec![0.1; 3]; 3], vec![vec![-0.3; 3]; 3]);
        let whole: Vec<Vec<f64>> =
            a.iter().zip(&b).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a + b).collect()).collect();
        let e = relative_error(&whole, &t, 0.95).expect("light").value;
        let shares = weighted_share(&whole, &a, &t).expect("a") + weighted_share(&whole, &b, &t).expect("b");
        assert!((e - 0.1).abs() < 1e-12 && (shares - e * e).abs() < 1e-12);
        assert_eq!(relative_error(&[], &[], 0.95), None);
        assert_eq!(relative_error(&a, &vec![vec![0.0; 3]; 3], 0.95), None);
    }
}
