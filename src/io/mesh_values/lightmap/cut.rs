//! Polygons in a picture cut along the borders of texels, and the way back into space.

use crate::math::{DVec3, area, clip_to_half_space};

/// Share of a polygon's area below which a piece is rounding dust.
const DUST: f64 = 1e-12;
/// How far a corner may be off the map of the others, as a share of the polygon's size.
const OFF: f64 = 1e-9;

/// The affine map from a picture to the plane of a face.
pub(super) struct Chart {
    origin: DVec3,
    corner: DVec3,
    along_x: DVec3,
    along_y: DVec3,
}

impl Chart {
    /// The map that takes three points of the picture (z = 0) to three corners; `None` if they lie on a line.
    pub(super) fn of(flat: [DVec3; 3], corners: [DVec3; 3]) -> Option<Self> {
        let (a, b) = (flat[1] - flat[0], flat[2] - flat[0]);
        let (p, q) = (corners[1] - corners[0], corners[2] - corners[0]);
        let det = a.x * b.y - a.y * b.x;
        let size = a.length_squared().max(b.length_squared());
        if det.abs() <= DUST * size || size == 0.0 {
            return None;
        }
        let along_x = (p * b.y - q * a.y) / det;
        let along_y = (q * a.x - p * b.x) / det;
        Some(Self { origin: flat[0], corner: corners[0], along_x, along_y })
    }

    /// The same for all corners of a polygon; `None` if they do not follow one map.
    pub(super) fn of_polygon(flat: &[DVec3], corners: &[DVec3]) -> Option<Self> {
        let chart = Self::of([flat[0], flat[1], flat[2]], [corners[0], corners[1], corners[2]])?;
        let size = corners.iter().map(|c| c.distance(corners[0])).fold(0.0, f64::max);
        let follows = |(f, c): (&DVec3, &DVec3)| chart.at(*f).distance(*c) <= OFF * size;
        flat.iter().zip(corners).all(follows).then_some(chart)
    }

    /// The point of the face at a point of the picture.
    pub(super) fn at(&self, p: DVec3) -> DVec3 {
        let d = p - self.origin;
        self.corner + self.along_x * d.x + self.along_y * d.y
    }
}

/// Cuts a convex polygon (texels, z = 0) and hands over column, row and corners of each piece, as long as `piece`
/// returns true. Returns whether it came to the end.
pub(super) fn by_texels(polygon: &[DVec3], mut piece: impl FnMut(usize, usize, Vec<DVec3>) -> bool) -> bool {
    let dust = DUST * area(polygon);
    for row in cells(polygon, |p| p.y) {
        let strip = between(polygon, DVec3::Y, row);
        if strip.len() < 3 || area(&strip) <= dust {
            continue;
        }
        for column in cells(&strip, |p| p.x) {
            let part = between(&strip, DVec3::X, column);
            if part.len() >= 3 && area(&part) > dust && !piece(column, row, part) {
                return false;
            }
        }
    }
    true
}

/// Cells of unit length that a polygon reaches into.
fn cells(polygon: &[DVec3], along: impl Fn(&DVec3) -> f64) -> std::ops::Range<usize> {
    let (low, high) = polygon.iter().map(along).fold((f64::MAX, 0.0f64), |(l, h), x| (l.min(x), h.max(x)));
    low.max(0.0).floor() as usize..high.ceil() as usize
}

fn between(polygon: &[DVec3], axis: DVec3, cell: usize) -> Vec<DVec3> {
    let part = clip_to_half_space(polygon, axis, cell as f64);
    clip_to_half_space(&part, -axis, -(cell as f64 + 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn p(x: f64, y: f64) -> DVec3 {
        DVec3::new(x, y, 0.0)
    }

    #[test]
    fn pieces_make_up_the_whole_and_stay_within_their_texels() {
        let t = [p(0.3, 0.2), p(6.7, 1.9), p(2.1, 5.4)];
        let corners = [DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 2.5, 3.0), DVec3::new(1.0, 5.0, 7.0)];
        let chart = Chart::of(t, corners).unwrap();
        let (mut sum, mut flat, mut count) = (0.0, 0.0, 0);
        assert!(by_texels(&t, |column, row, piece| {
            for q in &piece {
                assert!(
                    (q.x - column as f64 - 0.5).abs() < 0.5 + 1e-12 && (q.y - row as f64 - 0.5).abs() < 0.5 + 1e-12
                );
            }
            flat += area(&piece);
            sum += area(&piece.iter().map(|q| chart.at(*q)).collect::<Vec<_>>());
            count += 1;
            true
        }));
        assert!((flat - area(&t)).abs() < 1e-12 && count > 15, "{flat} {count}");
        assert!((sum - area(&corners)).abs() < 1e-12 * sum, "{sum}");
    }

    #[test]
    fn borders_of_texels_leave_no_dust() {
        let square = [p(1.0, 1.0), p(3.0, 1.0), p(3.0, 2.0), p(1.0, 2.0)];
        let mut seen = Vec::new();
        by_texels(&square, |column, row, _| {
            seen.push((column, row));
            true
        });
        assert_eq!(seen, [(1, 1), (2, 1)]);
        assert!(Chart::of([p(0.0, 0.0), p(1.0, 1.0), p(2.0, 2.0)], [DVec3::ZERO, DVec3::X, DVec3::Y]).is_none());
    }
}
