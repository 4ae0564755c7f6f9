//! Words in pictures: Noto Sans Mono, 16 pixels high.

use super::Raster;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// Height of a line of text, pixels.
pub(super) const LINE: u32 = 16;
/// sRGB grey of the letters.
const INK: u8 = 40;

/// Width of a text, pixels.
pub(super) fn width(text: &str) -> u32 {
    text.chars().count() as u32 * glyph_width()
}

fn glyph_width() -> u32 {
    get_raster_width(FontWeight::Regular, RasterHeight::Size16) as u32
}

/// Writes a line with its upper left corner at (x, y); what lies outside the picture is cut off. Letters that the
/// font lacks become question marks.
pub(super) fn write(raster: &mut Raster, x: u32, y: u32, text: &str) {
    for (letter, left) in text.chars().zip((x..).step_by(glyph_width() as usize)) {
        let glyph = |c| get_raster(c, FontWeight::Regular, RasterHeight::Size16);
        let Some(glyph) = glyph(letter).or_else(|| glyph('?')) else { continue };
        for (row, down) in glyph.rows().zip(y..) {
            for (strength, right) in row.iter().zip(left..) {
                darken(raster, right, down, *strength);
            }
        }
    }
}

/// Mixes ink into a pixel by the share of it that a letter covers, 0 to 255.
fn darken(raster: &mut Raster, x: u32, y: u32, strength: u8) {
    if x >= raster.width || y >= raster.height {
        return;
    }
    let at = 4 * (y as usize * raster.width as usize + x as usize);
    let share = u32::from(strength);
    for c in &mut raster.rgba[at..at + 3] {
        *c = ((u32::from(*c) * (255 - share) + u32::from(INK) * share + 127) / 255) as u8;
    }
}

/// Lines no wider than `width` pixels, broken between words; a word that is wider stands alone.
pub(super) fn wrap(text: &str, width: u32) -> Vec<String> {
    let most = (width / glyph_width()).max(1) as usize;
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= most => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_string()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_between_words() {
        let lines = wrap("one two three fourteen-letters", 9 * glyph_width());
        assert_eq!(lines, ["one two", "three", "fourteen-letters"]);
        assert!(wrap("", 100).is_empty());
    }

    #[test]
    fn every_letter_of_our_captions_is_in_the_font() {
        for c in (' '..='~').chain("\u{b2}\u{b7}\u{d7}".chars()) {
            assert!(get_raster(c, FontWeight::Regular, RasterHeight::Size16).is_some(), "{c}");
        }
    }

    #[test]
    fn text_over_the_edge_is_cut() {
        let mut raster = Raster { width: 10, height: 10, rgba: vec![255; 400] };
        write(&mut raster, 5, 4, "W\u{4e2d}W");
        assert!(raster.rgba.chunks(4).any(|p| p[0] < 128));
        assert!(raster.rgba.chunks(4).all(|p| p[3] == 255));
    }
}
