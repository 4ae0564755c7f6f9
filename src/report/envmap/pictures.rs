//! Where each picture stands, by its name.

use crate::report::gallery::{Group, PagePicture, Shown, named, taken};

/// Rows and columns of the spheres of [G86 fig. 8].
const ROWS: [&str; 3] = ["map", "rays", "off"];
const COLUMNS: [&str; 3] = ["diffuse", "half", "mirror"];
/// The object's pictures, from left to right.
const OBJECT: [&str; 4] = ["map", "hybrid", "rays", "off"];
/// Pictures of the world that come first.
const WORLD: [&str; 3] = ["world-cube", "world-latlong", "world-diffuse"];

/// Groups that have pictures, every picture in one of them.
pub(super) fn groups(all: &[PagePicture]) -> Vec<Group> {
    let mut left: Vec<&PagePicture> = all.iter().collect();
    let mut world: Vec<&PagePicture> = WORLD.iter().filter_map(|n| named(&mut left, n)).collect();
    world.extend(taken(&mut left, |n| n.starts_with("world-")));
    let footprints = taken(&mut left, |n| n.starts_with("footprints-"));
    let spheres = spheres(&mut left);
    let object: Vec<_> = OBJECT.iter().filter_map(|how| named(&mut left, &format!("object-{how}"))).collect();
    let groups = [
        Group::of(
            "The world around the centre",
            "What the map holds, the object taken away: as a cube unfolded, turned into other layouts, and as the \
             irradiance over every normal.",
            "worlds",
            world,
        ),
        Group::of(
            "Footprints of reflection cones",
            "The regions of the map that cones subtend (Greene 1986, figures 4 and 6).",
            "worlds",
            footprints,
        ),
        Group {
            title: "Three spheres",
            lead: "A Lambertian sphere, one half and half, and a mirror, about the first centre (Greene 1986, figure 8): by the \
             map, by rays, and the difference.",
            class: "spheres",
            pictures: spheres,
        },
        Group::of(
            "The object in its scene",
            "The object alone is shaded; all else is as it was solved.",
            "objects",
            object,
        ),
        Group::of("More pictures", "", "worlds", left),
    ];
    groups.into_iter().filter(|g| !g.is_empty()).collect()
}

/// Rows of three; a row without any picture is left out.
fn spheres(left: &mut Vec<&PagePicture>) -> Vec<Option<Shown>> {
    let mut row = |how: &str| COLUMNS.map(|c| named(left, &format!("sphere-{c}-{how}")).map(PagePicture::shown));
    let rows: Vec<[Option<Shown>; 3]> = ROWS.iter().map(|how| row(how)).collect();
    rows.into_iter().filter(|r| r.iter().any(Option::is_some)).flatten().collect()
}
