//! Rays per second: Embree by itself, our kernel on top of it, and the built-in kernel, on the same rays.
//!
//! `cargo bench --bench engine`. Time on the processor is measured, in interleaved rounds, so that a busy machine
//! disturbs little and all alike; medians and their ratios are printed. The raw line gets packets in single precision that were made beforehand and does
//! nothing with what they meet.

use etalon::math::DVec3;
use etalon::raycast::specimen::{Numbers, box_polygons, bumpy_ball, rays_from, tessellated};
use etalon::raycast::{BuiltinKernel, EmbreeKernel, Packets, RayBatch, RayKernel, find_embree};
use etalon::scene::Stage;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

/// Batches of rays per round, and rays per batch.
const BATCHES: u32 = 400;
const RAYS: usize = 1024;
const ROUNDS: usize = 7;

fn main() {
    let room = box_polygons(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5), true);
    measure("box room", &Stage::from_polygons(&room_of_triangles(&room)));
    measure("bumpy ball", &Stage::from_polygons(&bumpy_ball(84, true)));
}

/// 5,120 triangles: four walls of 21 x 21 cells, floor and ceiling of 20 x 20 less 2.
fn room_of_triangles(room: &[Vec<DVec3>]) -> Vec<Vec<DVec3>> {
    let mut triangles = tessellated(room, 21);
    triangles.truncate(5_120);
    triangles
}

fn measure(name: &str, stage: &Stage) {
    let exact = Arc::new(BuiltinKernel::new(stage));
    let library = find_embree().library;
    let embree = library.map(|l| EmbreeKernel::new(l, stage, exact.clone()).expect("Embree takes the stage"));
    let mut numbers = Numbers::new(7);
    let facets = stage.facets.len() as u32;
    let some_facet = |k: u32| (u64::from(k) * 7_919 % u64::from(facets)) as u32;
    let batches: Vec<RayBatch> = (0..BATCHES).map(|k| rays_from(stage, some_facet(k), RAYS, &mut numbers)).collect();
    println!("{name}, {facets} triangles, {BATCHES} x {RAYS} rays, single thread, medians of {ROUNDS}");
    let packets: Vec<Packets> = embree.iter().flat_map(|e| batches.iter().map(|b| e.packets(b))).collect();
    let mut found = vec![0; RAYS];
    let mut rounds: [Vec<f64>; 3] = Default::default();
    for _ in 0..ROUNDS {
        if let Some(e) = &embree {
            rounds[0].push(rate(|| packets.iter().for_each(|p| _ = black_box(e.trace_raw(p)))));
            rounds[1].push(rate(|| trace(e, &batches, &mut found)));
        }
        rounds[2].push(rate(|| trace(exact.as_ref(), &batches, &mut found)));
    }
    let [raw, ours, builtin] = rounds.map(median);
    if let Some(e) = &embree {
        let info = e.info();
        let set = info.instruction_set.as_deref().unwrap_or("?");
        println!("  raw Embree {} ({set}), packets of 8  {raw:6.2} Mrays/s", info.version);
        println!("  Embree kernel                     {ours:6.2} Mrays/s = {:.1} % of raw", 100.0 * ours / raw);
    } else {
        println!("  no Embree found: `etalon setup embree`");
    }
    println!("  built-in kernel                   {builtin:6.2} Mrays/s = {:.1} % of raw", 100.0 * builtin / raw);
}

fn trace(kernel: &dyn RayKernel, batches: &[RayBatch], found: &mut [u32]) {
    for rays in batches {
        kernel.intersect(rays, found);
        black_box(&found);
    }
}

/// Millions of rays per second of one round.
fn rate(round: impl FnOnce()) -> f64 {
    let (start, busy) = (Instant::now(), time_on_processor());
    round();
    let seconds = time_on_processor().zip(busy).map_or(start.elapsed().as_secs_f64(), |(end, start)| end - start);
    f64::from(BATCHES) * RAYS as f64 / 1e6 / seconds
}

/// Seconds this thread has run, where the system tells (Linux): a busy machine counts for less.
fn time_on_processor() -> Option<f64> {
    let times = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    times.split(' ').next()?.parse().ok().map(|nanoseconds: f64| 1e-9 * nanoseconds)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
