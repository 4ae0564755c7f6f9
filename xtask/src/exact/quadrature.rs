//! Adaptive integration in one dimension by the pair of rules of Gauss (7 points) and Kronrod (15 points).

/// A value and what its error is estimated to be at most.
#[derive(Clone, Copy, Debug, Default)]
pub struct Integral {
    pub value: f64,
    pub error: f64,
}

const NODES: [f64; 8] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_5,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
    0.0,
];
const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_56,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_82,
];
const GAUSS: [f64; 4] =
    [0.129_484_966_168_869_7, 0.279_705_391_489_276_64, 0.381_830_050_505_118_9, 0.417_959_183_673_469_4];

const DEEPEST: usize = 40;

/// The integral over the intervals between neighbouring `breaks` (ascending): halves an interval until the two rules
/// differ by less than `tolerance` there.
pub fn integrate(breaks: &[f64], tolerance: f64, f: &mut impl FnMut(f64) -> f64) -> Integral {
    let mut sum = Integral::default();
    for pair in breaks.windows(2) {
        let part = on_interval(pair[0], pair[1], tolerance, DEEPEST, f);
        sum.value += part.value;
        sum.error += part.error;
    }
    sum
}

fn on_interval(a: f64, b: f64, tolerance: f64, depth: usize, f: &mut impl FnMut(f64) -> f64) -> Integral {
    let whole = rules(a, b, f);
    if whole.error <= tolerance || depth == 0 {
        return whole;
    }
    let middle = 0.5 * (a + b);
    let left = on_interval(a, middle, tolerance, depth - 1, f);
    let right = on_interval(middle, b, tolerance, depth - 1, f);
    Integral { value: left.value + right.value, error: left.error + right.error }
}

fn rules(a: f64, b: f64, f: &mut impl FnMut(f64) -> f64) -> Integral {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let centre = f(middle);
    let (mut kronrod, mut gauss) = (KRONROD[7] * centre, GAUSS[3] * centre);
    for k in 0..7 {
        let both = f(middle - half * NODES[k]) + f(middle + half * NODES[k]);
        kronrod += KRONROD[k] * both;
        if k % 2 == 1 {
            gauss += GAUSS[k / 2] * both;
        }
    }
    Integral { value: kronrod * half, error: (kronrod - gauss).abs() * half }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_degree_22_are_exact_and_kinks_are_found() {
        let power = rules(0.0, 1.0, &mut |x: f64| x.powi(22));
        assert!((power.value - 1.0 / 23.0).abs() < 1e-15);
        let kink = integrate(&[0.0, 1.0], 1e-13, &mut |x: f64| (x - 0.3).abs());
        assert!((kink.value - (0.09 + 0.49) / 2.0).abs() < 1e-12);
    }
}
