//! Rays per second: Embree by itself, our kernel on top of it, and the built-in kernel, on the same rays.
//!
//! `cargo bench --bench engine`. Time on the processor is measured, in interleaved rounds, so that a busy machine
//! disturbs little and all alike; medians and their ratios are printed. The raw line gets packets in single precision
//! that were made beforehand, the very rays the engine makes, and does nothing with what they meet.

use etalon::estimate::{Emitter, Plan, cast, patch_emitters, row_batches};
use etalon::math::DVec3;
use etalon::raycast::specimen::{box_polygons, bumpy_ball, tessellated};
use etalon::raycast::{BuiltinKernel, EmbreeKernel, Packets, RayBatch, RayKernel, Tracer, find_embree};
use etalon::sampling::{Role, Stream};
use etalon::scene::Stage;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

/// Rays per patch.
const RAYS: u64 = 16_384;
const ROUNDS: usize = 7;

fn main() {
    let room = box_polygons(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5), true);
    measure("box room", &Stage::from_polygons(&room_of_triangles(&room)));
    measure("bumpy ball", &Stage::from_polygons(&bumpy_ball(84, true)));
}

/// 5,120 triangles: the faces of a box, x, y and z, in cells of about the same size.
fn room_of_triangles(room: &[Vec<DVec3>]) -> Vec<Vec<DVec3>> {
    let divisions = [(20, 16), (16, 20), (32, 20)];
    let faces = room.chunks(2).zip(divisions).flat_map(|(pair, (na, nb))| tessellated(pair, na, nb));
    faces.collect()
}

fn measure(name: &str, stage: &Stage) {
    let exact = Arc::new(BuiltinKernel::new(stage));
    let library = find_embree().library;
    let embree = library.map(|l| Arc::new(EmbreeKernel::new(l, stage, exact.clone()).expect("Embree takes the stage")));
    let emitters = some_emitters(stage);
    let plan = Plan { rays: RAYS, ..Plan::default() };
    let stream = Stream::new(Role::Judge, 7);
    let batches = row_batches(&emitters, stream, &plan);
    let rays: usize = batches.iter().map(RayBatch::len).sum();
    println!("{name}, {} triangles, {rays} rays, one thread, medians of {ROUNDS}", stage.facets.len());
    let packets: Vec<Packets> = embree.iter().flat_map(|e| batches.iter().map(|b| e.packets(b))).collect();
    let fast: Arc<dyn RayKernel> = embree.clone().map_or(exact.clone() as Arc<dyn RayKernel>, |e| e);
    let engine = Tracer::new(stage, fast, exact.clone(), true);
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    let mut found = vec![0; batches.iter().map(RayBatch::len).max().unwrap_or(0)];
    let mut rounds: [Vec<f64>; 4] = Default::default();
    for _ in 0..ROUNDS {
        if let Some(e) = &embree {
            rounds[0].push(rate(rays, || packets.iter().for_each(|p| _ = black_box(e.trace_raw(p)))));
            rounds[1].push(rate(rays, || trace(e.as_ref(), &batches, &mut found)));
        }
        rounds[2].push(rate(rays, || trace(exact.as_ref(), &batches, &mut found)));
        let all = || cast(&engine, &emitters, stream, &plan, &|_| 0.0, &|_| ());
        rounds[3].push(one_thread.install(|| rate(rays, || _ = black_box(all()))));
    }
    let [raw, ours, builtin, whole] = rounds.map(median);
    let line = |what: &str, rate: f64| {
        let share = if raw.is_nan() { String::new() } else { format!("  {:5.1} % of raw", 100.0 * rate / raw) };
        println!("  {what:<44} {rate:6.2} Mrays/s{share}");
    };
    match &embree {
        None => println!("  no Embree found: `etalon setup embree`"),
        Some(e) => {
            let set = e.info().instruction_set.clone().unwrap_or_default();
            line(&format!("raw Embree {} ({set}), packets of 8", e.info().version), raw);
            line("Embree kernel (f64 batches in, facets out)", ours);
        }
    }
    line("whole engine (rays made, traced, counted)", whole);
    line("built-in kernel", builtin);
}

/// Some 256 patches spread over the stage.
fn some_emitters(stage: &Stage) -> Vec<Option<Emitter>> {
    let step = stage.patch_count().div_ceil(256);
    let mut emitters = patch_emitters(stage);
    emitters.iter_mut().enumerate().filter(|(i, _)| i % step != 0).for_each(|(_, e)| *e = None);
    emitters
}

fn trace(kernel: &dyn RayKernel, batches: &[RayBatch], found: &mut [u32]) {
    for rays in batches {
        kernel.intersect(rays, &mut found[..rays.len()]);
        black_box(&found);
    }
}

/// Millions of rays per second of one round.
fn rate(rays: usize, round: impl FnOnce()) -> f64 {
    let (start, busy) = (Instant::now(), time_on_processor());
    round();
    let seconds = time_on_processor().zip(busy).map_or(start.elapsed().as_secs_f64(), |(end, start)| end - start);
    rays as f64 / 1e6 / seconds
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
