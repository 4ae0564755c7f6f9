//! The pictures of a record: painted, captioned, with the colour bars that belong to them.

use super::ReportError;
use super::artifact::check_shape;
use super::asked::Level;
use super::format::{count, round_number, significant};
use crate::render::{
    Exposure, Field, LinearRgb, Mesh, Raster, Scale, Stencils, View, Visibility, difference, in_standard_errors,
    luminance, luminance_std_err, paint, paint_smooth, relative_difference, to_srgb8, vertex_colours,
};
use crate::solution::Radiosity;
use crate::study::Record;

/// Colours along a drawn bar.
const BAR_STOPS: usize = 25;
/// A difference picture in standard errors reaches at least this far: what lies within is no news.
const LEAST_Z: f64 = 3.0;

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
    /// `reference`, `candidate`, `difference`, `relative`, `std_err`, `z`, `reference-smooth` or `candidate-smooth`.
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

/// A colour bar.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ColourBar {
    /// Colours at equal steps from left to right, as `#rrggbb`.
    pub colours: Vec<String>,
    /// (place in percent, label).
    pub ticks: Vec<(String, String)>,
    /// Unit of the labels.
    pub unit: &'static str,
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
    let plates = plates(record, &mesh);
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
            Fill::Flat(palette) => paint(visibility, palette),
            Fill::Smooth(colours) => paint_smooth(visibility, mesh, colours),
        },
        bar: plate.bar.clone(),
    }
}

fn plates(record: &Record, mesh: &Mesh) -> Vec<Plate> {
    let exposure = exposure(record);
    let mut all = natural(record, &exposure);
    all.extend(shown_fields(record).into_iter().map(false_colour));
    all.extend(smooth(record, &exposure, mesh));
    all
}

/// One number per patch that is shown in false colour, with its words and its scale.
pub(super) struct ShownField {
    /// `difference`, `relative`, `std_err` or `z`.
    pub kind: &'static str,
    /// Title.
    pub title: &'static str,
    /// What is shown, without what the scale leaves out.
    pub what: String,
    /// The numbers.
    pub field: Field,
    /// Their colours.
    pub scale: Scale,
    /// Their unit.
    pub unit: Unit,
}

/// What is shown in false colour, the errors of the reference only where there are any.
pub(super) fn shown_fields(record: &Record) -> Vec<ShownField> {
    let (stage, photometry) = (&record.stage, &record.stage.photometry);
    let areas = stage.areas();
    let reference = luminance(photometry, &record.reference);
    let solution = luminance(photometry, &record.solution);
    let wrong = difference(&reference, &solution);
    let relative = relative_difference(&reference, &solution);
    let noise = luminance_std_err(photometry, &record.reference);
    let z = tested(record)
        .unwrap_or_else(|| in_standard_errors(&wrong, &noise, &luminance_std_err(photometry, &record.solution)));
    let shown = |kind, title, what: String, field, scale, unit| ShownField { kind, title, what, field, scale, unit };
    let scale = Scale::symmetric(&wrong, &areas, 0.0);
    let mut all = vec![shown("difference", "Signed difference", WRONG.into(), wrong, scale, WATTS)];
    let scale = Scale::symmetric(&relative, &areas, 0.0);
    all.push(shown("relative", "Relative difference", RELATIVE.into(), relative, scale, PERCENT));
    if !noise.is_blank() {
        let scale = Scale::from_zero(&noise, &areas);
        all.push(shown("std_err", "Standard error of the reference", NOISE.into(), noise, scale, WATTS));
        let scale = Scale::symmetric(&z, &areas, LEAST_Z);
        let what = format!("{IN_ERRORS}{}", beyond(record));
        all.push(shown("z", "Difference in standard errors", what, z, scale, ERRORS));
    }
    all
}

/// The scores that were tested, where they are of patches: then picture, histogram and counts agree.
fn tested(record: &Record) -> Option<Field> {
    let scores = &record.breakdown.as_ref()?.noise.as_ref()?.scores;
    let of_patches = Level::of(record) == Level::Patch && scores.len() == record.stage.patch_count();
    of_patches.then(|| Field { values: scores.clone() })
}

/// How many lie beyond what chance allows to all of them together.
fn beyond(record: &Record) -> String {
    let Some(noise) = record.breakdown.as_ref().and_then(|b| b.noise.as_ref()) else { return String::new() };
    let (family, nouns) = (&noise.family, Level::of(record).nouns());
    format!(
        " {} of {} {nouns} lie beyond {} standard errors, where chance alone would put {}.",
        count(family.count),
        count(noise.tested),
        significant(family.threshold, 3),
        significant(family.expected, 2)
    )
}

/// (unit, what a value is multiplied by for its label).
pub(super) type Unit = (&'static str, f64);
pub(super) const WATTS: Unit = ("W/m\u{b2}, luminance", 1.0);
const PERCENT: Unit = ("% of the reference", 100.0);
const ERRORS: Unit = ("standard errors", 1.0);

const WRONG: &str = "Solution minus reference: red where the solution is too bright, blue where it is too dark.";
const RELATIVE: &str = "The same as a share of what the reference has there: errors in dark corners show as clearly as \
                        those in the light.";
const NOISE: &str = "How well the reference itself is known.";
const SMOOTHED: &str = "Interpolated between vertices, as in Cohen and Greenberg (1985): how the solution would be shown. \
                        Nothing is judged by it.";
const IN_ERRORS: &str =
    "Differences against the noise: what stays within two or three is no evidence of an error in the solution.";

/// One exposure for all pictures in natural colours.
pub(super) fn exposure(record: &Record) -> Exposure {
    let stage = &record.stage;
    let is_emitter: Vec<bool> = (0..stage.patch_count()).map(|i| stage.emission(i).iter().any(|e| *e > 0.0)).collect();
    Exposure::fit(&stage.photometry, &luminance(&stage.photometry, &record.reference), &stage.areas(), &is_emitter)
}

/// What an exposure does, in a sentence.
pub(super) fn exposed(exposure: &Exposure) -> String {
    format!(
        "One linear scale for both pictures, then the sRGB curve: a luminance of {} W/m\u{b2} is shown white (99 % of \
         the reflecting area stays below); lamps may burn out.",
        significant(exposure.white_luminance, 3)
    )
}

/// Reference and solution as a camera would show them, one colour a patch.
fn natural(record: &Record, exposure: &Exposure) -> Vec<Plate> {
    let shown = exposed(exposure);
    let palette = |r: &Radiosity| Fill::Flat((0..r.len()).map(|i| Some(exposure.display(r.of(i)))).collect());
    let plate = |kind, title, caption, radiosity| Plate { kind, title, caption, fill: palette(radiosity), bar: None };
    vec![
        plate("reference", "Reference", shown, &record.reference),
        plate("candidate", "Solution", "The same exposure as the reference.".into(), &record.solution),
    ]
}

/// The same, shaded between the vertices.
fn smooth(record: &Record, exposure: &Exposure, mesh: &Mesh) -> Vec<Plate> {
    let stencils = Stencils::of(mesh);
    let plate = |kind, title, caption: &str, radiosity: &Radiosity| Plate {
        kind,
        title,
        caption: caption.into(),
        fill: Fill::Smooth(vertex_colours(&stencils, exposure, radiosity)),
        bar: None,
    };
    vec![
        plate("reference-smooth", "Reference, smoothed", SMOOTHED, &record.reference),
        plate("candidate-smooth", "Solution, smoothed", "Smoothed alike; the same exposure.", &record.solution),
    ]
}

fn false_colour(shown: ShownField) -> Plate {
    let ShownField { kind, title, what, field, scale, unit } = shown;
    let beyond = beyond_range(&scale);
    let bar = colour_bar(&scale, unit);
    let palette = field.values.iter().map(|v| v.map(|v| scale.colour(v))).collect();
    Plate { kind, title, caption: format!("{what}{beyond}"), fill: Fill::Flat(palette), bar: Some(bar) }
}

/// What a caption says of values that a scale does not reach.
pub(super) fn beyond_range(scale: &Scale) -> String {
    if scale.beyond > 0.0 {
        let share = significant(100.0 * scale.beyond, 2);
        format!(" {share} % of the area lies beyond the range and has its end colours.")
    } else {
        String::new()
    }
}

/// The bar of a scale.
pub(super) fn colour_bar(scale: &Scale, unit: Unit) -> ColourBar {
    let tick = |t: &crate::render::Tick| (round_number(100.0 * t.at), label(unit.1 * t.value, scale.low()));
    ColourBar {
        colours: scale.stops(BAR_STOPS).into_iter().map(hex).collect(),
        ticks: scale.ticks().iter().map(tick).collect(),
        unit: unit.0,
    }
}

/// A mark's label; signed on scales that reach below zero.
fn label(value: f64, low: f64) -> String {
    let plus = if value > 0.0 && low < 0.0 { "+" } else { "" };
    format!("{plus}{}", round_number(value))
}

fn hex(colour: LinearRgb) -> String {
    let [r, g, b] = colour.map(to_srgb8);
    format!("#{r:02x}{g:02x}{b:02x}")
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
    use crate::render::testing::{room, tracer};
    use crate::render::views;
    use crate::report::testing::record;

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
