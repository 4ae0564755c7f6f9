//! What a page needs to hold a view: markup, style, the program, its library and the licence of it.

use super::SceneView;
use serde::Serialize;

/// Markup and style, for pages to include; all of them speak of `viewer`.
pub(in crate::report) const TEMPLATES: [(&str, &str); 4] = [
    ("viewer.html", include_str!("page/viewer.html.j2")),
    ("viewer.css", include_str!("page/viewer.css")),
    ("viewer_licence.html", include_str!("page/viewer_licence.html.j2")),
    ("viewer_script.html", include_str!("page/viewer_script.html.j2")),
];
/// The library that draws.
pub(in crate::report) const LIBRARY: &str = include_str!("../vendor/three.min.js");
const LICENCES: &str = include_str!("../vendor/LICENSES.txt");
/// The program, in the order in which its parts know each other.
const PROGRAM: &str = concat!(
    include_str!("page/data.js"),
    include_str!("page/shaders.js"),
    include_str!("page/geometry.js"),
    include_str!("page/camera.js"),
    include_str!("page/scale.js"),
    include_str!("page/panel.js"),
    include_str!("page/drawing.js"),
    include_str!("page/controls.js"),
    include_str!("page/viewer.js"),
);

const OF_A_RECORD: &str = "One flat colour a patch: its own value, nothing lit or smoothed. Click a patch for its \
                           numbers, a row of the tables below to fly to its worst patch. What looks away is left out, so \
                           that one sees into a room from outside.";
const OF_A_FILM: &str = "Each series on its way to the reference, one flat colour a patch: nothing is lit or smoothed. Play the \
                         steps or pull the slider; click a patch for its numbers. What looks away is left out, so that one \
                         sees into a room from outside.";

/// A view as a page holds it: ready text, nothing of which may be escaped again.
#[derive(Debug, Clone, Serialize)]
pub struct Parts {
    lead: &'static str,
    data: String,
    library: &'static str,
    program: &'static str,
    licence: String,
}

impl Parts {
    /// A view as the parts of a page.
    ///
    /// # Errors
    /// [`serde_json::Error`], which no view provokes.
    pub(in crate::report) fn of(view: &SceneView) -> Result<Self, serde_json::Error> {
        // In a script element `<` alone could end it or begin a comment.
        let data = serde_json::to_string(view)?.replace('<', "\\u003c");
        let lead = if view.is_film() { OF_A_FILM } else { OF_A_RECORD };
        Ok(Self { lead, data, library: LIBRARY, program: PROGRAM, licence: licence_of("three.js") })
    }
}

/// The notice of one library, out of those of all.
fn licence_of(library: &str) -> String {
    let begins = |line: &str| line.ends_with(".js)");
    let mut mine = false;
    let mut out = String::new();
    for line in LICENCES.lines() {
        if begins(line) {
            mine = line.starts_with(library);
        }
        if mine {
            out += line;
            out.push('\n');
        }
    }
    out.trim_end().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::scene3d::scene_view;
    use crate::report::testing::record;

    #[test]
    fn the_licence_of_the_library_and_of_nothing_else() {
        let text = licence_of("three.js");
        assert!(text.starts_with("three.js") && text.contains("Permission is hereby granted"));
        assert!(text.ends_with("THE SOFTWARE.") && !text.contains("Plotly"));
    }

    #[test]
    fn no_name_can_end_the_script_that_holds_it() {
        let mut r = record();
        r.stage.surfaces[0].name = "</script><script>alert(1)</script><!--".into();
        let parts = Parts::of(&scene_view(&r, &[]).expect("a view")).expect("json");
        assert!(!parts.data.contains('<'));
        let back: serde_json::Value = serde_json::from_str(&parts.data).expect("json");
        assert_eq!(back["surfaces"][0][0], r.stage.surfaces[0].name);
        // Nor can what is inlined beside it.
        assert!(!parts.program.contains("</script") && !parts.library.contains("</script"));
    }
}
