//! Many models at one resolution, summed over the same picture at once.

use super::model::{Mistake, Model, Rule};
use super::tables::Table;
use crate::methods::hemicube::{FACES, Item};

/// Tables of some models; those that share their deltas, and differ in the faces that count or by a factor, share
/// one.
#[derive(Debug)]
pub(super) struct Sheet {
    tables: Vec<Table>,
    /// What each table is made of.
    made: Vec<(bool, Mistake, usize)>,
    pub views: Vec<View>,
}

/// A model, in one of the four ways its hemi-cube can be turned by quarters.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    /// Number of the model.
    pub model: usize,
    /// Number of the table, and factors of its faces.
    table: usize,
    faces: [f64; FACES],
}

/// What a row gets from each face of a picture, by table and patch.
#[derive(Debug)]
pub(super) struct Sums(Vec<Vec<[f64; FACES]>>);

impl Sheet {
    /// All quarter turns of the models for which they make a difference.
    pub fn new(n: u32, models: &[Model]) -> Self {
        let mut sheet = Self { tables: Vec::new(), made: Vec::new(), views: Vec::new() };
        for (number, model) in models.iter().enumerate() {
            let mut table = Table::new(n, *model);
            for turn in 0..if model.mistake.is_lopsided() { 4 } else { 1 } {
                if turn > 0 {
                    table = table.turned();
                }
                sheet.add(number, *model, turn, &table);
            }
        }
        sheet
    }

    fn add(&mut self, model: usize, Model { rule, mistake }: Model, turn: usize, table: &Table) {
        let whole = mistake.leaves_out();
        let key = (rule == Rule::Exact, if whole { Mistake::None } else { mistake }, if whole { 0 } else { turn });
        let at = self.made.iter().position(|made| *made == key).unwrap_or_else(|| {
            self.made.push(key);
            self.tables.push(table.clone());
            self.made.len() - 1
        });
        self.views.push(View { model, table: at, faces: table.faces });
    }

    /// One model by itself.
    pub fn only(&self, model: usize) -> Self {
        let views = self.views.iter().filter(|v| v.model == model).copied().collect();
        Self { tables: self.tables.clone(), made: self.made.clone(), views }
    }

    /// Sums of a picture.
    pub fn sums(&self, picture: &[Vec<Item>; FACES], patches: usize) -> Sums {
        let one = |table: &Table| {
            let mut sums = vec![[0.0; FACES]; patches];
            for (face, items) in picture.iter().enumerate() {
                for (item, delta) in items.iter().zip(deltas(table, face)) {
                    if let Some(j) = item.as_patch() {
                        sums[j as usize][face] += delta;
                    }
                }
            }
            sums
        };
        Sums(self.tables.iter().map(one).collect())
    }

    /// Pixels' deltas as a view has them.
    pub fn delta(&self, view: View, face: usize, pixel: usize) -> f64 {
        view.faces[face] * deltas(&self.tables[view.table], face)[pixel]
    }

    /// What a table costs to sum, in tables.
    pub fn tables(&self) -> usize {
        self.tables.len()
    }
}

impl Sums {
    /// The row a view makes of them.
    pub fn row(&self, view: View) -> Vec<f64> {
        let weighted = |s: &[f64; FACES]| s.iter().zip(view.faces).map(|(s, f)| s * f).sum();
        self.0[view.table].iter().map(weighted).collect()
    }
}

fn deltas(table: &Table, face: usize) -> &[f64] {
    if face == 0 { &table.top } else { &table.side }
}
