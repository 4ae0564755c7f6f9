//! An interactive program in miniature: solve a room, take the cube in hand, drag it, put it down, read radiosities at
//! every moment.
//!
//! `cargo run --release --example drag_an_object`

use etalon::KernelKind;
use etalon::io::scene::{SceneOptions, open_scene};
use etalon::math::DVec3;
use etalon::methods::shooting::{Budget, Params, Shooting};
use etalon::scene::{Edit, Transform};
use std::ops::ControlFlow;
use std::time::Duration;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = open_scene("builtin:cube-room", &SceneOptions::default())?;
    let mut solver = Shooting::open(&scene, 1, Params::progressive("rays=4096")?, KernelKind::Auto, 0)?;
    solver.converge();
    tell("the room with its cube", &solver);

    solver.select("cube")?;
    // One picture's time at most, as often as pictures are drawn; `select` and `drag` may come before it is used up.
    let frame = Budget { shots: None, time: Some(Duration::from_millis(40)) };
    for step in 1..=3 {
        let translate = DVec3::new(0.1 * f64::from(step), 0.0, 0.0);
        let transform = Transform { axis: DVec3::Z, angle: 0.0, about: DVec3::ZERO, translate };
        solver.drag(&[Edit::Move { object: "cube".into(), transform }])?;
        solver.run(frame, &mut |_, _| ControlFlow::Continue(()));
        tell(&format!("dragged by {:.1} m", translate.x), &solver);
    }
    solver.release()?;
    tell("put down", &solver);
    solver.converge();
    tell("converged", &solver);
    Ok(())
}

fn tell(what: &str, solver: &Shooting) {
    let (radiosity, costs) = (solver.radiosity(), solver.costs());
    let left: usize = solver.log().iter().map(|entry| entry.patches.len()).sum();
    println!(
        "{what:>24}: {:6} shots, {:.2e} unshot, {left:3} patches in the log, brightest patch {:.3} W/m^2",
        costs.shots,
        solver.unshot_share(),
        radiosity.values.iter().copied().fold(0.0, f64::max),
    );
}
