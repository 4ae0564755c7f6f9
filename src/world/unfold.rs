//! The unfolded cube [G86 fig. 2].

use super::layout::{Face, Layout, Shape};

/// Column and row of each face in the horizontal cross of 4 x 3 faces, in the order of [`Face::ALL`]: left, front, right
/// and back beside one another, up above the front and down below it.
const CROSS: [(usize, usize); 6] = [(1, 1), (2, 1), (3, 1), (0, 1), (1, 0), (1, 2)];

/// A map as a plane picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unfolded {
    /// Width, pixels.
    pub width: u32,
    /// Height, pixels.
    pub height: u32,
    /// The texel that each pixel shows, rows from the top; `None` where nothing is drawn.
    pub texels: Vec<Option<usize>>,
}

/// The picture of a map: a cube as the horizontal cross of its faces, 4 by 3 of them, the others as they are. Of a
/// fish-eye only texels whose middle lies within the circle are shown.
pub fn unfolded(shape: Shape) -> Unfolded {
    let n = shape.size as usize;
    if shape.layout != Layout::Cube {
        let texels = (0..shape.texels()).map(|k| shape.middle(k).map(|_| k)).collect();
        return Unfolded { width: shape.width() as u32, height: shape.size, texels };
    }
    let (width, height) = (4 * n, 3 * n);
    let mut texels = vec![None; width * height];
    for (face, (column, row)) in Face::ALL.into_iter().zip(CROSS) {
        for y in 0..n {
            for x in 0..n {
                texels[(row * n + y) * width + column * n + x] = Some(shape.index(face as usize, x, y));
            }
        }
    }
    Unfolded { width: width as u32, height: height as u32, texels }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_texel_is_shown_once_and_neighbours_stay_neighbours() {
        let shape = Shape { layout: Layout::Cube, size: 8 };
        let picture = unfolded(shape);
        assert_eq!((picture.width, picture.height), (32, 24));
        let mut shown: Vec<usize> = picture.texels.iter().flatten().copied().collect();
        shown.sort_unstable();
        assert_eq!(shown, (0..shape.texels()).collect::<Vec<_>>());
        // Across every seam of the cross that joins two faces the directions stay close.
        for y in 0..24 {
            for x in 0..32 {
                for (dx, dy) in [(1, 0), (0, 1)] {
                    // Beside the faces up and down, seams of the cross end.
                    let across = |x: usize, y: usize| (x < 32 && y < 24).then(|| picture.texels[y * 32 + x]).flatten();
                    if let (Some(a), Some(b)) = (across(x, y), across(x + dx, y + dy)) {
                        let [a, b] = [a, b].map(|k| shape.middle(k).expect("whole"));
                        assert!(a.distance(b) < 0.26, "{x} {y}");
                    }
                }
            }
        }
        assert_eq!(picture.texels[0], None);
    }

    #[test]
    fn other_layouts_are_plane_already() {
        let plane = unfolded(Shape { layout: Layout::LatLong, size: 4 });
        assert_eq!((plane.width, plane.height), (8, 4));
        assert_eq!(plane.texels, (0..32).map(Some).collect::<Vec<_>>());
        let eye = unfolded(Shape { layout: Layout::Fisheye { field: 180.0 }, size: 8 });
        assert_eq!(eye.texels[0], None);
        assert_eq!(eye.texels[8 * 4 + 4], Some(36));
    }
}
