//! Values within cells from values at their corners: bilinear in quadrilaterals, linear in triangles.

use super::{LinearRgb, Mesh, Shade, Stencils};
use crate::math::{Bilinear, DVec3, centroid};
use crate::solution::Radiosity;

impl Mesh<'_> {
    /// Calls `take(vertex, weight)` for the vertices that make the value at a point of a cell; the weights are
    /// 0 or above and add to 1. Points outside count as the nearest ones of the cell. Nothing is called for cells
    /// that take no part.
    pub fn blend(&self, cell: usize, point: DVec3, mut take: impl FnMut(usize, f64)) {
        let (corners, vertices) = (self.corners(cell), self.vertices_of(cell));
        let mut give = |k: usize, w: f64| take(vertices[k] as usize, w);
        match vertices.len() {
            0 => {}
            3 => {
                let weights = in_triangle([corners[0], corners[1], corners[2]], point);
                weights.into_iter().enumerate().for_each(|(k, w)| give(k, w));
            }
            4 => {
                let map = Bilinear::new([corners[0], corners[1], corners[2], corners[3]]);
                let (u, v) = map.inverse(point);
                let (u, v) = (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
                let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v];
                weights.into_iter().enumerate().for_each(|(k, w)| give(k, w));
            }
            _ => in_fan(corners, point, &mut give),
        }
    }

    /// Value at a point of a cell, of values at the vertices; 0 in cells that take no part.
    pub fn value_at(&self, cell: usize, point: DVec3, vertices: &[f64]) -> f64 {
        let mut sum = 0.0;
        self.blend(cell, point, |v, w| sum += w * vertices[v]);
        sum
    }
}

/// Colours at the vertices, linear and not yet clamped, of one set of radiosities per cell: what
/// [`paint_smooth`](super::paint_smooth) takes.
pub fn vertex_colours(stencils: &Stencils, shade: &dyn Shade, cells: &Radiosity) -> Vec<LinearRgb> {
    let band = |c: usize| cells.values.iter().skip(c).step_by(cells.bands).copied().collect::<Vec<f64>>();
    let bands: Vec<Vec<f64>> = (0..cells.bands).map(|c| stencils.values(&band(c))).collect();
    let count = bands.first().map_or(0, Vec::len);
    (0..count).map(|v| shade.linear(&bands.iter().map(|b| b[v]).collect::<Vec<_>>())).collect()
}

/// Barycentric weights, clamped.
fn in_triangle(t: [DVec3; 3], p: DVec3) -> [f64; 3] {
    let normal = (t[1] - t[0]).cross(t[2] - t[0]);
    let part = |a: DVec3, b: DVec3| ((a - p).cross(b - p).dot(normal) / normal.length_squared()).max(0.0);
    let weights = [part(t[1], t[2]), part(t[2], t[0]), part(t[0], t[1])];
    let sum: f64 = weights.iter().sum();
    if sum > 0.0 { weights.map(|w| w / sum) } else { [1.0 / 3.0; 3] }
}

/// A polygon of five corners and more: triangles about its centre, which has the mean of the corners.
fn in_fan(corners: &[DVec3], p: DVec3, give: &mut impl FnMut(usize, f64)) {
    let (n, centre) = (corners.len(), centroid(corners));
    let normal = (corners[0] - centre).cross(corners[1] - centre);
    // The point lies in the triangle it is left of both spokes of.
    let left = |k: usize| (corners[k % n] - centre).cross(p - centre).dot(normal) >= 0.0;
    let k = (0..n).find(|k| left(*k) && !left(k + 1)).unwrap_or(0);
    let [inner, a, b] = in_triangle([centre, corners[k], corners[(k + 1) % n]], p);
    (0..n).for_each(|j| give(j, inner / n as f64));
    give(k, a);
    give((k + 1) % n, b);
}
