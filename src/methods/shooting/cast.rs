//! Rows of form factors, whole or as differences, by rays or by hemi-cubes.

use super::Shooting;
use super::change::Change;
use super::counter::Counter;
use super::fan::{EXCESS_SINK, Fans, back_sink, escaped_sink};
use super::geometry::Geometry;
use super::row::Row;
use crate::methods::hemicube::{self, DeltaTable, Hemicube, Stand, drawn, stand};

/// Where rows come from.
pub(super) enum Caster {
    Rays(Box<(Fans, Counter)>),
    Hemicube(Box<DeltaTable>, hemicube::Params),
}

impl Shooting {
    /// All form factors of a patch in a version.
    pub(super) fn whole(&mut self, g: &Geometry, patch: usize) -> Row {
        match &mut self.caster {
            Caster::Rays(rays) => {
                let (fans, counter) = &mut **rays;
                self.costs.rays += fans.whole(g, patch, 1, counter);
                counter.take(fans.rays(patch))
            }
            Caster::Hemicube(table, params) => hemicube_row(g, patch, table, params),
        }
    }

    /// Form factors in the newest version less those in an old one.
    pub(super) fn difference(&mut self, version: usize, patch: usize) -> Row {
        let (old, new) = (self.versions[version].geometry.clone(), self.newest().geometry.clone());
        let change = self.versions[version].change.take();
        let row = self.row_between([&old, &new], change.as_ref(), patch);
        self.versions[version].change = change;
        row
    }

    pub(super) fn row_between(&mut self, [old, new]: [&Geometry; 2], change: Option<&Change>, patch: usize) -> Row {
        match (&mut self.caster, change) {
            (Caster::Rays(rays), Some(change)) => {
                let (fans, counter) = &mut **rays;
                self.costs.rays += if change.own[patch] {
                    fans.whole(old, patch, -1, counter) + fans.whole(new, patch, 1, counter)
                } else {
                    fans.diverted([old, new], change, patch, counter)
                };
                counter.take(fans.rays(patch))
            }
            (Caster::Hemicube(table, params), Some(_)) => {
                let (before, after) =
                    (hemicube_row(old, patch, table, params), hemicube_row(new, patch, table, params));
                less(&after, &before)
            }
            (_, None) => Row::default(),
        }
    }
}

fn hemicube_row(g: &Geometry, patch: usize, table: &DeltaTable, params: &hemicube::Params) -> Row {
    let mut row = Row::default();
    let Some((eye, frame)) = stand(&g.stage.patches[patch], params) else { return row };
    let drawn = drawn(vec![Stand::at(eye, frame)], patch, params);
    let (entries, lost) = Hemicube::new(g.world(), table).row_at(&drawn[0]);
    entries.iter().for_each(|(e, f)| row.push_exact(*e, *f));
    let lost = [
        (escaped_sink(&g.stage), lost.nothing),
        (back_sink(&g.stage), lost.backs),
        (g.stage.elements.len() + EXCESS_SINK, 1.0 - table.total()),
    ];
    lost.iter().filter(|(_, f)| *f != 0.0).for_each(|(sink, f)| row.push_exact(*sink as u32, *f));
    row
}

/// The difference of two rows; equal entries leave nothing.
fn less(after: &Row, before: &Row) -> Row {
    let mut entries: std::collections::BTreeMap<u32, f64> = after.iter().collect();
    before.iter().for_each(|(s, f)| *entries.entry(s).or_default() -= f);
    let mut row = Row::default();
    entries.into_iter().filter(|(_, f)| *f != 0.0).for_each(|(s, f)| row.push_exact(s, f));
    row
}
