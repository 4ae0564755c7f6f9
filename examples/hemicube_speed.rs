//! How fast hemi-cubes are beside one ray per pixel through the kernel in use, both timed here on all threads.
//!
//! `cargo run --release --example hemicube_speed [SCENE ...]`; scenes are built-in ones. Rows of patches spread over
//! the scene are timed until there are enough pixels; the time of the whole matrix follows from them.

use etalon::io::scene::builtin;
use etalon::methods::hemicube::{Params, Stand, by_rays, compare_closely, item_buffer, rows_of, stands};
use etalon::raycast::{KernelKind, Tracer, open_kernels};
use etalon::scene::Stage;
use std::time::Instant;

/// Pixels scanned, and pixels ray-cast, per line of the table.
const SCANNED: usize = 150_000_000;
const CAST: usize = 3_000_000;

/// About `count` of the patches, evenly spread.
fn spread(stage: &Stage, count: usize) -> impl Iterator<Item = usize> {
    (0..stage.patch_count()).step_by((stage.patch_count() / count.max(1)).max(1))
}

/// Rows timed, and pixels per second of the scan.
fn scan(stage: &Stage, params: &Params, pixels: usize) -> Result<(usize, f64), Box<dyn std::error::Error>> {
    let all = stands(stage, params);
    let some: Vec<Vec<Stand>> = spread(stage, SCANNED / pixels).map(|i| all[i].clone()).collect();
    let start = Instant::now();
    rows_of(stage, &some, params, &|_| ())?;
    let rows = some.iter().flatten().count();
    Ok((rows, (rows * pixels) as f64 / start.elapsed().as_secs_f64()))
}

/// Pixels per second of one ray per pixel, pixels that differ from the scan, and those no edge explains.
fn cast(
    tracer: &Tracer<'_>,
    params: &Params,
    pixels: usize,
) -> Result<(f64, usize, usize), Box<dyn std::error::Error>> {
    let (mut seconds, mut done, mut differ, mut off_edge) = (0.0, 0, 0, 0);
    for patch in spread(tracer.stage(), CAST / pixels) {
        let Some(scanned) = item_buffer(tracer.stage(), patch, params)? else { continue };
        let start = Instant::now();
        let seen = by_rays(tracer, patch, &scanned);
        seconds += start.elapsed().as_secs_f64();
        let found = compare_closely(tracer, patch, &scanned, &seen);
        done += found.pixels;
        differ += found.differ;
        off_edge += found.off_edge;
    }
    Ok((done as f64 / seconds, differ, off_edge))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let names = if asked.is_empty() { ["cornell-box", "furnished-room"].map(String::from).to_vec() } else { asked };
    println!("threads: {}; M = millions", rayon::current_num_threads());
    println!(
        "{:<16} {:>7} {:>10} {:>6} {:>10} {:>11} {:>9} {:>9} {:>7} {:>8} {:>8}",
        "scene",
        "patches",
        "resolution",
        "rows",
        "ms/row",
        "matrix [s]",
        "Mpixel/s",
        "Mray/s",
        "ratio",
        "differ",
        "off edge"
    );
    for name in names {
        let scene = builtin(&name).ok_or_else(|| format!("there is no built-in scene `{name}`"))?;
        let stage = scene.at(0)?;
        let kernels = open_kernels(KernelKind::Auto, &stage)?;
        let tracer = Tracer::new(&stage, kernels.kernel.clone(), kernels.exact.clone(), false);
        for resolution in [50, 100, 256, 1024] {
            let params = Params { resolution, rotation: 30.0, ..Params::default() };
            let pixels = 3 * (resolution as usize).pow(2);
            let (rows, scanned) = scan(&stage, &params, pixels)?;
            let (traced, differ, off_edge) = cast(&tracer, &params, pixels)?;
            let per_row = pixels as f64 / scanned;
            println!(
                "{name:<16} {:>7} {resolution:>10} {rows:>6} {:>10.3} {:>11.1} {:>9.1} {:>9.2} {:>7.1} {differ:>8} {off_edge:>8}",
                stage.patch_count(),
                1e3 * per_row,
                per_row * stage.patch_count() as f64,
                1e-6 * scanned,
                1e-6 * traced,
                scanned / traced,
            );
        }
        println!("{name}: rays by {}", tracer.kernel().name);
    }
    Ok(())
}
