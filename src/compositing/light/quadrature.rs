//! Gauss-Legendre rules.

use std::sync::LazyLock;

/// Nodes on 0..1 and weights.
pub(super) type Rule = Vec<(f64, f64)>;

/// Three points: short arcs of the sky.
pub(super) static THREE: LazyLock<Rule> = LazyLock::new(|| rule(3));

/// Six points: arcs of the sky.
pub(super) static SIX: LazyLock<Rule> = LazyLock::new(|| rule(6));

/// For the whole sky: 24 points in x = u^2 (3 - 2 u), crowded at both ends. Tips and steep ends there do no harm.
pub(super) static WHOLE_SKY: LazyLock<Rule> =
    LazyLock::new(|| rule(24).into_iter().map(|(u, w)| (u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u) * w)).collect());

/// Zeros of the Legendre polynomial by Newton's iteration.
pub(super) fn rule(n: usize) -> Rule {
    let node = |i: usize| {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..9 {
            let (mut last, mut value) = (1.0, x);
            for k in 2..=n {
                let k = k as f64;
                (last, value) = (value, x * value + (k - 1.0) / k * (x * value - last));
            }
            slope = n as f64 * (last - x * value) / (1.0 - x * x);
            x -= value / slope;
        }
        (0.5 - 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn powers_come_out_exactly() {
        for n in [3, 6, 24] {
            for power in 0..2 * n as i32 {
                let sum: f64 = super::rule(n).iter().map(|(x, w)| w * x.powi(power)).sum();
                assert!((sum * f64::from(power + 1) - 1.0).abs() < 1e-13, "{n} {power}");
            }
        }
    }
}
