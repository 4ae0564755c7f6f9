//! The scene doctor from a program: `cargo run --release --example examine_a_scene -- room.toml`.

use etalon::{examine_scene, open_scene};

fn main() -> Result<(), etalon::Error> {
    let spec = std::env::args().nth(1).unwrap_or_else(|| "builtin:cornell-box".into());
    let scene = open_scene(&spec)?;
    let findings = examine_scene(&scene, scene.edits.len())?;
    println!("{}: {} findings", scene.name, findings.len());
    for f in findings {
        println!("{} {} in {}: {}", f.severity.name(), f.kind.name(), f.place.surfaces.join(", "), f.what);
        if let Some(c) = f.consequence {
            println!("    {}", c.text);
        }
        println!("    mend: {}", f.mend);
    }
    Ok(())
}
