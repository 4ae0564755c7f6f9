//! Sheets: pictures side by side with titles, a colour bar and a caption, as one raster.

use super::text::{LINE, width as text_width, wrap, write};
use super::{LinearRgb, Raster, Scale, to_srgb8};

/// Blank space around and between things, pixels.
const GAP: u32 = 12;
/// Height of a colour bar and length of its marks, pixels.
const BAR: u32 = 14;
const MARK: u32 = 5;
/// A sheet is at least wide enough for a caption and the labels of a bar, pixels.
const LEAST_WIDTH: u32 = 420;
/// sRGB grey of marks and frames.
const LINE_GREY: u8 = 90;

/// What is put on a sheet.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sheet {
    /// Pictures from left to right, of one height, each under its title.
    pub panels: Vec<(String, Raster)>,
    /// The colour bar that belongs to them.
    pub bar: Option<Bar>,
    /// Sentences at the foot.
    pub caption: String,
}

/// A colour bar with marks.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    /// Colours at equal steps from left to right.
    pub colours: Vec<LinearRgb>,
    /// (place from 0 to 1, label).
    pub marks: Vec<(f64, String)>,
    /// Quantity and unit.
    pub title: String,
}

impl Bar {
    /// The bar of a scale; labels are the values times `factor`.
    pub fn of(scale: &Scale, title: &str, factor: f64) -> Self {
        Self {
            colours: scale.stops(256),
            marks: scale.ticks().iter().map(|t| (t.at, label(factor * t.value))).collect(),
            title: title.into(),
        }
    }
}

/// A round number without the digits that binary fractions add.
fn label(x: f64) -> String {
    let cleaned: f64 = format!("{x:.9e}").parse().unwrap_or(x);
    let plain = cleaned == 0.0 || (1e-4..1e7).contains(&cleaned.abs());
    if plain { cleaned.to_string() } else { format!("{cleaned:e}") }
}

impl Sheet {
    /// Everything as one opaque picture on white.
    pub fn compose(&self) -> Raster {
        let content = self.content_width();
        let height = self.panels.iter().map(|(_, r)| r.height).max().unwrap_or(0);
        let caption = wrap(&self.caption, content);
        let bar_height = if self.bar.is_some() { GAP + LINE + 2 + BAR + MARK + LINE } else { 0 };
        let foot = if caption.is_empty() { 0 } else { GAP + LINE * caption.len() as u32 };
        let title = if self.has_titles() { LINE + 4 } else { 0 };
        let mut sheet = blank(content + 2 * GAP, GAP + title + height + bar_height + foot + GAP);
        let mut x = GAP;
        for (name, panel) in &self.panels {
            write(&mut sheet, x, GAP, name);
            paste(&mut sheet, panel, x, GAP + title);
            x += panel.width + GAP;
        }
        let mut y = GAP + title + height;
        if let Some(bar) = &self.bar {
            draw_bar(&mut sheet, bar, y + GAP, content);
            y += bar_height;
        }
        for (line, k) in caption.iter().zip(0..) {
            write(&mut sheet, GAP, y + GAP + k * LINE, line);
        }
        sheet
    }

    fn has_titles(&self) -> bool {
        self.panels.iter().any(|(title, _)| !title.is_empty())
    }

    fn content_width(&self) -> u32 {
        let panels: u32 = self.panels.iter().map(|(_, r)| r.width + GAP).sum();
        panels.saturating_sub(GAP).max(LEAST_WIDTH)
    }
}

/// Pictures of one height side by side, touching, with nothing added.
pub fn side_by_side(panels: &[Raster]) -> Raster {
    let height = panels.iter().map(|p| p.height).max().unwrap_or(0);
    let mut all = blank(panels.iter().map(|p| p.width).sum(), height);
    all.rgba.fill(0);
    let mut x = 0;
    for panel in panels {
        for y in 0..panel.height {
            let (from, to) = (4 * (y * panel.width) as usize, 4 * (y * all.width + x) as usize);
            let length = 4 * panel.width as usize;
            all.rgba[to..to + length].copy_from_slice(&panel.rgba[from..from + length]);
        }
        x += panel.width;
    }
    all
}

fn blank(width: u32, height: u32) -> Raster {
    Raster { width, height, rgba: vec![255; 4 * width as usize * height as usize] }
}

/// Lays a picture on the sheet; where it is clear, the sheet shows.
fn paste(sheet: &mut Raster, picture: &Raster, left: u32, top: u32) {
    for (k, pixel) in picture.rgba.chunks_exact(4).enumerate() {
        let (x, y) = (left + k as u32 % picture.width, top + k as u32 / picture.width);
        let alpha = u32::from(pixel[3]);
        let at = 4 * (y as usize * sheet.width as usize + x as usize);
        for (under, over) in sheet.rgba[at..at + 3].iter_mut().zip(pixel) {
            *under = ((u32::from(*under) * (255 - alpha) + u32::from(*over) * alpha + 127) / 255) as u8;
        }
    }
}

fn set(sheet: &mut Raster, x: u32, y: u32, rgb: [u8; 3]) {
    let at = 4 * (y as usize * sheet.width as usize + x as usize);
    sheet.rgba[at..at + 3].copy_from_slice(&rgb);
}

/// Title, bar, marks and labels, from `top` down.
fn draw_bar(sheet: &mut Raster, bar: &Bar, top: u32, width: u32) {
    write(sheet, GAP, top, &bar.title);
    let top = top + LINE + 2;
    let last = bar.colours.len().saturating_sub(1) as f64;
    for x in 0..width {
        let at = f64::from(x) / f64::from(width - 1);
        let Some(colour) = bar.colours.get((at * last).round() as usize) else { continue };
        (0..BAR).for_each(|y| set(sheet, GAP + x, top + y, colour.map(to_srgb8)));
    }
    for (at, label) in &bar.marks {
        let x = GAP + (at * f64::from(width - 1)).round() as u32;
        (0..MARK).for_each(|y| set(sheet, x, top + BAR + y, [LINE_GREY; 3]));
        let wide = text_width(label);
        // Labels are centred under their marks and kept on the sheet.
        let left = x.saturating_sub(wide / 2).clamp(GAP, (GAP + width).saturating_sub(wide).max(GAP));
        write(sheet, left, top + BAR + MARK, label);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::Field;

    fn picture(width: u32, height: u32, pixel: [u8; 4]) -> Raster {
        Raster { width, height, rgba: pixel.repeat((width * height) as usize) }
    }

    fn at(r: &Raster, x: u32, y: u32) -> &[u8] {
        let k = 4 * (y * r.width + x) as usize;
        &r.rgba[k..k + 4]
    }

    #[test]
    fn pictures_come_through_unchanged_and_the_bar_runs_from_end_to_end() {
        let field = Field { values: vec![Some(3.0), Some(0.5)] };
        let scale = Scale::from_zero(&field, &[1.0, 1.0]);
        let bar = Bar::of(&scale, "luminance, W/m\u{b2}", 1.0);
        let panels = vec![
            ("left".to_string(), picture(300, 200, [10, 200, 30, 255])),
            ("right".to_string(), picture(300, 200, [7, 7, 7, 0])),
        ];
        let sheet = Sheet { panels, bar: Some(bar.clone()), caption: "Some words. ".repeat(20) }.compose();
        assert_eq!(sheet.width, 612 + 24);
        let top = GAP + LINE + 4;
        assert_eq!(at(&sheet, GAP, top), [10, 200, 30, 255]);
        assert_eq!(at(&sheet, GAP + 299, top + 199), [10, 200, 30, 255]);
        assert_eq!(at(&sheet, GAP + 312, top), [255; 4], "clear pixels show the sheet");
        let y = top + 200 + GAP + LINE + 3;
        for (x, value) in [(GAP, 0.0), (GAP + 611, scale.high)] {
            let [r, g, b] = scale.colour(value).map(to_srgb8);
            assert_eq!(at(&sheet, x, y), [r, g, b, 255]);
        }
        let marks: Vec<_> = bar.marks.into_iter().map(|(_, l)| l).collect();
        assert_eq!(marks, ["0", "1", "2", "3"]);
    }

    #[test]
    fn small_pictures_leave_room_for_words() {
        let sheet = Sheet { panels: vec![(String::new(), picture(8, 6, [1, 2, 3, 255]))], ..Sheet::default() };
        let done = sheet.compose();
        assert_eq!((done.width, done.height), (LEAST_WIDTH + 2 * GAP, 6 + 2 * GAP));
        assert_eq!(at(&done, GAP + 7, GAP + 5), [1, 2, 3, 255]);
    }

    #[test]
    fn side_by_side_adds_nothing() {
        let both = side_by_side(&[picture(2, 1, [1; 4]), picture(3, 1, [0; 4])]);
        assert_eq!(both.rgba, [[1; 4], [1; 4], [0; 4], [0; 4], [0; 4]].concat());
    }

    #[test]
    fn labels_are_short() {
        assert_eq!([0.1 + 0.2, 0.0, 2e-7, 30.0].map(label), ["0.3", "0", "2e-7", "30"]);
    }
}
