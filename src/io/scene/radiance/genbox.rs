//! `!genbox`: six polygons of a box.

use super::parse::{Primitive, shown};
use crate::io::scene::check::{Check, Checked, LARGEST};
use crate::io::scene::error::Refusal;
use std::ops::Range;

/// Corners of the sides in genbox's order, outwards; bits of a corner are x, y, z.
const SIDES: [[u8; 4]; 6] = [[1, 5, 4, 0], [4, 6, 2, 0], [2, 3, 1, 0], [3, 2, 6, 7], [5, 1, 3, 7], [6, 4, 5, 7]];

/// The box of `genbox material name x y z [-i]`, from the origin to (x, y, z).
pub(super) fn genbox(check: Check, arguments: &[&str], span: &Range<usize>) -> Checked<Vec<Primitive>> {
    let expand = "write it out first: xform scene.rad > expanded.rad";
    let [material, name, sizes @ .., last] = arguments else {
        let mend = "write !genbox material name x y z";
        return check.refuse(Refusal::Syntax, span.clone(), "genbox has too few arguments", mend);
    };
    let inward = *last == "-i";
    let sizes: Vec<&str> = sizes.iter().copied().chain((!inward).then_some(*last)).collect();
    let [x, y, z] = sizes[..] else {
        let message = format!("this genbox is not read: {}", shown(&sizes.join(" ")));
        return check.refuse(Refusal::Reserved, span.clone(), message, expand);
    };
    let mut size = [0.0; 3];
    for (out, word) in size.iter_mut().zip([x, y, z]) {
        match word.parse::<f64>() {
            Ok(v) if v > 0.0 && v <= LARGEST => *out = v,
            _ => {
                let message = format!("\"{}\" is not a length of a box", shown(word));
                return check.refuse(Refusal::Number, span.clone(), message, "give three numbers greater than zero");
            }
        }
    }
    let corner = |c: u8| [0, 1, 2].map(|axis| if c >> axis & 1 == 1 { size[axis as usize] } else { 0.0 });
    let side = |corners: &[u8; 4]| {
        let mut order = *corners;
        if inward {
            order.reverse();
        }
        Primitive {
            modifier: material.to_string(),
            kind: "polygon".into(),
            name: format!("{name}.{}", corners.map(|c| c.to_string()).concat()),
            alias: None,
            reals: order.iter().flat_map(|c| corner(*c)).collect(),
            span: span.clone(),
        }
    };
    Ok(SIDES.iter().map(side).collect())
}
