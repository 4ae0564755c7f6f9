//! Pixels whose centre lies on the border between two patches. Whose they are is a matter of rounding: two right
//! programs may differ, and where patches line up with pixels they do, whole columns at a time.

use super::pictures::Slack;
use crate::methods::hemicube::{FACES, Item};
use std::collections::BTreeMap;

/// An edge that passes a pixel's centre this closely passes through it, pixels: far more than rounding in double
/// precision, far less than what is seen of a pixel otherwise.
const HAIR: f64 = 1.0 / (1u64 << 16) as f64;

/// Directions looked in from a centre: where corners meet, a patch fills a wedge only.
const AROUND: usize = 12;

/// Pictures it takes to find borders, with the one at the centres.
pub(super) const BORDER_PICTURES: f64 = 1.0 + AROUND as f64;

/// Looks around a centre, along no edge that is likely.
fn around() -> impl Iterator<Item = [f64; 2]> {
    let angle = |k: usize| (k as f64 + 0.37) * std::f64::consts::TAU / AROUND as f64;
    (0..AROUND).map(angle).map(|a| [HAIR * a.cos(), HAIR * a.sin()])
}

/// The pixels of a hemi-cube that may show one thing or another: face, pixel, and what they show, first what our
/// picture has.
#[derive(Debug)]
pub(super) struct Borders(BTreeMap<(usize, usize), Vec<Item>>);

impl Borders {
    /// Where a picture changes if looked at from a hair aside.
    pub fn new(picture: &[Vec<Item>; FACES], shifted: impl Fn([f64; 2]) -> Option<[Vec<Item>; FACES]>) -> Self {
        let mut found: BTreeMap<(usize, usize), Vec<Item>> = BTreeMap::new();
        for other in around().filter_map(shifted) {
            for (face, (own, other)) in picture.iter().zip(&other).enumerate() {
                for pixel in (0..own.len()).filter(|k| own[*k] != other[*k]) {
                    let items = found.entry((face, pixel)).or_insert_with(|| vec![own[pixel]]);
                    if !items.contains(&other[pixel]) {
                        items.push(other[pixel]);
                    }
                }
            }
        }
        Self(found)
    }

    /// Entries of a row that are not ours but that these pixels explain: each within what they can give or take, and
    /// all together unchanged, unless some may show no patch at all.
    pub fn explained(
        &self,
        theirs: &[f64],
        ours: &[f64],
        slack: Slack<'_>,
        delta: impl Fn(usize, usize) -> f64,
    ) -> usize {
        // By patch: what may be taken from it, and what may be given to it.
        let mut open: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
        let mut all_patches = true;
        for ((face, pixel), items) in &self.0 {
            for (k, item) in items.iter().enumerate() {
                match item.as_patch() {
                    Some(j) => open.entry(j as usize).or_default()[usize::from(k > 0)] += delta(*face, *pixel),
                    None => all_patches = false,
                }
            }
        }
        let change: f64 = open.keys().map(|j| theirs[*j] - ours[*j]).sum();
        let allowed: f64 = open.keys().map(|j| slack(theirs[*j])).sum();
        if all_patches && change.abs() > allowed {
            return 0;
        }
        let is_explained = |(j, [take, give]): &(&usize, &[f64; 2])| {
            let (change, slack) = (theirs[**j] - ours[**j], slack(theirs[**j]));
            change.abs() > slack && change >= -*take - slack && change <= *give + slack
        };
        open.iter().filter(is_explained).count()
    }
}
