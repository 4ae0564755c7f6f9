//! Painting: natural colours, quantities, patches; plain, or on a sheet with words.

use super::Look;
use super::natural::{Natural, Shown};
use super::subject::Subject;
use crate::cli::args::RenderStyle;
use crate::cli::exit::Failure;
use crate::cli::values::Quantity;
use crate::render::{
    Bar, Field, LinearRgb, Mesh, Raster, Scale, Sheet, Stencils, Visibility, luminance, luminance_std_err, paint_cells,
    paint_field, paint_items, paint_smooth, side_by_side, vertex_colours,
};
use crate::solution::Radiosity;
use crate::view::Response;

/// Everything about a picture that no camera changes.
pub(super) struct Painter<'a> {
    mesh: Mesh<'a>,
    stencils: Stencils,
    style: RenderStyle,
    caption: bool,
    natural: Option<Natural>,
    /// What is shown in natural colours.
    radiosity: Option<&'a Radiosity>,
    quantity: Option<False>,
    /// False colours of cells.
    constant: Vec<Option<LinearRgb>>,
    /// Values of a quantity at the vertices; empty unless asked for.
    field: Vec<f64>,
}

/// A quantity in false colours.
struct False {
    scale: Scale,
    /// Name and unit.
    title: String,
    factor: f64,
}

impl<'a> Painter<'a> {
    pub(super) fn new(subject: &'a Subject, look: &Look) -> Result<Self, Failure> {
        let stage = &subject.stage;
        let mesh = if subject.per_element { Mesh::of_elements(stage) } else { Mesh::of_patches(stage) };
        let stencils = Stencils::of(&mesh);
        let (style, caption) = (look.style, look.caption);
        let (constant, field) = (Vec::new(), Vec::new());
        let mut painter =
            Self { mesh, stencils, style, caption, natural: None, radiosity: None, quantity: None, constant, field };
        match (&subject.radiosity, &look.args.quantity) {
            (Some(b), Some(quantity)) => painter.show_quantity(subject, b, quantity)?,
            (Some(b), None) if style != RenderStyle::Items => {
                painter.natural = Some(Natural::new(subject, b, look));
                painter.radiosity = Some(b);
            }
            _ => {}
        }
        Ok(painter)
    }

    /// True if this is the style asked for.
    pub(super) fn is(&self, style: RenderStyle) -> bool {
        self.style == style
    }

    /// The natural colours of a picture, where they are natural.
    pub(super) fn look(&self, visibility: &Visibility) -> Option<Shown> {
        self.natural.as_ref().map(|n| n.through(visibility, &self.mesh))
    }

    /// The colour scale, where colours are false.
    pub(super) fn scale(&self) -> Option<&Scale> {
        self.quantity.as_ref().map(|q| &q.scale)
    }

    /// One value per cell carried to the vertices.
    pub(super) fn at_vertices(&self, cells: &[f64]) -> Vec<f64> {
        self.stencils.values(cells)
    }

    /// The cells and how they hang together.
    pub(super) fn mesh(&self) -> &Mesh<'a> {
        &self.mesh
    }

    fn wants_smooth(&self) -> bool {
        matches!(self.style, RenderStyle::Smooth | RenderStyle::Both)
    }

    fn show_quantity(&mut self, subject: &Subject, b: &Radiosity, quantity: &Quantity) -> Result<(), Failure> {
        let is_error = matches!(quantity, Quantity::StdErr | Quantity::RelativeStdErr);
        if is_error && self.wants_smooth() {
            return Err(Failure::input(
                "standard errors belong to patches and are not interpolated; use --style constant",
            ));
        }
        let (field, title, factor) = field(subject, b, quantity)?;
        let scale = Scale::from_zero(&field, &subject.receivers.areas);
        self.constant = field.values.iter().map(|v| v.map(|v| scale.colour(v))).collect();
        if self.wants_smooth() {
            let cells: Vec<f64> = field.values.iter().map(|v| v.unwrap_or(0.0)).collect();
            self.field = self.at_vertices(&cells);
        }
        self.quantity = Some(False { scale, title, factor });
        Ok(())
    }

    /// The picture through one camera, in the natural colours that belong to it.
    pub(super) fn paint(&self, visibility: &Visibility, shown: Option<&Shown>) -> Raster {
        let panels = self.panels(visibility, shown);
        if !self.caption {
            return side_by_side(&panels.into_iter().map(|(_, raster)| raster).collect::<Vec<_>>());
        }
        let panels = panels.into_iter().map(|(title, raster)| (title.to_string(), raster)).collect();
        let bar = self.quantity.as_ref().map(|q| Bar::of(&q.scale, &q.title, q.factor));
        Sheet { panels, bar, caption: self.words(shown) }.compose()
    }

    /// The picture without words.
    pub(super) fn plain(&self, visibility: &Visibility, shown: Option<&Shown>) -> Raster {
        side_by_side(&self.panels(visibility, shown).into_iter().map(|(_, raster)| raster).collect::<Vec<_>>())
    }

    /// The pictures of the style, with their titles.
    fn panels(&self, visibility: &Visibility, shown: Option<&Shown>) -> Vec<(&'static str, Raster)> {
        let constant = || self.flat(visibility, shown);
        let smooth = || self.shaded(visibility, shown);
        match self.style {
            RenderStyle::Smooth => vec![("Interpolated between vertices", smooth())],
            RenderStyle::Constant => vec![("As solved: constant per patch", constant())],
            RenderStyle::Both => {
                vec![("As solved: constant per patch", constant()), ("Interpolated between vertices", smooth())]
            }
            RenderStyle::Items => vec![("Each patch in a colour of its own", paint_items(visibility))],
        }
    }

    /// One colour a cell.
    fn flat(&self, visibility: &Visibility, shown: Option<&Shown>) -> Raster {
        let (Some(shown), Some(b)) = (shown, self.radiosity) else {
            return paint_cells(visibility, &self.mesh, &self.constant, Response::Srgb);
        };
        let shade = shown.shade();
        let palette: Vec<Option<LinearRgb>> = (0..b.len()).map(|i| Some(shade.display(b.of(i)))).collect();
        paint_cells(visibility, &self.mesh, &palette, shade.response())
    }

    /// Interpolated between vertices.
    fn shaded(&self, visibility: &Visibility, shown: Option<&Shown>) -> Raster {
        match (self.scale(), shown, self.radiosity) {
            // Values are interpolated, not colours: the bar stays true.
            (Some(scale), _, _) => paint_field(visibility, &self.mesh, &self.field, |v| scale.colour(v)),
            (None, Some(shown), Some(b)) => {
                let colours = vertex_colours(&self.stencils, shown.shade(), b);
                paint_smooth(visibility, &self.mesh, &colours, shown.shade().response())
            }
            // The item buffer.
            _ => paint_items(visibility),
        }
    }

    /// What the colours mean.
    pub(super) fn words(&self, shown: Option<&Shown>) -> String {
        if let Some(shown) = shown {
            return shown.words();
        }
        match self.scale() {
            Some(s) if s.beyond > 0.0 => {
                format!("{} % of the area lies beyond the range and has its end colour.", figures(100.0 * s.beyond))
            }
            _ => String::new(),
        }
    }
}

/// Values of a quantity with its title (name and unit) and the factor of its labels.
fn field(subject: &Subject, b: &Radiosity, quantity: &Quantity) -> Result<(Field, String, f64), Failure> {
    let photometry = &subject.receivers.photometry;
    let all = |values: Vec<f64>| Field { values: values.into_iter().map(Some).collect() };
    let errors = || {
        let field = luminance_std_err(photometry, b);
        if !field.is_blank() {
            return Ok(field);
        }
        Err(Failure::input(format!(
            "{} holds no standard errors: show a reference, or a solution with std_err columns",
            subject.name
        ))
        .at(subject.name.clone()))
    };
    match quantity {
        Quantity::Luminance => Ok((all(luminance(photometry, b)), "luminance, W/m\u{b2}".into(), 1.0)),
        Quantity::StdErr => Ok((errors()?, "standard error of the luminance, W/m\u{b2}".into(), 1.0)),
        Quantity::RelativeStdErr => {
            let share = |(e, y): (&Option<f64>, f64)| e.map(|e| e / y).filter(|x| x.is_finite());
            let values = errors()?.values.iter().zip(luminance(photometry, b)).map(share).collect();
            Ok((Field { values }, "standard error of the luminance, % of it".into(), 100.0))
        }
        Quantity::Band(name) => {
            let found = photometry.bands.iter().position(|n| n == name);
            let c = found.ok_or_else(|| {
                Failure::input(format!("there is no band \"{name}\"; the scene has {}", photometry.bands.join(", ")))
            })?;
            Ok((all(band(b, c)), format!("radiosity in band {name}, W/m\u{b2}"), 1.0))
        }
    }
}

/// One band of all cells.
pub(super) fn band(b: &Radiosity, c: usize) -> Vec<f64> {
    b.values.iter().skip(c).step_by(b.bands).copied().collect()
}

/// Three significant figures.
pub(super) fn figures(x: f64) -> String {
    let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    let plain = rounded == 0.0 || (1e-3..1e6).contains(&rounded.abs());
    if plain { rounded.to_string() } else { format!("{rounded:e}") }
}
