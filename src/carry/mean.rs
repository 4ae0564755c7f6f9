//! Mean and spread of a function over an area.

/// Integrals of a function and of its square, per band, counted from one of its own values: what is the same
/// everywhere has that very value as its mean, and no spread.
#[derive(Debug, Clone)]
pub(super) struct Mean {
    base: Option<Vec<f64>>,
    /// Area, m^2.
    pub weight: f64,
    first: Vec<f64>,
    second: Vec<f64>,
}

impl Mean {
    pub fn new(bands: usize) -> Self {
        Self { base: None, weight: 0.0, first: vec![0.0; bands], second: vec![0.0; bands] }
    }

    /// Adds a function that is linear on a triangle of this area, by its values at the corners.
    pub fn add_triangle(&mut self, area: f64, corners: [&[f64]; 3]) {
        self.add(area, corners[0], |band, base| {
            let [a, b, c] = corners.map(|v| v[band] - base);
            ((a + b + c) / 3.0, (a * a + b * b + c * c + a * b + b * c + c * a) / 6.0)
        });
    }

    /// Adds one value that stands for this area.
    pub fn add_point(&mut self, area: f64, values: &[f64]) {
        self.add(area, values, |band, base| (values[band] - base, (values[band] - base).powi(2)));
    }

    fn add(&mut self, area: f64, any: &[f64], moments: impl Fn(usize, f64) -> (f64, f64)) {
        let base = self.base.get_or_insert_with(|| any.to_vec());
        self.weight += area;
        for (band, base) in base.iter().enumerate() {
            let (first, second) = moments(band, *base);
            self.first[band] += area * first;
            self.second[band] += area * second;
        }
    }

    /// Mean and standard deviation over the area, per band; `None` where there is no area.
    pub fn result(&self) -> Option<(Vec<f64>, Vec<f64>)> {
        let base = self.base.as_ref().filter(|_| self.weight > 0.0)?;
        let mean = base.iter().zip(&self.first).map(|(b, f)| b + f / self.weight).collect();
        let moments = self.first.iter().zip(&self.second);
        let spread = moments.map(|(f, s)| (s / self.weight - (f / self.weight).powi(2)).max(0.0).sqrt()).collect();
        Some((mean, spread))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_has_its_mean_and_the_spread_of_a_slope() {
        // x over the unit square, as two triangles: mean 1/2, variance 1/12.
        let mut m = Mean::new(1);
        m.add_triangle(0.5, [&[0.0], &[1.0], &[1.0]]);
        m.add_triangle(0.5, [&[0.0], &[1.0], &[0.0]]);
        let (mean, spread) = m.result().unwrap();
        assert!((mean[0] - 0.5).abs() < 1e-15 && (spread[0] - (1.0f64 / 12.0).sqrt()).abs() < 1e-15);
    }

    #[test]
    fn what_is_the_same_everywhere_keeps_its_bits_and_nothing_has_no_mean() {
        let mut m = Mean::new(1);
        (0..7).for_each(|k| m.add_point(0.1 + f64::from(k), &[0.1]));
        assert_eq!(m.result().unwrap(), (vec![0.1], vec![0.0]));
        assert!(Mean::new(1).result().is_none());
    }
}
