//! Materials of glTF: the base colour is the reflectance, the emissive factor the self-emitted radiosity.

use super::json::{Material, Root};
use crate::io::scene::mesh::model::{At, FileMaterial, one_line, optics};
use std::collections::BTreeSet;

const STRENGTH: &str = "KHR_materials_emissive_strength";

/// All materials of a file, by number.
pub(super) fn materials(root: &Root, file: &str) -> Vec<FileMaterial> {
    let mut taken = BTreeSet::new();
    root.materials.iter().enumerate().map(|(i, m)| material(i, m, file, &mut taken)).collect()
}

fn material(index: usize, m: &Material, file: &str, taken: &mut BTreeSet<String>) -> FileMaterial {
    let written = m.name.as_deref().map(one_line).filter(|n| !n.is_empty());
    let mut name = written.unwrap_or_else(|| format!("material {index}"));
    // Names need not differ in glTF; those of a scene do.
    if !taken.insert(name.clone()) {
        name = format!("{name} ({index})");
        taken.insert(name.clone());
    }
    let place = format!("materials[{index}]");
    let at = || format!("{file}, {place}");
    let base = m.pbr_metallic_roughness.as_ref().and_then(|p| p.base_color_factor);
    let strength = m.extensions.get(STRENGTH).and_then(|e| e.get("emissiveStrength")).and_then(|s| s.as_f64());
    let strength = strength.unwrap_or(1.0);
    let emission = m.emissive_factor.map_or([0.0; 3], |e| e.map(|v| v * strength));
    let emits = emission.iter().any(|v| *v != 0.0);
    // The specification's default is a perfect white, which no lamp is meant to be.
    let reflectance = match base {
        Some([r, g, b, _]) => [r, g, b],
        None => [if emits { 0.0 } else { 1.0 }; 3],
    };
    let emission_key = if strength == 1.0 { "emissiveFactor" } else { "emissiveFactor x emissiveStrength" };
    FileMaterial {
        used_at: At::Part(place.clone()),
        optics: optics(&name, (reflectance, "baseColorFactor", at()), (emission, emission_key, at())),
        defined_at: at(),
        left_out: left_out(m, base.is_none() && emits),
        double_sided: m.double_sided,
        name,
    }
}

/// What diffuse radiosity does not show of a material.
fn left_out(m: &Material, black: bool) -> Vec<String> {
    let mut out = Vec::new();
    let mut tell = |is_so: bool, what: &str| {
        if is_so {
            out.push(what.to_string());
        }
    };
    let pbr = m.pbr_metallic_roughness.as_ref();
    tell(pbr.is_some_and(|p| p.base_color_texture.is_some()), "a texture (baseColorTexture)");
    tell(m.emissive_texture.is_some(), "a texture (emissiveTexture)");
    // Metal is the default where nothing is written; only what is written is told.
    tell(pbr.is_some_and(|p| p.metallic_factor.is_some_and(|f| f > 0.0)), "metallic reflection (metallicFactor)");
    let clear = pbr.and_then(|p| p.base_color_factor).is_some_and(|c| c[3] < 1.0);
    tell(m.alpha_mode.as_deref().is_some_and(|a| a != "OPAQUE") && clear, "transparency (alphaMode)");
    for name in m.extensions.keys().filter(|n| *n != STRENGTH) {
        tell(true, &format!("the extension {}", one_line(name)));
    }
    tell(black, "its default base colour, a perfect white,");
    out
}
