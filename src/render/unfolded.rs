//! A hemi-cube unfolded: what every pixel shows, the true silhouettes over it, and which pixels are wrong.
//!
//! The top lies in the middle, x to the right and y up; the four half faces are folded down around it, so that edges
//! that meet in space meet in the picture and the horizon runs along the rim of the cross.

mod layout;
mod legend;
mod window;

use super::{Raster, Sheet};
use layout::Layout;
use window::Window;

/// What a pixel shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// Nothing: an open scene.
    Nothing,
    /// The black back of something.
    Back,
    /// A patch of a surface.
    Patch {
        /// Number of the patch: neighbours differ a little in lightness.
        patch: u32,
        /// Number of its surface: decides the hue.
        surface: u32,
    },
    /// The source that the picture is about.
    Source,
}

/// What is wrong with a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Wrong {
    /// Share of the pixel that is counted for the source and not covered by it; negative: covered and not counted.
    pub excess: f32,
    /// Share of the pixel that shows something other than what it is counted for, 0 to 1.
    pub mixed: f32,
}

/// What a line of a silhouette parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outline {
    /// Two patches of one surface.
    Patches,
    /// Two surfaces, or a surface and nothing.
    Surfaces,
    /// The source and everything else.
    Source,
}

/// A line of a silhouette.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Silhouette {
    /// What it parts.
    pub outline: Outline,
    /// Ends in coordinates of the face: u from -1 to 1, v from -1 (sides: 0) to 1.
    pub ends: [[f64; 2]; 2],
}

/// One face: pixels row by row, row 0 at v = -1 (top) or at the horizon (sides).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct UnfoldedFace {
    /// What pixels show.
    pub shown: Vec<Shown>,
    /// What is wrong with them, in the same order.
    pub wrong: Vec<Wrong>,
    /// True silhouettes.
    pub silhouettes: Vec<Silhouette>,
}

/// A hemi-cube to be shown: plain data.
#[derive(Debug, Clone, PartialEq)]
pub struct UnfoldedHemicube {
    /// Pixels along an edge of the top, even.
    pub resolution: usize,
    /// The top, then the sides towards +x, +y, -x, -y of the patch's frame: `resolution` squared pixels on the top,
    /// half as many on each side.
    pub faces: [UnfoldedFace; 5],
    /// Sentences at the foot.
    pub caption: String,
}

/// The cross is drawn about this wide, pixels.
const WIDTH: usize = 1200;
/// An inset shows this many pixels of the hemi-cube each way at least, at most.
const INSET: [usize; 2] = [8, 20];
/// Space around an inset and around words, pixels.
const MARGIN: u32 = 10;

impl UnfoldedHemicube {
    /// The picture: the cross, a legend, the words, and, where the source is small, its surroundings enlarged.
    pub fn paint(&self) -> Raster {
        let layout = Layout::new(self.resolution);
        let scale = scale_of(self.resolution);
        let size = ((2 * self.resolution) as f64 * scale).round() as u32;
        let whole = Window { left: 0.0, top: 0.0, scale, size };
        let mut raster = whole.paint(self, &layout);
        let corner = size / 4;
        if let Some((cells, [left, top])) = self.inset(&layout) {
            let room = corner.saturating_sub(2 * MARGIN);
            let zoom = f64::from(room / cells as u32);
            if zoom > scale {
                let size = (cells as f64 * zoom) as u32;
                let window = Window { left: left as f64, top: top as f64, scale: zoom, size };
                legend::frame(&mut raster, &whole, &window);
                let at = [raster.width - size - MARGIN, MARGIN];
                legend::lay(&mut raster, &window.paint(self, &layout), at);
            }
        }
        legend::face_names(&mut raster);
        legend::key(&mut raster, [MARGIN, 3 * corner + MARGIN + 20]);
        Sheet { panels: vec![(String::new(), raster)], bar: None, caption: self.caption.clone() }.compose()
    }

    /// The cells to enlarge, (count each way, first column and row): around the source, where that is small.
    fn inset(&self, layout: &Layout) -> Option<(usize, [usize; 2])> {
        let n = 2 * self.resolution;
        let (mut low, mut high, mut worst, mut concerned) = ([usize::MAX; 2], [0; 2], (-1.0f32, [0; 2]), 0);
        for (y, x) in (0..n).flat_map(|y| (0..n).map(move |x| (y, x))) {
            let Some((face, k)) = layout.pixel(x, y) else { continue };
            let (shown, wrong) = (self.faces[face].shown[k], self.faces[face].wrong[k]);
            if shown == Shown::Source || wrong.excess != 0.0 {
                concerned += 1;
                low = [low[0].min(x), low[1].min(y)];
                high = [high[0].max(x), high[1].max(y)];
                if wrong.excess.abs() > worst.0 {
                    worst = (wrong.excess.abs(), [x, y]);
                }
            }
        }
        if low[0] == usize::MAX {
            return None;
        }
        let extent = (0..2).map(|c| high[c] - low[c] + 1).max()?;
        // Sources in many places: the surroundings of the worst pixel.
        let middle = if extent + 4 <= INSET[1] { [0, 1].map(|c| (low[c] + high[c]).div_ceil(2)) } else { worst.1 };
        let cells = (extent + 4).clamp(INSET[0], INSET[1]).min(n / 4);
        (concerned < n * n / 64).then(|| (cells, middle.map(|m| m.saturating_sub(cells / 2).min(n - cells))))
    }
}

/// Pixels of the picture per pixel of the hemi-cube: a whole number, or one over a whole number.
fn scale_of(resolution: usize) -> f64 {
    match WIDTH / (2 * resolution) {
        0 => 1.0 / (2 * resolution).div_ceil(WIDTH) as f64,
        whole => whole as f64,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A hemi-cube under a floor of nothing with one source pixel on the top, right and above the axes.
    fn specimen(resolution: usize) -> UnfoldedHemicube {
        let face = |pixels| UnfoldedFace {
            shown: vec![Shown::Patch { patch: 1, surface: 0 }; pixels],
            wrong: vec![Wrong::default(); pixels],
            silhouettes: Vec::new(),
        };
        let (n, half) = (resolution * resolution, resolution * resolution / 2);
        let mut cube = UnfoldedHemicube {
            resolution,
            faces: [face(n), face(half), face(half), face(half), face(half)],
            caption: "Some words.".into(),
        };
        cube.faces[0].shown[resolution * resolution / 2 + resolution / 2] = Shown::Source;
        cube
    }

    fn at(r: &Raster, x: u32, y: u32) -> [u8; 3] {
        let k = 4 * (y * r.width + x) as usize;
        [r.rgba[k], r.rgba[k + 1], r.rgba[k + 2]]
    }

    /// Where the middle of a cell of the cross lies on the sheet, which leaves 12 pixels around.
    fn middle(x: u32, y: u32, scale: u32) -> [u32; 2] {
        [x, y].map(|c| 12 + c * scale + scale / 2)
    }

    #[test]
    fn pixels_have_their_colours_at_their_places() {
        let mut cube = specimen(50);
        let nothing = 50 * 24 + 3;
        // The side towards -x: its row 0 lies at the left rim, its column 49 (u = 1, y = -1) at the lower end.
        cube.faces[3].shown[49] = Shown::Back;
        cube.faces[1].shown[nothing] = Shown::Nothing;
        let picture = cube.paint();
        let seen = |x, y| {
            let [x, y] = middle(x, y, 12);
            at(&picture, x, y)
        };
        assert_eq!(seen(50, 49), window::SOURCE);
        assert_eq!(seen(49, 49), seen(60, 60));
        assert_eq!(seen(0, 74), window::BACK);
        assert_ne!(seen(0, 25), window::BACK);
        assert_eq!(seen(75, 71), window::NOTHING, "row 24 touches the top, column 3 lies at its lower end");
        assert_eq!(seen(2, 40), seen(60, 60), "one patch, one colour, on all faces");
        assert_eq!(at(&picture, 13, 13), [255; 3], "outside of the cross");
    }

    #[test]
    fn too_much_and_too_little_are_marked_apart_and_by_their_size() {
        let mut cube = specimen(50);
        let middle_row = 50 * 25 + 25;
        let count = |cube: &UnfoldedHemicube, colour: [u8; 3]| {
            let picture = cube.paint();
            (0..12 * 12).filter(|k| at(&picture, 12 + 600 + k % 12, 12 + 588 + k / 12) == colour).count()
        };
        assert_eq!(count(&cube, window::TOO_MUCH) + count(&cube, window::TOO_LITTLE), 0);
        cube.faces[0].wrong[middle_row] = Wrong { excess: 0.25, mixed: 0.25 };
        let quarter = count(&cube, window::TOO_MUCH);
        cube.faces[0].wrong[middle_row] = Wrong { excess: 1.0, mixed: 1.0 };
        let whole = count(&cube, window::TOO_MUCH);
        assert!(quarter >= 8 && whole > 3 * quarter, "{quarter} {whole}");
        cube.faces[0].wrong[middle_row] = Wrong { excess: -1.0, mixed: 1.0 };
        assert_eq!((count(&cube, window::TOO_MUCH), count(&cube, window::TOO_LITTLE)), (0, whole));
    }

    #[test]
    fn a_silhouette_is_drawn_where_it_lies() {
        let mut cube = specimen(50);
        let line = Silhouette { outline: Outline::Source, ends: [[-0.5, 0.5], [0.5, 0.5]] };
        let clean = cube.paint();
        cube.faces[0].silhouettes.push(line);
        let drawn = cube.paint();
        // y = 0.5 lies 3/8 of the way down the cross.
        let dark = |r: &Raster, x: u32, y: u32| at(r, 12 + x, 12 + y).iter().all(|c| *c < 60);
        assert!(dark(&drawn, 600, 450) && !dark(&clean, 600, 450));
        assert!(!dark(&drawn, 600, 460) && !dark(&drawn, 280, 450));
    }

    #[test]
    fn every_resolution_makes_a_picture_of_about_one_size() {
        for (resolution, width) in [(4, 1200), (50, 1200), (128, 1024), (600, 1200), (1024, 1024)] {
            let picture = specimen(resolution).paint();
            assert_eq!(picture.width, width + 24, "{resolution}");
            assert!(picture.height > picture.width, "room for the caption");
        }
    }
}
