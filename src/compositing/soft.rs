//! Light that changes gently along a segment: evaluated where it must be, linear between.

/// Pixels between places that are always evaluated: under skies and where nothing throws a shadow, and where lamps do. What
/// is half as broad is not missed.
pub(super) const WIDE: f64 = 8.0;
pub(super) const NARROW: f64 = 1.0;

/// Segments up to this many pixels have one value.
const SHORT: f64 = 1.0;

/// Values along a segment of a sub-scanline.
pub(super) struct Along {
    bands: usize,
    places: Vec<f64>,
    values: Vec<f64>,
}

impl Along {
    /// The same value everywhere.
    pub(super) fn constant(from: f64, to: f64, value: &[f64]) -> Self {
        Self { bands: value.len(), places: vec![from, to], values: [value, value].concat() }
    }

    /// Evaluates `value` from `from` to `to` (`scale` pixels a unit), every `stride` pixels and between until it is linear within `tolerance` of the larger
    /// end, or half a pixel is reached.
    pub(super) fn new(
        from: f64,
        to: f64,
        scale: f64,
        bands: usize,
        (stride, tolerance): (f64, f64),
        value: impl FnMut(f64, &mut [f64]),
    ) -> Self {
        let mut build =
            Build { along: Self { bands, places: Vec::new(), values: Vec::new() }, value, tolerance, scale };
        if (to - from) * scale <= SHORT {
            let middle = build.at(0.5 * (from + to));
            build.keep(&(from, middle.clone()));
            build.keep(&(to, middle));
            return build.along;
        }
        let pieces = ((to - from) * scale / stride).ceil().max(1.0) as usize;
        let mut left = (from, build.at(from));
        build.keep(&left);
        for k in 1..=pieces {
            let x = if k == pieces { to } else { from + (to - from) * k as f64 / pieces as f64 };
            let right = (x, build.at(x));
            build.between(&left, &right);
            build.keep(&right);
            left = right;
        }
        build.along
    }

    /// Adds the value at a place.
    pub(super) fn add_at(&self, x: f64, out: &mut [f64]) {
        let k = self.places.partition_point(|p| *p <= x).clamp(1, self.places.len() - 1);
        let (a, b) = (self.places[k - 1], self.places[k]);
        let t = if b > a { ((x - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
        let (va, vb) = (&self.values[(k - 1) * self.bands..k * self.bands], &self.values[k * self.bands..]);
        out.iter_mut().zip(va.iter().zip(vb)).for_each(|(o, (a, b))| *o += a + t * (b - a));
    }

    /// Number of evaluations.
    #[cfg(test)]
    fn len(&self) -> usize {
        self.places.len()
    }
}

struct Build<F> {
    along: Along,
    value: F,
    tolerance: f64,
    scale: f64,
}

type Node = (f64, Vec<f64>);

impl<F: FnMut(f64, &mut [f64])> Build<F> {
    fn at(&mut self, x: f64) -> Vec<f64> {
        let mut out = vec![0.0; self.along.bands];
        (self.value)(x, &mut out);
        out
    }

    fn keep(&mut self, node: &Node) {
        self.along.places.push(node.0);
        self.along.values.extend(&node.1);
    }

    fn between(&mut self, a: &Node, b: &Node) {
        if (b.0 - a.0) * self.scale <= 0.5 {
            return;
        }
        let x = 0.5 * (a.0 + b.0);
        let middle = (x, self.at(x));
        let bent = |k: usize| {
            let (l, m, r) = (a.1[k], middle.1[k], b.1[k]);
            (m - 0.5 * (l + r)).abs() > self.tolerance * l.max(r).max(m)
        };
        if (0..self.along.bands).any(bent) {
            self.between(a, &middle);
            self.keep(&middle);
            self.between(&middle, b);
        } else {
            self.keep(&middle);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_exact_and_cheap() {
        let along = Along::new(3.0, 35.0, 1.0, 1, (WIDE, 1e-3), |x, out| out[0] = 2.0 * x + 1.0);
        for x in [3.0, 3.3, 17.0, 34.9, 35.0] {
            let mut v = [0.0];
            along.add_at(x, &mut v);
            assert!((v[0] - (2.0 * x + 1.0)).abs() < 1e-12);
        }
        assert_eq!(along.len(), 9);
    }

    #[test]
    fn an_edge_is_found_to_half_a_pixel() {
        let along = Along::new(0.0, 64.0, 1.0, 1, (WIDE, 1e-3), |x, out| out[0] = f64::from(u8::from(x > 21.3)));
        let mut v = [0.0];
        along.add_at(20.7, &mut v);
        assert_eq!(v, [0.0]);
        v = [0.0];
        along.add_at(21.9, &mut v);
        assert_eq!(v, [1.0]);
    }

    #[test]
    fn thin_shadows_are_seen_wherever_they_fall() {
        for k in 0..400 {
            let middle = 5.0 + 0.037 * f64::from(k);
            let dip = |x: f64| 1.0 - 0.9 * (1.0 - (x - middle).abs()).max(0.0);
            let along = Along::new(0.0, 30.0, 1.0, 1, (NARROW, 1e-3), |x, out| out[0] = dip(x));
            let mut least = 1.0f64;
            for i in 0..600 {
                let mut v = [0.0];
                along.add_at(0.05 * f64::from(i), &mut v);
                least = least.min(v[0]);
            }
            assert!(least < 0.6, "a shadow of 2 pixels at {middle}: {least}");
        }
    }

    #[test]
    fn a_curve_is_within_tolerance() {
        let f = |x: f64| (0.1 * x).exp();
        let along = Along::new(0.0, 50.0, 1.0, 1, (WIDE, 1e-3), |x, out| out[0] = f(x));
        for k in 0..500 {
            let x = f64::from(k) * 0.1;
            let mut v = [0.0];
            along.add_at(x, &mut v);
            assert!((v[0] / f(x) - 1.0).abs() < 1.1e-3);
        }
    }
}
