//! What people should know of how values were carried.

use super::{Carried, Unmatched};
use crate::math::compensated_sum;
use crate::scene::Stage;

/// So many faces or patches are named; the others are counted.
const NAMED: usize = 10;

impl Carried {
    /// Sentences, most important first; none where every patch was covered by faces of its own.
    pub fn notices(&self) -> Vec<String> {
        let mut told = Vec::new();
        if self.turned {
            told.push("all faces are wound backwards: they were turned around, since none matched as it is".into());
        }
        if self.crossed > 0 {
            told.push(format!("{} faces have an outline that crosses itself and were left out", self.crossed));
        }
        if self.doubled > 0.0 {
            told.push(format!("{:.4} m^2 are covered by several faces: their values were averaged there", self.doubled));
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
        let mut idle: Vec<&(usize, f64)> = self.idle.iter().filter(|(_, area)| *area > 0.0).collect();
        if idle.is_empty() {
            return None;
        }
        let total = compensated_sum(idle.iter().map(|(_, a)| *a));
        idle.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        let named: Vec<String> = idle.iter().take(NAMED).map(|(f, _)| f.to_string()).collect();
        let most = if idle.len() > NAMED { "the largest: " } else { "" };
        Some(format!(
            "{} of {} faces match no patch ({total:.4} m^2; {most}{})",
            idle.len(),
            self.faces,
            named.join(", ")
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
            format!("{n} {plural} no face to take a value from ({area:.4} m^2, {share:.2} % of the area): {first}{more}")
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
