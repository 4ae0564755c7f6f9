//! How a table of delta form factors is made, and what people get wrong.

use serde::Serialize;

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
    /// N is odd and sides have (N - 1) / 2 rows from the horizon: half a row below the top face is lost.
    OddRowLost,
    /// N is odd and the lowest row of the sides lies on the horizon, half of it below, where its delta is 0.
    OddRowOnHorizon,
}

impl Mistake {
    /// All that change what a row sums to, or nothing.
    pub(super) const ALL: [Mistake; 18] = [
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
        Mistake::OddRowLost,
        Mistake::OddRowOnHorizon,
    ];

    /// True where faces are left out: any rule can be combined with it.
    pub(super) fn leaves_out(self) -> bool {
        matches!(self, Self::MissingTop | Self::MissingSide | Self::MissingTwoSides | Self::MissingSides)
    }

    /// True where its pixels are those of a right hemi-cube, so that a picture can be summed with its table.
    pub(super) fn is_pictured(self) -> bool {
        !matches!(self, Self::TallSides | Self::SquashedSides) && !self.is_odd()
    }

    /// True where resolutions are odd.
    pub(super) fn is_odd(self) -> bool {
        matches!(self, Self::OddRowLost | Self::OddRowOnHorizon)
    }

    /// True where a quarter turn makes another table.
    pub(super) fn is_lopsided(self) -> bool {
        matches!(self, Self::MissingSide | Self::MissingTwoSides | Self::PixelCorner)
    }

    /// True where every delta is off by the same factor: divided by the sum, nothing is left of it.
    pub(super) fn is_factor(self) -> bool {
        matches!(self, Self::NoPi | Self::TwoPi | Self::PixelEdgeHalved)
    }

    /// How much each face counts, in the order of [`crate::methods::hemicube::Face::ALL`].
    pub(super) fn faces(self) -> [f64; 5] {
        match self {
            Self::MissingTop => [0.0, 1.0, 1.0, 1.0, 1.0],
            Self::MissingSide => [1.0, 0.0, 1.0, 1.0, 1.0],
            Self::MissingTwoSides => [1.0, 0.0, 1.0, 0.0, 1.0],
            Self::MissingSides => [1.0, 0.0, 0.0, 0.0, 0.0],
            _ => [1.0; 5],
        }
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
