//! Where each picture stands, by its name.

use super::EnvmapPicture;
use crate::report::html::context::minus;
use serde::Serialize;

/// Rows and columns of the spheres of [G86 fig. 8].
const ROWS: [&str; 3] = ["map", "rays", "off"];
const COLUMNS: [&str; 3] = ["diffuse", "half", "mirror"];
/// The object's pictures, from left to right.
const OBJECT: [&str; 4] = ["map", "hybrid", "rays", "off"];
/// Pictures of the world that come first.
const WORLD: [&str; 3] = ["world-cube", "world-latlong", "world-diffuse"];

/// A picture with what is written below it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(super) struct Shown {
    pub file: String,
    pub title: String,
    pub width: u32,
    pub height: u32,
}

/// Pictures that belong together.
#[derive(Debug, Serialize)]
pub(super) struct Group {
    pub title: &'static str,
    pub lead: &'static str,
    /// Class of its layout.
    pub class: &'static str,
    /// Row after row; `None` where a grid has no picture.
    pub pictures: Vec<Option<Shown>>,
}

/// Name of its file.
pub(super) fn file(p: &EnvmapPicture) -> String {
    format!("{}.png", p.name)
}

fn shown(p: &EnvmapPicture) -> Shown {
    Shown { file: file(p), title: minus(&p.title), width: p.raster.width, height: p.raster.height }
}

/// Takes what `chosen` holds for out of `left`, in order.
fn taken<'a>(left: &mut Vec<&'a EnvmapPicture>, chosen: impl Fn(&str) -> bool) -> Vec<&'a EnvmapPicture> {
    let (mine, others) = left.drain(..).partition(|p| chosen(&p.name));
    *left = others;
    mine
}

/// The first of that name.
fn named<'a>(left: &mut Vec<&'a EnvmapPicture>, name: &str) -> Option<&'a EnvmapPicture> {
    let at = left.iter().position(|p| p.name == name)?;
    Some(left.remove(at))
}

/// Groups that have pictures, every picture in one of them.
pub(super) fn groups(all: &[EnvmapPicture]) -> Vec<Group> {
    let mut left: Vec<&EnvmapPicture> = all.iter().collect();
    let mut world: Vec<&EnvmapPicture> = WORLD.iter().filter_map(|n| named(&mut left, n)).collect();
    world.extend(taken(&mut left, |n| n.starts_with("world-")));
    let footprints = taken(&mut left, |n| n.starts_with("footprints-"));
    let spheres = spheres(&mut left);
    let object: Vec<_> = OBJECT.iter().filter_map(|how| named(&mut left, &format!("object-{how}"))).collect();
    let flat = |of: Vec<&EnvmapPicture>| of.into_iter().map(|p| Some(shown(p))).collect();
    let group = |title, lead, class, pictures| Group { title, lead, class, pictures };
    let groups = [
        group(
            "The world around the centre",
            "What the map holds, the object taken away: as a cube unfolded, turned into other layouts, and as the \
             irradiance over every normal.",
            "worlds",
            flat(world),
        ),
        group(
            "Footprints of reflection cones",
            "The regions of the map that cones subtend (Greene 1986, figures 4 and 6).",
            "worlds",
            flat(footprints),
        ),
        group(
            "Three spheres",
            "A Lambertian sphere, one half and half, and a mirror, about the first centre (Greene 1986, figure 8): by the \
             map, by rays, and the difference.",
            "spheres",
            spheres,
        ),
        group(
            "The object in its scene",
            "The object alone is shaded; all else is as it was solved.",
            "objects",
            flat(object),
        ),
        group("More pictures", "", "worlds", flat(left)),
    ];
    groups.into_iter().filter(|g| g.pictures.iter().any(Option::is_some)).collect()
}

/// Rows of three; a row without any picture is left out.
fn spheres(left: &mut Vec<&EnvmapPicture>) -> Vec<Option<Shown>> {
    let mut row = |how: &str| COLUMNS.map(|c| named(left, &format!("sphere-{c}-{how}")).map(shown));
    let rows: Vec<[Option<Shown>; 3]> = ROWS.iter().map(|how| row(how)).collect();
    rows.into_iter().filter(|r| r.iter().any(Option::is_some)).flatten().collect()
}
