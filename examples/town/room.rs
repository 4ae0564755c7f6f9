//! A room with a lamp that has a body, and a window: the lighting design of [NINT89 fig. 7], made up.

use super::solid::{Solids, obj, v};
use etalon::math::DVec3;
use std::fmt::Write;

/// Materials: name, reflectance, emission.
const MATERIALS: [(&str, [f64; 3], f64); 9] = [
    ("wall", [0.72, 0.7, 0.64], 0.0),
    ("ceiling", [0.8, 0.8, 0.78], 0.0),
    ("floor", [0.42, 0.3, 0.2], 0.0),
    ("wood", [0.5, 0.34, 0.2], 0.0),
    ("cloth", [0.24, 0.34, 0.5], 0.0),
    ("picture", [0.6, 0.25, 0.2], 0.0),
    ("cord", [0.2, 0.2, 0.2], 0.0),
    ("shade", [0.6, 0.6, 0.55], 30.0),
    ("pane", [0.1, 0.1, 0.1], 12.0),
];

/// Things keep this much off what they stand on or hang from: nothing is covered.
const GAP: f64 = 0.001;

/// The scene file and its mesh.
pub fn files() -> Vec<(String, String)> {
    let size = v(5.0, 4.0, 2.7);
    let mut text = String::from(
        "# A room: daylight from a window, an octahedral lamp over the table.\nformat = \"etalon-scene/1\"\n\
         name = \"room\"\nenclosure = true\n\n[discretisation]\nmax_edge = 0.25\n",
    );
    for (name, [r, g, b], emission) in MATERIALS {
        let _ = write!(text, "\n[[material]]\nname = \"{name}\"\nreflectance = [{r}, {g}, {b}]\n");
        if emission > 0.0 {
            let _ = writeln!(text, "emission = {emission:?}");
        }
    }
    let mut polygon = |name: &str, object: &str, material: &str, corners: &[DVec3]| {
        let list: Vec<_> = corners.iter().map(|p| format!("[{}, {}, {}]", p.x, p.y, p.z)).collect();
        let _ = write!(
            text,
            "\n[[surface]]\nname = \"{name}\"\nobject = \"{object}\"\nmaterial = \"{material}\"\npolygon = [{}]\n",
            list.join(", ")
        );
    };
    let at = |x: f64, y: f64, z: f64| v(x, y, z) * size;
    polygon("floor", "walls", "floor", &[at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(1.0, 1.0, 0.0), at(0.0, 1.0, 0.0)]);
    polygon(
        "ceiling",
        "walls",
        "ceiling",
        &[at(0.0, 0.0, 1.0), at(0.0, 1.0, 1.0), at(1.0, 1.0, 1.0), at(1.0, 0.0, 1.0)],
    );
    polygon("south", "walls", "wall", &[at(0.0, 0.0, 0.0), at(0.0, 0.0, 1.0), at(1.0, 0.0, 1.0), at(1.0, 0.0, 0.0)]);
    polygon("north", "walls", "wall", &[at(0.0, 1.0, 0.0), at(1.0, 1.0, 0.0), at(1.0, 1.0, 1.0), at(0.0, 1.0, 1.0)]);
    polygon("west", "walls", "wall", &[at(0.0, 0.0, 0.0), at(0.0, 1.0, 0.0), at(0.0, 1.0, 1.0), at(0.0, 0.0, 1.0)]);
    // The east wall around the window, mitred.
    let outer = [(0.0, 0.0), (0.0, 2.7), (4.0, 2.7), (4.0, 0.0)].map(|(y, z)| v(5.0, y, z));
    let hole = [(1.2, 0.9), (1.2, 2.2), (3.0, 2.2), (3.0, 0.9)].map(|(y, z)| v(5.0, y, z));
    for k in 0..4 {
        let n = (k + 1) % 4;
        polygon(&format!("east {}", k + 1), "walls", "wall", &[outer[k], outer[n], hole[n], hole[k]]);
    }
    polygon("window", "walls", "pane", &hole);
    let solids = furniture();
    for (object, material, _) in solids.parts() {
        let _ = write!(
            text,
            "\n[[surface]]\nname = \"{object} {material}\"\nobject = \"{object}\"\nmaterial = \"{material}\"\n\
             mesh = \"room-{object}-{material}.obj\"\n"
        );
    }
    text += r#"
[[light]]
name = "lamp"
type = "polyhedron"
object = "lamp"

[[light]]
name = "daylight"
type = "area"
surface = "window"

[[camera]]
name = "door"
eye = [0.35, 0.45, 1.65]
target = [3.2, 2.4, 1.1]
fov = 62
size = [640, 480]
"#;
    let mut files = vec![("room.toml".to_string(), text)];
    files.extend(solids.parts().map(|(o, m, faces)| (format!("room-{o}-{m}.obj"), obj(faces))));
    files
}

fn furniture() -> Solids {
    let mut solids = Solids::default();
    let wood = ("table", "wood");
    solids.cuboid(wood, v(2.0, 1.5, 0.7), v(3.6, 2.5, 0.74), &[]);
    for (x, y) in [(2.06, 1.56), (3.48, 1.56), (2.06, 2.38), (3.48, 2.38)] {
        solids.cuboid(wood, v(x, y, GAP), v(x + 0.06, y + 0.06, 0.7 - GAP), &[]);
    }
    for (x, y, back) in [(2.3, 1.05, -1.0), (3.0, 1.05, -1.0), (2.3, 2.6, 1.0), (3.0, 2.6, 1.0)] {
        chair(&mut solids, v(x, y, 0.0), back);
    }
    // The cupboard stands at the north wall, its doors before its body.
    solids.cuboid(("cupboard", "wood"), v(0.5, 4.0 - 0.452, GAP), v(1.7, 4.0 - GAP, 1.9), &[]);
    for x in [0.52, 1.105] {
        solids.cuboid(("cupboard", "wood"), v(x, 3.522, 0.06), v(x + 0.575, 3.547, 1.86), &[]);
        solids.cuboid(("cupboard", "cord"), v(x + 0.27, 3.5, 0.95), v(x + 0.29, 3.521, 1.08), &[]);
    }
    // A framed picture on the same wall.
    let frame = ("frame", "wood");
    let (low, high) = (v(2.5, 3.97, 1.3), v(3.7, 4.0 - GAP, 2.1));
    solids.cuboid(frame, low, v(high.x, high.y, low.z + 0.05), &[]);
    solids.cuboid(frame, v(low.x, low.y, high.z - 0.05), high, &[]);
    let inner = (low.z + 0.05 + GAP, high.z - 0.05 - GAP);
    solids.cuboid(frame, v(low.x, low.y, inner.0), v(low.x + 0.05, high.y, inner.1), &[]);
    solids.cuboid(frame, v(high.x - 0.05, low.y, inner.0), v(high.x, high.y, inner.1), &[]);
    let sides = [low.x + 0.05 + GAP, high.x - 0.05 - GAP];
    solids.cuboid(("frame", "picture"), v(sides[0], 3.985, inner.0), v(sides[1], 4.0 - GAP, inner.1), &[]);
    // The lamp, and the cord it hangs from.
    let (middle, r) = (v(2.8, 2.0, 1.85), 0.16);
    let corners: Vec<_> =
        [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y, DVec3::Z, -DVec3::Z].map(|d| middle + d * r).into();
    let faces: Vec<[usize; 3]> = (0..4).flat_map(|k| [[k, (k + 1) % 4, 4], [k, (k + 1) % 4, 5]]).collect();
    solids.body(("lamp", "shade"), &corners, &faces.iter().map(|f| &f[..]).collect::<Vec<_>>());
    let cord = [middle + DVec3::Z * (r + 2.0 * GAP), v(middle.x, middle.y, 2.7 - GAP)];
    solids.prism(("cord", "cord"), cord, [0.006; 2], 6, [true, true]);
    solids
}

/// A chair of 0.4 m; `back` tells on which side in y its back is.
fn chair(solids: &mut Solids, at: DVec3, back: f64) {
    let (wood, cloth) = (("chairs", "wood"), ("chairs", "cloth"));
    solids.cuboid(cloth, at + v(0.0, 0.0, 0.44), at + v(0.4, 0.4, 0.48), &[]);
    for (x, y) in [(0.0, 0.0), (0.36, 0.0), (0.0, 0.36), (0.36, 0.36)] {
        solids.cuboid(wood, at + v(x, y, GAP), at + v(x + 0.04, y + 0.04, 0.44 - GAP), &[]);
    }
    let y = if back > 0.0 { 0.36 } else { 0.0 };
    solids.cuboid(cloth, at + v(0.0, y, 0.48 + GAP), at + v(0.4, y + 0.04, 0.95), &[]);
}
