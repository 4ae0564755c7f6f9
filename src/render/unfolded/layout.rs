//! Where pixels and points of faces lie on the cross, in pixels of the hemi-cube from its upper left corner.

/// The cross of a hemi-cube: 2N x 2N cells, of which the corners are empty.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    n: usize,
}

impl Layout {
    pub fn new(resolution: usize) -> Self {
        Self { n: resolution }
    }

    /// (face, number of the pixel on it) in a cell of the cross; `None` in its empty corners.
    pub fn pixel(self, x: usize, y: usize) -> Option<(usize, usize)> {
        let (n, half) = (self.n, self.n / 2);
        // Column and row of the top, where the cell lies beside, above or below it too.
        let column = (x >= half).then(|| x - half).filter(|c| *c < n);
        let row = (y >= half).then(|| y - half).filter(|r| *r < n).map(|r| n - 1 - r);
        let at = |face: usize, column: usize, row: usize| Some((face, row * n + column));
        match (column, row) {
            (Some(c), Some(r)) => at(0, c, r),
            (None, Some(r)) if x >= half => at(1, r, 2 * n - 1 - x),
            (None, Some(r)) => at(3, n - 1 - r, x),
            (Some(c), None) if y < half => at(2, n - 1 - c, y),
            (Some(c), None) => at(4, c, 2 * n - 1 - y),
            (None, None) => None,
        }
    }

    /// Where a point (u, v) of a face lies.
    pub fn point(self, face: usize, [u, v]: [f64; 2]) -> [f64; 2] {
        let down = 2.0 - v;
        let (x, y) = match face {
            0 => (u, v),
            1 => (down, u),
            2 => (-u, down),
            3 => (-down, -u),
            _ => (u, -down),
        };
        [x + 2.0, 2.0 - y].map(|c| c * self.n as f64 / 2.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_and_points_agree_and_every_pixel_has_one_cell() {
        let n = 6;
        let layout = Layout::new(n);
        let mut seen = vec![0; 5 * n * n];
        for (x, y) in (0..2 * n).flat_map(|x| (0..2 * n).map(move |y| (x, y))) {
            let Some((face, k)) = layout.pixel(x, y) else { continue };
            seen[face * n * n + k] += 1;
            let start = if face == 0 { -1.0 } else { 0.0 };
            let centre = |k: usize, start: f64| start + (k as f64 + 0.5) * 2.0 / n as f64;
            let p = layout.point(face, [centre(k % n, -1.0), centre(k / n, start)]);
            assert!((p[0] - x as f64 - 0.5).abs() < 1e-12 && (p[1] - y as f64 - 0.5).abs() < 1e-12, "{face} {k}");
        }
        let full = |face: usize, pixels: usize| seen[face * n * n..][..pixels].iter().all(|c| *c == 1);
        assert!(full(0, n * n) && (1..5).all(|f| full(f, n * n / 2)));
        assert_eq!(seen.iter().sum::<usize>(), 3 * n * n);
    }
}
