//! What is kept of a mesh file beside its shape.

/// What a reader is asked to keep. Scenes ask for the shape alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::io) enum Keep<'a> {
    /// Vertices and faces.
    Shape,
    /// And values of faces or vertices: those of these names, or the usual ones.
    Values(Option<&'a [String]>),
    /// And texture coordinates.
    Textures,
}

/// What was kept, in the order of the file; empty where it was not asked for.
#[derive(Debug, Default)]
pub(in crate::io) struct Carried {
    /// Names of the bands of the values.
    pub bands: Vec<String>,
    /// Values of each vertex, band by band.
    pub of_vertices: Vec<f64>,
    /// Values of each face, band by band.
    pub of_faces: Vec<f64>,
    /// Texture coordinates, u and v.
    pub uvs: Vec<[f64; 2]>,
}

/// Names of the bands that the fields of a file stand for: colours are r, g and b, a single field is y, fields of
/// one stem `radiosity_` are called by what follows it, and all others keep their names.
pub(in crate::io) fn band_names(fields: &[String]) -> Vec<String> {
    const COLOURS: [[&str; 3]; 3] =
        [["r", "g", "b"], ["red", "green", "blue"], ["diffuse_red", "diffuse_green", "diffuse_blue"]];
    let lower: Vec<String> = fields.iter().map(|f| f.to_lowercase()).collect();
    if COLOURS.iter().any(|c| lower == c) {
        return COLOURS[0].map(String::from).to_vec();
    }
    if fields.iter().all(|f| f.len() > STEM.len() && f.starts_with(STEM)) {
        return fields.iter().map(|f| f[STEM.len()..].to_string()).collect();
    }
    match fields {
        [_] => vec!["y".into()],
        _ => fields.to_vec(),
    }
}

/// What the names of radiosities begin with in files that etalon writes.
pub(in crate::io) const STEM: &str = "radiosity_";
/// What those of their standard errors end with.
pub(in crate::io) const ERROR_TAIL: &str = "_std_err";

/// The fields of a file that hold radiosities of etalon's own writing, in their order.
pub(in crate::io) fn stemmed<'n>(names: impl Iterator<Item = &'n str>) -> Vec<String> {
    names
        .filter(|n| n.len() > STEM.len() && n.starts_with(STEM) && !n.ends_with(ERROR_TAIL))
        .map(String::from)
        .collect()
}

/// What is told about values of few bits.
pub(in crate::io) fn coarse(what: &str, steps: f64) -> String {
    format!("{what} are whole numbers, taken as 0 to 1 in steps of 1/{steps}: coarser than most differences looked for")
}
