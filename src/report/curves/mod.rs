//! Curves as tables, drawings and a page: of a run, of a refinement of the mesh, of two runs overlaid.

mod figures;
mod page;
mod pictures;
mod summary;
mod table;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod words;

pub use super::scene3d::{Filmed, Parts as Film, film};
pub use pictures::{Picture, Pictures, Shown, pictures};
pub use summary::{convergence_json, convergence_text, difference_json, difference_text, mesh_json, mesh_text};
pub use table::read_curves;

use super::json::timing_file;
use super::{Artifact, Phase, ReportError};
use crate::study::converge::{Curve, Difference, Digest, MeshCurve};

/// Name of the judged snapshots in a folder of curves.
pub const CURVES_NAME: &str = "curves.csv";
/// Name of the page there.
pub const CURVES_PAGE: &str = "index.html";

/// What a page says about its run.
#[derive(Debug, Clone, Default)]
pub struct About {
    /// Scene, with its state where there is one.
    pub scene: String,
    /// Two-sided confidence of the intervals.
    pub confidence: f64,
    /// Settings in force: (name, value).
    pub settings: Vec<(String, String)>,
    /// Where everything comes from: (what, value).
    pub provenance: Vec<(String, String)>,
    /// Things the reader has to know.
    pub notices: Vec<String>,
    /// The command that repeats this run.
    pub replay: String,
    /// Wall-clock times, apart from everything else.
    pub timing: Vec<Phase>,
}

/// Convergence curves of a run.
#[derive(Debug, Clone)]
pub struct CurvesReport {
    /// About the run.
    pub about: About,
    /// Judged snapshots by method and state.
    pub curves: Vec<Curve>,
    /// What is read off them.
    pub digest: Digest,
    /// Pictures on the way, by state.
    pub pictures: Vec<Pictures>,
    /// The scene on the way, to turn.
    pub film: Option<Film>,
}

/// Errors against the size of the mesh.
#[derive(Debug, Clone)]
pub struct MeshReport {
    /// About the run.
    pub about: About,
    /// By method.
    pub curves: Vec<MeshCurve>,
}

/// Two runs overlaid.
#[derive(Debug, Clone)]
pub struct DifferenceReport {
    /// About both.
    pub about: About,
    /// What the runs are called.
    pub names: [String; 2],
    /// Their curves.
    pub curves: [Vec<Curve>; 2],
    /// Curves of equal method and state held against each other.
    pub differences: Vec<Difference>,
}

/// The folder of a run: tables, drawings, page, clock.
///
/// # Errors
/// [`ReportError::Page`] or [`ReportError::Json`], which no data provokes.
pub fn convergence_files(report: &CurvesReport) -> Result<Vec<Artifact>, ReportError> {
    let figures = figures::of_curves(report);
    let tables = vec![
        Artifact::new(CURVES_NAME, table::curves(&report.curves)),
        Artifact::new("rates.csv", table::rates(&report.digest)),
        Artifact::new("reached.csv", table::reached(&report.digest)),
    ];
    let mut all = files(&report.about, tables, &figures, page::of_curves(report, &figures)?)?;
    let pictures = report.pictures.iter().flat_map(|p| p.rows.iter().flatten());
    all.extend(pictures.map(|p| Artifact::new(p.file.clone(), p.png.clone())));
    Ok(all)
}

/// The folder of a refinement.
///
/// # Errors
/// As [`convergence_files`].
pub fn mesh_files(report: &MeshReport) -> Result<Vec<Artifact>, ReportError> {
    let figures = figures::of_meshes(report);
    let tables =
        vec![Artifact::new("refine.csv", table::meshes(report)), Artifact::new("orders.csv", table::orders(report))];
    files(&report.about, tables, &figures, page::of_meshes(report, &figures)?)
}

/// The folder of two runs overlaid.
///
/// # Errors
/// As [`convergence_files`].
pub fn difference_files(report: &DifferenceReport) -> Result<Vec<Artifact>, ReportError> {
    let figures = figures::of_difference(report);
    let tables = vec![Artifact::new("diff.csv", table::differences(&report.differences))];
    files(&report.about, tables, &figures, page::of_difference(report, &figures)?)
}

fn files(
    about: &About,
    tables: Vec<Artifact>,
    figures: &[figures::Drawing],
    page: String,
) -> Result<Vec<Artifact>, ReportError> {
    let mut out = tables;
    out.extend(super::chart::files(figures.iter().map(|f| &f.chart)));
    out.push(Artifact::new(CURVES_PAGE, page));
    if !about.timing.is_empty() {
        out.push(timing_file(&about.timing)?);
    }
    Ok(out)
}
