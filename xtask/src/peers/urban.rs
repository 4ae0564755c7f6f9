//! A block of houses of any number of facets, the same on every machine: for times, not for truth.

use std::fmt::Write;

/// Houses stand on a square grid of this pitch, metres; each takes `FOOTPRINT` of it.
const PITCH: f64 = 30.0;
const FOOTPRINT: f64 = 18.0;
/// Facets along a side of a house; the ground around it has facets of the same size.
const CELLS: usize = 6;
/// Five sides of a house, two long and two short strips of ground.
const FACETS: usize = 5 * CELLS * CELLS + 2 * (10 * 2 + 2 * CELLS);

/// The scene as text and how many facets it has: at least as many as asked for, and less than one house more.
pub fn scene(facets: usize) -> (String, usize) {
    let houses = facets.div_ceil(FACETS);
    let side = (1..).find(|n| n * n >= houses).unwrap_or(1);
    let mut text = String::from(
        "# A block of houses on open ground: for times.\nformat = \"etalon-scene/1\"\nname = \"urban-block\"\n\
         enclosure = false\n\n[photometry]\nprimaries = \"mono\"\nbands = [\"y\"]\n\n[[material]]\n\
         name = \"stone\"\nreflectance = 0.4\n",
    );
    for k in 0..houses {
        plot(&mut text, k / side, k % side, height(k));
    }
    (text, houses * FACETS)
}

/// Between 9 and 30 metres, from a fixed multiplicative sequence.
fn height(k: usize) -> f64 {
    9.0 + 3.0 * ((k * 5 + 3) % 8) as f64
}

/// The ground round one house, its walls and its roof.
fn plot(text: &mut String, row: usize, column: usize, height: f64) {
    let (x0, y0) = (column as f64 * PITCH, row as f64 * PITCH);
    let (x1, y1) = (x0 + PITCH, y0 + PITCH);
    let gap = (PITCH - FOOTPRINT) / 2.0;
    let (a, b, c, d) = (x0 + gap, x1 - gap, y0 + gap, y1 - gap);
    let name = format!("plot-{row}-{column}");
    let flat = |x: [f64; 2], y: [f64; 2], z: f64| [[x[0], y[0], z], [x[1], y[0], z], [x[1], y[1], z], [x[0], y[1], z]];
    let strips = [
        ([x0, x1], [y0, c], [10, 2]),
        ([x0, x1], [d, y1], [10, 2]),
        ([x0, a], [c, d], [2, CELLS]),
        ([b, x1], [c, d], [2, CELLS]),
    ];
    for (k, (x, y, cells)) in strips.into_iter().enumerate() {
        surface(text, &format!("{name}-ground-{k}"), flat(x, y, 0.0), cells);
    }
    let walls = [([a, c], [b, c]), ([b, c], [b, d]), ([b, d], [a, d]), ([a, d], [a, c])];
    for (k, (p, q)) in walls.into_iter().enumerate() {
        let wall = [[p[0], p[1], 0.0], [q[0], q[1], 0.0], [q[0], q[1], height], [p[0], p[1], height]];
        surface(text, &format!("{name}-wall-{k}"), wall, [CELLS; 2]);
    }
    surface(text, &format!("{name}-roof"), flat([a, b], [c, d], height), [CELLS; 2]);
}

fn surface(text: &mut String, name: &str, corners: [[f64; 3]; 4], cells: [usize; 2]) {
    let _ = write!(
        text,
        "\n[[surface]]\nname = \"{name}\"\nmaterial = \"stone\"\npolygon = {corners:?}\npatches = {cells:?}\n"
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_block_has_the_facets_it_says() {
        let (text, facets) = scene(22_000);
        assert!((22_000..22_300).contains(&facets), "{facets}");
        let divisions = text.lines().filter_map(|l| l.strip_prefix("patches = [")?.strip_suffix(']'));
        let counted: usize =
            divisions.map(|d| d.split(", ").map(|n| n.parse::<usize>().unwrap()).product::<usize>()).sum();
        assert_eq!(counted, facets);
        assert_eq!(scene(22_000).0, text);
    }
}
