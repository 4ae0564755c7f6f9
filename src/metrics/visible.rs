//! Errors as they are seen: how much of a picture is off by more than a step of the display [TR93].

use super::quantity::mean_of;
use crate::math::compensated_sum;
use crate::stats::{Estimate, Moments, two_sided_t};
use crate::view::Viewer;
use serde::{Deserialize, Serialize};

/// Who looks, and what of the picture each receiver takes.
#[derive(Debug, Clone, PartialEq)]
pub struct Viewing {
    /// The eye, the operator and the screen: settled before the solution is looked at, and the same for both sides.
    pub viewer: Viewer,
    /// Share of the picture that each receiver takes, by number; 0 out of sight.
    pub shares: Vec<f64>,
}

/// What can be seen of an error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AsSeen {
    /// Share of the picture (of what of it shows judged receivers) where the solution is off by more than one step of the
    /// frame buffer. No standard error: the interval comes from those of the receivers, all at once.
    pub share: Estimate,
    /// The receiver that is off by most steps.
    pub worst: Option<WorstSeen>,
    /// How accurate a solution must be for nothing to be seen.
    pub needed: Option<Needed>,
    /// Who looks.
    pub viewer: Viewer,
}

/// The receiver that is off by most steps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WorstSeen {
    /// Number.
    pub patch: usize,
    /// Solution less reference, steps of the frame buffer.
    pub steps: f64,
    /// Solution less reference, brils.
    pub brils: f64,
}

/// How accurate a solution must be: relative errors of luminance that move the screen by one step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Needed {
    /// The least of them: within this everywhere, nothing is seen.
    pub everywhere: f64,
    /// The receiver it belongs to.
    pub patch: usize,
    /// The middle one: half of the picture is more forgiving.
    pub median: f64,
}

/// The share of a picture that is visibly wrong.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct VisibleShare {
    pub estimate: Estimate,
    receivers: Vec<Receiver>,
}

/// A receiver in sight.
#[derive(Debug, Clone, PartialEq)]
struct Receiver {
    share: f64,
    /// True if off by more than one step as far as one can tell.
    visible: bool,
    /// Times the rays after which one can tell; 1 and less: now.
    settles: f64,
}

/// Looks at a solution (luminance by receiver, weighted by band, W/m^2) beside a reference of one row per replicate. `None`
/// where nothing of it is in the picture.
pub(super) fn visible_share(
    viewing: &Viewing,
    areas: &[f64],
    solution: &[f64],
    reference: &[Vec<f64>],
    confidence: f64,
) -> Option<VisibleShare> {
    let seen: Vec<usize> = in_sight(viewing, areas);
    let all = compensated_sum(seen.iter().map(|i| viewing.shares[*i]));
    let mean = mean_of(reference);
    // Student t over replicates, Bonferroni over the receivers in sight: all of them hold together, so the share does.
    let t = if reference.len() > 1 {
        two_sided_t(1.0 - (1.0 - confidence) / seen.len().max(1) as f64, reference.len() as f64 - 1.0)
    } else {
        0.0
    };
    let receiver = |i: &usize| {
        let std_err = reference.iter().map(|row| row[*i]).collect::<Moments>().std_err().unwrap_or(0.0);
        let (low, high) = viewing.viewer.alike(solution[*i]);
        let visible = !(low..=high).contains(&mean[*i]);
        let gap = (mean[*i] - low).abs().min((mean[*i] - high).abs());
        let settles = if std_err > 0.0 { (t * std_err / gap).powi(2) } else { 0.0 };
        Receiver { share: viewing.shares[*i] / all, visible, settles }
    };
    let receivers: Vec<Receiver> = seen.iter().map(receiver).collect();
    (!receivers.is_empty()).then(|| {
        let (low, high) = bounds(&receivers, 1.0);
        let value = compensated_sum(receivers.iter().filter(|r| r.visible).map(|r| r.share));
        VisibleShare { estimate: Estimate { value, std_err: None, low, high: high.min(1.0) }, receivers }
    })
}

/// Bounds of the share with so many times the rays: sure receivers on either side, the others in between.
fn bounds(receivers: &[Receiver], rays: f64) -> (f64, f64) {
    let sum = |keep: &dyn Fn(&&Receiver) -> bool| compensated_sum(receivers.iter().filter(keep).map(|r| r.share));
    let sure = |r: &Receiver| r.settles <= rays;
    (sum(&|r| r.visible && sure(r)), sum(&|r| r.visible || !sure(r)))
}

impl VisibleShare {
    /// Times the rays after which the limit would be decided if every value stays where it is; `None` if none would do.
    pub fn rays_factor(&self, limit: f64) -> Option<f64> {
        let mut steps: Vec<f64> =
            self.receivers.iter().map(|r| r.settles).filter(|s| *s > 1.0 && s.is_finite()).collect();
        steps.sort_by(f64::total_cmp);
        let decides = |rays: &f64| {
            let (low, high) = bounds(&self.receivers, *rays);
            low > limit || high <= limit
        };
        // What decides goes on deciding with more rays.
        let first = steps.partition_point(|rays| !decides(rays));
        steps.get(first).copied()
    }
}

/// What can be seen of an error, and how small it would have to be for nothing to be seen. `None` where nothing of it is
/// in the picture.
pub(super) fn as_seen(
    viewing: &Viewing,
    areas: &[f64],
    solution: &[f64],
    reference: &[Vec<f64>],
    confidence: f64,
) -> Option<AsSeen> {
    let share = visible_share(viewing, areas, solution, reference, confidence)?.estimate;
    let (mean, viewer) = (mean_of(reference), &viewing.viewer);
    let off = |i: usize| WorstSeen {
        patch: i,
        steps: viewer.steps(solution[i]) - viewer.steps(mean[i]),
        brils: viewer.brightness(solution[i]) - viewer.brightness(mean[i]),
    };
    let seen = in_sight(viewing, areas);
    let worst = seen.iter().map(|i| off(*i)).max_by(|a, b| a.steps.abs().total_cmp(&b.steps.abs()));
    let mut least: Vec<(f64, usize)> =
        seen.iter().filter_map(|i| Some((viewer.least_visible(mean[*i])?, *i))).collect();
    least.sort_by(|a, b| a.0.total_cmp(&b.0));
    let needed = least.first().map(|(everywhere, patch)| {
        let half = 0.5 * compensated_sum(least.iter().map(|(_, i)| viewing.shares[*i]));
        let mut below = 0.0;
        let median = least.iter().find(|(_, i)| {
            below += viewing.shares[*i];
            below >= half
        });
        Needed { everywhere: *everywhere, patch: *patch, median: median.unwrap_or(&least[0]).0 }
    });
    Some(AsSeen { share, worst, needed, viewer: viewer.clone() })
}

fn in_sight(viewing: &Viewing, areas: &[f64]) -> Vec<usize> {
    (0..areas.len()).filter(|i| areas[*i] > 0.0 && viewing.shares[*i] > 0.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::test_random::Random;
    use crate::view::{Display, Levels, Operator, Surround};

    fn viewing(shares: Vec<f64>) -> Viewing {
        let levels = Levels { log_mean: 60.0, brightest_surface: 400.0, unseen: 0.0 };
        let viewer = Viewer::new(Operator::Tr93Consistent, Surround::Dim, Display::srgb(), 179.0, levels);
        Viewing { viewer, shares }
    }

    #[test]
    fn by_hand() {
        let v = viewing(vec![0.2, 0.3, 0.0, 0.1]);
        let truth = vec![1.0, 2.0, 3.0, 4.0];
        let (least, step) = (v.viewer.least_visible(2.0).unwrap(), |y: f64| v.viewer.steps(y));
        // The second is off by just more than a step, the third out of sight, the fourth absent.
        let solution = vec![1.0, 2.0 * (1.0 + 1.1 * least), 9.0, 9.0];
        let seen = as_seen(&v, &[1.0, 1.0, 1.0, 0.0], &solution, &[truth], 0.95).unwrap();
        assert!((seen.share.value - 0.6).abs() < 1e-12 && seen.share.low == seen.share.high);
        let worst = seen.worst.unwrap();
        assert_eq!(worst.patch, 1);
        assert!(
            (worst.steps - (step(solution[1]) - step(2.0))).abs() < 1e-12 && worst.steps > 1.0 && worst.brils > 0.0
        );
        let needed = seen.needed.unwrap();
        assert!(needed.everywhere <= least && needed.median >= needed.everywhere);
        assert_eq!(visible_share(&v, &[0.0, 0.0, 1.0, 0.0], &solution, std::slice::from_ref(&solution), 0.95), None);
    }

    /// 200 receivers against 400 noisy references each way: a third of them off by 1.3 steps and the rest by 0.7, so that
    /// noise leaves many open; and all of them off by just less than one, so that any that is called visible is a false
    /// alarm. The interval holds the true share in at least 95 % of the runs.
    #[test]
    fn the_interval_holds_the_share() {
        let (n, runs) = (200, 400);
        let v = viewing(vec![1.0 / n as f64; n]);
        let mut random = Random(11);
        let truth: Vec<f64> = (0..n).map(|i| 0.5 + 3.0 * i as f64 / n as f64).collect();
        let mut run = |name: &str, steps: &dyn Fn(usize) -> f64| {
            let off = |i: usize| truth[i] * (1.0 + steps(i) * v.viewer.least_visible(truth[i]).unwrap());
            let solution: Vec<f64> = (0..n).map(off).collect();
            let right = (0..n).filter(|i| steps(*i) > 1.0).count() as f64 / n as f64;
            let (mut missed, mut width) = (0, 0.0);
            for _ in 0..runs {
                let rows: Vec<Vec<f64>> =
                    (0..16).map(|_| truth.iter().map(|y| y * (1.0 + 0.004 * random.normal())).collect()).collect();
                let e = visible_share(&v, &vec![1.0; n], &solution, &rows, 0.95).unwrap().estimate;
                missed += usize::from(e.low > right + 1e-12 || e.high < right - 1e-12);
                width += (e.high - e.low) / f64::from(runs);
            }
            println!("{name}: {missed} of {runs} intervals miss the share; they are {width:.2} wide");
            // 5 % promised: 20 of 400 at most expected, sd 4.4; above 38 with probability 1e-4.
            assert!(missed <= 38, "{missed}");
            // Noise leaves a part of them open: there is something to miss.
            assert!(width > 0.02, "{width}");
        };
        run("a third visible", &|i| if i % 3 == 0 { 1.3 } else { 0.7 });
        run("none quite visible", &|_| 0.99);
    }

    #[test]
    fn more_rays_settle_what_is_open() {
        let v = viewing(vec![0.5, 0.5]);
        let least = v.viewer.least_visible(2.0).unwrap();
        // Both reflect alike; the first is off by a step and a half, the second by half of one.
        let solution = [2.0 * (1.0 + 1.5 * least), 2.0 * (1.0 + 0.5 * least)];
        let noisy = |size: f64| -> Vec<Vec<f64>> {
            (0..16).map(|k| vec![2.0 * (1.0 + size * least * if k % 2 == 0 { 1.0 } else { -1.0 }); 2]).collect()
        };
        let at = |size: f64| visible_share(&v, &[1.0; 2], &solution, &noisy(size), 0.95).unwrap();
        let (open, sure) = (at(3.0), at(0.1));
        assert_eq!((open.estimate.low, open.estimate.value, open.estimate.high), (0.0, 0.5, 1.0));
        assert_eq!((sure.estimate.low, sure.estimate.high), (0.5, 0.5));
        let factor = open.rays_factor(0.2).unwrap();
        assert!(factor > 1.0, "{factor}");
        let settled = at(3.0 / (1.01 * factor).sqrt());
        assert!(settled.estimate.low > 0.2, "{factor} {:?}", settled.estimate);
        assert!(open.rays_factor(0.2).is_some() && sure.rays_factor(0.5).is_none());
    }
}
