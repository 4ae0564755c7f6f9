//! Houses: fronts with windows set back into the wall, ledges, parapets, a gabled roof.

use super::solid::{Solids, v};
use etalon::math::DVec3;

const OBJECT: &str = "buildings";

/// Ground of the blocks: the height of a kerb.
pub const GROUND: f64 = 0.12;

/// A rectangular house.
struct House<'a> {
    /// South-west corner and breadth along x and y.
    at: [f64; 2],
    size: [f64; 2],
    floors: usize,
    floor_height: f64,
    wall: &'a str,
    glass: &'a str,
    /// Width and height of a window's hole, as a share of its cell; how deep the pane lies.
    window: [f64; 2],
    depth: f64,
    ledges: bool,
    /// Windows per side: west, east, south, north; 0 is a blind wall.
    bays: [usize; 4],
}

/// All houses of the town.
pub fn build(solids: &mut Solids) {
    let brick = House {
        at: [7.0, 7.0],
        size: [15.0, 12.0],
        floors: 5,
        floor_height: 3.2,
        wall: "brick",
        glass: "window",
        window: [0.5, 0.58],
        depth: 0.18,
        ledges: true,
        bays: [5, 0, 6, 0],
    };
    // The office: nearly all glass, and the glass mirrors the street.
    let office = House {
        at: [-25.0, 7.0],
        size: [18.0, 15.0],
        floors: 7,
        floor_height: 3.4,
        wall: "concrete",
        glass: "mirror",
        window: [0.88, 0.78],
        depth: 0.1,
        ledges: false,
        bays: [0, 6, 7, 0],
    };
    let plaster =
        House { at: [7.0, 20.0], size: [14.0, 16.0], wall: "plaster", bays: [6, 0, 0, 0], floors: 4, ..brick };
    let tall = House { at: [-23.0, 24.0], size: [16.0, 18.0], floors: 6, bays: [0, 6, 0, 0], ..brick };
    let cottage = House {
        at: [-19.0, -22.0],
        size: [12.0, 15.0],
        floors: 2,
        wall: "plaster",
        bays: [0, 5, 0, 4],
        window: [0.42, 0.5],
        ..brick
    };
    for house in [&brick, &office, &plaster, &tall] {
        house.walls(solids);
        house.parapet(solids);
    }
    cottage.walls(solids);
    cottage.gable(solids);
    // Far away a box will do.
    for (low, high, wall) in [
        (v(7.0, 38.0, GROUND), v(26.0, 60.0, 17.0), "concrete"),
        (v(-27.0, 44.0, GROUND), v(-7.0, 66.0, 15.0), "plaster"),
        (v(7.0, 62.0, GROUND), v(30.0, 100.0, 21.0), "brick"),
        (v(-30.0, 68.0, GROUND), v(-7.0, 100.0, 18.0), "concrete"),
        (v(30.0, 7.0, GROUND), v(60.0, 24.0, 12.0), "plaster"),
        (v(-60.0, 7.0, GROUND), v(-30.0, 26.0, 16.0), "brick"),
        (v(-50.0, -30.0, GROUND), v(-24.0, -7.0, 9.0), "brick"),
    ] {
        solids.cuboid((OBJECT, wall), low, high, &[]);
    }
}

impl House<'_> {
    fn low(&self) -> DVec3 {
        v(self.at[0], self.at[1], GROUND)
    }

    fn high(&self) -> DVec3 {
        self.low() + v(self.size[0], self.size[1], self.floors as f64 * self.floor_height)
    }

    /// Walls, and the bottom that the house stands on.
    fn walls(&self, solids: &mut Solids) {
        let (low, high) = (self.low(), self.high());
        let bottom = [(low.x, low.y), (high.x, low.y), (high.x, high.y), (low.x, high.y)];
        let bottom = bottom.map(|(x, y)| v(x, y, low.z)).to_vec();
        solids.face((OBJECT, self.wall), bottom, -DVec3::Z);
        // Lower left corner seen from outside, and the level direction to the right.
        let sides = [
            (v(low.x, high.y, low.z), -DVec3::Y, self.size[1]),
            (v(high.x, low.y, low.z), DVec3::Y, self.size[1]),
            (low, DVec3::X, self.size[0]),
            (v(high.x, high.y, low.z), -DVec3::X, self.size[0]),
        ];
        for ((corner, right, breadth), bays) in sides.into_iter().zip(self.bays) {
            let out = right.cross(DVec3::Z);
            if bays == 0 {
                let (r, u) = (right * breadth, DVec3::Z * (high.z - low.z));
                solids.face((OBJECT, self.wall), vec![corner, corner + r, corner + r + u, corner + u], out);
                continue;
            }
            let cell = [breadth / bays as f64, self.floor_height];
            for k in 0..bays * self.floors {
                let (bay, floor) = ((k % bays) as f64, (k / bays) as f64);
                let at = corner + right * (bay * cell[0]) + DVec3::Z * (floor * cell[1]);
                self.cell(solids, at, right, out, cell);
            }
        }
    }

    /// A window and the wall around it.
    fn cell(&self, solids: &mut Solids, at: DVec3, right: DVec3, out: DVec3, cell: [f64; 2]) {
        let point = |x: f64, z: f64, depth: f64| at + right * x + DVec3::Z * z - out * depth;
        let [w, h] = [cell[0] * self.window[0], cell[1] * self.window[1]];
        let (x0, z0) = (0.5 * (cell[0] - w), 0.52 * (cell[1] - h));
        let frame =
            |depth: f64| [(x0, z0), (x0 + w, z0), (x0 + w, z0 + h), (x0, z0 + h)].map(|(x, z)| point(x, z, depth));
        let outer = [(0.0, 0.0), (cell[0], 0.0), (cell[0], cell[1]), (0.0, cell[1])].map(|(x, z)| point(x, z, 0.0));
        let (hole, pane) = (frame(0.0), frame(self.depth));
        let middle = point(x0 + 0.5 * w, z0 + 0.5 * h, 0.5 * self.depth);
        for k in 0..4 {
            let n = (k + 1) % 4;
            // Mitred, so that no corner lies on another face's edge.
            solids.face((OBJECT, self.wall), vec![outer[k], outer[n], hole[n], hole[k]], out);
            let reveal = vec![hole[k], hole[n], pane[n], pane[k]];
            let inward = middle - 0.25 * reveal.iter().sum::<DVec3>();
            solids.face((OBJECT, "frame"), reveal, inward);
        }
        solids.face((OBJECT, self.glass), pane.to_vec(), out);
        if self.ledges {
            let corners: Vec<_> = (0..8)
                .map(|k| {
                    let pick = |bit: usize, a: f64, b: f64| if k >> bit & 1 == 0 { a } else { b };
                    point(pick(0, x0 - 0.1, x0 + w + 0.1), pick(1, z0 - 0.1, z0 - 0.02), pick(2, 0.0, -0.16))
                })
                .collect();
            let faces: [&[usize]; 6] =
                [&[0, 2, 6, 4], &[1, 3, 7, 5], &[0, 1, 5, 4], &[2, 3, 7, 6], &[4, 5, 7, 6], &[0, 1, 3, 2]];
            solids.body((OBJECT, "frame"), &corners, &faces);
        }
    }

    /// A flat roof within a low wall of 0.3 m breadth and 0.6 m height.
    fn parapet(&self, solids: &mut Solids) {
        let (low, high) = (self.low(), self.high());
        let ring = |inset: f64, z: f64| {
            let (a, b) = (low + DVec3::ONE * inset, high - DVec3::ONE * inset);
            [v(a.x, a.y, z), v(b.x, a.y, z), v(b.x, b.y, z), v(a.x, b.y, z)]
        };
        let (base, top) = (ring(0.0, high.z), ring(0.0, high.z + 0.6));
        let (inner, floor) = (ring(0.3, high.z + 0.6), ring(0.3, high.z));
        let middle = 0.5 * (base[0] + base[2]);
        for k in 0..4 {
            let n = (k + 1) % 4;
            let out = 0.5 * (base[k] + base[n]) - middle;
            solids.face((OBJECT, self.wall), vec![base[k], base[n], top[n], top[k]], out);
            solids.face((OBJECT, "frame"), vec![top[k], top[n], inner[n], inner[k]], DVec3::Z);
            solids.face((OBJECT, self.wall), vec![inner[k], inner[n], floor[n], floor[k]], -out);
        }
        solids.face((OBJECT, "roof"), floor.to_vec(), DVec3::Z);
    }

    /// Two slopes that meet over the middle, with eaves, and a chimney.
    fn gable(&self, solids: &mut Solids) {
        let (low, high) = (self.low(), self.high());
        let (z, ridge) = (high.z, high.z + 0.4 * self.size[0]);
        let x = 0.5 * (low.x + high.x);
        for (y, out) in [(low.y, -DVec3::Y), (high.y, DVec3::Y)] {
            let gable = vec![v(low.x, y, z), v(high.x, y, z), v(x, y, ridge)];
            solids.face((OBJECT, self.wall), gable, out);
        }
        let (south, north, eaves) = (low.y - 0.4, high.y + 0.4, 0.5);
        let drop = eaves * (ridge - z) / (0.5 * self.size[0]);
        for side in [-1.0, 1.0] {
            let foot = x + side * (0.5 * self.size[0] + eaves);
            // The roof is a plate of 0.12 m; its lower side keeps a millimetre off the walls.
            for (lift, towards) in [(0.121, DVec3::Z), (0.001, -DVec3::Z)] {
                let (a, b) = (z - drop + lift, ridge + lift);
                let slope = vec![v(foot, south, a), v(foot, north, a), v(x, north, b), v(x, south, b)];
                solids.face((OBJECT, "tiles"), slope, towards);
            }
            let rim = |y: f64, x: f64, z: f64, lift: f64| v(x, y, z + lift);
            for (y, out) in [(south, -DVec3::Y), (north, DVec3::Y)] {
                let end = vec![
                    rim(y, foot, z - drop, 0.001),
                    rim(y, x, ridge, 0.001),
                    rim(y, x, ridge, 0.121),
                    rim(y, foot, z - drop, 0.121),
                ];
                solids.face((OBJECT, "frame"), end, out);
            }
            let (a, b) = (z - drop + 0.001, z - drop + 0.121);
            let gutter = vec![v(foot, south, a), v(foot, north, a), v(foot, north, b), v(foot, south, b)];
            solids.face((OBJECT, "frame"), gutter, DVec3::X * side);
        }
    }
}
