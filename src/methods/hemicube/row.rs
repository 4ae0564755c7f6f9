//! One row of form factors: the hemi-cube of one patch, from aiming to the sum.

use super::delta::DeltaTable;
use super::project::{Face, PixelGrid, Projection, Projector};
use super::raster::{Item, Raster};
use super::stand::Stand;
use super::world::World;
use crate::math::{DVec3, Frame};

/// What is not a patch in a row, as form factors.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Lost {
    /// What falls on backs.
    pub backs: f64,
    /// What escapes.
    pub nothing: f64,
}

/// Pixel rows summed side by side: an addition waits for the one before it in its row, not for those of others.
const ABREAST: usize = 4;

/// A row of form factors with the number of pixels behind each.
#[derive(Debug, Clone, PartialEq)]
pub struct Counted {
    /// (patch, form factor, pixels that show it) by patch number.
    pub row: Vec<(u32, f64, u32)>,
    /// What is no patch.
    pub lost: Lost,
    /// Pixels that show no patch. With those of the patches, 3 N^2 in all.
    pub lost_pixels: u32,
}

/// A hemi-cube with all the memory it needs, moved from patch to patch.
///
/// [`Hemicube::row`] does it all; the steps it takes, [`Hemicube::aim`] once and then [`Hemicube::project`],
/// [`Hemicube::scan`] and [`Hemicube::sum`] for every face, are public so that they can be timed and looked into.
#[derive(Debug)]
pub struct Hemicube<'a> {
    world: &'a World,
    table: &'a DeltaTable,
    grid: PixelGrid,
    projector: Projector,
    projection: Projection,
    raster: Raster,
    tally: Tally,
    runs: [Vec<(Item, f64)>; ABREAST],
}

impl<'a> Hemicube<'a> {
    /// A hemi-cube in a world, at the resolution of the table.
    pub fn new(world: &'a World, table: &'a DeltaTable) -> Self {
        Self {
            world,
            table,
            grid: PixelGrid::new(2 * table.half(), [0.0; 2]),
            projector: Projector::default(),
            projection: Projection::default(),
            raster: Raster::default(),
            tally: Tally::new(world.patches),
            runs: Default::default(),
        }
    }

    /// Form factors from a point with a frame (z the normal) to all patches: (patch, form factor) by patch
    /// number, zeros left out, and what is lost [CG85 eq. 7].
    pub fn row(&mut self, eye: DVec3, frame: &Frame) -> (Vec<(u32, f64)>, Lost) {
        self.row_at(&Stand::at(eye, *frame))
    }

    /// The same from a stand, its shift included; the weight is left to who takes the mean.
    pub fn row_at(&mut self, stand: &Stand) -> (Vec<(u32, f64)>, Lost) {
        self.aim_at(stand);
        for face in Face::ALL {
            self.project(face);
            self.scan(face);
            self.sum(face);
        }
        self.take()
    }

    /// The same with the number of pixels that show each patch.
    pub fn row_with_counts(&mut self, stand: &Stand) -> Counted {
        let mut pixels = vec![0; self.world.patches];
        let mut lost_pixels = 0;
        self.aim_at(stand);
        for face in Face::ALL {
            self.project(face);
            self.scan(face);
            self.sum(face);
            for run in self.items().chunk_by(|a, b| a == b) {
                let count = run[0].as_patch().map_or(&mut lost_pixels, |j| &mut pixels[j as usize]);
                *count += run.len() as u32;
            }
        }
        let (row, lost) = self.take();
        Counted { row: row.into_iter().map(|(j, f)| (j, f, pixels[j as usize])).collect(), lost, lost_pixels }
    }

    /// Items of all pixels of a face, row by row, as last scanned.
    pub fn items(&self) -> &[Item] {
        self.raster.items()
    }

    /// Moves the hemi-cube; it looks through the centres of its pixels.
    pub fn aim(&mut self, eye: DVec3, frame: &Frame) {
        self.aim_at(&Stand::at(eye, *frame));
    }

    /// Moves the hemi-cube to a stand.
    pub fn aim_at(&mut self, stand: &Stand) {
        self.grid = PixelGrid::new(self.grid.resolution, stand.shift);
        self.projector.aim(self.world, stand.eye, &stand.frame);
    }

    /// Clips and projects the environment onto a face. Returns the number of polygons on it.
    pub fn project(&mut self, face: Face) -> usize {
        self.projector.project(self.world, face, &self.grid, &mut self.projection);
        self.projection.polygons.len()
    }

    /// Draws what was projected.
    pub fn scan(&mut self, face: Face) {
        self.raster.clear(face.size(2 * self.table.half()));
        self.raster.draw(&self.projection);
    }

    /// Adds the delta form factors of what was drawn, pixel row by pixel row.
    pub fn sum(&mut self, face: Face) {
        let (_, height) = face.size(2 * self.table.half());
        let together = height - height % ABREAST;
        (0..together).step_by(ABREAST).for_each(|row| self.sum_rows::<ABREAST>(face, row));
        (together..height).for_each(|row| self.sum_rows::<1>(face, row));
    }

    /// Sums `K` rows from `first` on, column by column. What each row adds, and in which order, is as if it were
    /// summed alone.
    fn sum_rows<const K: usize>(&mut self, face: Face, first: usize) {
        let (half, raster, runs) = (self.table.half(), &self.raster, &mut self.runs);
        let rows: [&[Item]; K] = std::array::from_fn(|k| &raster.row(first + k)[..2 * half]);
        let outwards: [&[f64]; K] = std::array::from_fn(|k| match (face, first + k) {
            // Rows and columns are mirrored about the axes.
            (Face::Top, row) => self.table.top_row(if row < half { half - 1 - row } else { row - half }),
            (Face::Side(_), row) => self.table.side_row(row),
        });
        // Neighbouring pixels mostly show the same patch: sum the run, then add it.
        let (mut run, mut sum) = ([Item::NOTHING; K], [0.0; K]);
        let mut step = |column: usize, from_axis: usize| {
            for k in 0..K {
                let item = rows[k][column];
                if item != run[k] {
                    runs[k].push((run[k], sum[k]));
                    (run[k], sum[k]) = (item, 0.0);
                }
                sum[k] += outwards[k][from_axis];
            }
        };
        (0..half).for_each(|a| step(a, half - 1 - a));
        (0..half).for_each(|a| step(half + a, a));
        for k in 0..K {
            let tally = &mut self.tally;
            self.runs[k].drain(..).for_each(|(item, amount)| tally.add(item, amount));
            tally.add(run[k], sum[k]);
        }
    }

    /// The finished row; the sums start again from zero.
    pub fn take(&mut self) -> (Vec<(u32, f64)>, Lost) {
        self.tally.take()
    }
}

/// Form factors of a row while they are summed.
#[derive(Debug)]
struct Tally {
    /// One value per patch; zero between rows.
    sums: Vec<f64>,
    /// Patches with a value.
    touched: Vec<u32>,
    lost: Lost,
}

impl Tally {
    fn new(patches: usize) -> Self {
        Self { sums: vec![0.0; patches], touched: Vec::new(), lost: Lost::default() }
    }

    fn add(&mut self, item: Item, amount: f64) {
        match item.as_patch() {
            Some(j) => {
                let sum = &mut self.sums[j as usize];
                if *sum == 0.0 {
                    self.touched.push(j);
                }
                *sum += amount;
            }
            None if item == Item::BACK => self.lost.backs += amount,
            None => self.lost.nothing += amount,
        }
    }

    fn take(&mut self) -> (Vec<(u32, f64)>, Lost) {
        self.touched.sort_unstable();
        let sums = &mut self.sums;
        let row = self.touched.drain(..).map(|j| (j, std::mem::take(&mut sums[j as usize]))).collect();
        (row, std::mem::take(&mut self.lost))
    }
}
