//! Colours and texture coordinates of vertices.

use super::Builder;
use super::json::Primitive;
use crate::io::scene::error::Refusal;
use crate::io::scene::mesh::keep::{Keep, coarse};
use crate::io::scene::mesh::model::{At, MeshFault, shown};

const COLOUR: &str = "COLOR_0";
const TEXTURE: &str = "TEXCOORD_0";

impl Builder<'_> {
    /// Keeps what was asked for of the vertices of a primitive, `count` of them.
    pub(super) fn carry(&mut self, primitive: &Primitive, count: usize, place: &str) -> Result<(), MeshFault> {
        match self.keep {
            Keep::Shape => Ok(()),
            Keep::Textures => self.textures(primitive, count, place),
            Keep::Values(None) => self.values(COLOUR, primitive, count, place),
            Keep::Values(Some([name])) => self.values(name, primitive, count, place),
            Keep::Values(Some(names)) => {
                let message = format!("{} attributes were asked for", names.len());
                MeshFault::new(At::File, message).mend("name one that holds all bands: COLOR_0, or one of your own")
            }
        }
    }

    fn attribute(&self, name: &str, primitive: &Primitive, place: &str) -> Result<usize, MeshFault> {
        primitive.attributes.get(name).copied().ok_or(()).or_else(|()| {
            let all: Vec<String> = primitive.attributes.keys().map(|k| shown(k)).collect();
            let message = format!("the primitive has no {}; it has {}", shown(name), all.join(", "));
            MeshFault::new(At::Part(format!("{place}.attributes")), message)
                .of(Refusal::Empty)
                .mend("export it with every primitive that the scene shows")
        })
    }

    fn values(&mut self, name: &str, primitive: &Primitive, count: usize, place: &str) -> Result<(), MeshFault> {
        let index = self.attribute(name, primitive, place)?;
        let read = self.buffers.attribute(index, &["VEC3", "VEC4", "SCALAR"])?;
        self.agree(read.numbers.len() / read.width, count, name, place)?;
        let bands: &[&str] = if read.width == 1 { &["y"] } else { &["r", "g", "b"] };
        let carried = &mut self.mesh.carried;
        if !carried.bands.is_empty() && carried.bands != bands {
            let message = format!("{} has {} bands here and {} before", shown(name), bands.len(), carried.bands.len());
            return MeshFault::new(At::Part(format!("{place}.attributes")), message).mend("export them alike");
        }
        carried.bands = bands.iter().map(|b| b.to_string()).collect();
        // A fourth component is opacity.
        for (item, numbers) in read.numbers.chunks_exact(read.width).enumerate() {
            if let Some(v) = numbers.iter().find(|v| !v.is_finite()) {
                let at = At::Part(format!("accessors[{index}], vertex {item}"));
                return MeshFault::new(at, format!("a value is {v}")).of(Refusal::Number).mend("give finite numbers");
            }
            carried.of_vertices.extend_from_slice(&numbers[..bands.len()]);
        }
        let told = read.steps.map(|steps| coarse(&format!("the values of {}", shown(name)), steps));
        if let Some(told) = told.filter(|t| !self.mesh.notices.contains(t)) {
            self.mesh.notices.push(told);
        }
        Ok(())
    }

    fn textures(&mut self, primitive: &Primitive, count: usize, place: &str) -> Result<(), MeshFault> {
        let index = self.attribute(TEXTURE, primitive, place)?;
        let read = self.buffers.attribute(index, &["VEC2"])?;
        self.agree(read.numbers.len() / 2, count, TEXTURE, place)?;
        if let Some(k) = read.numbers.iter().position(|v| !v.is_finite()) {
            let at = At::Part(format!("accessors[{index}], vertex {}", k / 2));
            return MeshFault::new(at, format!("a coordinate is {}", read.numbers[k])).mend("give finite numbers");
        }
        self.mesh.carried.uvs.extend(read.numbers.chunks_exact(2).map(|c| [c[0], c[1]]));
        Ok(())
    }

    fn agree(&self, items: usize, count: usize, name: &str, place: &str) -> Result<(), MeshFault> {
        if items == count {
            return Ok(());
        }
        let message = format!("{} has {items} items for {count} vertices", shown(name));
        MeshFault::new(At::Part(format!("{place}.attributes")), message).mend("export the mesh again")
    }
}
