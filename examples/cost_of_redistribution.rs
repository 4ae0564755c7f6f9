//! What a redistribution shot costs, by the number of receivers it changes, beside a shot of the whole fan.
//!
//! `cargo run --release --example cost_of_redistribution [SCENE]` (a scene with an edit; `builtin:cube-room` unless given)

use etalon::KernelKind;
use etalon::io::scene::{SceneOptions, open_scene};
use etalon::methods::shooting::{Budget, Costs, Params, Shooting, Step};
use std::collections::BTreeMap;
use std::ops::ControlFlow;

/// Shots, receivers, rays, seconds.
type Sum = (u64, u64, u64, f64);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let spec = std::env::args().nth(1).unwrap_or_else(|| "builtin:cube-room".into());
    let scene = open_scene(&spec, &SceneOptions::default())?;
    let mut solver = Shooting::open(&scene, 0, Params::redistribution("unshot=1%,lamps=1")?, KernelKind::Auto, 0)?;
    let mut whole = Sum::default();
    let mut by_receivers: BTreeMap<u32, Sum> = BTreeMap::new();
    let mut count = |before: &mut Costs, now: Costs, step: Step, receivers: usize| {
        let sum = match step {
            Step::Redistributed { .. } => by_receivers.entry((receivers + 1).ilog2()).or_default(),
            _ => &mut whole,
        };
        sum.0 += 1;
        sum.1 += receivers as u64;
        sum.2 += now.rays - before.rays;
        sum.3 += now.seconds - before.seconds;
        *before = now;
    };
    for state in 0..=scene.edits.len() {
        if state > 0 {
            solver.apply_next()?;
        }
        let mut before = solver.costs();
        solver.run(Budget::default(), &mut |_, event| {
            count(&mut before, event.costs, event.step, event.receivers);
            ControlFlow::Continue(())
        });
    }
    println!("{:>22} {:>7} {:>10} {:>10} {:>12}", "receivers changed", "shots", "receivers", "rays", "microseconds");
    for (class, sum) in &by_receivers {
        tell(&format!("{} to {}", (1 << class) - 1, (1 << (class + 1)) - 2), sum);
    }
    tell("the whole fan", &whole);
    println!(
        "{} patches needed no shot at all: nothing that changed lies in their shadow volumes",
        solver.costs().spared
    );
    Ok(())
}

fn tell(what: &str, (shots, receivers, rays, seconds): &Sum) {
    let mean = |x: f64| x / (*shots as f64).max(1.0);
    println!(
        "{what:>22} {shots:7} {:10.0} {:10.0} {:12.0}",
        mean(*receivers as f64),
        mean(*rays as f64),
        mean(seconds * 1e6)
    );
}
