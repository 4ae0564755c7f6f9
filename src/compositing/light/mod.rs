//! Direct light of every kind of lamp, with shadows from shadow volumes [NINT89 fig. 7].
//!
//! A lamp brings a point the irradiance strength * factor, per band; here are the factors. Where the paper's lamps have
//! extent, so have their shadows a penumbra: what a point sees of the lamp is found exactly, not sampled.

mod casters;
mod cone;
mod crowd;
mod cut;
mod dome;
mod lamp;
mod panel;
mod point;
mod quadrature;
mod sky;
mod stretch;
#[cfg(test)]
mod tests;
mod tube;
mod volumes;

pub use casters::{Casters, NO_CASTER};
pub use lamp::Lamp;
pub use volumes::Volumes;
