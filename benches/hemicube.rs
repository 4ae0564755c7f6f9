//! Seconds per hemi-cube row, and where they go: aiming and clipping, scan conversion, summing.
//!
//! `cargo bench --bench hemicube`; one thread for the phases, then all threads for whole matrices.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Build, p};
use etalon::math::DVec3;
use etalon::methods::hemicube::{DeltaTable, Face, Hemicube, Params, World, form_factors, stand};
use etalon::scene::Stage;
use std::time::{Duration, Instant};

/// Times each setting is measured.
const ROUNDS: usize = 12;

/// A room with three boxes in it: `n` x `n` patches per wall, half as fine on the boxes.
fn furnished(n: u32) -> Stage {
    let mut b = Build::new();
    b.room(DVec3::ZERO, p(4.0, 3.0, 2.5), n, 0.6, [0.0, 10.0, 0.0, 0.0, 0.0, 0.0]);
    for (lo, hi) in [
        (p(0.5, 0.4, 0.1), p(1.5, 1.2, 0.8)),
        (p(2.2, 0.6, 0.05), p(3.4, 1.4, 1.9)),
        (p(1.1, 1.9, 0.2), p(2.9, 2.6, 0.7)),
    ] {
        b.solid(lo, hi, n.div_ceil(2), 0.5);
    }
    b.0
}

/// Time spent per phase over some rows.
#[derive(Default)]
struct Phases {
    aim: Duration,
    clip: Duration,
    scan: Duration,
    sum: Duration,
    polygons: usize,
}

impl Phases {
    fn total(&self) -> Duration {
        self.aim + self.clip + self.scan + self.sum
    }
}

/// Runs `work` and books its time.
fn timed<T>(account: &mut Duration, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    *account += start.elapsed();
    result
}

fn profile(stage: &Stage, params: &Params) -> (Phases, usize) {
    let (world, table) = (World::new(stage), DeltaTable::new(params.resolution, params.delta));
    let mut cube = Hemicube::new(&world, &table);
    let mut phases = Phases::default();
    let step = (stage.patch_count() / 50).max(1);
    let stands: Vec<_> = stage.patches.iter().step_by(step).filter_map(|patch| stand(patch, params)).collect();
    for (eye, frame) in &stands {
        timed(&mut phases.aim, || cube.aim(*eye, frame));
        for face in Face::ALL {
            phases.polygons += timed(&mut phases.clip, || cube.project(face));
            timed(&mut phases.scan, || cube.scan(face));
            timed(&mut phases.sum, || cube.sum(face));
        }
        timed(&mut phases.sum, || cube.take());
    }
    (phases, stands.len())
}

fn report_phases(stage: &Stage, resolution: u32) {
    let params = Params { resolution, ..Params::default() };
    // The fastest of some rounds: other work on the machine only ever adds time.
    let rounds = (0..ROUNDS).map(|_| profile(stage, &params));
    let Some((t, rows)) = rounds.min_by_key(|(t, _)| t.total()) else { return };
    let total = t.total();
    let share = |part: Duration| 100.0 * part.as_secs_f64() / total.as_secs_f64();
    let per_row = total.as_secs_f64() / rows as f64;
    let pixels = 3.0 * f64::from(resolution).powi(2);
    println!(
        "{:>7} {:>10} {:>12.3} {:>9.1} {:>9.1} {:>9.1} {:>9.1} {:>12.1} {:>14.0}",
        stage.patch_count(),
        resolution,
        1e3 * per_row,
        share(t.aim),
        share(t.clip),
        share(t.scan),
        share(t.sum),
        1e-6 * pixels / per_row,
        t.polygons as f64 / rows as f64,
    );
}

fn report_matrix(stage: &Stage, resolution: u32) {
    let params = Params { resolution, ..Params::default() };
    let start = Instant::now();
    let f = form_factors(stage, &params, &|_| ()).expect("a matrix");
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "{:>7} {:>10} {:>12.3} {:>9.2} s for the matrix of {} entries on {} threads",
        f.n,
        resolution,
        1e3 * seconds / f.n as f64,
        seconds,
        f.stored(),
        rayon::current_num_threads(),
    );
}

fn main() {
    let scenes = [furnished(4), furnished(12), furnished(36)];
    println!("one thread; shares in %, pixels in millions per second");
    println!("patches resolution       ms/row       aim      clip      scan       sum     Mpixel/s  polygons/row");
    for stage in &scenes {
        for resolution in [50, 100, 200, 400] {
            report_phases(stage, resolution);
        }
    }
    println!("whole matrices");
    for stage in &scenes[..2] {
        report_matrix(stage, 100);
    }
}
