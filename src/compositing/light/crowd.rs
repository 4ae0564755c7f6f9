//! Many things by their bounding spheres, in groups: those that matter are found without a look at most of them.

use crate::math::DVec3;

/// Spheres to a group.
const GROUP: usize = 16;

/// A sphere around something.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ball {
    pub centre: DVec3,
    pub radius: f64,
}

impl Ball {
    pub fn around(points: &[DVec3]) -> Self {
        let centre = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
        // Larger by a rounding: what touches is in.
        let radius = points.iter().map(|p| p.distance(centre)).fold(0.0, f64::max) * (1.0 + 1e-12);
        Self { centre, radius }
    }
}

/// Balls by number, and a ball around each group of them.
#[derive(Default)]
pub(super) struct Crowd {
    balls: Vec<Ball>,
    groups: Vec<Ball>,
}

/// The order in which neighbours stand together: halved along the longest spread.
pub(super) fn neighbours(balls: &[Ball]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..balls.len() as u32).collect();
    let mut parts = vec![(0, order.len())];
    while let Some((from, to)) = parts.pop() {
        if to - from <= GROUP {
            continue;
        }
        let at = |i: &u32| balls[*i as usize].centre;
        let part = &mut order[from..to];
        let (lo, hi) = part.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), i| {
            let p = at(i);
            (lo.min(p), hi.max(p))
        });
        let axis = (hi - lo).max_position();
        // Whole groups on the left, so that no group straddles a cut. Ties by number: the same order everywhere.
        let half = (part.len() / 2).next_multiple_of(GROUP).min(part.len() - 1);
        part.select_nth_unstable_by(half, |i, j| at(i)[axis].total_cmp(&at(j)[axis]).then(i.cmp(j)));
        parts.push((from, from + half));
        parts.push((from + half, to));
    }
    order
}

impl Crowd {
    /// Balls in an order in which neighbours stand together.
    pub fn new(balls: Vec<Ball>) -> Self {
        let group = |part: &[Ball]| {
            let centre = part.iter().map(|b| b.centre).sum::<DVec3>() / part.len() as f64;
            let radius = part.iter().map(|b| b.centre.distance(centre) + b.radius).fold(0.0, f64::max);
            Ball { centre, radius: radius * (1.0 + 1e-12) }
        };
        let groups = balls.chunks(GROUP).map(group).collect();
        Self { balls, groups }
    }

    /// Calls `visit` with the number of each ball that `may` matter, in order, until it returns true; says if it did.
    pub fn any(&self, may: impl Fn(&Ball) -> bool, mut visit: impl FnMut(usize) -> bool) -> bool {
        for (g, group) in self.groups.iter().enumerate() {
            if !may(group) {
                continue;
            }
            let from = g * GROUP;
            let part = &self.balls[from..(from + GROUP).min(self.balls.len())];
            if part.iter().enumerate().any(|(k, ball)| may(ball) && visit(from + k)) {
                return true;
            }
        }
        false
    }

    pub fn bytes(&self) -> usize {
        (self.balls.len() + self.groups.len()) * size_of::<Ball>()
    }
}

/// A cone or a cylinder from one end to another: whatever stands between is in it.
pub(super) struct Shaft {
    from: DVec3,
    axis: DVec3,
    radius: f64,
    slope: f64,
    secant: f64,
    end: f64,
}

impl Shaft {
    /// From a point to a ball.
    pub fn to(from: DVec3, ball: Ball) -> Self {
        let way = ball.centre - from;
        let length = way.length();
        let across = length * length - ball.radius * ball.radius;
        if across.is_nan() || across <= 0.0 {
            // Within the ball: no cone.
            return Self { from, axis: DVec3::Z, radius: f64::INFINITY, slope: 0.0, secant: 1.0, end: f64::INFINITY };
        }
        let slope = ball.radius / across.sqrt();
        let secant = (1.0 + slope * slope).sqrt();
        Self { from, axis: way / length, radius: 0.0, slope, secant, end: length + ball.radius }
    }

    /// From a ball endlessly in the direction of a unit vector.
    pub fn along(ball: Ball, axis: DVec3) -> Self {
        Self { from: ball.centre, axis, radius: ball.radius, slope: 0.0, secant: 1.0, end: f64::INFINITY }
    }

    /// False if the ball has no point in it; true in a few cases more than need be.
    pub fn meets(&self, ball: &Ball) -> bool {
        let way = ball.centre - self.from;
        let along = way.dot(self.axis);
        let reach = self.radius + self.slope * along + self.secant * ball.radius;
        if self.radius == f64::INFINITY {
            return true;
        }
        // The 1e-12 stands for the rounding of the difference of two large squares.
        let (square, aside) = (way.length_squared(), reach.max(0.0));
        along >= -(ball.radius + self.radius)
            && along <= self.end + ball.radius
            && reach >= 0.0
            && square - along * along <= aside * aside + 1e-12 * square
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_hide_nobody() {
        let ball = |k: usize| {
            let k = k as f64;
            Ball { centre: DVec3::new((k * 0.61).fract(), (k * 0.37).fract(), (k * 0.83).fract()) * 10.0, radius: 0.1 }
        };
        let balls: Vec<Ball> = (0..333).map(ball).collect();
        let order = neighbours(&balls);
        let sorted: Vec<Ball> = order.iter().map(|i| balls[*i as usize]).collect();
        let mut seen = order.clone();
        seen.sort_unstable();
        assert!(seen.iter().copied().eq(0..333));
        let shaft = Shaft::to(DVec3::new(1.0, 2.0, 0.0), Ball { centre: DVec3::new(8.0, 7.0, 9.0), radius: 1.0 });
        let mut found = Vec::new();
        Crowd::new(sorted.clone()).any(
            |b| shaft.meets(b),
            |k| {
                found.push(k);
                false
            },
        );
        let slow: Vec<usize> = (0..333).filter(|k| shaft.meets(&sorted[*k])).collect();
        assert_eq!(found, slow);
        assert!(found.len() > 5 && found.len() < 100, "{}", found.len());
    }

    #[test]
    fn what_lies_on_a_way_to_the_ball_is_in_the_shaft() {
        let target = Ball { centre: DVec3::new(3.0, 0.5, 2.0), radius: 1.5 };
        let shaft = Shaft::to(DVec3::ZERO, target);
        for k in 0..2000 {
            let f = |s: f64| (k as f64 * s).fract() * 2.0 - 1.0;
            let way = DVec3::new(f(0.754877), f(0.569840), f(0.438579));
            let on_way = (target.centre + way.normalize_or_zero() * target.radius) * (k as f64 * 0.618034).fract();
            assert!(shaft.meets(&Ball { centre: on_way, radius: 1e-6 }), "{k}");
        }
        assert!(!shaft.meets(&Ball { centre: DVec3::new(-1.0, 0.0, 0.0), radius: 0.5 }));
    }
}
