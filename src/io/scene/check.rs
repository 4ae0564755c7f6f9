//! Checks of single values, each with its place.

use super::error::{Refusal, SceneFileError};
use super::source::Source;
use crate::math::DVec3;
use std::ops::Range;
use toml::Spanned;

/// Coordinates and lengths beyond this are taken for mistakes: squares of them still have to be exact.
pub(super) const LARGEST: f64 = 1e9;

pub(super) type Checked<T> = Result<T, SceneFileError>;

/// The file being read, as the one that refuses.
#[derive(Clone, Copy)]
pub(super) struct Check<'a> {
    pub source: &'a Source,
}

impl Check<'_> {
    pub(super) fn refuse<T>(
        &self,
        refusal: Refusal,
        span: Range<usize>,
        message: impl Into<String>,
        mend: impl Into<String>,
    ) -> Checked<T> {
        Err(SceneFileError::new(self.source, refusal, span, message).mend(mend))
    }

    /// A finite number.
    pub(super) fn finite(&self, what: &str, value: f64, span: Range<usize>) -> Checked<f64> {
        match value.is_finite() {
            true => Ok(value),
            false => self.refuse(Refusal::Number, span, format!("{what} is {value}"), "give a finite number"),
        }
    }

    /// A finite number greater than zero.
    pub(super) fn positive(&self, what: &str, value: &Spanned<f64>) -> Checked<f64> {
        let v = self.finite(what, *value.get_ref(), value.span())?;
        match v > 0.0 {
            true => Ok(v),
            false => {
                self.refuse(Refusal::Number, value.span(), format!("{what} is {v}"), "give a number greater than zero")
            }
        }
    }

    /// Three finite numbers.
    pub(super) fn point(&self, what: &str, value: &Spanned<Vec<f64>>) -> Checked<DVec3> {
        let [x, y, z] = value.get_ref()[..] else {
            let count = value.get_ref().len();
            return self.refuse(
                Refusal::Number,
                value.span(),
                format!("{what} has {count} numbers"),
                "give three: [x, y, z]",
            );
        };
        let p = DVec3::new(x, y, z);
        if !p.is_finite() {
            return self.refuse(
                Refusal::Number,
                value.span(),
                format!("{what} is [{x}, {y}, {z}]"),
                "give finite numbers",
            );
        }
        if p.abs().max_element() > LARGEST {
            return self.refuse(
                Refusal::Number,
                value.span(),
                format!("{what} lies beyond {LARGEST:e} m"),
                "coordinates are in metres; check the unit",
            );
        }
        Ok(p)
    }

    /// A vector that is not zero.
    pub(super) fn direction(&self, what: &str, value: &Spanned<Vec<f64>>) -> Checked<DVec3> {
        let v = self.point(what, value)?;
        match v.length() > 0.0 {
            true => Ok(v),
            false => self.refuse(
                Refusal::Number,
                value.span(),
                format!("{what} has no direction"),
                "give at least one number other than zero",
            ),
        }
    }

    /// A name that can stand in one line of a message or a table.
    pub(super) fn name(&self, what: &str, value: &Spanned<String>) -> Checked<String> {
        let name = value.get_ref();
        let sound = !name.trim().is_empty() && !name.chars().any(char::is_control) && name.len() <= 200;
        match sound {
            true => Ok(name.clone()),
            false => self.refuse(
                Refusal::Name,
                value.span(),
                format!("the {what} is empty, longer than 200 bytes, or holds control characters"),
                "give a short name on one line",
            ),
        }
    }
}

/// The name nearest to a mistyped one, if any is near.
pub(super) fn nearest<'n>(name: &str, known: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    let scored = known.into_iter().map(|k| (edit_distance(name, k), k));
    scored.min_by_key(|s| s.0).filter(|(d, k)| *d <= 1 + k.chars().count() / 4).map(|s| s.1)
}

/// Insertions, deletions and replacements between two words.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut corner = std::mem::replace(&mut row[0], i + 1);
        for (j, y) in b.iter().enumerate() {
            let replaced = corner + usize::from(x != *y);
            corner = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(corner + 1);
        }
    }
    row[b.len()]
}

/// The mend for an unknown name: the nearest one, or all of them.
pub(super) fn known_names<'n>(name: &str, known: impl IntoIterator<Item = &'n str> + Clone) -> String {
    match nearest(name, known.clone()) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None => {
            let all: Vec<&str> = known.into_iter().take(20).collect();
            if all.is_empty() { "there are none".into() } else { format!("there are: {}", all.join(", ")) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mistyped_names_find_their_neighbour() {
        assert_eq!(nearest("refletance", ["reflectance", "emission", "name"]), Some("reflectance"));
        assert_eq!(nearest("colour", ["reflectance", "emission", "name"]), None);
        assert_eq!(edit_distance("kitten", "sitting"), 3);
    }
}
