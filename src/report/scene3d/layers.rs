//! What is shown on the patches: numbers in false colour, and lists of ready colours.

use super::encode::{bytes, numbers};
use crate::render::{ColourMap, Field, Scale, Shade, ToneMap, luminance, to_byte, to_srgb8};
use crate::report::figures::{Unit, WATTS, beyond_range, exposed, exposure, shown_fields};
use crate::report::html::context::minus;
use crate::solution::Radiosity;
use crate::study::{Before, Record};
use crate::view::Operator;
use serde::Serialize;

/// Colours of a map are handed over at this many equal steps; odd, so that the middle is one of them.
const STEPS: usize = 1025;

/// One number per patch in false colour.
#[derive(Debug, Serialize)]
pub(in crate::report) struct Layer {
    /// Its name among the others.
    pub key: String,
    /// Title.
    pub title: String,
    /// What is shown, in a sentence.
    pub note: String,
    /// Unit of the labels.
    pub unit: &'static str,
    /// What a value is multiplied by for its label.
    pub factor: f64,
    /// `sequential` or `diverging`.
    pub map: &'static str,
    /// Value at the lower end of the bar.
    pub low: f64,
    /// Value at the upper end.
    pub high: f64,
    /// Layers with the same word keep the same range.
    pub range: String,
    /// True for what stood there before the edit.
    pub before: bool,
    /// One value per patch (f32), NaN where there is none; empty for a film.
    pub values: String,
    /// Number of the film that has its values, step by step.
    pub film: Option<usize>,
    /// Key of the layer that is taken off them.
    pub minus: Option<String>,
}

/// A way from radiosities to what a display shows.
#[derive(Debug, Serialize)]
pub(in crate::report) struct Colouring {
    /// Its name among the others.
    pub key: String,
    /// Title.
    pub title: String,
    /// What is shown, in a sentence.
    pub note: String,
    /// Colours of the reference: red, green, blue as sRGB codes, by patch.
    pub reference: String,
    /// Colours of the solution; `None` where there is none.
    pub candidate: Option<String>,
    /// Colours of what stood there before the edit.
    pub before: Option<String>,
}

/// The colour maps at equal steps: red, green, blue as sRGB codes.
#[derive(Debug, Serialize)]
pub(in crate::report) struct Maps {
    sequential: String,
    diverging: String,
}

impl Maps {
    pub(super) fn new() -> Self {
        let map = |map: ColourMap, low: f64| {
            let at = |k: usize| low + (1.0 - low) * k as f64 / (STEPS - 1) as f64;
            bytes(&(0..STEPS).flat_map(|k| map.colour(at(k)).map(to_srgb8)).collect::<Vec<u8>>())
        };
        Self { sequential: map(ColourMap::Sequential, 0.0), diverging: map(ColourMap::Diverging, -1.0) }
    }
}

impl Layer {
    /// A layer with the colours of a scale.
    pub(super) fn new(key: &str, title: &str, note: &str, field: &Field, scale: &Scale, unit: Unit) -> Self {
        Self {
            key: key.into(),
            title: title.into(),
            note: minus(&format!("{note}{}", beyond_range(scale))),
            unit: unit.0,
            factor: unit.1,
            map: if scale.low() < 0.0 { "diverging" } else { "sequential" },
            low: scale.low(),
            high: scale.high,
            range: key.into(),
            before: false,
            values: numbers(field.values.iter().copied()),
            film: None,
            minus: None,
        }
    }

    /// The same over the range of another.
    pub(super) fn in_range_of(self, range: &str) -> Self {
        Self { range: range.into(), ..self }
    }
}

/// Layers of a record in order of display.
pub(super) fn layers(record: &Record, before: Option<&Before>) -> Vec<Layer> {
    let photometry = &record.stage.photometry;
    let reference = known(luminance(photometry, &record.reference));
    let solution = known(luminance(photometry, &record.solution));
    let scale = Scale::from_zero(&reference, &record.stage.areas());
    let bright =
        |key, title, note, field: &Field| Layer::new(key, title, note, field, &scale, WATTS).in_range_of("light");
    let mut all = vec![
        bright("reference", "Luminance of the reference", "In false colour.", &reference),
        bright("candidate", "Luminance of the solution", "In the colours of the reference.", &solution),
    ];
    if let Some(before) = before {
        let field = known(luminance(photometry, &before.reference));
        let layer = bright("before", "Luminance before the edit", &before_note(before), &field);
        all.push(Layer { before: true, ..layer });
    }
    let shown = shown_fields(record);
    all.extend(shown.iter().map(|s| Layer::new(s.kind, s.title, &s.what, &s.field, &s.scale, s.unit)));
    all
}

pub(super) fn before_note(before: &Before) -> String {
    format!("State {} of the scene, by the reference {}.", before.stage.state, before.name)
}

/// Every number as one that is known.
pub(super) fn known(values: Vec<f64>) -> Field {
    Field { values: values.into_iter().map(|v| Some(v).filter(|v| v.is_finite())).collect() }
}

/// Ways to show reference and solution in natural colours: through the eye that looked, by every operator, the one asked for
/// first; and on one linear scale.
pub(super) fn colourings(record: &Record, before: Option<&Before>) -> Vec<Colouring> {
    let painted = |key: &str, title: &str, note: String, shade: &dyn Shade| Colouring {
        key: key.into(),
        title: title.into(),
        note: minus(&note),
        reference: coloured(shade, &record.reference),
        candidate: Some(coloured(shade, &record.solution)),
        before: before.map(|b| coloured(shade, &b.reference)),
    };
    let mut all = Vec::new();
    if let Some(seen) = &record.as_seen {
        let asked = seen.viewer.operator;
        for operator in std::iter::once(asked).chain(Operator::ALL.into_iter().filter(|o| *o != asked)) {
            let map = ToneMap::new(seen.viewer.with(operator), &record.stage.photometry);
            let note = format!("Shown {}, on {}.", operator.title(), seen.viewer.display);
            all.push(painted(operator.name(), operator.title(), note, &map));
        }
    }
    let exposure = exposure(record);
    all.push(painted("exposure", "one linear exposure", exposed(&exposure), &exposure));
    all
}

/// Codes of a display, by patch.
pub(super) fn coloured(shade: &dyn Shade, radiosity: &Radiosity) -> String {
    let code = |x: f64| to_byte(shade.response(), x);
    let codes = (0..radiosity.len()).flat_map(|i| shade.display(radiosity.of(i)).map(code));
    bytes(&codes.collect::<Vec<u8>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::testing::record;
    use base64::Engine;
    use base64::engine::general_purpose::STANDARD;

    fn values(layer: &Layer) -> Vec<f32> {
        let bytes = STANDARD.decode(&layer.values).expect("base64");
        bytes.chunks_exact(4).map(|c| f32::from_le_bytes(c.try_into().expect("four"))).collect()
    }

    #[test]
    fn layers_hold_the_numbers_of_the_pictures() {
        let record = record();
        let all = layers(&record, None);
        let keys: Vec<&str> = all.iter().map(|l| l.key.as_str()).collect();
        assert_eq!(keys, ["reference", "candidate", "difference", "relative", "std_err", "z"]);
        let worst = &record.comparison.worst[0];
        assert_eq!(values(&all[0])[worst.patch], worst.reference as f32);
        assert_eq!(values(&all[1])[worst.patch], worst.solution as f32);
        assert_eq!(values(&all[2])[worst.patch], worst.difference as f32);
        assert_eq!((all[2].map, all[2].low), ("diverging", -all[2].high));
        // The ceiling is black: no relative difference there, and none is not 0.
        let black = values(&all[0]).iter().position(|v| *v == 0.0).expect("the ceiling");
        assert!(values(&all[3])[black].is_nan());
    }

    #[test]
    fn the_middle_of_the_diverging_map_is_the_colour_of_zero() {
        let map = STANDARD.decode(Maps::new().diverging).expect("base64");
        let middle = 3 * (STEPS / 2);
        assert_eq!(map[middle..middle + 3], ColourMap::Diverging.colour(0.0).map(to_srgb8));
    }

    #[test]
    fn natural_colours_are_those_of_the_pictures() {
        let record = record();
        let all = colourings(&record, None);
        let codes = STANDARD.decode(&all[0].reference).expect("base64");
        let exposure = exposure(&record);
        assert_eq!(codes[30..33], exposure.display(record.reference.of(10)).map(to_srgb8));
    }
}
