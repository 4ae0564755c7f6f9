//! A block of houses of any number of facets, the same on every machine: for times, not for truth.

use std::fmt::Write;

/// Houses stand on a square grid of this pitch, metres; each takes `FOOTPRINT` of it.
const PITCH: f64 = 30.0;
const FOOTPRINT: f64 = 18.0;
/// Facets along a side of a house, and of the ground under one pitch.
const CELLS: usize = 6;
const GROUND: usize = 10;

/// The scene as text and how many facets it has: at least as many as asked for, and less than one ring of houses more.
pub fn scene(facets: usize) -> (String, usize) {
    let per_plot = 5 * CELLS * CELLS + GROUND * GROUND;
    let side = (1..).find(|n| n * n * per_plot >= facets).unwrap_or(1);
    let mut text = String::from(
        "# A block of houses on open ground: for times.\nformat = \"etalon-scene/1\"\nname = \"urban-block\"\n\
         enclosure = false\n\n[photometry]\nprimaries = \"mono\"\nbands = [\"y\"]\n\n[[material]]\n\
         name = \"stone\"\nreflectance = 0.4\n",
    );
    for row in 0..side {
        for column in 0..side {
            plot(&mut text, row, column, height(row * side + column));
        }
    }
    (text, side * side * per_plot)
}

/// Between 9 and 30 metres, from a fixed multiplicative sequence.
fn height(k: usize) -> f64 {
    9.0 + 3.0 * ((k * 5 + 3) % 8) as f64
}

/// The ground of one plot, around and, out of sight, under its house; its walls and its roof.
fn plot(text: &mut String, row: usize, column: usize, height: f64) {
    let (x0, y0) = (column as f64 * PITCH, row as f64 * PITCH);
    let (x1, y1) = (x0 + PITCH, y0 + PITCH);
    let gap = (PITCH - FOOTPRINT) / 2.0;
    let (a, b, c, d) = (x0 + gap, x1 - gap, y0 + gap, y1 - gap);
    let name = format!("plot-{row}-{column}");
    surface(text, &format!("{name}-ground"), [[x0, y0, 0.0], [x1, y0, 0.0], [x1, y1, 0.0], [x0, y1, 0.0]], GROUND);
    let walls = [([a, c], [b, c]), ([b, c], [b, d]), ([b, d], [a, d]), ([a, d], [a, c])];
    for (k, (p, q)) in walls.into_iter().enumerate() {
        let wall = [[p[0], p[1], 0.0], [q[0], q[1], 0.0], [q[0], q[1], height], [p[0], p[1], height]];
        surface(text, &format!("{name}-wall-{k}"), wall, CELLS);
    }
    surface(text, &format!("{name}-roof"), [[a, c, height], [b, c, height], [b, d, height], [a, d, height]], CELLS);
}

fn surface(text: &mut String, name: &str, corners: [[f64; 3]; 4], cells: usize) {
    let _ = write!(
        text,
        "\n[[surface]]\nname = \"{name}\"\nmaterial = \"stone\"\npolygon = {corners:?}\npatches = [{cells}, {cells}]\n"
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_block_has_the_facets_it_says() {
        let (text, facets) = scene(22_000);
        assert!((22_000..25_000).contains(&facets), "{facets}");
        let counted: usize = text
            .lines()
            .filter_map(|l| l.strip_prefix("patches = ["))
            .map(|l| {
                let (first, _) = l.split_once(',').unwrap();
                first.parse::<usize>().unwrap().pow(2)
            })
            .sum();
        assert_eq!(counted, facets);
        assert_eq!(scene(22_000).0, text);
    }
}
