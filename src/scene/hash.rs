//! The identity of a scene at a state.

use super::{Distribution, Grid, Stage};
use sha2::{Digest, Sha256};

/// Version of what is hashed; changes when the meaning of a stage does.
const DOMAIN: &[u8] = b"etalon-stage/1";

impl Stage {
    /// SHA-256 in hexadecimal over geometry, materials, discretisation, photometry and state: all that the
    /// radiosities depend on. Names, cameras, receivers and comments do not count.
    pub fn hash(&self) -> String {
        let mut h = Sha256::new();
        h.update(DOMAIN);
        integer(&mut h, self.state);
        integer(&mut h, self.patches.len());
        numbers(&mut h, &self.photometry.weights);
        for m in &self.materials {
            numbers(&mut h, &m.reflectance);
            numbers(&mut h, &m.emission);
        }
        for f in &self.facets {
            f.vertices.iter().for_each(|v| numbers(&mut h, &v.to_array()));
            for g in [f.grid, f.elements] {
                let (kind, a, b) = match g {
                    Grid::Quad { na, nb } => (1, na, nb),
                    Grid::Triangle { n } => (2, n, 0),
                    Grid::Whole => (3, 0, 0),
                };
                h.update([kind]);
                integer(&mut h, a as usize);
                integer(&mut h, b as usize);
            }
            integer(&mut h, f.first_patch as usize);
            integer(&mut h, f.first_back_patch.map_or(usize::MAX, |p| p as usize));
        }
        for p in &self.patches {
            integer(&mut h, p.material as usize);
            numbers(&mut h, &[p.area]);
        }
        // After everything else: scenes without lights keep the hash they have always had.
        for light in &self.lights {
            h.update(b"light");
            numbers(&mut h, &light.position.to_array());
            numbers(&mut h, &light.intensity);
            match light.distribution {
                Distribution::Isotropic => h.update([1]),
                Distribution::Lambert(axis) => numbers(&mut h, &axis.to_array()),
            }
        }
        h.finalize().iter().map(|b| format!("{b:02x}")).collect()
    }
}

fn integer(h: &mut Sha256, x: usize) {
    h.update((x as u64).to_le_bytes());
}

fn numbers(h: &mut Sha256, values: &[f64]) {
    integer(h, values.len());
    values.iter().for_each(|v| h.update(v.to_le_bytes()));
}
