//! Makes the pictures of the README and of `reports/gallery`, all of them by the program's own commands.
//!
//! `cargo run --release --example gallery -- [--all] PROGRAM FOLDER`; `cargo xtask gallery` does it. `--all` adds the robot
//! room, which takes some ten minutes.

use etalon::io::image::png;
use etalon::render::{Raster, side_by_side};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;

type Done = Result<(), Box<dyn Error>>;

/// 1,000 lamberts, and a hundredth each time [TR93 fig. 5].
const LAMPS: &str = "3183098.86,31830.9886,318.309886,3.18309886,0.0318309886,0.000318309886,0.00000318309886";

fn main() -> Done {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let all = arguments.iter().position(|a| a == "--all").map(|k| arguments.remove(k)).is_some();
    let [program, folder] = arguments.as_slice() else { return Err("usage: gallery [--all] PROGRAM FOLDER".into()) };
    let work = tempfile::tempdir()?;
    std::fs::create_dir_all(folder)?;
    let gallery = Gallery { program: program.into(), folder: folder.into(), work: work.path().into() };
    gallery.cornell_box()?;
    gallery.tones()?;
    gallery.unfolded()?;
    gallery.environment()?;
    gallery.town()?;
    if all {
        gallery.robot_room()?;
    }
    Ok(())
}

struct Gallery {
    program: PathBuf,
    folder: PathBuf,
    work: PathBuf,
}

impl Gallery {
    /// Runs the program in the work folder.
    fn etalon(&self, arguments: &str) -> Done {
        println!("etalon {arguments}");
        let program = std::path::absolute(&self.program)?;
        let status = Command::new(program).args(arguments.split_whitespace()).current_dir(&self.work).status()?;
        if status.success() { Ok(()) } else { Err(format!("etalon {arguments}: {status}").into()) }
    }

    fn keep(&self, from: &str, to: &str) -> Done {
        std::fs::copy(self.work.join(from), self.folder.join(to))?;
        println!("  -> {}", self.folder.join(to).display());
        Ok(())
    }

    fn read(&self, name: &str) -> Result<Raster, Box<dyn Error>> {
        let picture = image::open(self.work.join(name))?.into_rgba8();
        Ok(Raster { width: picture.width(), height: picture.height(), rgba: picture.into_raw() })
    }

    /// Pictures of one height beside each other.
    fn join(&self, names: &[&str], to: &str) -> Done {
        let panels = names.iter().map(|n| self.read(n)).collect::<Result<Vec<Raster>, _>>()?;
        let joined = side_by_side(&panels);
        std::fs::write(self.work.join(to), png(joined.width, joined.height, &joined.rgba)?)?;
        self.keep(to, to)
    }

    /// A town in four clusters under three lights, and a room [NINT89 fig. 7]: scanned, composited, shaded, judged by rays.
    fn town(&self) -> Done {
        let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
        let town = self.work.join("town");
        let status =
            Command::new(cargo).args(["run", "--release", "--quiet", "--example", "town", "--"]).arg(&town).status()?;
        if !status.success() {
            return Err(format!("the town: {status}").into());
        }
        self.etalon("scan town/town.toml --each -o parts")?;
        let parts = ["buildings", "roads", "trees", "cars"].map(|o| format!("parts/{o}.span")).join(" ");
        self.etalon(&format!("composite {parts} -o town.span"))?;
        for light in ["day", "overcast", "night"] {
            self.etalon(&format!("shade town.span --lighting town/{light}.toml -o town-{light}.png"))?;
        }
        self.join(&["town-day.png", "town-night.png"], "town.png")?;
        self.keep("town-overcast.png", "town-overcast.png")?;
        self.etalon("scan town/room.toml -o room.span")?;
        self.etalon("shade room.span -o room.png")?;
        self.keep("room.png", "lamp-and-window.png")?;
        for scene in ["town", "room"] {
            self.etalon(&format!("audit compositing town/{scene}.toml -o audit-{scene} -q"))?;
            let panels = ["shaded", "rays", "off"].map(|p| format!("audit-{scene}/{p}.png"));
            self.join(&panels.each_ref().map(String::as_str), &format!("{scene}-judged.png"))?;
        }
        Ok(())
    }

    fn cornell_box(&self) -> Done {
        self.etalon("demo -o demo")?;
        let camera = camera(&self.work.join("demo"))?;
        let panels = ["reference", "candidate", "difference"].map(|kind| format!("demo/{camera}-{kind}.png"));
        self.join(&panels.each_ref().map(String::as_str), "cornell-box.png")
    }

    /// The same light by every operator, and one operator under all lights.
    fn tones(&self) -> Done {
        let scene = "render demo/reference --size 260x260";
        for operator in ["tr93", "tr93-consistent"] {
            let name = format!("searchlight-to-firefly-{operator}.png");
            self.etalon(&format!("{scene} --tone {operator} --display crt --lamp {LAMPS} -o {name}"))?;
            self.keep(&name, &name)?;
        }
        let operators = ["tr93", "tr93-consistent", "film", "television", "brightest"];
        for operator in operators {
            self.etalon(&format!("{scene} --tone {operator} --lamp 3000 -o {operator}.png"))?;
        }
        self.join(&operators.map(|o| format!("{o}.png")).each_ref().map(String::as_str), "operators.png")
    }

    fn unfolded(&self) -> Done {
        self.etalon("audit hemicube builtin:small-lamp --resolution 50 --source lamp --no-cures -o audit")?;
        let unfolded = named(&self.work.join("audit"), |n| n.starts_with("unfolded-") && n.ends_with(".png"))?;
        self.keep(&format!("audit/{unfolded}"), "unfolded.png")
    }

    fn robot_room(&self) -> Done {
        let methods = "progressive:unshot=1%,redistribution:unshot=1%,before=1%";
        self.etalon(&format!(
            "converge builtin:robot-room --estimator rays --methods {methods} --pictures 5,100 -o curves"
        ))?;
        let rows = [["reference-before", "reference"], ["method-1-after-100", "method-2-after-100"]];
        let pictures = rows.map(|row| row.map(|stem| format!("curves/picture-edit-1-{stem}.png")));
        self.rows(&pictures, "robot-room.png")
    }

    /// The world around the tall block, and the spheres of [G86 fig. 8]: by the map above, by rays below.
    fn environment(&self) -> Done {
        self.etalon("audit envmap demo/reference --object tall-block --size 256 -o envmap")?;
        self.keep("envmap/footprints-cube.png", "world-unfolded.png")?;
        let row = |by: &str| ["diffuse", "half", "mirror"].map(|kind| format!("envmap/sphere-{kind}-{by}.png"));
        self.rows(&[row("map"), row("rays")], "spheres.png")
    }

    /// Rows of pictures, all of one size, above one another.
    fn rows<const N: usize>(&self, rows: &[[String; N]], to: &str) -> Done {
        let (mut rgba, mut size) = (Vec::new(), [0, 0]);
        for row in rows {
            let row = side_by_side(&row.iter().map(|n| self.read(n)).collect::<Result<Vec<Raster>, _>>()?);
            size = [row.width, size[1] + row.height];
            rgba.extend(row.rgba);
        }
        std::fs::write(self.work.join(to), png(size[0], size[1], &rgba)?)?;
        self.keep(to, to)
    }
}

/// Stem of the pictures of a report folder.
fn camera(folder: &Path) -> Result<String, Box<dyn Error>> {
    let name = named(folder, |n| n.ends_with("-reference.png"))?;
    Ok(name.trim_end_matches("-reference.png").to_string())
}

/// The first file, by name, that is wanted.
fn named(folder: &Path, wanted: impl Fn(&str) -> bool) -> Result<String, Box<dyn Error>> {
    let mut names: Vec<String> = std::fs::read_dir(folder)?
        .map(|e| e.map(|e| e.file_name().to_string_lossy().into_owned()))
        .collect::<Result<_, _>>()?;
    names.sort();
    names.into_iter().find(|n| wanted(n)).ok_or_else(|| format!("{}: no such file", folder.display()).into())
}
