//! A picture of a world laid out in another way, by filtering.

use super::drawn::{Drawn, Kind, texels};
use super::{Made, shape, sky, turning};
use crate::cli::args::ProjectArgs;
use crate::cli::exit::Failure;
use crate::io::world_map::ReadMap;
use crate::math::{DMat3, DVec3};
use crate::render::Centre;
use crate::view::{Camera, Photometry};
use crate::world::{DiffuseMap, Layout, Shape, WorldMap, exact_picture, resample, rotated, round_trip};
use serde_json::json;
use std::path::Path;

/// Weights of the bands of a picture: red, green and blue by their names, anything else alike.
fn photometry(bands: &[String]) -> Photometry {
    let known = Photometry::rec709();
    if bands.len() == 3 && bands.iter().zip(&known.bands).all(|(a, b)| a.eq_ignore_ascii_case(b)) {
        return known;
    }
    Photometry { bands: bands.to_vec(), weights: vec![1.0 / bands.len() as f64; bands.len()] }
}

pub(super) fn made(args: &ProjectArgs, source: &Path) -> Result<Made, Failure> {
    refuse(args)?;
    let ReadMap { map, bands, how } = sky::open(source, args.given)?;
    let photometry = photometry(&bands);
    let from = map.shape();
    let map = if shape(args).is_some() { turned(args, map)? } else { map };
    let mut words = vec![format!("{}: {how}", source.display())];
    let mut json = json!({ "source": source.display().to_string(), "read_as": how });
    let (kind, comments) = match shape(args) {
        Some(_) if args.diffuse => {
            let table = DiffuseMap::new(&map, [2 * args.size, args.size]);
            let values = table.values().iter().map(|e| *e as f32).collect();
            let to = Shape { layout: Layout::LatLong, size: args.size };
            (
                Kind::Map(WorldMap::new(to, table.bands(), values)),
                "Irradiance over each normal: a diffuse illumination map.",
            )
        }
        Some(to) => {
            let drawn = resample(&map, to);
            let back = round_trip(&map, to);
            words.push(format!(
                "there and back again: {:.3} % (rms) off, mean radiance changed by {:+.5} %",
                100.0 * back.relative,
                100.0 * back.mean_change
            ));
            json["round_trip"] = json!({ "rms": back.relative, "energy": back.mean_change, "worst": back.worst });
            (Kind::Map(drawn), "As the picture it was made from, filtered.")
        }
        None => (perspective(args, &map, &mut words)?, "As the picture it was made from, filtered."),
    };
    json["from"] = json!({ "layout": from.layout, "size": from.size });
    let adapts_to = match &kind {
        Kind::Map(map) => texels(map, &photometry),
        Kind::Flat(..) => texels(&map, &photometry),
    };
    let comments = format!("{comments} Made from {}.", source.file_name().unwrap_or_default().to_string_lossy());
    let mut drawn = Drawn { kind, photometry, adapts_to, comments, is_irradiance: false, more: Vec::new() };
    if args.diffuse {
        drawn.shown_as_white_matt();
    }
    Ok(Made { drawn, words, json })
}

/// The map seen by an observer who looks elsewhere.
fn turned(args: &ProjectArgs, map: WorldMap) -> Result<WorldMap, Failure> {
    if args.towards.is_none() && args.up.is_none() {
        return Ok(map);
    }
    let (front, up) = directions(args)?;
    let axes = Centre::new(DVec3::ZERO, front, up).frame;
    // What a fish-eye does not show may be in front now.
    let layout = if let Layout::Fisheye { .. } = map.shape().layout { Layout::Cube } else { map.shape().layout };
    Ok(rotated(&map, DMat3::from_cols(axes.x, axes.y, axes.z), Shape { layout, ..map.shape() }))
}

/// Front and up as given; both, with an up that is not the front.
fn directions(args: &ProjectArgs) -> Result<(DVec3, DVec3), Failure> {
    let (front, up) = (args.towards.map_or(DVec3::Y, |t| t.0), args.up.map_or(DVec3::Z, |u| u.0));
    if front.cross(up).length() <= 1e-9 * (front.length() * up.length()).max(1e-300) {
        return Err(Failure::input("--towards: the front must be another direction than up; give --up too"));
    }
    Ok((front, up))
}

/// What a camera in the middle of the picture sees.
fn perspective(args: &ProjectArgs, map: &WorldMap, words: &mut Vec<String>) -> Result<Kind, Failure> {
    let size = [(args.size * 4).div_ceil(3), args.size];
    let (target, up) = directions(args)?;
    let camera = Camera { name: "turned".into(), eye: DVec3::ZERO, target, up, fov: args.field.unwrap_or(45.0), size };
    if let Some(end) = args.turning_to {
        let blur = turning::blurred(map, &camera, end.0, |d| d)?;
        words.push(turning::words(blur.off));
        return Ok(Kind::Flat(size, blur.values));
    }
    Ok(Kind::Flat(size, exact_picture(map, size.map(|n| n as usize), |x, y| Some(camera.direction(x, y)))))
}

/// Options of a scene say nothing about a picture.
fn refuse(args: &ProjectArgs) -> Result<(), Failure> {
    let scene_only = [
        ("--solution", args.solution.is_some()),
        ("--at", args.at.is_some()),
        ("--camera", args.camera.is_some()),
        ("--without", args.without.is_some()),
        ("--from-cube", args.from_cube.is_some()),
        ("--sky", args.sky.is_some()),
        ("--state", args.state.is_some()),
        ("--max-edge", args.max_edge.is_some()),
    ];
    match scene_only.iter().find(|(_, given)| *given) {
        Some((option, _)) => Err(Failure::input(format!(
            "{}: {option} is about scenes, and this is a picture of a world; leave it out",
            args.source
        ))),
        None => Ok(()),
    }
}
