//! Light on its way from lamps: whether it arrives, and how much of it.

use super::grove::NO_TREE;
use super::light::SHORT_OF_THE_LAMP;
use super::setting::Setting;
use super::wave::in_groups;
use crate::math::DVec3;

/// More panes than these in a row let nothing through.
const PANES: u32 = 32;

/// Light that arrives if nothing stands between.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beam {
    /// Where it is added.
    pub slot: u32,
    /// Facet that the rest of the way starts on.
    pub from: u32,
    /// Tree that it starts on.
    pub tree: u32,
    /// Where it starts, for trees.
    pub start: DVec3,
    /// Where the rest of the way starts: behind the last pane.
    pub origin: DVec3,
    /// Unit vector to the lamp.
    pub direction: DVec3,
    /// All of the way, m.
    pub distance: f64,
    /// Number of its values.
    pub number: u32,
}

/// Beams of a wave, and what each brings, per band.
#[derive(Debug, Default)]
pub(super) struct Beams {
    pub list: Vec<Beam>,
    pub values: Vec<f64>,
}

impl Beams {
    /// Adds one; its values are those that were pushed last.
    pub fn push(&mut self, beam: Beam, values: impl Iterator<Item = f64>) {
        let number = self.list.len() as u32;
        self.values.extend(values);
        self.list.push(Beam { number, ..beam });
    }
}

impl Setting<'_> {
    /// Adds what arrives to `sums` (slots x bands) and empties the beams. Returns the rays cast.
    ///
    /// What stands between hides; a pane lets through its transmitted share, straight on whatever its refraction.
    pub fn arrive(&self, beams: &mut Beams, sums: &mut [f64]) -> u64 {
        let Beams { list, values } = beams;
        let mut rays = 0;
        for _ in 0..PANES {
            if list.is_empty() {
                break;
            }
            rays += list.len() as u64;
            list.sort_by_key(|b| b.from);
            let mut behind = Vec::new();
            in_groups(
                self.tracer,
                list,
                |b| (b.from, b.origin, b.direction),
                |beam, hit| {
                    let end = beam.distance * SHORT_OF_THE_LAMP;
                    let own = beam.number as usize * self.bands..(beam.number as usize + 1) * self.bands;
                    match hit.filter(|(_, at, _)| at.distance(beam.start) < end) {
                        Some((facet, at, _)) => {
                            let share = self.let_through(facet, at);
                            if share > 0.0 {
                                values[own].iter_mut().for_each(|v| *v *= share);
                                behind.push(Beam { from: facet, origin: at, ..*beam });
                            }
                        }
                        None => {
                            let share = self.grove.passed(beam.start, beam.direction, beam.distance, beam.tree);
                            let slot = beam.slot as usize * self.bands;
                            let into = &mut sums[slot..slot + self.bands];
                            into.iter_mut().zip(&values[own]).for_each(|(s, v)| *s += share * v);
                        }
                    }
                },
            );
            *list = behind;
        }
        list.clear();
        values.clear();
        rays
    }
}

/// A beam that has not met anything yet.
pub(super) fn beam(slot: u32, from: u32, start: DVec3, direction: DVec3, distance: f64) -> Beam {
    Beam { slot, from, tree: NO_TREE, start, origin: start, direction, distance, number: 0 }
}
