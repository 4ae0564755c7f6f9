//! Error maps: what every patch errs by, in all and by cause, through each camera.

use crate::audit::Cause;
use crate::render::{Field, LinearRgb, Raster, Scale, View, area_percentile, paint};
use crate::report::figures::{WATTS, beyond_range, colour_bar, stems};
use crate::report::format::significant;
use crate::report::html::context::minus;
use crate::report::html::pictures::{BarBlock, bar_block};
use crate::scene::Stage;
use crate::study::audit::{AuditRecord, Receiver};
use serde::Serialize;

/// Share of the area that stays below white in the picture of the light.
const WHITE: f64 = 0.99;

/// The maps of one camera.
#[derive(Debug, Serialize)]
pub(super) struct MapView {
    pub camera: String,
    /// True if the scene has no camera and this one was fitted.
    pub fitted: bool,
    pub figures: Vec<Map>,
}

/// One picture with its words.
#[derive(Debug, Serialize)]
pub(super) struct Map {
    pub id: String,
    pub title: String,
    pub caption: String,
    /// File name in the folder.
    pub file: String,
    pub width: u32,
    pub height: u32,
    #[serde(skip)]
    pub raster: Raster,
    pub bar: Option<BarBlock>,
    pub marks: Vec<MapMark>,
}

/// Where a receiver that is listed shows.
#[derive(Debug, Serialize)]
pub(super) struct MapMark {
    pub rank: usize,
    pub patch: usize,
    pub x: String,
    pub y: String,
    pub radius: String,
    pub font: String,
}

/// What is painted: the same for every camera.
struct Plate {
    kind: &'static str,
    title: String,
    caption: String,
    palette: Vec<Option<LinearRgb>>,
    bar: Option<BarBlock>,
}

/// Maps of every view; the scale is one for all of them.
pub(super) fn maps(record: &AuditRecord, stage: &Stage, views: &[View]) -> Vec<MapView> {
    if views.is_empty() {
        return Vec::new();
    }
    let plates = plates(record, stage);
    let of = |(view, stem): (&View, String)| MapView {
        camera: view.visibility.camera().name.clone(),
        fitted: view.fitted,
        figures: plates.iter().map(|p| print(p, view, &stem, record)).collect(),
    };
    views.iter().zip(stems(views)).map(of).collect()
}

fn print(plate: &Plate, view: &View, stem: &str, record: &AuditRecord) -> Map {
    let raster = paint(&view.visibility, &plate.palette);
    Map {
        id: format!("map-{stem}-{}", plate.kind),
        title: plate.title.clone(),
        caption: minus(&plate.caption),
        file: format!("map-{stem}-{}.png", plate.kind),
        width: raster.width,
        height: raster.height,
        bar: plate.bar.clone(),
        marks: if plate.kind == "error" { marks(record, view, raster.width) } else { Vec::new() },
        raster,
    }
}

/// The worst receivers of the first source, by their rank.
fn marks(record: &AuditRecord, view: &View, width: u32) -> Vec<MapMark> {
    let Some(source) = record.sources.first() else { return Vec::new() };
    let patches: Vec<usize> = source.seen.worst.iter().map(|w| w.patch as usize).collect();
    let radius = f64::from(width) / 60.0;
    let mark = |(k, place): (usize, &Option<(f64, f64)>)| {
        place.map(|(x, y)| MapMark {
            rank: k + 1,
            patch: patches[k],
            x: format!("{x:.1}"),
            y: format!("{y:.1}"),
            radius: format!("{radius:.1}"),
            font: format!("{:.1}", 1.2 * radius),
        })
    };
    view.visibility.middles(&patches).iter().enumerate().filter_map(mark).collect()
}

fn plates(record: &AuditRecord, stage: &Stage) -> Vec<Plate> {
    let areas = stage.areas();
    let field = |of: &dyn Fn(&Receiver) -> f64| Field {
        values: (record.receivers.iter().enumerate())
            .map(|(i, r)| stage.patches[i].is_present().then(|| of(r)))
            .collect(),
    };
    let total = field(&|r| r.carried.iter().sum());
    let parts = [0, 1, 2].map(|k| field(&|r| r.carried[k]));
    // One scale for all of them: the widest that one of them asks for.
    let all = || std::iter::once(&total).chain(&parts);
    let widest = all().filter(|f| !f.is_blank()).map(|f| Scale::symmetric(f, &areas, 0.0).high).fold(0.0, f64::max);
    let mut plates = vec![light(record, stage, &areas)];
    let unscaled = "Hemi-cube minus truth, carried through all bounces: red where it makes the scene too bright, blue \
                    where too dark.";
    plates.push(map("error", "The whole error".into(), unscaled, &total, &areas, widest));
    for (cause, part) in Cause::ALL.into_iter().zip(&parts) {
        let caption = match cause {
            Cause::Aliasing => "What pixels standing for areas do. The same scale.",
            Cause::Proximity => "What centres standing for patches do. The same scale.",
            Cause::Visibility => "What the centre's sight past others standing for the patch's does. The same scale.",
        };
        plates.push(map(cause.name(), title(cause), caption, part, &areas, widest));
    }
    plates
}

fn title(cause: Cause) -> String {
    let name = cause.name();
    name[..1].to_uppercase() + &name[1..]
}

fn map(kind: &'static str, title: String, what: &str, field: &Field, areas: &[f64], widest: f64) -> Plate {
    let scale = Scale::symmetric(field, areas, widest);
    Plate {
        kind,
        title,
        caption: format!("{what}{}", beyond_range(&scale)),
        palette: field.values.iter().map(|v| v.map(|v| scale.colour(v))).collect(),
        bar: Some(bar_block(&colour_bar(&scale, WATTS))),
    }
}

/// The light itself in greys, so that the maps can be found one's way in.
fn light(record: &AuditRecord, stage: &Stage, areas: &[f64]) -> Plate {
    let shown = |i: usize| {
        let own = stage.photometry.luminance(stage.emission(i));
        own + record.receivers[i].reflected
    };
    let reflecting = record.receivers.iter().zip(areas).map(|(r, a)| (r.reflected, *a));
    let white = area_percentile(reflecting, WHITE).filter(|w| *w > 0.0).unwrap_or(1.0);
    let grey = |i: usize| stage.patches[i].is_present().then(|| [(shown(i) / white).clamp(0.0, 1.0); 3]);
    Plate {
        kind: "light",
        title: "The light".into(),
        caption: format!(
            "The truth, for orientation: luminance by the reference, white from {} W/m\u{b2} on.",
            significant(white, 3)
        ),
        palette: (0..record.receivers.len()).map(grey).collect(),
        bar: None,
    }
}
