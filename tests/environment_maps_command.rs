//! `etalon project` and `etalon audit envmap` as a script runs them.

#[path = "common/program.rs"]
mod program;

use program::{json, ok, refused, run};
use std::fs;
use std::path::Path;

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

/// A solution of the coarse Cornell box in a folder.
fn solved(here: &Path) {
    ok(here, "solve builtin:cornell-box-coarse --method hemicube:resolution=50 -o s.csv");
}

#[test]
fn a_world_in_every_layout_and_back() {
    let place = folder();
    let here = place.path();
    solved(here);
    for (layout, size) in
        [("cube", [128, 96]), ("latlong", [64, 32]), ("sine-latlong", [64, 32]), ("fisheye", [32, 32])]
    {
        let from = "project builtin:cornell-box-coarse --solution s.csv --at 0.28,0.28,0.2";
        let value = json(here, &format!("{from} --layout {layout} --size 32 -o {layout}.exr"));
        assert_eq!([&value["width"], &value["height"]], [size[0], size[1]], "{value}");
        ok(here, &format!("{from} --layout {layout} --size 32 -o {layout}.png"));
        // The same bytes on one thread.
        let first = fs::read(here.join(format!("{layout}.exr"))).expect("written");
        ok(here, &format!("{from} --layout {layout} --size 32 -o {layout}.exr --threads 1"));
        assert_eq!(first, fs::read(here.join(format!("{layout}.exr"))).expect("written"), "{layout}");
        // What was written is read, and turned into a cube and a perspective.
        let value = json(here, &format!("project {layout}.exr --layout cube --size 32 -o again.exr"));
        let rms = value["round_trip"]["rms"].as_f64().expect("a number");
        assert!((0.0..0.9).contains(&rms), "{layout} {rms}");
        ok(here, &format!("project {layout}.exr --layout perspective --size 30 --towards 0,1,0 -o p.png"));
    }
    let view = "project builtin:cornell-box-coarse --solution s.csv --layout perspective --size 60 -o p.exr";
    let off = |rest: &str| json(here, &format!("{view} {rest}"))["from_cube"]["off_rays"].as_f64().expect("a number");
    let (coarse, fine) = (off("--from-cube 64"), off("--from-cube 512"));
    assert!(fine < 0.5 * coarse && fine < 0.1, "{coarse} {fine}");
    assert!(json(here, view)["from_cube"].is_null());
    let diffuse =
        "project builtin:cornell-box-coarse --solution s.csv --at 0.28,0.28,0.2 --layout latlong --diffuse --size 20";
    let value = json(here, &format!("{diffuse} -o d.exr"));
    assert_eq!([&value["width"], &value["height"]], [40, 20]);
}

/// A white matt surface in a furnace looks like the furnace, whatever its normal; a map that is turned shows what was
/// to the right in the middle; a picture straight down looks down.
#[test]
fn pictures_show_what_they_say() {
    let place = folder();
    let here = place.path();
    ok(here, "solve builtin:furnace --method gather --rays 256 -o f.csv");
    let furnace = "project builtin:furnace --solution f.csv --at 0.5,0.5,0.5 --layout latlong --size 8";
    ok(here, &format!("{furnace} -o world.png"));
    ok(here, &format!("{furnace} --diffuse -o diffuse.png"));
    let pixels = |name: &str| image::open(here.join(name)).expect("a picture").into_rgb8().into_raw();
    let (world, diffuse) = (pixels("world.png"), pixels("diffuse.png"));
    assert!(world.iter().zip(&diffuse).all(|(a, b)| a.abs_diff(*b) <= 1), "{:?} {:?}", &world[..6], &diffuse[..6]);

    solved(here);
    let room = "project builtin:cornell-box-coarse --solution s.csv --at 0.28,0.28,0.3";
    ok(here, &format!("{room} --layout latlong --size 64 --towards 0,1,0 -o ahead.exr"));
    ok(here, &format!("{room} --layout latlong --size 64 --towards 1,0,0 -o right.png"));
    ok(here, "project ahead.exr --layout latlong --size 64 --towards 1,0,0 -o turned.png");
    let off = |a: &str, b: &str| {
        let (a, b) = (pixels(a), pixels(b));
        assert_eq!(a.len(), b.len());
        a.iter().zip(&b).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / a.len() as f64
    };
    ok(here, "project ahead.exr --layout latlong --size 64 -o ahead.png");
    // Lamps are known in the scene, not in its picture: the eye adapts a little otherwise, and edges are filtered.
    let (turned, not) = (off("turned.png", "right.png"), off("ahead.png", "right.png"));
    assert!(turned < 0.4 * not, "{turned} {not}");
    // Half down and straight down see other things.
    for (name, towards) in [("level", "0,1,0"), ("half", "0,1,-1"), ("down", "0,0,-1")] {
        ok(here, &format!("{room} --layout perspective --size 30 --field 40 --towards {towards} -o {name}.png"));
    }
    assert!(off("level.png", "half.png") > 2.0 && off("half.png", "down.png") > 2.0);
}

#[test]
fn what_makes_no_sense_is_refused() {
    let place = folder();
    let here = place.path();
    solved(here);
    let project = "project builtin:cornell-box-coarse --solution s.csv";
    ok(here, &format!("{project} --layout latlong --size 8 -o latlong.exr"));
    fs::write(here.join("bad.exr"), b"v/1\x01 not at all").expect("written");
    for (rest, says) in [
        (format!("{project} -o x.jpg"), ".exr"),
        (format!("{project} --field 90 -o x.exr"), "--field"),
        (format!("{project} --layout fisheye --field 400 -o x.exr"), "360"),
        (format!("{project} --at 1,2 -o x.exr"), "X,Y,Z"),
        (format!("{project} --towards 0,0,0 -o x.exr"), "--towards"),
        (format!("{project} --camera nobody -o x.exr"), "nobody"),
        (format!("{project} --without nobody -o x.exr"), "nobody"),
        (format!("{project} --diffuse -o x.exr"), "latlong"),
        (format!("{project} --turning-to 0,1,0 -o x.exr"), "perspective"),
        (format!("{project} --size 8192 -o x.exr"), "--size 8192"),
        (format!("{project} --from-cube 8192 -o x.exr"), "--from-cube 8192"),
        (format!("{project} --layout perspective --size 8192 -o x.exr"), "--samples"),
        (format!("{project} --layout latlong --diffuse -o x.exr"), "20 is usual"),
        ("project latlong.exr --towards 0,0,1 -o x.exr".into(), "--towards"),
        (format!("{project} --sky bad.exr -o x.exr"), "bad.exr"),
        ("project builtin:cornell-box-coarse -o x.exr".into(), "--solution"),
        ("project bad.exr -o x.exr".into(), "bad.exr"),
        ("project none.exr -o x.exr".into(), "none.exr"),
        ("project bad.exr --at 0,0,0 -o x.exr".into(), "--at"),
    ] {
        let message = refused(here, &rest);
        assert!(message.contains(says), "{rest}: {message}");
        assert!(!here.join("x.exr").exists() && !here.join("x.jpg").exists(), "{rest}");
    }
    let audit = "audit envmap builtin:cornell-box-coarse --solution s.csv";
    for (rest, says) in [
        (format!("{audit} --object nobody -o a"), "nobody"),
        (format!("{audit} --object tall-block --shading 1 -o a"), "DC,SC"),
        (format!("{audit} --object tall-block --confidence 2 -o a"), "--confidence"),
        (format!("{audit} --object tall-block --at 50,50,50 -o a"), "sees no light"),
        (format!("{audit} --object tall-block --stated-error 0 -o a"), "--stated-error"),
    ] {
        let message = refused(here, &rest);
        assert!(message.contains(says), "{rest}: {message}");
        assert!(!here.join("a").exists(), "{rest}");
    }
}

#[test]
fn the_audit_leaves_a_page_and_an_exit_code() {
    let place = folder();
    let here = place.path();
    solved(here);
    let audit = "audit envmap builtin:cornell-box-coarse --solution s.csv --object tall-block --size 32 --points 64 --rays 1024 --directions 10";
    let (code, out, err) = run(here, &format!("{audit} -o a --max-error 5%"));
    assert_eq!(code, 1, "{out}{err}");
    assert!(out.contains("Irradiance over \"tall-block\"") && out.contains("Nine spherical harmonics"), "{out}");
    for file in ["index.html", "audit.json", "points.csv", "world-cube.png", "sphere-mirror-map.png", "object-rays.png"]
    {
        assert!(here.join("a").join(file).metadata().is_ok_and(|m| m.len() > 100), "{file}");
    }
    assert_eq!(run(here, &format!("{audit} -o b --max-error 500%")).0, 0);
    // Same bytes on any number of threads, seconds aside.
    let timeless = |threads: u32| {
        let mut value = json(here, &format!("{audit} -o c --threads {threads}"));
        program::strip_seconds(&mut value);
        (value, fs::read(here.join("c/points.csv")).expect("a table"))
    };
    assert_eq!(timeless(1), timeless(2));
}
