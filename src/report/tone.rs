//! What is said of a tone-mapped picture.

use super::format::significant;
use crate::render::Clipped;
use crate::view::{Observer, Viewer};
use serde_json::{Value, json};

/// The operator, the eye and the screen in a few sentences.
pub fn tone_words(viewer: &Viewer, clipped: Clipped) -> String {
    let three = |x: f64| significant(x, 3);
    let percent = |x: f64| if x > 0.0 { format!("{} %", significant(100.0 * x, 2)) } else { "nothing".into() };
    let adapted = Observer::new(viewer.levels.adapts_to());
    let mut words = format!("Shown {}, on {}. ", viewer.operator.title(), viewer.display);
    if viewer.tone.eye.is_some() {
        words.push_str(&format!(
            "The eye is adapted to {} cd/m\u{b2} ({} dB). ",
            three(adapted.adapted_to),
            three(adapted.stevens())
        ));
    }
    words.push_str(&format!(
        "Too dark for the screen: {} of the picture; too bright: {}. A radiosity of 1 W/m\u{b2} is {} cd/m\u{b2} ({} lm/W).",
        percent(clipped.black),
        percent(clipped.white),
        three(viewer.luminance(1.0)),
        viewer.efficacy
    ));
    if viewer.levels.unseen > 0.0 {
        let share = percent(viewer.levels.unseen);
        words.push_str(&format!(
            " {share} of the picture is darker than can be seen at all and left out of the adaptation."
        ));
    }
    if viewer.tone.too_dark.is_some() {
        words.push_str(
            " The scene is darker than the eye's model reaches: below 27 dB it says that more light looks darker, so the \
             eye is kept at 27 dB, where all light looks alike.",
        );
    }
    words
}

/// The same as data.
pub fn tone_json(viewer: &Viewer, clipped: Clipped) -> Value {
    let adapted = Observer::new(viewer.levels.adapts_to());
    let display = &viewer.display;
    json!({
        "operator": viewer.operator.name(),
        "display": { "name": display.name, "peak": display.peak, "contrast": display.contrast, "response": display.response },
        "efficacy": viewer.efficacy,
        "adapted_to": adapted.adapted_to,
        "adapted_to_db": adapted.stevens(),
        "below_27_db": adapted.is_inverted(),
        "log_mean": viewer.levels.log_mean,
        "brightest_surface": viewer.levels.brightest_surface,
        "unseen": viewer.levels.unseen,
        "clipped_black": clipped.black,
        "clipped_white": clipped.white,
    })
}
