//! A record as the layers of one EXR picture.

use super::ReportError;
use super::artifact::check_shape;
use super::figures::shown_fields;
use crate::io::image::{Channel, Samples, channel_names, exr};
use crate::render::Visibility;
use crate::solution::Radiosity;
use crate::study::Record;

const COMMENTS: &str = "Radiosities in W/m^2 per band, linear, not tone-mapped; premultiplied by coverage (A). \
Layers: reference (also shown as the main layer), std_err of the reference, candidate, difference = candidate - \
reference; where somebody looks, steps and brils: the difference in steps of the display and in brightness; patch.number is the patch in the upper left sample of the pixel, 4294967295 where there is none.";

/// The reference, its standard errors, the candidate and the difference as seen by one camera, per band in f32,
/// with the coverage and the patch numbers.
///
/// # Errors
/// [`ReportError::Shape`] where reference or solution do not belong to the scene.
pub fn exr_layers(record: &Record, visibility: &Visibility) -> Result<Vec<u8>, ReportError> {
    check_shape(record)?;
    let errors = record.reference.std_err.as_ref();
    let mut channels = Vec::new();
    for (c, name) in channel_names(&record.stage.photometry.bands).iter().enumerate() {
        let of = |r: &Radiosity| column(&r.values, r.bands, c);
        let (reference, candidate) = (of(&record.reference), of(&record.solution));
        let difference: Vec<f64> = candidate.iter().zip(&reference).map(|(s, r)| s - r).collect();
        let mut add = |layer: &str, values: &[f64]| {
            channels.push(Channel { name: format!("{layer}{name}"), samples: resolve(visibility, values) });
        };
        add("", &reference);
        add("reference.", &reference);
        add("candidate.", &candidate);
        add("difference.", &difference);
        if let Some(e) = errors {
            add("std_err.", &column(e, record.reference.bands, c));
        }
    }
    for shown in shown_fields(record).into_iter().filter(|s| ["steps", "brils"].contains(&s.kind)) {
        let values: Vec<f64> = shown.field.values.iter().map(|v| v.unwrap_or(f64::NAN)).collect();
        channels.push(Channel { name: format!("{}.Y", shown.kind), samples: resolve(visibility, &values) });
    }
    let whole = vec![1.0; record.stage.patch_count()];
    channels.push(Channel { name: "A".into(), samples: resolve(visibility, &whole) });
    channels.push(Channel { name: "patch.number".into(), samples: numbers(visibility, whole.len()) });
    let [width, height] = visibility.size();
    Ok(exr(width, height, &channels, COMMENTS)?)
}

fn column(values: &[f64], bands: usize, c: usize) -> Vec<f64> {
    values.iter().skip(c).step_by(bands).copied().collect()
}

/// Values of patches averaged over the samples of each pixel; what is no patch counts as 0.
fn resolve(visibility: &Visibility, values: &[f64]) -> Samples {
    let pixel = |p| {
        let samples = visibility.samples(p);
        // A pixel inside one patch holds its value exactly.
        if samples.iter().all(|s| *s == samples[0]) {
            return values.get(samples[0] as usize).map_or(0.0, |v| *v as f32);
        }
        let sum: f64 = samples.iter().filter_map(|s| values.get(*s as usize)).sum();
        (sum / samples.len() as f64) as f32
    };
    Samples::F32((0..visibility.pixel_count()).map(pixel).collect())
}

fn numbers(visibility: &Visibility, patches: usize) -> Samples {
    let number = |p| Some(visibility.samples(p)[0]).filter(|n| (*n as usize) < patches).unwrap_or(u32::MAX);
    Samples::U32((0..visibility.pixel_count()).map(number).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::testing::{room, tracer};
    use crate::report::testing::record;
    use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
    use std::collections::HashMap;
    use std::io::Cursor;

    fn decode(bytes: Vec<u8>) -> HashMap<String, FlatSamples> {
        let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
        let image = reader.all_attributes().from_buffered(Cursor::new(bytes)).expect("decodes");
        let list = image.layer_data.channel_data.list;
        list.into_iter().map(|c| (c.name.to_string(), c.sample_data)).collect()
    }

    #[test]
    fn layers_hold_the_values_of_the_patches_exactly() {
        let (stage, record) = (room(), record());
        let seen = Visibility::cast(&tracer(&stage), &stage.cameras[0], 2);
        let bytes = exr_layers(&record, &seen).expect("exr");
        assert_eq!(bytes, exr_layers(&record, &seen).expect("exr"));
        let layers = decode(bytes);
        assert_eq!(layers.len(), 3 * 5 + 2);
        let FlatSamples::U32(numbers) = &layers["patch.number"] else { panic!("numbers") };
        let errors = record.reference.std_err.as_ref().expect("errors");
        let value = |name: &str, p: usize| f64::from(layers[name].value_by_flat_index(p).to_f32());
        let mut inside = 0;
        for p in (0..seen.pixel_count()).filter(|p| seen.coverage(*p).len() == 1) {
            let i = numbers[p] as usize;
            for (c, band) in ["R", "G", "B"].iter().enumerate() {
                let (b, s) = (record.reference.of(i)[c], record.solution.of(i)[c]);
                assert_eq!(value(band, p), f64::from(b as f32));
                assert_eq!(value(&format!("reference.{band}"), p), f64::from(b as f32));
                assert_eq!(value(&format!("candidate.{band}"), p), f64::from(s as f32));
                assert_eq!(value(&format!("difference.{band}"), p), f64::from((s - b) as f32));
                assert_eq!(value(&format!("std_err.{band}"), p), f64::from(errors[3 * i + c] as f32));
            }
            assert_eq!(value("A", p), 1.0);
            inside += 1;
        }
        assert!(inside > seen.pixel_count() / 2, "{inside}");
    }
}
