//! Writes a town [NINT89 fig. 7] and a room, with their pictures and lights, as scene files.
//!
//! `cargo run --release --example town -- FOLDER [--night]`: `town.toml` by day (with `--night`, by night), `day.toml`,
//! `overcast.toml` and `night.toml` to light it otherwise, `room.toml`. The same bytes every time.

mod buildings;
mod cars;
mod lighting;
mod pictures;
mod plants;
mod room;
mod solid;
mod street;

use etalon::io::image::png;
use pictures::Sheet;
use solid::{Solids, obj};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;

/// Materials of the town: name, reflectance, and what else it shows.
const MATERIALS: [(&str, [f64; 3], &str); 23] = [
    ("brick", [0.9, 0.9, 0.9], r#"texture = { picture = "brick.png", tile = [0.5, 0.6] }"#),
    ("plaster", [0.66, 0.6, 0.48], ""),
    ("concrete", [0.52, 0.52, 0.5], ""),
    ("roof", [0.3, 0.3, 0.3], ""),
    ("tiles", [0.45, 0.2, 0.13], ""),
    ("frame", [0.68, 0.68, 0.66], ""),
    ("window", [0.05, 0.06, 0.07], "reflection = 0.25"),
    ("mirror", [0.04, 0.05, 0.06], "reflection = 0.7"),
    ("asphalt", [0.9, 0.9, 0.9], r#"texture = { picture = "asphalt.png", tile = [2.0, 2.0] }"#),
    (
        "paving",
        [0.8, 0.8, 0.8],
        "texture = { picture = \"slabs.png\", tile = [2.0, 2.0] }\n\
         bump = { picture = \"slab-heights.png\", tile = [2.0, 2.0], height = 0.01 }",
    ),
    ("kerb", [0.5, 0.5, 0.48], ""),
    ("grass", [0.1, 0.2, 0.06], ""),
    ("marking", [0.8, 0.8, 0.78], ""),
    ("metal", [0.3, 0.31, 0.32], ""),
    ("red", [0.5, 0.05, 0.04], "reflection = 0.06"),
    ("blue", [0.06, 0.1, 0.38], "reflection = 0.06"),
    ("white", [0.7, 0.7, 0.68], "reflection = 0.04"),
    ("rubber", [0.05, 0.05, 0.05], ""),
    ("headlamp", [0.8, 0.8, 0.75], ""),
    ("taillamp", [0.5, 0.03, 0.02], ""),
    ("bark", [0.2, 0.15, 0.1], ""),
    ("leaf", [0.1, 0.24, 0.05], ""),
    ("young-leaf", [0.2, 0.34, 0.08], ""),
];

const CAMERA: &str = r#"
[[camera]]
name = "street"
eye = [1.2, -33.0, 2.6]
target = [-0.6, 6.0, 4.6]
fov = 50
size = [640, 480]
"#;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let night = arguments.iter().position(|a| a == "--night").map(|k| arguments.remove(k)).is_some();
    let [folder] = arguments.as_slice() else { return Err("usage: town FOLDER [--night]".into()) };
    let folder = Path::new(folder);
    std::fs::create_dir_all(folder)?;
    let mut solids = Solids::default();
    buildings::build(&mut solids);
    street::build(&mut solids);
    cars::build(&mut solids);
    plants::build(&mut solids);
    let light = if night { lighting::night() } else { lighting::DAY.to_string() };
    let mut files = vec![("town.toml".to_string(), town(&solids, &light))];
    files.extend(solids.parts().map(|(o, m, faces)| (mesh(o, m), obj(faces))));
    for (name, light) in [("day", lighting::DAY), ("overcast", lighting::OVERCAST), ("night", &lighting::night())] {
        files.push((format!("{name}.toml"), format!("format = \"etalon-lighting/1\"\n{light}")));
    }
    files.extend(room::files());
    for (name, text) in &files {
        std::fs::write(folder.join(name), text)?;
    }
    let sheets = [
        ("brick", pictures::bricks()),
        ("asphalt", pictures::asphalt()),
        ("slabs", pictures::slabs()),
        ("slab-heights", pictures::slab_heights()),
        ("clouds", pictures::clouds()),
        ("tree", pictures::tree()),
    ];
    for (name, Sheet { size: [w, h], rgba }) in sheets {
        std::fs::write(folder.join(format!("{name}.png")), png(w as u32, h as u32, &rgba)?)?;
    }
    println!("{}: town.toml has {} faces", folder.display(), solids.count());
    Ok(())
}

/// Name of a mesh file.
fn mesh(object: &str, material: &str) -> String {
    format!("town-{object}-{material}.obj")
}

/// The scene file.
fn town(solids: &Solids, light: &str) -> String {
    let mut text =
        String::from("# A street corner, made up.\nformat = \"etalon-scene/1\"\nname = \"town\"\nenclosure = false\n");
    for (name, [r, g, b], more) in MATERIALS {
        if solids.parts().any(|(_, material, _)| material == name) {
            let _ = write!(text, "\n[[material]]\nname = \"{name}\"\nreflectance = [{r}, {g}, {b}]\n");
            text += more;
            text += if more.is_empty() { "" } else { "\n" };
        }
    }
    for (object, material, _) in solids.parts() {
        let _ = write!(
            text,
            "\n[[surface]]\nname = \"{object} {material}\"\nobject = \"{object}\"\nmaterial = \"{material}\"\nmesh = \"{}\"\n",
            mesh(object, material)
        );
        if material.ends_with("leaf") {
            text += "two_sided = true\n";
        }
    }
    for (k, (foot, size)) in plants::PICTURES.iter().enumerate() {
        let _ = write!(
            text,
            "\n[[tree]]\nname = \"tree {}\"\nobject = \"trees\"\nfoot = {foot:?}\nsize = {size:?}\npicture = \"tree.png\"\n",
            k + 1
        );
    }
    text + CAMERA + light
}
