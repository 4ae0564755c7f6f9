//! Errors by surface or object, with intervals from the replicates: errors of patches are correlated, and so a sum
//! over patches knows its error from the spread of the sums alone.

use crate::stats::{Estimate, jackknife_interval, mean_interval};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The error of one surface or object; luminances, W/m^2.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GroupError {
    /// Name of the surface or object.
    pub name: String,
    /// Object a surface belongs to; `None` for objects.
    pub object: Option<String>,
    /// Receivers that are present.
    pub receivers: usize,
    /// Their area, m^2.
    pub area: f64,
    /// Mean luminance of the reference.
    pub reference: Estimate,
    /// Mean luminance of the solution.
    pub solution: f64,
    /// Solution - reference of the means.
    pub bias: Estimate,
    /// Share of the squared error of eq. 7, the reference's noise taken out; shares add to 1. `None` where the whole
    /// error cannot be told from noise.
    pub share: Option<Estimate>,
    /// Receiver with the largest |difference|.
    pub worst: usize,
    /// Its difference.
    pub worst_difference: f64,
}

/// Sums over the receivers of a group.
struct Sums {
    receivers: usize,
    area: f64,
    /// `sum A Y_r` per replicate.
    reference: Vec<f64>,
    /// `sum A Y` of the solution.
    solution: f64,
    square: Square,
    worst: (usize, f64),
}

/// `sum A d_r d_s` averaged over pairs of different replicates: the squared error without the reference's noise.
#[derive(Clone)]
struct Square {
    full: f64,
    /// The same with one replicate left out.
    left_out: Vec<f64>,
}

impl Square {
    fn zero(replicates: usize) -> Self {
        Self { full: 0.0, left_out: if replicates > 1 { vec![0.0; replicates] } else { Vec::new() } }
    }

    /// Adds a receiver: `d` holds its difference from each replicate.
    fn add(&mut self, area: f64, d: &[f64]) {
        let r = d.len() as f64;
        let (sum, squares) = d.iter().fold((0.0, 0.0), |(s, q), d| (s + d, q + d * d));
        if d.len() == 1 {
            self.full += area * squares;
            return;
        }
        self.full += area * (sum * sum - squares) / (r * (r - 1.0));
        for (out, d) in self.left_out.iter_mut().zip(d) {
            *out += area * ((sum - d).powi(2) - (squares - d * d)) / ((r - 1.0) * (r - 2.0));
        }
    }

    fn merge(&mut self, other: &Self) {
        self.full += other.full;
        self.left_out.iter_mut().zip(&other.left_out).for_each(|(a, b)| *a += b);
    }

    /// This as a share of the total; `None` where the total cannot be told from 0.
    fn share_of(&self, total: &Self, confidence: f64) -> Option<Estimate> {
        if total.left_out.is_empty() {
            return (total.full > 0.0).then(|| Estimate::exact(self.full / total.full));
        }
        let is_error = jackknife_interval(total.full, &total.left_out, confidence).low > 0.0;
        let left_out: Vec<f64> = self.left_out.iter().zip(&total.left_out).map(|(a, b)| a / b).collect();
        let sound = is_error && total.left_out.iter().all(|t| *t > 0.0);
        sound.then(|| jackknife_interval(self.full / total.full, &left_out, confidence))
    }
}

impl Sums {
    fn zero(replicates: usize) -> Self {
        Self {
            receivers: 0,
            area: 0.0,
            reference: vec![0.0; replicates],
            solution: 0.0,
            square: Square::zero(replicates),
            worst: (0, 0.0),
        }
    }

    fn add(&mut self, i: usize, area: f64, solution: f64, rows: &[Vec<f64>]) {
        let differences: Vec<f64> = rows.iter().map(|row| solution - row[i]).collect();
        let mean = differences.iter().sum::<f64>() / rows.len() as f64;
        if self.receivers == 0 || mean.abs() > self.worst.1.abs() {
            self.worst = (i, mean);
        }
        self.receivers += 1;
        self.area += area;
        self.solution += area * solution;
        self.reference.iter_mut().zip(rows).for_each(|(sum, row)| *sum += area * row[i]);
        self.square.add(area, &differences);
    }

    fn finish(&self, (object, name): (Option<&str>, &str), total: &Square, confidence: f64) -> GroupError {
        let solution = self.solution / self.area;
        let means: Vec<f64> = self.reference.iter().map(|sum| sum / self.area).collect();
        let differences: Vec<f64> = means.iter().map(|m| solution - m).collect();
        let estimate = |x: &[f64]| if x.len() == 1 { Estimate::exact(x[0]) } else { mean_interval(x, confidence) };
        GroupError {
            name: name.into(),
            object: object.map(Into::into),
            receivers: self.receivers,
            area: self.area,
            reference: estimate(&means),
            solution,
            bias: estimate(&differences),
            share: self.square.share_of(total, confidence),
            worst: self.worst.0,
            worst_difference: self.worst.1,
        }
    }
}

/// A group's name: (object, surface) for surfaces, (nothing, object) for objects.
pub(super) type Key<'a> = (Option<&'a str>, &'a str);

/// Errors of the groups that `key` names, the largest part of the squared error first. `rows` holds the reference,
/// one row per replicate; receivers of area 0 do not count.
pub(super) fn group_errors<'a>(
    areas: &[f64],
    solution: &[f64],
    rows: &[Vec<f64>],
    key: impl Fn(usize) -> Key<'a>,
    confidence: f64,
) -> Vec<GroupError> {
    let mut groups: BTreeMap<Key, Sums> = BTreeMap::new();
    for i in (0..areas.len()).filter(|i| areas[*i] > 0.0) {
        groups.entry(key(i)).or_insert_with(|| Sums::zero(rows.len())).add(i, areas[i], solution[i], rows);
    }
    let mut total = Square::zero(rows.len());
    groups.values().for_each(|g| total.merge(&g.square));
    let mut order: Vec<(&Key, &Sums)> = groups.iter().collect();
    // Stable: equal ones stay in the order of their names.
    order.sort_by(|a, b| b.1.square.full.total_cmp(&a.1.square.full));
    order.into_iter().map(|(key, sums)| sums.finish(*key, &total, confidence)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::test_random::Random;

    fn by_two<'a>(i: usize) -> Key<'a> {
        (Some("room"), if i.is_multiple_of(2) { "floor" } else { "wall" })
    }

    #[test]
    fn by_hand_against_another_solution() {
        let areas = [1.0, 2.0, 3.0, 4.0, 0.0];
        let rows = [vec![1.0, 2.0, 3.0, 4.0, 9.0]];
        // Differences 0.5, -1, 1, 0: squares by area 0.25 + 3 on the floor, 2 on the wall.
        let groups = group_errors(&areas, &[1.5, 1.0, 4.0, 4.0, 0.0], &rows, by_two, 0.95);
        let (floor, wall) = (&groups[0], &groups[1]);
        assert_eq!((floor.name.as_str(), floor.object.as_deref(), floor.receivers), ("floor", Some("room"), 2));
        assert_eq!((floor.area, floor.worst, floor.worst_difference), (4.0, 2, 1.0));
        assert_eq!((floor.reference, floor.solution), (Estimate::exact(2.5), 13.5 / 4.0));
        assert_eq!(floor.bias, Estimate::exact(0.875));
        assert_eq!(floor.share, Some(Estimate::exact(3.25 / 5.25)));
        assert_eq!((wall.name.as_str(), wall.worst, wall.share), ("wall", 1, Some(Estimate::exact(2.0 / 5.25))));
        // No error at all: nothing to share out.
        let none = group_errors(&areas, &rows[0], &rows, by_two, 0.95);
        assert!(none.iter().all(|g| g.share.is_none()));
    }

    /// Noise that all patches of a replicate share is the worst case: errors of single patches would promise
    /// intervals that are several times too narrow. True shares and biases lie inside 95 % of the intervals.
    #[test]
    fn intervals_cover_the_truth_where_patches_err_together() {
        let n = 40;
        let truth: Vec<f64> = (0..n).map(|i| 1.0 + 0.3 * (i as f64).sin()).collect();
        let error = |i: usize| if i.is_multiple_of(2) { 0.03 } else { -0.02 };
        let solution: Vec<f64> = (0..n).map(|i| truth[i] + error(i)).collect();
        let (share, bias) = (0.0009 / 0.0013, 0.03);
        let mut random = Random(5);
        let (mut shares, mut biases) = (0, 0);
        const RUNS: usize = 2000;
        for _ in 0..RUNS {
            let row = |random: &mut Random| -> Vec<f64> {
                let common = 0.01 * random.normal();
                truth.iter().map(|y| y + common + 0.004 * random.normal()).collect()
            };
            let rows: Vec<Vec<f64>> = (0..16).map(|_| row(&mut random)).collect();
            let groups = group_errors(&vec![1.0; n], &solution, &rows, by_two, 0.95);
            let floor = groups.iter().find(|g| g.name == "floor").expect("a floor");
            let inside = |e: &Estimate, x: f64| usize::from(e.low <= x && x <= e.high);
            shares += inside(&floor.share.expect("a share"), share);
            biases += inside(&floor.bias, bias);
        }
        // 1900 expected, sd 10.
        assert!((1850..1950).contains(&biases), "{biases}");
        assert!((1840..1960).contains(&shares), "{shares}");
    }

    #[test]
    fn noise_alone_is_not_shared_out_but_has_its_bias() {
        let mut random = Random(9);
        let rows: Vec<Vec<f64>> = (0..16).map(|_| (0..100).map(|_| 1.0 + 0.05 * random.normal()).collect()).collect();
        let groups = group_errors(&[1.0; 100], &[1.0; 100], &rows, by_two, 0.999);
        assert!(groups.iter().all(|g| g.share.is_none() && g.bias.low < 0.0 && g.bias.high > 0.0), "{groups:?}");
    }
}
