//! `<transform>`: affine maps, exact at multiples of 90 degrees.

use super::tree::{Id, Tree};
use crate::io::scene::check::{Checked, LARGEST};
use crate::io::scene::error::Refusal;
use crate::math::DVec3;
use glam::DMat3;

/// p -> linear p + translation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Affine {
    pub linear: DMat3,
    pub translation: DVec3,
}

impl Affine {
    pub(super) const IDENTITY: Self = Self { linear: DMat3::IDENTITY, translation: DVec3::ZERO };

    pub(super) fn point(&self, p: DVec3) -> DVec3 {
        self.linear * p + self.translation
    }

    pub(super) fn vector(&self, v: DVec3) -> DVec3 {
        self.linear * v
    }

    /// True if it turns left into right.
    pub(super) fn mirrors(&self) -> bool {
        self.linear.determinant() < 0.0
    }

    /// This one after `first`.
    fn after(&self, first: &Self) -> Self {
        Self { linear: self.linear * first.linear, translation: self.linear * first.translation + self.translation }
    }

    fn is_sound(&self) -> bool {
        let within = |v: DVec3| v.is_finite() && v.abs().max_element() <= LARGEST;
        within(self.translation) && [0, 1, 2].into_iter().all(|i| within(self.linear.col(i)))
    }
}

/// The steps of a `<transform>`, each applied after those before it.
pub(super) fn transform(tree: &Tree, at: Id) -> Checked<Affine> {
    let mut all = Affine::IDENTITY;
    for step in tree.children(at) {
        all = one(tree, step)?.after(&all);
        if !all.is_sound() {
            let message = format!("the transformation moves beyond {LARGEST:e}");
            return tree.refuse(step, Refusal::Number, message, "use smaller numbers");
        }
    }
    Ok(all)
}

fn one(tree: &Tree, at: Id) -> Checked<Affine> {
    let linear = |linear| Affine { linear, translation: DVec3::ZERO };
    match tree.tag(at) {
        "translate" => {
            tree.only(at, &["x", "y", "z", "value"])?;
            Ok(Affine { translation: tree.vector(at, 0.0)?, ..Affine::IDENTITY })
        }
        "scale" => {
            tree.only(at, &["x", "y", "z", "value"])?;
            let factors = tree.vector(at, 1.0)?;
            match factors.to_array().contains(&0.0) {
                true => tree.refuse(at, Refusal::Number, "a scale of 0", "give factors other than zero"),
                false => Ok(linear(DMat3::from_diagonal(factors))),
            }
        }
        "rotate" => {
            tree.only(at, &["x", "y", "z", "value", "angle"])?;
            let axis = tree.vector(at, 0.0)?.normalize_or_zero();
            match axis == DVec3::ZERO {
                true => tree.refuse(at, Refusal::Number, "the axis has no direction", "give x, y or z other than 0"),
                false => Ok(linear(rotation(axis, tree.number(at, "angle")?))),
            }
        }
        "lookat" => look_at(tree, at),
        "matrix" => matrix(tree, at),
        other => {
            let message = format!("no transformation is called <{}>", super::tree::shown(other));
            tree.refuse(at, Refusal::Key, message, "use translate, scale, rotate, lookat or matrix")
        }
    }
}

/// Rotation about a unit axis (Rodrigues), degrees.
fn rotation(axis: DVec3, degrees: f64) -> DMat3 {
    let (s, c) = match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        turned => turned.to_radians().sin_cos(),
    };
    let turned = |v: DVec3| v * c + axis.cross(v) * s + axis * (axis.dot(v) * (1.0 - c));
    DMat3::from_cols(turned(DVec3::X), turned(DVec3::Y), turned(DVec3::Z))
}

/// The z axis towards the target, x to the left, y up.
fn look_at(tree: &Tree, at: Id) -> Checked<Affine> {
    tree.only(at, &["origin", "target", "up"])?;
    let (origin, target) = (tree.triple(at, "origin")?, tree.triple(at, "target")?);
    let up = tree.attribute(at, "up").map_or(Ok(DVec3::Y), |_| tree.triple(at, "up"))?;
    let forward = (target - origin).normalize_or_zero();
    let left = up.normalize_or_zero().cross(forward);
    if forward == DVec3::ZERO || left.length() < 1e-9 {
        let message = "origin and target are the same point, or up runs along the direction of view";
        return tree.refuse(at, Refusal::Number, message, "give another target or up");
    }
    let left = left.normalize();
    Ok(Affine { linear: DMat3::from_cols(left, forward.cross(left), forward), translation: origin })
}

/// 16 numbers row by row, the last row 0 0 0 1; or 9.
fn matrix(tree: &Tree, at: Id) -> Checked<Affine> {
    tree.only(at, &["value"])?;
    let v = tree.numbers(at, "value")?;
    let columns = match v.len() {
        9 => 3,
        16 => 4,
        n => {
            let message = format!("the matrix has {n} numbers");
            return tree.refuse(at, Refusal::Number, message, "give 16 (or 9), row by row");
        }
    };
    if columns == 4 && v[12..] != [0.0, 0.0, 0.0, 1.0] {
        return tree.refuse(at, Refusal::Number, "the last row of the matrix is not 0 0 0 1", "give an affine map");
    }
    let column = |c: usize| DVec3::new(v[c], v[columns + c], v[2 * columns + c]);
    let linear = DMat3::from_cols(column(0), column(1), column(2));
    if linear.determinant() == 0.0 {
        return tree.refuse(at, Refusal::Number, "the matrix is singular", "give one that keeps areas");
    }
    Ok(Affine { linear, translation: if columns == 4 { column(3) } else { DVec3::ZERO } })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn right_angles_are_exact_and_turn_right_handed() {
        assert_eq!(rotation(DVec3::X, 90.0) * DVec3::Y, DVec3::Z);
        assert_eq!(rotation(DVec3::Y, -90.0) * DVec3::Z, -DVec3::X);
        assert_eq!(rotation(DVec3::Z, 450.0) * DVec3::X, DVec3::Y);
        let tilted = rotation(DVec3::new(1.0, 1.0, 1.0).normalize(), 120.0) * DVec3::X;
        assert!((tilted - DVec3::Y).length() < 1e-15);
    }
}
