//! The pictures of a record: painted, captioned, with the colour bars that belong to them.

mod bar;
mod fields;
mod look;

pub use bar::ColourBar;
pub(super) use bar::{beyond_range, colour_bar};
pub(super) use fields::{ShownField, Unit, WATTS, shown_fields};
pub(super) use look::{exposed, exposure};

use super::ReportError;
use super::artifact::check_shape;
use super::asked::Level;
use crate::render::{LinearRgb, Mesh, Raster, Stencils, View, Visibility, paint_cells, paint_smooth, vertex_colours};
use crate::solution::Radiosity;
use crate::study::Record;
use crate::view::Response;
use look::Look;

const SMOOTHED: &str = "Interpolated between vertices, as in Cohen and Greenberg (1985): how the solution would be shown. \
                        Nothing is judged by it.";

/// The pictures through one camera.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewFigures {
    /// Name of the camera.
    pub camera: String,
    /// File-name stem of its pictures.
    pub stem: String,
    /// True if the scene has no camera and this one was fitted.
    pub fitted: bool,
    /// Pictures in order of display.
    pub figures: Vec<Figure>,
    /// Where the worst patches show.
    pub marks: Vec<Mark>,
}

/// One picture with its words.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// `reference`, `candidate`, `difference`, `relative`, `std_err`, `z`, `steps`, `brils`, `reference-smooth` or
    /// `candidate-smooth`.
    pub kind: &'static str,
    /// Title.
    pub title: &'static str,
    /// What is shown, and how.
    pub caption: String,
    /// The pixels.
    pub raster: Raster,
    /// The colour bar; `None` for pictures in natural colours.
    pub bar: Option<ColourBar>,
}

/// Where one of the worst patches shows in the pictures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// Rank, 1 for the worst.
    pub rank: usize,
    /// Number of the patch, or of the element where elements are judged.
    pub number: usize,
    /// Pixels from the left.
    pub x: f64,
    /// Pixels from the top.
    pub y: f64,
}

/// What is painted, by patch, with the words that go with it: the same for every camera.
struct Plate {
    kind: &'static str,
    title: &'static str,
    caption: String,
    fill: Fill,
    bar: Option<ColourBar>,
    /// Of the screen it is made for.
    response: Response,
}

/// How the patches are filled.
enum Fill {
    /// One colour each.
    Flat(Vec<Option<LinearRgb>>),
    /// Shaded between colours at the vertices.
    Smooth(Vec<LinearRgb>),
}

/// All pictures of a record, one set for each view.
///
/// # Errors
/// [`ReportError::Shape`] where reference or solution do not belong to the scene.
pub fn figures(record: &Record, views: &[View]) -> Result<Vec<ViewFigures>, ReportError> {
    if views.is_empty() {
        return Ok(Vec::new());
    }
    check_shape(record)?;
    let mesh = Mesh::of_patches(&record.stage);
    let plates = plates(record, views, &mesh);
    let stems = stems(views);
    let view = |(v, stem): (&View, String)| ViewFigures {
        camera: v.visibility.camera().name.clone(),
        stem,
        fitted: v.fitted,
        figures: plates.iter().map(|p| print(p, &v.visibility, &mesh)).collect(),
        marks: marks(record, &v.visibility),
    };
    Ok(views.iter().zip(stems).map(view).collect())
}

fn print(plate: &Plate, visibility: &Visibility, mesh: &Mesh) -> Figure {
    Figure {
        kind: plate.kind,
        title: plate.title,
        caption: plate.caption.clone(),
        raster: match &plate.fill {
            Fill::Flat(palette) => paint_cells(visibility, mesh, palette, plate.response),
            Fill::Smooth(colours) => paint_smooth(visibility, mesh, colours, plate.response),
        },
        bar: plate.bar.clone(),
    }
}

fn plates(record: &Record, views: &[View], mesh: &Mesh) -> Vec<Plate> {
    let look = Look::of(record, views, mesh);
    let mut all = natural(record, &look);
    all.extend(shown_fields(record).into_iter().map(false_colour));
    all.extend(smooth(record, &look, mesh));
    all
}

/// Reference and solution as a camera would show them, one colour a patch.
fn natural(record: &Record, look: &Look) -> Vec<Plate> {
    let palette = |r: &Radiosity| Fill::Flat((0..r.len()).map(|i| Some(look.shade.display(r.of(i)))).collect());
    let plate = |kind, title, caption, radiosity| Plate {
        kind,
        title,
        caption,
        fill: palette(radiosity),
        bar: None,
        response: look.shade.response(),
    };
    vec![
        plate("reference", "Reference", look.words.clone(), &record.reference),
        plate("candidate", "Solution", "Shown as the reference is.".into(), &record.solution),
    ]
}

/// The same, shaded between the vertices.
fn smooth(record: &Record, look: &Look, mesh: &Mesh) -> Vec<Plate> {
    let stencils = Stencils::of(mesh);
    let plate = |kind, title, caption: &str, radiosity: &Radiosity| Plate {
        kind,
        title,
        caption: caption.into(),
        fill: Fill::Smooth(vertex_colours(&stencils, look.shade.as_ref(), radiosity)),
        bar: None,
        response: look.shade.response(),
    };
    vec![
        plate("reference-smooth", "Reference, smoothed", SMOOTHED, &record.reference),
        plate("candidate-smooth", "Solution, smoothed", "Smoothed alike.", &record.solution),
    ]
}

fn false_colour(shown: ShownField) -> Plate {
    let ShownField { kind, title, what, field, scale, unit } = shown;
    let beyond = beyond_range(&scale);
    let bar = colour_bar(&scale, unit);
    let palette = field.values.iter().map(|v| v.map(|v| scale.colour(v))).collect();
    Plate {
        kind,
        title,
        caption: format!("{what}{beyond}"),
        fill: Fill::Flat(palette),
        bar: Some(bar),
        response: Response::Srgb,
    }
}

fn marks(record: &Record, visibility: &Visibility) -> Vec<Mark> {
    let level = Level::of(record);
    let numbers: Vec<usize> = record.comparison.worst.iter().map(|w| w.patch).collect();
    // A number that belongs to no patch is in nobody's sight.
    let patches: Vec<usize> = numbers.iter().map(|n| level.patch(record, *n).unwrap_or(usize::MAX)).collect();
    let places = visibility.middles(&patches);
    let mark =
        |(k, place): (usize, &Option<(f64, f64)>)| place.map(|(x, y)| Mark { rank: k + 1, number: numbers[k], x, y });
    places.iter().enumerate().filter_map(mark).collect()
}

/// File-name stems: the camera's name where it is safe, made different where two are alike.
pub(super) fn stems(views: &[View]) -> Vec<String> {
    let safe = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' };
    let mut stems: Vec<String> = Vec::new();
    for (k, view) in views.iter().enumerate() {
        let plain: String = view.visibility.camera().name.chars().take(60).map(safe).collect();
        let stem = if plain.is_empty() { "view".to_string() } else { plain };
        // File systems that ignore case must not merge two cameras.
        let taken = stems.iter().any(|s| s.eq_ignore_ascii_case(&stem));
        stems.push(if taken { format!("{stem}-{}", k + 1) } else { stem });
    }
    stems
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::AsSeen;
    use crate::render::testing::{room, tracer};
    use crate::render::views;
    use crate::report::testing::record;
    use crate::stats::Estimate;
    use crate::view::{Display, Levels, Operator, Surround, Viewer};

    #[test]
    fn a_record_has_eight_pictures_and_four_bars() {
        let stage = room();
        let shown = figures(&record(), &views(&tracer(&stage))).expect("figures");
        let kinds: Vec<_> = shown[0].figures.iter().map(|f| (f.kind, f.bar.is_some())).collect();
        let expected = [
            ("reference", false),
            ("candidate", false),
            ("difference", true),
            ("relative", true),
            ("std_err", true),
            ("z", true),
            ("reference-smooth", false),
            ("candidate-smooth", false),
        ];
        assert_eq!(kinds, expected);
        let bar = shown[0].figures[2].bar.as_ref().expect("bar");
        assert_eq!((bar.ticks[2].0.as_str(), bar.ticks[2].1.as_str()), ("50", "0"));
        assert!(bar.ticks[0].1.starts_with('-') && bar.ticks[4].1.starts_with('+'));
        assert!(!shown[0].marks.is_empty());
    }

    #[test]
    fn where_somebody_looks_there_are_steps_and_brils_and_the_pictures_are_the_eyes() {
        let stage = room();
        let views = views(&tracer(&stage));
        let mut r = record();
        let plain = figures(&r, &views).expect("figures");
        let levels = Levels { log_mean: 20.0, brightest_surface: 200.0, unseen: 0.0 };
        let viewer = Viewer::new(Operator::Film, Surround::Dim, Display::crt(), 179.0, levels);
        let share = Estimate { value: 0.5, std_err: None, low: 0.4, high: 0.6 };
        r.as_seen = Some(AsSeen { share, worst: None, needed: None, viewer });
        let seen = figures(&r, &views).expect("figures");
        let kinds: Vec<_> = seen[0].figures.iter().map(|f| f.kind).collect();
        assert_eq!((kinds.len(), &kinds[6..8]), (10, &["steps", "brils"][..]));
        assert_ne!(plain[0].figures[0].raster, seen[0].figures[0].raster);
        assert!(seen[0].figures[0].caption.contains("as on film") && seen[0].figures[0].caption.contains("crt"));
    }

    #[test]
    fn a_reference_without_errors_has_no_pictures_of_them() {
        let stage = room();
        let mut r = record();
        r.reference.std_err = None;
        let shown = figures(&r, &views(&tracer(&stage))).expect("figures");
        assert_eq!(shown[0].figures.len(), 6);
    }

    #[test]
    fn names_of_cameras_cannot_leave_the_folder_or_collide() {
        let stage = room();
        let view = views(&tracer(&stage)).remove(0);
        let named = |name: &str| {
            let mut camera = view.visibility.camera().clone();
            (camera.name, camera.size) = (name.into(), [1, 1]);
            View { visibility: Visibility::cast(&tracer(&stage), &camera, 1), fitted: false }
        };
        let stems = stems(&["../a/b", "Main", "main", ""].map(named));
        assert_eq!(stems, ["___a_b", "Main", "main-3", "view"]);
    }

    #[test]
    fn radiosities_of_another_scene_are_refused() {
        let stage = room();
        let mut r = record();
        r.solution.values.truncate(30);
        let e = figures(&r, &views(&tracer(&stage))).expect_err("shape");
        assert!(e.to_string().contains("the solution has 30 values"), "{e}");
    }
}
