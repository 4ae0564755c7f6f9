//! Values that came on a mesh of their own.

use crate::math::DVec3;

/// Where the values of a mesh stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ValuesPer {
    /// One value per face: constant over it.
    Face,
    /// One value per corner of each face: linear over triangles; faces of more corners are fans of triangles from their
    /// first corner.
    Corner,
}

/// Faces with values per band, as another program wrote them: no patches of any scene, no quantity known yet.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshValues {
    /// Names of the bands, in the order of the values: `r`, `g`, `b` for colours, `y` for one unnamed value.
    pub bands: Vec<String>,
    /// What a user should know of how they were read: faces left out, values of few bits.
    pub notices: Vec<String>,
    per: ValuesPer,
    corners: Vec<DVec3>,
    /// End of each face in `corners`.
    ends: Vec<usize>,
    values: Vec<f64>,
}

impl MeshValues {
    /// No faces yet.
    pub fn new(bands: Vec<String>, per: ValuesPer) -> Self {
        Self { bands, notices: Vec::new(), per, corners: Vec::new(), ends: Vec::new(), values: Vec::new() }
    }

    /// Adds a face: its corners in metres, three or more, counter-clockwise seen from the side that radiates; and its
    /// values, band by band: for the face, or for one corner after the other.
    ///
    /// # Panics
    /// If the number of values does not fit, which is a mistake of the program.
    pub fn push(&mut self, corners: &[DVec3], values: &[f64]) {
        let places = match self.per {
            ValuesPer::Face => 1,
            ValuesPer::Corner => corners.len(),
        };
        assert_eq!(values.len(), places * self.bands.len(), "values of a face");
        self.corners.extend_from_slice(corners);
        self.ends.push(self.corners.len());
        self.values.extend_from_slice(values);
    }

    /// Number of faces.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// True if there is no face.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Where the values stand.
    pub fn per(&self) -> ValuesPer {
        self.per
    }

    fn start(&self, face: usize) -> usize {
        if face == 0 { 0 } else { self.ends[face - 1] }
    }

    /// Corners of a face, metres.
    pub fn corners(&self, face: usize) -> &[DVec3] {
        &self.corners[self.start(face)..self.ends[face]]
    }

    /// Values of a face: one per band, or one per band for each of its corners.
    pub fn values(&self, face: usize) -> &[f64] {
        let bands = self.bands.len();
        match self.per {
            ValuesPer::Face => &self.values[face * bands..(face + 1) * bands],
            ValuesPer::Corner => &self.values[self.start(face) * bands..self.ends[face] * bands],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_keep_their_corners_and_values_apart() {
        let p = |x: f64| DVec3::new(x, 0.0, 0.0);
        let mut m = MeshValues::new(vec!["a".into(), "b".into()], ValuesPer::Corner);
        m.push(&[p(0.0), p(1.0), p(2.0)], &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        m.push(&[p(3.0), p(4.0), p(5.0), p(6.0)], &[7.0; 8]);
        assert_eq!((m.len(), m.corners(1)[0].x, m.corners(0).len()), (2, 3.0, 3));
        assert_eq!((m.values(0)[5], m.values(1).len()), (6.0, 8));
        let mut f = MeshValues::new(vec!["y".into()], ValuesPer::Face);
        f.push(&[p(0.0), p(1.0), p(2.0)], &[1.5]);
        f.push(&[p(0.0), p(1.0), p(2.0)], &[2.5]);
        assert_eq!(f.values(1), [2.5]);
    }
}
