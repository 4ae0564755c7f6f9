//! Materials of mesh files become materials of the scene.

use super::model::{FileMaterial, MeshFault, Optics, one_line};
use super::{Fallback, Gathered, Loaded, MeshSpec};
use crate::io::scene::check::Checked;
use crate::io::scene::error::Refusal;
use crate::scene::Material;

const MEND: &str = "give the surface a material = ";
/// Reflectance of what says nothing about itself.
const GREY: f64 = 0.5;

/// Scene materials for the file's own, by their number there; `None` for those of no use or not needed.
pub(super) fn materials(loaded: &Loaded, spec: &MeshSpec, gathered: &mut Gathered) -> Checked<Vec<Option<u32>>> {
    let mesh = &loaded.mesh;
    let mut used = vec![false; mesh.materials.len()];
    if spec.material.is_none() {
        mesh.faces.iter().filter_map(|f| f.tags.material).for_each(|m| used[m as usize] = true);
    }
    let mut numbers = Vec::with_capacity(used.len());
    for (material, used) in mesh.materials.iter().zip(used) {
        numbers.push(if used { adopt(material, loaded, spec, gathered)? } else { None });
    }
    Ok(numbers)
}

/// Makes a material of the scene from one of the file.
fn adopt(material: &FileMaterial, loaded: &Loaded, spec: &MeshSpec, gathered: &mut Gathered) -> Checked<Option<u32>> {
    let refuse = |refusal, message: String, mend: &str| -> Checked<Option<u32>> {
        let fault = MeshFault { refusal, at: material.used_at.clone(), message, mend: mend.into() };
        Err(spec.file.within(fault.in_file(&loaded.source)))
    };
    let name = &material.name;
    let optics = match usable(material, gathered) {
        Ok(optics) => optics,
        Err((_, why)) if spec.fallback == Fallback::Grey => {
            gathered.notices.push(format!("{}: {why}: its faces are taken as grey", loaded.source.name));
            return Ok(None);
        }
        Err(_) if spec.fallback != Fallback::Refuse => return Ok(None),
        Err((refusal, why)) => return refuse(refusal, why, MEND),
    };
    for what in &material.left_out {
        gathered.notices.push(format!("{}: material \"{name}\": {what} is left out", material.defined_at));
    }
    let full = format!("{}/{}", spec.surface, one_line(name));
    let (reflectance, emission) = (optics.reflectance.to_vec(), optics.emission.to_vec());
    if !gathered.materials.add(Material { name: full.clone(), reflectance, emission }) {
        let message = format!("the scene has a material \"{full}\" already");
        return refuse(Refusal::Name, message, "rename that one: mesh materials are called surface/material");
    }
    Ok(gathered.materials.number(&full))
}

fn usable(material: &FileMaterial, gathered: &Gathered) -> Result<Optics, (Refusal, String)> {
    let optics = material.optics.clone().map_err(|e| (e.refusal, e.message))?;
    if gathered.rgb {
        return Ok(optics);
    }
    let (name, bands) = (&material.name, gathered.bands.join(", "));
    let message = format!("material \"{name}\" has red, green and blue, but the bands of the scene are {bands}");
    Err((Refusal::Bands, message))
}

/// The number of the grey that faces without a material are made of.
pub(super) fn grey(gathered: &mut Gathered) -> u32 {
    let bands = gathered.bands.len();
    let grey = Material { name: "grey".into(), reflectance: vec![GREY; bands], emission: vec![0.0; bands] };
    // Materials of meshes are called surface/material: the name is free, or it is this one.
    gathered.materials.add(grey);
    gathered.materials.number("grey").unwrap_or_default()
}

/// What is told about faces made of it.
pub(super) fn grey_notice(file: &str, faces: usize) -> String {
    format!(
        "{file}: {faces} faces without a usable material are taken as grey, reflectance {GREY}, emission 0; \
         write a scene file with a material to choose"
    )
}
