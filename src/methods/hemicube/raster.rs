//! Scan conversion of projected polygons into a depth buffer and an item buffer.
//!
//! Pixels are half-open: a pixel belongs to a polygon if its centre does, and a centre that lies on an edge
//! belongs to the polygon towards larger column and row. Polygons that share an edge thus share no pixel and
//! lose none. Depth is 1 / depth in f64, linear on the face.

use super::project::{Projected, Projection};
use std::ops::Range;

/// Positions within this many pixels of a pixel centre are taken to be on it. Two surfaces compute the edge they
/// share with different rounding (about 1e-13 pixels); a centre on that edge must not fall between them.
const ON_CENTRE: f64 = 1.0 / (1u64 << 25) as f64;

/// Surfaces whose distances differ by less than this fraction coincide: the one drawn first stays.
const COINCIDENT: f64 = 1e-9;

/// What is seen at a pixel: a patch from its front, a back, or nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Item(u32);

impl Item {
    /// Nothing there: an open scene.
    pub const NOTHING: Item = Item(u32::MAX);
    /// The back of some polygon: black and opaque.
    pub const BACK: Item = Item(u32::MAX - 1);

    /// The front of a patch.
    pub fn patch(number: u32) -> Self {
        Item(number)
    }

    /// Number of the patch seen from its front, if it is one.
    pub fn as_patch(self) -> Option<u32> {
        (self < Item::BACK).then_some(self.0)
    }
}

/// Pixels whose depths are held at once: a quarter of a megabyte, which stays in the processor's cache. A face with
/// more is drawn in bands of rows.
const BAND_PIXELS: usize = 1 << 15;

/// Items of one face, and depths of the band of rows at hand.
#[derive(Debug, Default)]
pub(super) struct Raster {
    width: usize,
    height: usize,
    /// Depths of the rows from `band_start` on.
    nearness: Vec<f64>,
    band_start: usize,
    items: Vec<Item>,
    /// First and one-past-last column of the polygon at hand, per row.
    spans: Vec<[i32; 2]>,
    /// Column numbers, which cost more to convert than to read.
    columns: Vec<f64>,
    /// Polygons that hold pixel centres, and their rows.
    large: Vec<(u32, Range<i32>)>,
}

impl Raster {
    /// Starts a face with nothing on it.
    pub fn clear(&mut self, (width, height): (usize, usize)) {
        (self.width, self.height) = (width, height);
        self.items.clear();
        self.items.resize(width * height, Item::NOTHING);
        self.spans.resize(height, [i32::MAX, i32::MIN]);
        if self.columns.len() != width {
            self.columns = (0..width).map(|k| k as f64).collect();
        }
    }

    /// Items of a row.
    pub fn row(&self, row: usize) -> &[Item] {
        &self.items[row * self.width..(row + 1) * self.width]
    }

    /// Items of the face, row by row.
    pub fn items(&self) -> &[Item] {
        &self.items
    }

    /// Draws all polygons in order, band by band.
    pub fn draw(&mut self, projection: &Projection) {
        let mut large = std::mem::take(&mut self.large);
        large.clear();
        let numbered = (0..).zip(&projection.polygons);
        large.extend(numbered.filter_map(|(k, p)| Some((k, self.rows_of(projection.points_of(p))?))));
        let step = (BAND_PIXELS / self.width.max(1)).max(1);
        for start in (0..self.height).step_by(step) {
            let end = (start + step).min(self.height);
            self.band_start = start;
            self.nearness.clear();
            self.nearness.resize((end - start) * self.width, 0.0);
            for (k, rows) in &large {
                let rows = rows.start.max(start as i32)..rows.end.min(end as i32);
                if !rows.is_empty() {
                    let p = &projection.polygons[*k as usize];
                    self.polygon(p, projection.points_of(p), rows);
                }
            }
        }
        self.large = large;
    }

    /// Rows of pixel centres between a polygon's ends; `None` if it misses all columns or rows of them.
    fn rows_of(&self, points: &[[f64; 2]]) -> Option<Range<i32>> {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for q in points {
            for k in 0..2 {
                low[k] = low[k].min(q[k]);
                high[k] = high[k].max(q[k]);
            }
        }
        let rows = first_at_or_after(low[1]).max(0)..first_at_or_after(high[1]).min(self.height as i32);
        // Most polygons of a fine scene are smaller than a pixel and miss all centres.
        (!rows.is_empty() && first_at_or_after(low[0]) < first_at_or_after(high[0])).then_some(rows)
    }

    /// Draws the given rows of a polygon.
    fn polygon(&mut self, p: &Projected, points: &[[f64; 2]], rows: Range<i32>) {
        self.spans[rows.start as usize..rows.end as usize].fill([i32::MAX, i32::MIN]);
        let mut previous = points[points.len() - 1];
        for &next in points {
            self.edge(previous, next, &rows);
            previous = next;
        }
        rows.for_each(|row| self.fill(row as usize, p));
    }

    /// Notes where an edge crosses each row of pixel centres. A convex polygon crosses a row twice.
    fn edge(&mut self, a: [f64; 2], b: [f64; 2], rows: &Range<i32>) {
        let ([x0, y0], [x1, y1]) = if a[1] <= b[1] { (a, b) } else { (b, a) };
        let rows = first_at_or_after(y0).max(rows.start)..first_at_or_after(y1).min(rows.end);
        if rows.is_empty() {
            return;
        }
        let slope = (x1 - x0) / (y1 - y0);
        let (left, right) = (x0.min(x1), x0.max(x1));
        for row in rows {
            // Clamped: an edge within a hair of the row would otherwise be prolonged far beyond its ends.
            let x = (x0 + (f64::from(row) - y0) * slope).max(left).min(right);
            let column = first_at_or_after(x);
            let span = &mut self.spans[row as usize];
            *span = [span[0].min(column), span[1].max(column)];
        }
    }

    fn fill(&mut self, row: usize, p: &Projected) {
        let [left, right] = self.spans[row];
        let (left, right) = (left.max(0) as usize, right.clamp(0, self.width as i32) as usize);
        if left >= right {
            return;
        }
        let [base, slope, per_row] = p.nearness;
        let start = base + per_row * row as f64;
        let (at, deep) = (row * self.width, (row - self.band_start) * self.width);
        let depths = &mut self.nearness[deep + left..deep + right];
        let items = &mut self.items[at + left..at + right];
        for ((depth, item), column) in depths.iter_mut().zip(items).zip(&self.columns[left..right]) {
            let nearness = start + slope * column;
            // Written as selections, which the compiler can do several at a time.
            let nearer = nearness > *depth * (1.0 + COINCIDENT);
            *depth = if nearer { nearness } else { *depth };
            *item = if nearer { p.item } else { *item };
        }
    }
}

/// The first pixel whose centre lies at or after a position (greater than -1): half-open intervals start there
/// and end before it.
fn first_at_or_after(position: f64) -> i32 {
    // The cast rounds towards zero: for positions above -1 this is the ceiling, without a call.
    (position + (1.0 - ON_CENTRE)) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: usize = 10;

    /// Draws polygons given as (points, nearness) in order, items 0, 1, ...
    fn draw(polygons: &[(Vec<[f64; 2]>, f64)]) -> Raster {
        let mut projection = Projection::default();
        for (k, (points, nearness)) in polygons.iter().enumerate() {
            let first = projection.points.len() as u32;
            projection.points.extend(points);
            let last = projection.points.len() as u32;
            let nearness = [*nearness, 0.0, 0.0];
            projection.polygons.push(Projected { first, last, item: Item::patch(k as u32), nearness });
        }
        let mut raster = Raster::default();
        raster.clear((SIZE, SIZE));
        raster.draw(&projection);
        raster
    }

    fn count(r: &Raster, item: Item) -> usize {
        r.items().iter().filter(|i| **i == item).count()
    }

    fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64) -> Vec<[f64; 2]> {
        vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
    }

    #[test]
    fn pixels_are_half_open() {
        let r = draw(&[(rectangle(2.0, 3.0, 4.0, 6.0), 1.0)]);
        assert_eq!(count(&r, Item::patch(0)), 6);
        assert_eq!((r.row(3)[2], r.row(3)[4], r.row(6)[2]), (Item::patch(0), Item::NOTHING, Item::NOTHING));
        let rounded = draw(&[(rectangle(2.0 + 1e-13, 3.0 - 1e-13, 4.0 + 1e-13, 6.0 + 1e-13), 1.0)]);
        assert_eq!(rounded.items(), r.items());
    }

    #[test]
    fn a_fan_of_triangles_covers_every_pixel_once() {
        // The hub lies on a pixel centre and many spokes run through others.
        let hub = [4.0, 5.0];
        let rim: Vec<[f64; 2]> = (0..24)
            .map(|k| match k / 6 {
                0 => [-0.5 + 10.0 * f64::from(k) / 6.0, -0.5],
                1 => [9.5, -0.5 + 10.0 * f64::from(k - 6) / 6.0],
                2 => [9.5 - 10.0 * f64::from(k - 12) / 6.0, 9.5],
                _ => [-0.5, 9.5 - 10.0 * f64::from(k - 18) / 6.0],
            })
            .collect();
        let fan: Vec<_> = (0..24).map(|k| vec![hub, rim[k], rim[(k + 1) % 24]]).collect();
        let alone = |t: &Vec<[f64; 2]>| count(&draw(&[(t.clone(), 1.0)]), Item::patch(0));
        assert_eq!(fan.iter().map(alone).sum::<usize>(), SIZE * SIZE, "pixels counted twice or lost");
        let together = draw(&fan.iter().map(|t| (t.clone(), 1.0)).collect::<Vec<_>>());
        assert_eq!(count(&together, Item::NOTHING), 0);
        let reversed = |t: &Vec<[f64; 2]>| alone(&t.iter().rev().copied().collect());
        assert!(fan.iter().all(|t| alone(t) == reversed(t)));
    }

    #[test]
    fn the_nearer_wins_and_of_equals_the_first() {
        let whole = || rectangle(-0.5, -0.5, 9.5, 9.5);
        let part = || rectangle(1.5, 1.5, 4.5, 4.5);
        assert_eq!(count(&draw(&[(whole(), 1.0), (part(), 1.1)]), Item::patch(1)), 9);
        assert_eq!(count(&draw(&[(whole(), 1.0), (part(), 0.9)]), Item::patch(1)), 0);
        assert_eq!(count(&draw(&[(part(), 1.0), (whole(), 1.0 + 1e-12)]), Item::patch(0)), 9);
    }

    #[test]
    fn points_beyond_all_numbers_do_no_harm() {
        let wild = vec![[f64::NAN, 0.0], [f64::INFINITY, 5.0], [-1e300, 1e300]];
        draw(&[(wild, f64::NAN)]);
    }
}
