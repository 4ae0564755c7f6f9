//! From where a world is seen, and which way is the front.

use crate::cli::exit::Failure;
use crate::math::DVec3;
use crate::raycast::Tracer;
use crate::render::{Centre, fit_camera};
use crate::scene::Stage;
use crate::view::Camera;

/// The camera of this name, or the first; one is fitted where the scene has none.
pub fn camera(tracer: &Tracer, name: Option<&str>) -> Result<Camera, Failure> {
    match (name, tracer.stage().cameras.is_empty()) {
        (None, true) => Ok(fit_camera(tracer)),
        _ => own_camera(tracer.stage(), name),
    }
}

/// The same of the scene's own cameras alone.
pub fn own_camera(stage: &Stage, name: Option<&str>) -> Result<Camera, Failure> {
    let own = &stage.cameras;
    if let (None, Some(first)) = (name, own.first()) {
        return Ok(first.clone());
    }
    let name = name.unwrap_or_default();
    let names = || own.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", ");
    own.iter().find(|c| c.name == name).cloned().ok_or_else(|| {
        Failure::input(match own.is_empty() {
            true => format!("there is no camera \"{name}\": the scene has none; leave --camera out and one is fitted"),
            false => format!("there is no camera \"{name}\"; the scene has {}", names()),
        })
    })
}

/// The observer's axes at a place: the front and up as given, else the camera's.
pub fn centre(camera: &Camera, place: DVec3, towards: Option<DVec3>, up: Option<DVec3>) -> Result<Centre, Failure> {
    let direction = |d: DVec3, option: &str| {
        d.try_normalize().ok_or_else(|| Failure::input(format!("{option}: a direction cannot be 0,0,0")))
    };
    let up_given = up.is_some();
    let up = direction(up.unwrap_or(camera.up), "--up")?;
    let given = towards.is_some();
    let front = direction(towards.unwrap_or(camera.target - camera.eye), "--towards")?;
    if front.cross(up).length() > 1e-6 {
        return Ok(Centre::new(place, front, up));
    }
    // Who looks straight up or down has his front where the top of the picture is; a map has no such thing.
    if given && up_given {
        return Err(Failure::input("--towards and --up are the same direction: the front must be another than up"));
    }
    let other = if given { up.any_orthonormal_vector().cross(front) } else { up.any_orthonormal_vector() };
    Ok(if given { Centre::new(place, front, other) } else { Centre::new(place, other, up) })
}
