//! Finished records as pages, tables and files. Formats, never computes.
//!
//! Every output is an [`Exporter`]; what several outputs show is made ready once: [`headline`] says the verdict in
//! a sentence, [`metric_lines`] and [`worst_lines`] are the tables.

mod artifact;
mod asked;
pub mod audit;
mod brightness;
mod changes;
mod chart;
pub mod compositing;
pub mod curves;
pub mod envmap;
mod figures;
mod format;
mod frame;
mod gallery;
mod headline;
mod html;
mod json;
mod junit;
mod layers;
mod lines;
mod markdown;
mod number;
mod plots;
mod scene3d;
mod split;
mod template;
#[cfg(test)]
mod testing;
mod text;
mod thumbnail;
mod tone;

pub use artifact::{Artifact, Exporter, Extras, Phase, ReportError, save};
pub use brightness::brightness_files;
pub use changes::change_lines;
pub use figures::{ColourBar, Figure, Mark, ViewFigures, figures};
pub use headline::{Headline, headline, warnings};
pub use html::{HtmlReport, PAGE_NAME};
pub use json::{Json, RECORD_NAME, TIMING_NAME, json_object, read_record, read_timing};
pub use junit::JUnit;
pub use layers::exr_layers;
pub use lines::{MetricLine, WorstLine, metric_lines, worst_lines};
pub use markdown::Markdown;
pub use text::{Text, one_line, text_summary};
pub use tone::{tone_json, tone_words};
