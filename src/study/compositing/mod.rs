//! The audit of compositing after Nakamae and others (1989): antialiasing, light and shadows, clusters, against rays.

mod edges;
mod findings;
mod lights;
mod record;
mod request;
mod run;
mod solved;

pub use record::{ClusterRow, CompositeRow, CompositingRecord, EdgeRow, LightRow, PictureRow, Rms};
pub use request::{CompositingError, CompositingRequest};
pub use run::{Audited, compositing};
pub use solved::Solved;

use crate::compositing::{Line, Span};

/// A sub-scanline without its shadow edges.
fn unlit(line: &Line) -> Line {
    let mut solid: Vec<Span> = Vec::with_capacity(line.solid.len());
    for span in &line.solid {
        match solid.last_mut() {
            Some(last) if last.face == span.face && last.to == span.from => last.to = span.to,
            _ => solid.push(Span { lit: true, ..*span }),
        }
    }
    Line { solid, over: line.over.clone() }
}
