//! A fingerprint in words.

use super::{Candidate, Confirmed, Digits, Fingerprint, Likeness, Mistake, Rule};
use std::fmt;

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Midpoint => "midpoint deltas of 1985",
            Self::Exact => "exact integrals over each pixel",
            Self::Normalised => "midpoint deltas divided by their sum",
        })
    }
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::None => "no mistake",
            Self::MissingTop => "the top face is missing",
            Self::MissingSide => "one side face is missing",
            Self::MissingTwoSides => "two side faces are missing",
            Self::MissingSides => "all side faces are missing",
            Self::SideWithoutZ => "the side's delta lacks its factor z",
            Self::ExponentOne => "x^2 + y^2 + 1 is not squared in the delta",
            Self::NoPi => "the delta is not divided by pi",
            Self::TwoPi => "the delta is divided by 2 pi in place of pi",
            Self::PixelEdgeHalved => "the pixel's edge is taken as 1/N in place of 2/N",
            Self::PixelCorner => "the delta is taken at a pixel's corner in place of its centre",
            Self::EdgeToEdge => "pixel centres are spread from edge to edge (N - 1 steps in place of N)",
            Self::HalfWidth => "the delta's coordinates run from -1/2 to 1/2",
            Self::TopTableOnSides => "the top's table is used on the sides",
            Self::SidesUpsideDown => "the rows of the sides are upside down",
            Self::TallSides => "the sides are N pixels high in place of N/2",
            Self::SquashedSides => "the sides have N rows but the pixel area of N/2",
            Self::OddRowLost => "N is odd and half a row at the top of the sides is lost",
            Self::OddRowOnHorizon => "N is odd and the lowest row of the sides lies on the horizon",
        })
    }
}

impl fmt::Display for Digits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Places(k) => write!(f, "{k} decimal places"),
            Self::Significant(d) => write!(f, "{d} significant digits"),
            Self::Single => f.write_str("single precision"),
            Self::Double => f.write_str("double precision"),
        }
    }
}

impl fmt::Display for Fingerprint {
    /// One sentence.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.likeness {
            Likeness::RayCounts { rays } => write!(f, "no hemi-cube: all entries are counts of {rays} rays"),
            Likeness::NoSignOfHemicube => f.write_str("no sign of a hemi-cube"),
            Likeness::CannotBeTold => f.write_str("cannot be told"),
            Likeness::Hemicube => {
                let untold = || "cannot be told".to_string();
                let n = self.resolution.map_or_else(untold, |n| n.to_string());
                let rule = self.rule.map_or_else(untold, |r| r.to_string());
                let mistake = self.mistake.map_or_else(untold, |m| m.to_string());
                write!(f, "a hemi-cube: resolution {n}; table: {rule}; mistakes: {mistake}")
            }
        }
    }
}

/// The reasons, most telling first.
pub(super) fn reasons(print: &Fingerprint) -> Vec<String> {
    let mut out = Vec::new();
    out.extend(print.candidates.first().filter(|_| print.likeness == Likeness::Hemicube).map(confirmation));
    out.push(row_sums(print));
    out.extend(print.candidates.first().and_then(small_entries));
    if let Some(smallest) = print.smallest_entry {
        out.push(format!("The smallest entry is {smallest:.6e}; the file carries {}.", print.digits));
    }
    out.extend(unsettled(print));
    out
}

fn row_sums(print: &Fingerprint) -> String {
    let sums = &print.row_sums;
    let Some(common) = sums.common else {
        let [low, high] = sums.range;
        return format!(
            "Row sums go from {low:.6} to {high:.6} and no sum is shared by most rows, as an open scene or noise \
             would have it: they say nothing of a resolution."
        );
    };
    let shared = format!("{} of {} rows sum to {common:.12} (+-{:.0e})", sums.sharing, sums.rows, sums.slack);
    match print.candidates.iter().find(|c| c.by_row_sum) {
        None if (common - 1.0).abs() <= sums.slack + 1e-11 => {
            format!("{shared}, as form factors of a closed scene do, however made.")
        }
        None => format!("{shared}, which no table known here sums to."),
        Some(c) if c.model.is_constant() && c.model.mistake == Mistake::None => {
            format!("{shared}, as exact or normalised tables do, and closed form factors and ray counts too.")
        }
        Some(c) if c.model.is_constant() => format!("{shared}, the sum of exact deltas where {}.", c.model.mistake),
        Some(c) => {
            let [low, high] = c.resolutions;
            let which = if low == high { format!("N = {low}") } else { format!("N = {low} to {high}") };
            let excess = common - 1.0;
            match c.model.mistake {
                Mistake::None | Mistake::SidesUpsideDown => {
                    format!("{shared}: {excess:.4e} above 1 is 0.542/N^2 at {which}.")
                }
                mistake => format!("{shared}, the sum at {which} where {mistake}."),
            }
        }
    }
}

fn small_entries(best: &Candidate) -> Option<String> {
    let (lattice, n) = (best.lattice?, best.resolution()?);
    let found = (lattice.entries > 0).then(|| {
        format!(
            "Of the {} smallest entries {} are the delta of one pixel and {} of two at N = {n} ({:.1e} expected by \
             chance).",
            lattice.entries, lattice.single, lattice.double, lattice.by_chance
        )
    });
    Some(found.unwrap_or_else(|| format!("No entry is small enough to be one pixel or two at N = {n}.")))
}

fn confirmation(best: &Candidate) -> String {
    match (best.confirmed, best.axes) {
        (Some(c), Some(_)) => format!(
            "Our pixels with that table reproduce {} of {} entries ({:.1} %) in {} rows, {} rows in full{}.",
            c.entries,
            c.of,
            100.0 * c.share(),
            c.rows,
            c.whole_rows,
            others(&c)
        ),
        (Some(c), None) => format!(
            "Our pixels reproduce {} of {} entries only: their hemi-cubes are turned, or stand, in a way not tried \
             here.",
            c.entries, c.of
        ),
        _ => "Pixels were not drawn: ours are not like these, too many, or the resolution is open.".to_string(),
    }
}

/// What is not reproduced.
fn others(c: &Confirmed) -> String {
    match (c.by_borders, c.of - c.entries - c.by_borders) {
        (0, _) => String::new(),
        (by, 0) => format!("; pixels whose centre lies on a border explain the other {by}"),
        (by, left) => format!("; pixels whose centre lies on a border explain {by} more, {left} are left"),
    }
}

/// What cannot be told, and why.
fn unsettled(print: &Fingerprint) -> Option<String> {
    match print.likeness {
        Likeness::CannotBeTold if print.row_sums.rows < 3 => {
            Some(format!("{} rows with entries are too few to tell.", print.row_sums.rows))
        }
        Likeness::CannotBeTold => Some(format!(
            "With {} a pixel cannot be told from rounding, nor decimal places from counts of as many rays; write more \
             digits.",
            print.digits
        )),
        Likeness::NoSignOfHemicube => {
            let drawn = print.drawn_to.map(|n| format!("Resolutions up to {n} were drawn. ")).unwrap_or_default();
            Some(format!(
                "{drawn}A hemi-cube of another resolution, or turned in a way not tried here, that leaves neither row \
                 sums nor small entries to go by would look the same."
            ))
        }
        Likeness::Hemicube if print.resolution.is_none() || print.rule.is_none() || print.mistake.is_none() => {
            let named = |c: &Candidate| {
                let [low, high] = c.resolutions;
                format!("N = {low}-{high}, {}, {}", c.model.rule, c.model.mistake)
            };
            let list: Vec<String> = print.candidates.iter().take(6).map(named).collect();
            Some(format!("These fit alike: {}.", list.join("; ")))
        }
        _ => None,
    }
}
