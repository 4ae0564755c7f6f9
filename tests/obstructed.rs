//! Obstructed form factors against `references/obstructed`: values that agree to 1e-10 between computations that share
//! no method.

#[path = "common/truth.rs"]
mod common;

use common::{number, reference_file, vertices};
use etalon::estimate::{PairPlan, pair_form_factors};
use etalon::formfactor::{Effort, hidden_exchange, polygon_to_polygon};
use etalon::math::{DVec3, Polytope, area};
use etalon::scene::Stage;
use serde_json::Value;

/// What the values agree to.
const AGREED: f64 = 1e-10;

fn scenes() -> Vec<Value> {
    let folder = std::fs::read_dir(reference_file("obstructed")).expect("the folder is there");
    let mut files: Vec<_> = folder.map(|f| f.expect("readable").path()).collect();
    files.retain(|f| f.extension().is_some_and(|e| e == "json"));
    files.sort();
    files.iter().map(|f| serde_json::from_slice(&std::fs::read(f).expect("readable")).expect("JSON")).collect()
}

fn list(v: &Value) -> &[Value] {
    v.as_array().map_or(&[], Vec::as_slice)
}

/// All pairs, every blocker a plate of its own: whatever stands aside hides nothing.
#[test]
fn every_pair() {
    let effort = Effort { tolerance: 1e-13, points: 40_000, arranged_bodies: 40 };
    let (mut pairs, mut agreed, mut worst) = (0, 0, 0.0f64);
    for scene in scenes() {
        let flat = |b: &Value| Polytope::flat(&vertices(b)).expect("a polygon");
        let plates: Vec<Polytope> = list(&scene["blockers"]).iter().map(flat).collect();
        for pair in list(&scene["pairs"]) {
            let (a, b) = (vertices(&pair["surface1"]), vertices(&pair["surface2"]));
            let shaft: Vec<&Polytope> = near(&plates, &a, &b);
            let open = polygon_to_polygon(&a, &b);
            let hidden = hidden_exchange(&a, &b, &shaft, &effort);
            let got = open - hidden.exchange / area(&a);
            let exact = number(&pair["values"]["F12"]);
            assert!((open - number(&pair["unobstructed"]["F12"])).abs() < 1e-12, "{} open", pair["id"]);
            let (error, stated) = ((got - exact).abs(), hidden.error / area(&a));
            println!("{} {exact:.3e} error {error:.1e}, stated {stated:.1e}, {} points", pair["id"], hidden.points);
            assert!(error < AGREED.max(stated), "{}: {got} for {exact}, stated {stated:e}", pair["id"]);
            worst = worst.max(error);
            agreed += usize::from(error < AGREED);
            pairs += 1;
        }
    }
    println!("{agreed} of {pairs} pairs agree to 1e-10, worst {worst:.1e}");
    // Tilted plates whose edges cross in the view of an edge: curves where the integrand bends, found by refinement only.
    assert!(pairs >= 70 && agreed >= 66 && worst < 1e-7, "{agreed} of {pairs}, worst {worst:e}");
}

/// Plates that are not wholly behind either polygon or beyond their hull's box.
fn near<'a>(plates: &'a [Polytope], a: &[DVec3], b: &[DVec3]) -> Vec<&'a Polytope> {
    let Some((a, b)) = etalon::formfactor::facing(a, b) else { return Vec::new() };
    let shaft = etalon::raycast::Shaft::new(&a, &b, 1e-11);
    plates.iter().filter(|p| !shaft.misses(p)).collect()
}

/// Whole rows of closed scenes, each patch a facet of its own: the boxes have to be put together again.
#[test]
fn whole_rows() {
    let mut rows = 0;
    for scene in scenes() {
        let polygons: Vec<Vec<DVec3>> = list(&scene["patches"])
            .iter()
            .map(|p| list(p).iter().map(|v| DVec3::new(number(&v[0]), number(&v[1]), number(&v[2]))).collect())
            .collect();
        if polygons.is_empty() {
            continue;
        }
        let stage = Stage::from_polygons(&polygons);
        let plan = PairPlan { target_error: Some(1e-6), ..PairPlan::default() };
        let f = pair_form_factors(&stage, &plan, &|_| ());
        for row in list(&scene["rows"]) {
            let i = row["patch"].as_u64().expect("a number") as usize;
            let errors =
                list(&row["values"]).iter().enumerate().map(|(j, v)| (f.form_factors.get(i, j) - number(v)).abs());
            let worst = errors.fold(0.0, f64::max);
            println!("{} row {i}: worst {worst:.1e}; {:?}", scene["scene"], f.tally);
            assert!(worst < 1e-8, "{} row {i}: {worst}", scene["scene"]);
            rows += 1;
        }
    }
    assert_eq!(rows, 5);
}
