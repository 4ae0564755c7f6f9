//! What people should know of how values were carried.

use super::{Carried, IdleFace, Unmatched};
use crate::math::{DVec3, compensated_sum};
use crate::scene::Stage;

/// So many patches are named; the others are counted.
const NAMED: usize = 10;

impl Carried {
    /// Sentences, most important first; none where every patch was covered by faces of its own.
    pub fn notices(&self) -> Vec<String> {
        let mut told = Vec::new();
        if self.turned {
            told.push("all faces are wound backwards: they were turned around, since none matched as it is".into());
        }
        if self.doubled > 0.0 {
            told.push(format!(
                "{:.4} m^2 are covered by several faces: their values were averaged there",
                self.doubled
            ));
        }
        told.extend(self.near_notice());
        told.extend(self.idle_notice());
        told
    }

    fn near_notice(&self) -> Option<String> {
        let patches = self.shares.iter().filter(|s| s.near > super::MOST_UNMATCHED).count();
        let (share, furthest) = (100.0 * self.of_scene().near, self.furthest);
        (patches > 0).then(|| {
            format!(
                "{patches} patches lie in the plane of no face in whole or in part: they took the nearest faces, up to \
                 {furthest:.4} m away ({share:.2} % of the area)"
            )
        })
    }

    fn idle_notice(&self) -> Option<String> {
        let mut idle: Vec<&IdleFace> = self.idle.iter().filter(|f| f.area > 0.0).collect();
        idle.sort_by(|a, b| b.area.total_cmp(&a.area).then(a.face.cmp(&b.face)));
        let largest = idle.first()?;
        let total = compensated_sum(idle.iter().map(|f| f.area));
        let (DVec3 { x, y, z }, of) = (largest.middle, self.faces);
        Some(format!(
            "{} of {of} faces match no patch ({total:.4} m^2), the largest around ({x:.3}, {y:.3}, {z:.3})",
            idle.len()
        ))
    }

    /// The unmatched patches in words: the first ten by surface and number, and their area; `None` if there are none.
    pub fn unmatched_told(&self, stage: &Stage) -> Option<String> {
        let unmatched = self.unmatched();
        let first: Vec<String> = unmatched.iter().take(NAMED).map(|u| one(u, stage)).collect();
        let area = compensated_sum(unmatched.iter().map(|u| u.area));
        let share = 100.0 * self.of_scene().unmatched;
        let more = unmatched.len().saturating_sub(NAMED);
        let more = if more > 0 { format!(", and {more} more") } else { String::new() };
        (!unmatched.is_empty()).then(|| {
            let (n, first) = (unmatched.len(), first.join(", "));
            let plural = if n == 1 { "patch has" } else { "patches have" };
            format!(
                "{n} {plural} no face to take a value from ({area:.4} m^2, {share:.2} % of the area): {first}{more}"
            )
        })
    }
}

fn one(u: &Unmatched, stage: &Stage) -> String {
    let mut details = Vec::new();
    if u.share < 0.9995 {
        details.push(format!("{:.1} % of it", 100.0 * u.share));
    }
    if let Some(d) = u.nearest {
        details.push(format!("nearest face {d:.4} m away"));
    }
    let details = if details.is_empty() { String::new() } else { format!(" ({})", details.join(", ")) };
    format!("{} of \"{}\"{details}", u.patch, stage.surface_name(u.patch))
}
