//! Delta tables as they are made and as they are got wrong.

use crate::math::Compensated;
use crate::methods::hemicube::{Delta, DeltaTable, Face, delta_side, delta_top};
use serde::Serialize;
use std::f64::consts::PI;

/// How the delta form factor of a pixel is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Rule {
    /// Integrand at the pixel's centre times its area, as in 1985: the table sums to 1 + 0.542 / N^2.
    Midpoint,
    /// Integral over the pixel: the table sums to 1.
    Exact,
    /// Midpoint values divided by their sum.
    Normalised,
}

/// What people get wrong in a hemi-cube.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Mistake {
    /// Nothing.
    None,
    /// The top is not summed.
    MissingTop,
    /// One side is not summed.
    MissingSide,
    /// Two sides are not summed.
    MissingTwoSides,
    /// No side is summed.
    MissingSides,
    /// The side's delta lacks its factor z.
    SideWithoutZ,
    /// `x^2 + y^2 + 1` is not squared.
    ExponentOne,
    /// No division by pi.
    NoPi,
    /// 2 pi in place of pi.
    TwoPi,
    /// Pixel edge 1 / N in place of 2 / N.
    PixelEdgeHalved,
    /// Coordinates of the pixel's corner in place of its centre.
    PixelCorner,
    /// Pixel centres spread from edge to edge: 2 k / (N - 1) - 1.
    EdgeToEdge,
    /// Coordinates from -1/2 to 1/2 (z to 1/2), as if the cube had half its width.
    HalfWidth,
    /// Rows 0 .. N/2 of the top's table on the sides.
    TopTableOnSides,
    /// Side rows counted from the top edge down.
    SidesUpsideDown,
    /// Sides N pixels high, up to z = 2.
    TallSides,
    /// Sides of N rows from z = 0 to 1, each with the area of a square pixel.
    SquashedSides,
}

impl Mistake {
    /// All that change what a row sums to, or nothing.
    pub(super) const ALL: [Mistake; 16] = [
        Mistake::None,
        Mistake::MissingTop,
        Mistake::MissingSide,
        Mistake::MissingTwoSides,
        Mistake::MissingSides,
        Mistake::SideWithoutZ,
        Mistake::ExponentOne,
        Mistake::NoPi,
        Mistake::TwoPi,
        Mistake::PixelEdgeHalved,
        Mistake::PixelCorner,
        Mistake::EdgeToEdge,
        Mistake::HalfWidth,
        Mistake::TopTableOnSides,
        Mistake::TallSides,
        Mistake::SquashedSides,
    ];

    /// True where faces are left out: any rule can be combined with it.
    pub(super) fn leaves_out(self) -> bool {
        matches!(self, Self::MissingTop | Self::MissingSide | Self::MissingTwoSides | Self::MissingSides)
    }

    /// True where its pixels are those of a right hemi-cube, so that a picture can be summed with its table.
    pub(super) fn is_pictured(self) -> bool {
        !matches!(self, Self::TallSides | Self::SquashedSides)
    }
}

/// A way to make a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Model {
    /// How a delta is found.
    pub rule: Rule,
    /// What is wrong.
    pub mistake: Mistake,
}

impl Model {
    /// The right table of a rule.
    pub(super) fn right(rule: Rule) -> Self {
        Self { rule, mistake: Mistake::None }
    }

    /// Models told apart by what their rows sum to: the midpoint rule with every mistake, the exact one with faces
    /// left out.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        let midpoint = Mistake::ALL.into_iter().map(|mistake| Self { rule: Rule::Midpoint, mistake });
        let exact = Mistake::ALL.into_iter().filter(|m| *m == Mistake::None || m.leaves_out());
        midpoint.chain(exact.map(|mistake| Self { rule: Rule::Exact, mistake })).chain([Self::right(Rule::Normalised)])
    }

    /// True if its total is the same at every resolution.
    pub(super) fn is_constant(self) -> bool {
        self.rule != Rule::Midpoint
    }
}

/// Deltas of all pixels of a top and of a side, with the faces that count.
#[derive(Debug, Clone)]
pub(super) struct Table {
    /// Pixels along an edge of the top.
    pub n: usize,
    /// N rows of N, row by row, row 0 at y = -1.
    pub top: Vec<f64>,
    /// Rows of N, row 0 at the horizon.
    pub side: Vec<f64>,
    /// Weights of the faces in the order of [`Face::ALL`].
    pub faces: [f64; 5],
}

impl Table {
    pub fn new(n: u32, model: Model) -> Self {
        let mut table = match (model.rule, model.mistake) {
            (Rule::Exact, _) => Self::exact(n),
            (_, mistake) => Self::midpoint(n as usize, mistake),
        };
        table.faces = match model.mistake {
            Mistake::MissingTop => [0.0, 1.0, 1.0, 1.0, 1.0],
            Mistake::MissingSide => [1.0, 0.0, 1.0, 1.0, 1.0],
            Mistake::MissingTwoSides => [1.0, 0.0, 1.0, 0.0, 1.0],
            Mistake::MissingSides => [1.0, 0.0, 0.0, 0.0, 0.0],
            _ => [1.0; 5],
        };
        if model.rule == Rule::Normalised {
            let scale = 1.0 / table.total();
            table.top.iter_mut().chain(&mut table.side).for_each(|d| *d *= scale);
        }
        table
    }

    fn exact(n: u32) -> Self {
        let (deltas, n) = (DeltaTable::new(n, Delta::Exact), n as usize);
        let half = n / 2;
        let from_axis = |k: usize| if k < half { half - 1 - k } else { k - half };
        let cells = |rows: usize| (0..rows).flat_map(move |b| (0..n).map(move |a| (a, b)));
        let top = cells(n).map(|(a, b)| deltas.top(from_axis(a), from_axis(b))).collect();
        let side = cells(half).map(|(a, b)| deltas.side(from_axis(a), b)).collect();
        Self { n, top, side, faces: [1.0; 5] }
    }

    fn midpoint(n: usize, mistake: Mistake) -> Self {
        let rule = Coordinates::new(n, mistake);
        let rows = if matches!(mistake, Mistake::TallSides | Mistake::SquashedSides) { n } else { n / 2 };
        let cells = |rows: usize| (0..rows).flat_map(move |b| (0..n).map(move |a| (a, b)));
        let top: Vec<f64> = cells(n).map(|(a, b)| rule.top(rule.across(a), rule.across(b))).collect();
        let side = match mistake {
            Mistake::TopTableOnSides => top[..n * (n / 2)].to_vec(),
            Mistake::SidesUpsideDown => {
                cells(rows).map(|(a, b)| rule.side(rule.across(a), rule.up(rows - 1 - b))).collect()
            }
            _ => cells(rows).map(|(a, b)| rule.side(rule.across(a), rule.up(b))).collect(),
        };
        Self { n, top, side, faces: [1.0; 5] }
    }

    /// What the row of a patch that sees no gap sums to.
    pub fn total(&self) -> f64 {
        let mut sum = Compensated::default();
        self.top.iter().for_each(|d| sum.add(d * self.faces[0]));
        let sides: f64 = self.faces[1..].iter().sum();
        self.side.iter().for_each(|d| sum.add(d * sides));
        sum.value()
    }

    /// The deltas of a face; none where it does not count.
    pub fn face(&self, face: Face) -> Option<&[f64]> {
        let number = match face {
            Face::Top => 0,
            Face::Side(k) => 1 + k as usize,
        };
        (self.faces[number] != 0.0).then_some(if number == 0 { &self.top } else { &self.side })
    }

    /// The same with its sides moved on by one.
    pub fn turned(mut self) -> Self {
        self.faces[1..].rotate_right(1);
        self
    }

    /// The different deltas of the faces that count, ascending.
    pub fn deltas(&self) -> Vec<f64> {
        let top = if self.faces[0] != 0.0 { self.top.as_slice() } else { &[] };
        let side = if self.faces[1..].iter().any(|w| *w != 0.0) { self.side.as_slice() } else { &[] };
        let mut all: Vec<f64> = top.iter().chain(side).copied().filter(|d| *d > 0.0).collect();
        all.sort_unstable_by(f64::total_cmp);
        all.dedup_by(|b, a| (*b - *a) <= 1e-12 * *a);
        all
    }
}

/// Where a maker of tables believes the pixels to be, and what formula is evaluated there.
struct Coordinates {
    mistake: Mistake,
    n: f64,
    /// Area of a pixel.
    area: f64,
}

impl Coordinates {
    fn new(n: usize, mistake: Mistake) -> Self {
        let n = n as f64;
        let edge = if matches!(mistake, Mistake::PixelEdgeHalved | Mistake::HalfWidth) { 1.0 / n } else { 2.0 / n };
        Self { mistake, n, area: edge * edge }
    }

    /// x or y of a column.
    fn across(&self, k: usize) -> f64 {
        let k = k as f64;
        match self.mistake {
            Mistake::PixelCorner => 2.0 * k / self.n - 1.0,
            Mistake::EdgeToEdge => 2.0 * k / (self.n - 1.0) - 1.0,
            Mistake::HalfWidth => (k + 0.5) / self.n - 0.5,
            _ => (2.0 * k + 1.0) / self.n - 1.0,
        }
    }

    /// z of a side's row.
    fn up(&self, k: usize) -> f64 {
        let k = k as f64;
        match self.mistake {
            Mistake::PixelCorner => 2.0 * k / self.n,
            Mistake::EdgeToEdge => k / (0.5 * self.n - 1.0),
            Mistake::HalfWidth | Mistake::SquashedSides => (k + 0.5) / self.n,
            _ => (2.0 * k + 1.0) / self.n,
        }
    }

    fn top(&self, x: f64, y: f64) -> f64 {
        match self.mistake {
            Mistake::ExponentOne => self.area / (PI * (x * x + y * y + 1.0)),
            Mistake::NoPi => PI * delta_top(x, y, self.area),
            Mistake::TwoPi => 0.5 * delta_top(x, y, self.area),
            _ => delta_top(x, y, self.area),
        }
    }

    fn side(&self, y: f64, z: f64) -> f64 {
        match self.mistake {
            Mistake::SideWithoutZ => delta_top(y, z, self.area),
            Mistake::ExponentOne => z * self.area / (PI * (y * y + z * z + 1.0)),
            Mistake::NoPi => PI * delta_side(y, z, self.area),
            Mistake::TwoPi => 0.5 * delta_side(y, z, self.area),
            _ => delta_side(y, z, self.area),
        }
    }
}

/// Resolutions whose table sums to a value, within `slack`: the lowest and the highest, even.
pub(super) fn resolutions(model: Model, value: f64, slack: f64) -> Option<(u32, u32)> {
    const LAST: u32 = 2048;
    let total = |n: u32| Table::new(n, model).total();
    if model.is_constant() {
        return ((total(4) - value).abs() <= slack).then_some((4, LAST));
    }
    let mut at = (4, total(4));
    while at.0 < LAST {
        let next = (2 * at.0, total(2 * at.0));
        let (low, high) = (at.1.min(next.1) - slack, at.1.max(next.1) + slack);
        if (low..=high).contains(&value) {
            return inside(&total, at, next, value, slack);
        }
        at = next;
    }
    None
}

/// The same between two resolutions, total falling or rising all the way.
fn inside(
    total: &dyn Fn(u32) -> f64,
    (mut low, first): (u32, f64),
    (mut high, last): (u32, f64),
    value: f64,
    slack: f64,
) -> Option<(u32, u32)> {
    let end = high;
    while high - low > 2 {
        let middle = (low + high) / 4 * 2;
        let before = if last < first { total(middle) > value } else { total(middle) < value };
        if before { low = middle } else { high = middle }
    }
    let fits = |n: u32| (total(n) - value).abs() <= slack;
    let first = [low, high].into_iter().find(|n| fits(*n))?;
    let (mut lowest, mut highest) = (first, first);
    while lowest > 4 && first - lowest < 64 && fits(lowest - 2) {
        lowest -= 2;
    }
    while highest < 2 * end && highest - first < 64 && fits(highest + 2) {
        highest += 2;
    }
    Some((lowest, highest))
}
