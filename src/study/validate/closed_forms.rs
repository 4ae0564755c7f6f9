//! The catalogue, the polygon integrals and exact shadows against exact form factors.

use super::FALSE_ALARM;
use super::obstructed;
use super::truth_file::{Case, Shape, Side, cases};
use crate::estimate::Plan;
use crate::formfactor::catalogue::{
    any_polygon_to_polygon, coaxial_disks, coaxial_disks_past_disk, concentric_spheres, disk_to_coaxial_ring,
    disk_to_coaxial_sphere, element_to_disk, element_to_sphere, polygon_to_any_polygon, polygon_to_sphere,
    polygons_past_sphere, sphere_to_sphere,
};
use crate::formfactor::{point_to_polygon, polygon_to_polygon};
use crate::math::{DVec3, area, convex_defect};
use crate::raycast::{KernelError, KernelKind};
use crate::reference::Progress;
use crate::stats::bonferroni_level;
use serde::Serialize;
use std::f64::consts::PI;

/// Relative error within which a closed form passes ...
pub const RELATIVE: f64 = 1e-9;
/// ... or absolute.
pub const ABSOLUTE: f64 = 1e-12;

/// How a value was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Route {
    /// The polygon integrals: no rays.
    Polygon,
    /// An entry of the catalogue: no rays.
    Catalogue,
    /// Exact shadows, witnessed by rays with an interval.
    Shadows,
    /// Nothing in this version answers it: the case fails.
    None,
}

/// One value of the truth file and ours.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// Name of the case.
    pub case: String,
    /// `F12` or `F21`.
    pub direction: &'static str,
    /// How it was found.
    pub route: Route,
    /// The function that answers.
    pub function: &'static str,
    /// Where the case is from.
    pub citation: String,
    /// Exact value.
    pub exact: f64,
    /// Ours; `None` where nothing answers.
    pub ours: Option<f64>,
    /// Stated error of exact shadows.
    pub std_err: Option<f64>,
    /// Interval by the rays that witness, simultaneous over the suite.
    pub interval: Option<[f64; 2]>,
    /// Ours less the exact value.
    pub error: Option<f64>,
    /// True if the error is within the bound, and the exact value within the interval of the rays.
    pub passed: bool,
}

/// A function with its answers there and back; back is `None` from an element.
struct Answer {
    route: Route,
    function: &'static str,
    values: [Option<f64>; 2],
}

/// Runs all cases of the truth file. Rays that witness obstructed pairs get intervals that together hold the truth with a probability of
/// `1 - FALSE_ALARM`.
///
/// # Errors
/// If the kernel cannot be had.
pub fn closed_forms(
    kernel: KernelKind,
    plan: &Plan,
    seed: u64,
    progress: &dyn Progress,
) -> Result<Vec<Row>, KernelError> {
    let cases = cases();
    progress.begin("closed forms", Some(cases.len() as u64));
    let by_rays = cases.iter().filter(|c| blocked_polygons(c).is_some()).count();
    let confidence = 1.0 - bonferroni_level(FALSE_ALARM, 2 * by_rays);
    let mut rows = Vec::with_capacity(2 * cases.len());
    for (number, case) in cases.iter().enumerate() {
        match blocked_polygons(case) {
            Some(polygons) => {
                let stream = obstructed::stream(seed, number);
                let witnessed = obstructed::by_rays(&polygons, kernel, plan, stream, confidence)?;
                let found = obstructed::exchange(&polygons).into_iter().zip(witnessed);
                for ((direction, exact), ([ours, stated], e)) in exact_values(case).into_iter().zip(found) {
                    let known = row(case, direction, exact, Some(ours));
                    rows.push(Row {
                        route: Route::Shadows,
                        function: "exact shadows",
                        std_err: Some(stated),
                        interval: Some([e.low, e.high]),
                        passed: known.passed && e.low <= exact && exact <= e.high,
                        ..known
                    });
                }
            }
            None => {
                let answer = answer(case);
                for ((direction, exact), ours) in exact_values(case).into_iter().zip(answer.values) {
                    let row = row(case, direction, exact, ours);
                    rows.push(Row { route: answer.route, function: answer.function, ..row });
                }
            }
        }
        progress.advance(1);
    }
    Ok(rows)
}

/// A row judged as a closed form.
fn row(case: &Case, direction: &'static str, exact: f64, ours: Option<f64>) -> Row {
    let error = ours.map(|o| o - exact);
    Row {
        case: case.id.clone(),
        direction,
        route: Route::None,
        function: "",
        citation: case.citation.clone(),
        exact,
        ours,
        std_err: None,
        interval: None,
        error,
        passed: error.is_some_and(|e| e.abs() <= ABSOLUTE.max(RELATIVE * exact)),
    }
}

/// The directions that have an exact value. Digits that cannot be read are NaN, which nothing passes.
fn exact_values(case: &Case) -> Vec<(&'static str, f64)> {
    let number = |digits: &str| digits.parse().unwrap_or(f64::NAN);
    let back = case.values.back.as_ref().map(|b| ("F21", number(b)));
    std::iter::once(("F12", number(&case.values.there))).chain(back).collect()
}

/// The polygons of a case of convex polygons with polygons between; `None` for any other.
fn blocked_polygons(case: &Case) -> Option<Vec<Vec<DVec3>>> {
    let polygon = |s: &Shape| match s {
        Shape::Polygon { vertices } if convex_defect(vertices) > -1e-9 => Some(vertices.clone()),
        _ => None,
    };
    let all = [&case.surface1, &case.surface2].into_iter().chain(&case.blockers);
    if case.blockers.is_empty() { None } else { all.map(polygon).collect() }
}

fn answer(case: &Case) -> Answer {
    let nothing = Answer { route: Route::None, function: "none", values: [None, None] };
    match &case.blockers[..] {
        [] => open(&case.surface1, &case.surface2),
        [blocker] => screened(&case.surface1, &case.surface2, blocker),
        _ => None,
    }
    .unwrap_or(nothing)
}

/// Nothing between.
fn open(first: &Shape, second: &Shape) -> Option<Answer> {
    use Shape::{Annulus, Disk, Point, Polygon, Sphere};
    let catalogue = |function, values| Some(Answer { route: Route::Catalogue, function, values });
    let polygon = |function, values| Some(Answer { route: Route::Polygon, function, values });
    match (first, second) {
        (Polygon { vertices: a }, Polygon { vertices: b }) => {
            let convex = convex_defect(a).min(convex_defect(b)) > -1e-9;
            if convex {
                return polygon("polygon_to_polygon", [Some(polygon_to_polygon(a, b)), Some(polygon_to_polygon(b, a))]);
            }
            let values = [polygon_to_any_polygon(a, b), any_polygon_to_polygon(b, a)];
            polygon("polygon_to_any_polygon", values.map(Some))
        }
        (Point { position, normal }, Polygon { vertices }) => {
            polygon("point_to_polygon", [Some(point_to_polygon(*position, *normal, vertices)), None])
        }
        (Point { position, normal }, Disk { center, normal: front, radius }) => {
            let f = element_to_disk(*position, *normal, *center, *front, *radius);
            catalogue("element_to_disk", [Some(f), None])
        }
        (Point { position, normal }, Sphere { center, radius, side: Side::Outside }) => {
            catalogue("element_to_sphere", [Some(element_to_sphere(*position, *normal, *center, *radius)), None])
        }
        (Disk { radius: r1, .. }, Disk { radius: r2, .. }) => {
            let h = gap(first, second)?;
            catalogue("coaxial_disks", [Some(coaxial_disks(*r1, *r2, h)), Some(coaxial_disks(*r2, *r1, h))])
        }
        (Disk { radius, .. }, Annulus { inner_radius, outer_radius, .. }) => {
            let f = disk_to_coaxial_ring(*radius, *inner_radius, *outer_radius, gap(first, second)?);
            let ring = outer_radius * outer_radius - inner_radius * inner_radius;
            catalogue("disk_to_coaxial_ring", [Some(f), Some(f * radius * radius / ring)])
        }
        (Polygon { vertices }, Sphere { center, radius, side: Side::Outside }) => {
            let f = polygon_to_sphere(vertices, *center, *radius)?;
            let back = f * area(vertices) / (4.0 * PI * radius * radius);
            catalogue("polygon_to_sphere", [Some(f), Some(back)])
        }
        (Disk { center, normal, radius: r }, Sphere { center: middle, radius, side: Side::Outside }) => {
            let h = on_axis(*center, *normal, *middle)?;
            let f = disk_to_coaxial_sphere(*r, *radius, h)?;
            catalogue("disk_to_coaxial_sphere", [Some(f), Some(f * r * r / (4.0 * radius * radius))])
        }
        (
            Sphere { center: a, radius: r1, side: Side::Outside },
            Sphere { center: b, radius: r2, side: Side::Outside },
        ) => {
            let d = a.distance(*b);
            catalogue("sphere_to_sphere", [Some(sphere_to_sphere(*r1, *r2, d)), Some(sphere_to_sphere(*r2, *r1, d))])
        }
        (
            Sphere { center: a, radius: outer, side: Side::Inside },
            Sphere { center: b, radius: inner, side: Side::Outside },
        ) if a == b => {
            let (there, back) = concentric_spheres(*outer, *inner);
            catalogue("concentric_spheres", [Some(there), Some(back)])
        }
        _ => None,
    }
}

/// One disk or sphere between.
fn screened(first: &Shape, second: &Shape, blocker: &Shape) -> Option<Answer> {
    let catalogue =
        |function, values: [f64; 2]| Some(Answer { route: Route::Catalogue, function, values: values.map(Some) });
    match (first, second, blocker) {
        (
            Shape::Disk { center, normal, radius: r1 },
            Shape::Disk { radius: r2, .. },
            Shape::Disk { center: middle, radius, .. },
        ) => {
            let (h, at) = (gap(first, second)?, on_axis(*center, *normal, *middle)?);
            let values = [
                coaxial_disks_past_disk(*r1, *r2, h, *radius, at),
                coaxial_disks_past_disk(*r2, *r1, h, *radius, h - at),
            ];
            catalogue("coaxial_disks_past_disk", values)
        }
        (Shape::Polygon { vertices: a }, Shape::Polygon { vertices: b }, Shape::Sphere { center, radius, .. }) => {
            let f = polygons_past_sphere(a, b, *center, *radius)?;
            catalogue("polygons_past_sphere", [f, f * area(a) / area(b)])
        }
        _ => None,
    }
}

/// Distance of two disks or rings that face each other on one axis.
fn gap(first: &Shape, second: &Shape) -> Option<f64> {
    let plate = |s: &Shape| match s {
        Shape::Disk { center, normal, .. } | Shape::Annulus { center, normal, .. } => Some((*center, *normal)),
        _ => None,
    };
    let ((c1, n1), (c2, n2)) = (plate(first)?, plate(second)?);
    let facing = n1.normalize_or_zero().dot(n2.normalize_or_zero()) <= -1.0 + 1e-12;
    if facing { on_axis(c1, n1, c2) } else { None }
}

/// Height of a point on the axis of a disk, if it lies on it, in front.
fn on_axis(centre: DVec3, normal: DVec3, point: DVec3) -> Option<f64> {
    let (n, to) = (normal.normalize_or_zero(), point - centre);
    let h = n.dot(to);
    (h > 0.0 && (to - n * h).length() <= 1e-12 * h).then_some(h)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_has_its_route() {
        let cases = cases();
        assert_eq!(cases.len(), 114);
        let by_rays = cases.iter().filter(|c| blocked_polygons(c).is_some()).count();
        let open: Vec<&Case> = cases.iter().filter(|c| blocked_polygons(c).is_none()).collect();
        assert_eq!((by_rays, open.len()), (20, 94));
        for case in open {
            let answer = answer(case);
            assert!(answer.route != Route::None, "{}", case.id);
            for ((direction, exact), ours) in exact_values(case).into_iter().zip(answer.values) {
                let row = row(case, direction, exact, ours);
                assert!(row.passed, "{} {direction} by {}: {:?}", case.id, answer.function, row);
                assert!(exact != 0.0 || ours == Some(0.0), "{}: zero is zero", case.id);
            }
        }
    }

    #[test]
    fn a_wrong_digit_is_seen() {
        let mut case = cases().into_iter().find(|c| c.id == "disk-r1-r1-h1").unwrap();
        case.values.there = "0.381966012250105".into();
        let ours = answer(&case).values[0];
        assert!(!row(&case, "F12", exact_values(&case)[0].1, ours).passed);
        case.values.there = "not digits".into();
        assert!(!row(&case, "F12", exact_values(&case)[0].1, ours).passed, "NaN passes nothing");
    }
}
