//! Refusals: every one names the file, the line, the surface and the mend.

use super::source::Source;
use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode};
use std::fmt::{self, Display};
use std::ops::Range;

/// What kind of thing is wrong with a scene file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Refusal {
    /// The file cannot be opened or read.
    Unreadable,
    /// A path leaves the scene's folder.
    Path,
    /// Not TOML, or a key with a value of the wrong kind; a mesh file that cannot be parsed.
    Syntax,
    /// The format line is missing, foreign or newer.
    Format,
    /// A key that does not exist here, is missing, or excludes another.
    Key,
    /// Kept for a later version, or for pictures alone.
    Reserved,
    /// A name that is taken, empty or unknown.
    Name,
    /// Bands, primaries and weights that do not fit together.
    Bands,
    /// A number out of range or not finite.
    Number,
    /// A polygon that is not planar, not convex or without area; a broken mesh face.
    Geometry,
    /// Counts of zero, of the wrong shape, or beyond memory.
    Counts,
    /// Polygons that overlap and radiate to the same side.
    Overlap,
    /// An edit that cannot be done.
    Edit,
    /// Nothing to look at.
    Empty,
    /// No built-in scene of that name.
    Builtin,
}

impl Refusal {
    /// The code shown with the message, stable across versions.
    pub fn code(self) -> &'static str {
        match self {
            Refusal::Unreadable => "etalon::scene::unreadable",
            Refusal::Path => "etalon::scene::path",
            Refusal::Syntax => "etalon::scene::syntax",
            Refusal::Format => "etalon::scene::format",
            Refusal::Key => "etalon::scene::key",
            Refusal::Reserved => "etalon::scene::reserved",
            Refusal::Name => "etalon::scene::name",
            Refusal::Bands => "etalon::scene::bands",
            Refusal::Number => "etalon::scene::number",
            Refusal::Geometry => "etalon::scene::geometry",
            Refusal::Counts => "etalon::scene::counts",
            Refusal::Overlap => "etalon::scene::overlap",
            Refusal::Edit => "etalon::scene::edit",
            Refusal::Empty => "etalon::scene::empty",
            Refusal::Builtin => "etalon::scene::builtin",
        }
    }
}

/// Why a scene file is refused. `Display` gives one line; as a [`Diagnostic`] it shows the place in the file.
#[derive(Debug)]
pub struct SceneFileError {
    details: Box<Details>,
}

#[derive(Debug)]
struct Details {
    refusal: Refusal,
    place: String,
    message: String,
    help: String,
    source: NamedSource<String>,
    span: Option<Range<usize>>,
}

impl SceneFileError {
    /// A refusal at a stretch of a file's text.
    pub(super) fn new(source: &Source, refusal: Refusal, span: Range<usize>, message: impl Into<String>) -> Self {
        let block = source.block(&span);
        let place = match block.as_str() {
            "" => source.at(&span),
            _ => format!("{}, {block}", source.at(&span)),
        };
        let named = NamedSource::new(&source.name, source.text.clone());
        Self::with(refusal, place, message.into(), named, Some(span))
    }

    /// A refusal of a whole file.
    pub(super) fn whole(name: &str, refusal: Refusal, message: impl Into<String>) -> Self {
        Self::with(refusal, name.to_string(), message.into(), NamedSource::new(name, String::new()), None)
    }

    fn with(
        refusal: Refusal,
        place: String,
        message: String,
        source: NamedSource<String>,
        span: Option<Range<usize>>,
    ) -> Self {
        let details = Details { refusal, place, message, help: String::new(), source, span };
        Self { details: Box::new(details) }
    }

    /// Adds what to do about it.
    pub(super) fn mend(mut self, help: impl Into<String>) -> Self {
        self.details.help = help.into();
        self
    }

    /// Adds another file that leads here (the scene file that names a mesh).
    pub(super) fn within(mut self, outer: &str) -> Self {
        self.details.place = format!("{} ({outer})", self.details.place);
        self
    }

    /// File, line and surface: `two-plates.toml:12, surface "floor"`.
    pub fn place(&self) -> String {
        self.details.place.clone()
    }

    /// What is wrong, without the place.
    pub fn message(&self) -> &str {
        &self.details.message
    }

    /// How to mend it.
    pub(super) fn help_text(&self) -> &str {
        &self.details.help
    }

    /// What kind of thing is wrong.
    pub fn refusal(&self) -> Refusal {
        self.details.refusal
    }
}

impl Display for SceneFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let d = &self.details;
        write!(f, "{}: {}", d.place, d.message)?;
        if d.help.is_empty() { Ok(()) } else { write!(f, "; {}", d.help) }
    }
}

impl std::error::Error for SceneFileError {}

impl Diagnostic for SceneFileError {
    fn code<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        Some(Box::new(self.details.refusal.code()))
    }

    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        (!self.details.help.is_empty()).then(|| Box::new(&self.details.help) as Box<dyn Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.details.span.as_ref().map(|_| &self.details.source as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let span = self.details.span.clone()?;
        let label = LabeledSpan::new(None, span.start, span.len());
        Some(Box::new(std::iter::once(label)))
    }
}
