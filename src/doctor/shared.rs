//! Overlaps and duplicates: areas that two faces claim for the same side.

use super::text::{digits, metres, verb};
use crate::scene::{Consequence, Finding, FindingKind, Place, Severity, SharedArea};

pub(super) fn finding(shared: &SharedArea) -> Finding {
    let duplicate = shared.duplicates == shared.pairs;
    let [first, second] = &shared.surfaces;
    let whose = match first == second {
        true => format!("faces of \"{first}\""),
        false => format!("faces of \"{first}\" and \"{second}\""),
    };
    let what = match duplicate {
        true => format!("{whose} stand there twice: {} {}", shared.pairs, verb(shared.pairs, "pair", "pairs")),
        false => format!(
            "{whose} overlap in one plane and face the same way: {} {}, {} of them wholly",
            shared.pairs,
            verb(shared.pairs, "pair", "pairs"),
            shared.duplicates
        ),
    };
    let mut surfaces = shared.surfaces.to_vec();
    surfaces.dedup();
    Finding {
        kind: if duplicate { FindingKind::Duplicate } else { FindingKind::Overlap },
        severity: Severity::Warning,
        place: Place { surfaces, point: Some(shared.point.to_array()), ..Place::default() },
        what,
        consequence: Some(Consequence {
            text: format!(
                "{} m² (a square of {}) belong to two faces; the earlier one keeps them, the later one loses \
                 them. Programs that keep both count that light twice",
                digits(shared.area),
                metres(shared.area.sqrt())
            ),
            value: shared.area,
            std_err: None,
            unit: "m^2".into(),
        }),
        mend: if duplicate {
            "delete one of the two".into()
        } else {
            "cut the later face back to what the earlier one leaves, or move it off the plane".into()
        },
    }
}
