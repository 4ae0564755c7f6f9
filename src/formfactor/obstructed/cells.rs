//! The integral over the domain: cells between event lines, Gauss points in each, refined where two orders disagree.

use super::events::Line;
use crate::formfactor::gauss::rule;
use crate::math::DVec2;

/// Orders tried in a cell before it is divided.
const LADDER: [usize; 5] = [1, 2, 3, 5, 7];

/// Where there may be kinks, an error is at least this share of the one an order below.
const KINK_MEMORY: f64 = 0.1;

/// Divisions of one cell.
const DEEPEST: u8 = 12;

/// Cells smaller than this share of the domain are left out: slivers between lines that coincide to rounding.
const SLIVER: f64 = 1e-15;

/// A triangle (last two corners the same) or a convex quadrilateral.
#[derive(Debug, Clone, Copy)]
struct Cell {
    corners: [DVec2; 4],
    value: f64,
    error: f64,
    /// Place in the ladder of `value`.
    order: usize,
    depth: u8,
}

/// What an integration came to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Integral {
    /// The integral.
    pub value: f64,
    /// What the last two orders differ by, summed over the cells: an upper estimate of the error.
    pub error: f64,
    /// Points evaluated.
    pub points: usize,
}

/// Integrates `f` over a convex polygon cut along `lines` until the error falls below `tolerance`, or `most` points.
///
/// `kinks`: the lines are not all of those where `f` bends, so that two orders may agree by chance: an error then
/// falls by no more than a factor at a time.
pub(super) fn integrate(
    domain: &[DVec2],
    lines: &[Line],
    kinks: bool,
    tolerance: f64,
    most: usize,
    f: &mut impl FnMut(DVec2) -> f64,
) -> Integral {
    let whole = area(domain);
    let memory = if kinks { KINK_MEMORY } else { 0.0 };
    let mut points = 0;
    let mut cells: Vec<Cell> = Vec::new();
    for polygon in arranged(domain, lines) {
        if area(&polygon) > SLIVER * whole {
            pieces(&polygon, &mut |corners| cells.push(begun(corners, 0, &mut points, f)));
        }
    }
    loop {
        let error: f64 = cells.iter().map(|c| c.error).sum();
        if error <= tolerance || points >= most {
            return Integral { value: cells.iter().map(|c| c.value).sum(), error, points };
        }
        // All cells above their share at once: the order of work does not depend on ties.
        let share = tolerance / cells.len() as f64;
        let mut next = Vec::with_capacity(cells.len());
        let mut stuck = true;
        for c in cells {
            // Out of points, the rest stays as good as it is.
            if points >= most || c.error <= share || (c.order + 1 == LADDER.len() && c.depth == DEEPEST) {
                next.push(c);
                continue;
            }
            stuck = false;
            if c.order + 1 < LADDER.len() && c.is_worth_raising() {
                next.push(raised(c, memory, &mut points, f));
            } else {
                quarters(&c, &mut |corners| {
                    let part = begun(corners, c.depth + 1, &mut points, f);
                    // An order at once, so that what is stated falls with every division.
                    next.push(raised(part, 0.0, &mut points, f));
                });
            }
        }
        cells = next;
        if stuck {
            return Integral {
                value: cells.iter().map(|c| c.value).sum(),
                error: cells.iter().map(|c| c.error).sum(),
                points,
            };
        }
    }
}

impl Cell {
    /// Where raising the order has not helped, there is a kink inside: dividing does.
    fn is_worth_raising(&self) -> bool {
        self.order < 2 || self.error < 1e-3 * self.value.abs() || self.depth == DEEPEST
    }
}

/// One point to begin with. Between event lines, what is zero at one point is zero throughout.
fn begun(corners: [DVec2; 4], depth: u8, points: &mut usize, f: &mut impl FnMut(DVec2) -> f64) -> Cell {
    let value = apply(&corners, LADDER[0], points, f);
    Cell { corners, value, error: value.abs(), order: 0, depth }
}

/// `memory`: the share of the last error that a new one does not fall below.
fn raised(cell: Cell, memory: f64, points: &mut usize, f: &mut impl FnMut(DVec2) -> f64) -> Cell {
    let value = apply(&cell.corners, LADDER[cell.order + 1], points, f);
    let floor = if cell.order == 0 { 0.0 } else { memory * cell.error };
    Cell { value, error: (value - cell.value).abs().max(floor), order: cell.order + 1, ..cell }
}

/// The rule of n x n points on a cell.
fn apply(corners: &[DVec2; 4], n: usize, points: &mut usize, f: &mut impl FnMut(DVec2) -> f64) -> f64 {
    let [a, b, c, d] = *corners;
    if n == 1 && c == d {
        *points += 1;
        return 0.5 * (b - a).perp_dot(c - a) * f((a + b + c) / 3.0);
    }
    let unit = |(x, w): &(f64, f64)| (0.5 + 0.5 * x, 0.5 * w);
    let mut sum = 0.0;
    for (s, ws) in rule(n).iter().map(unit) {
        for (t, wt) in rule(n).iter().map(unit) {
            let (p, dp, dq) = if c == d {
                // Triangle: side a collapsed.
                (a + (b - a) * (s * (1.0 - t)) + (c - a) * (s * t), (b - a) * s, c - a)
            } else {
                let (low, high) = (a.lerp(b, s), d.lerp(c, s));
                (low.lerp(high, t), (b - a).lerp(c - d, t), high - low)
            };
            sum += ws * wt * dp.perp_dot(dq) * f(p);
        }
    }
    *points += n * n;
    sum
}

fn quarters(cell: &Cell, put: &mut impl FnMut([DVec2; 4])) {
    let [a, b, c, d] = cell.corners;
    if c == d {
        let (ab, bc, ca) = ((a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5);
        for [p, q, r] in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            put([p, q, r, r]);
        }
    } else {
        let (ab, bc, cd, da) = ((a + b) * 0.5, (b + c) * 0.5, (c + d) * 0.5, (d + a) * 0.5);
        let m = (ab + cd) * 0.5;
        for quad in [[a, ab, m, da], [ab, b, bc, m], [m, bc, c, cd], [da, m, cd, d]] {
            put(quad);
        }
    }
}

/// A convex polygon in quadrilaterals and, where its corners are odd in number, one triangle.
fn pieces(polygon: &[DVec2], put: &mut impl FnMut([DVec2; 4])) {
    let n = polygon.len();
    let mut k = 1;
    while k + 1 < n {
        if k + 2 < n {
            put([polygon[0], polygon[k], polygon[k + 1], polygon[k + 2]]);
        } else {
            put([polygon[0], polygon[k], polygon[k + 1], polygon[k + 1]]);
        }
        k += 2;
    }
}

/// The cells into which lines cut a convex polygon.
fn arranged(domain: &[DVec2], lines: &[Line]) -> Vec<Vec<DVec2>> {
    let mut cells = vec![domain.to_vec()];
    for line in lines {
        let mut next = Vec::with_capacity(cells.len() * 2);
        for cell in cells {
            let heights: Vec<f64> = cell.iter().map(|p| line.height(*p)).collect();
            let (low, high) = heights.iter().fold((0.0f64, 0.0f64), |(l, h), x| (l.min(*x), h.max(*x)));
            let reach = 1e-12 * (high - low).max(line.offset.abs());
            if high <= reach || low >= -reach {
                next.push(cell);
                continue;
            }
            for sign in [1.0, -1.0] {
                let part = half(&cell, &heights, sign);
                if part.len() >= 3 {
                    next.push(part);
                }
            }
        }
        cells = next;
    }
    cells
}

fn half(cell: &[DVec2], heights: &[f64], sign: f64) -> Vec<DVec2> {
    let n = cell.len();
    let mut out = Vec::with_capacity(n + 1);
    for k in 0..n {
        let (a, b) = (sign * heights[k], sign * heights[(k + 1) % n]);
        if a >= 0.0 {
            out.push(cell[k]);
        }
        if (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0) {
            out.push(cell[k].lerp(cell[(k + 1) % n], a / (a - b)));
        }
    }
    out
}

fn area(polygon: &[DVec2]) -> f64 {
    let o = polygon[0];
    polygon[1..].windows(2).map(|w| (w[0] - o).perp_dot(w[1] - o)).sum::<f64>() * 0.5
}
