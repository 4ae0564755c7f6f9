//! Tables for programs: CSV, with numbers that read back exactly.

use super::MeshReport;
use crate::metrics::Rate;
use crate::stats::Estimate;
use crate::study::converge::{At, Axis, Curve, CurvePoint, Difference, Digest, mesh_rate};
use serde::Deserialize;

/// Columns of the judged snapshots.
const CURVES: &str = "method,edit,shots,rays,seconds,shots_since_edit,rays_since_edit,seconds_since_edit,rms,\
                      rms_std_err,rms_low,rms_high,top1,top1_std_err,top1_low,top1_high,noise_floor,top1_noise_floor";

/// Lines of comma-separated fields, quoted where needed.
fn lines(header: &str, rows: impl Iterator<Item = Vec<String>>) -> Vec<u8> {
    let mut csv = csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
    let header: Vec<&str> = header.split(',').collect();
    csv.write_record(&header).expect("memory is writable");
    rows.for_each(|r| csv.write_record(&r).expect("memory is writable"));
    csv.into_inner().expect("memory is writable")
}

/// What is not known is an empty field.
fn number(x: Option<f64>) -> String {
    x.filter(|x| x.is_finite()).map_or(String::new(), |x| format!("{x:?}"))
}

fn estimate(e: Option<Estimate>) -> [String; 4] {
    [e.map(|e| e.value), e.and_then(|e| e.std_err), e.map(|e| e.low), e.map(|e| e.high)].map(number)
}

fn slope(rate: Option<&Rate>) -> [String; 5] {
    let [value, std_err, low, high] = estimate(rate.map(|r| r.slope));
    [rate.map_or(0, |r| r.points).to_string(), value, std_err, low, high]
}

pub(super) fn curves(curves: &[Curve]) -> Vec<u8> {
    let row = |c: &Curve, p: &CurvePoint| {
        let mut row = vec![c.method.clone(), c.edit.to_string(), p.shots.to_string(), p.rays.to_string()];
        row.push(number(Some(p.seconds)));
        row.extend([p.shots_since_edit.to_string(), p.rays_since_edit.to_string(), number(Some(p.seconds_since_edit))]);
        row.extend(estimate(p.rms).into_iter().chain(estimate(p.top1)));
        row.extend([p.noise_floor, p.top1_noise_floor].map(number));
        row
    };
    lines(CURVES, curves.iter().flat_map(|c| c.points.iter().map(move |p| row(c, p))))
}

/// A line of `curves.csv`.
#[derive(Deserialize)]
struct Line {
    method: String,
    edit: usize,
    shots: u64,
    rays: u64,
    seconds: f64,
    shots_since_edit: u64,
    rays_since_edit: u64,
    seconds_since_edit: f64,
    rms: Option<f64>,
    rms_std_err: Option<f64>,
    rms_low: Option<f64>,
    rms_high: Option<f64>,
    top1: Option<f64>,
    top1_std_err: Option<f64>,
    top1_low: Option<f64>,
    top1_high: Option<f64>,
    noise_floor: Option<f64>,
    top1_noise_floor: Option<f64>,
}

/// Reads `curves.csv` again.
///
/// # Errors
/// Line and problem of what is not such a table.
pub fn read_curves(bytes: &[u8]) -> Result<Vec<Curve>, (String, String)> {
    let mut csv = csv::Reader::from_reader(bytes);
    let mut curves: Vec<Curve> = Vec::new();
    for line in csv.deserialize::<Line>() {
        let line = line.map_err(|e| {
            let at = e.position().map_or(1, csv::Position::line);
            (format!("line {at}"), format!("is not a line of curves: {e}"))
        })?;
        let known = |value: Option<f64>, std_err, low: Option<f64>, high: Option<f64>| {
            // An interval without an end was written as an empty field.
            let (low, high) = (low.unwrap_or(0.0), high.unwrap_or(f64::INFINITY));
            value.map(|value| Estimate { value, std_err, low, high })
        };
        let point = CurvePoint {
            shots: line.shots,
            rays: line.rays,
            seconds: line.seconds,
            shots_since_edit: line.shots_since_edit,
            rays_since_edit: line.rays_since_edit,
            seconds_since_edit: line.seconds_since_edit,
            rms: known(line.rms, line.rms_std_err, line.rms_low, line.rms_high),
            top1: known(line.top1, line.top1_std_err, line.top1_low, line.top1_high),
            noise_floor: line.noise_floor,
            top1_noise_floor: line.top1_noise_floor,
        };
        match curves.iter_mut().find(|c| c.method == line.method && c.edit == line.edit) {
            Some(curve) => curve.points.push(point),
            None => curves.push(Curve { method: line.method, edit: line.edit, points: vec![point] }),
        }
    }
    match curves.is_empty() {
        true => Err((String::new(), "holds no curve".into())),
        false => Ok(curves),
    }
}

pub(super) fn rates(digest: &Digest) -> Vec<u8> {
    let rows = digest.rates.iter().map(|r| {
        let mut row = vec![r.method.clone(), r.edit.to_string(), r.metric.name().into(), r.axis.name().into()];
        row.extend(slope(r.rate.as_ref()));
        row
    });
    lines("method,edit,metric,axis,points,slope,slope_std_err,slope_low,slope_high", rows)
}

pub(super) fn reached(digest: &Digest) -> Vec<u8> {
    let mut header = "method,edit,metric,level".to_string();
    for a in Axis::ALL.map(Axis::name) {
        header += &format!(",{a},{a}_with_confidence,{a}_first_over_this");
    }
    let rows = digest.reached.iter().map(|r| {
        let mut row = vec![r.method.clone(), r.edit.to_string(), r.metric.name().into(), number(Some(r.level))];
        for (cost, ratio) in r.costs.iter().zip(r.first_over_this) {
            row.extend([cost.and_then(|c| c.by_value), cost.and_then(|c| c.with_confidence), ratio].map(number));
        }
        row
    });
    lines(&header, rows)
}

pub(super) fn differences(all: &[Difference]) -> Vec<u8> {
    let rows = all.iter().map(|d| {
        let (at, x) = match d.at {
            At::Error(x) => ("error", x),
            At::Cost(x) => ("cost", x),
        };
        let mut row = vec![d.method.clone(), d.edit.to_string(), d.metric.name().into(), d.axis.name().into()];
        row.extend([at.to_string(), number(Some(x))]);
        for side in [d.first, d.second] {
            row.extend([side.map(|s| s.value), side.and_then(|s| s.low), side.and_then(|s| s.high)].map(number));
        }
        row.extend([number(d.ratio()), d.noise().map_or(String::new(), |n| n.name().into())]);
        row
    });
    let header = "method,edit,metric,axis,at,at_value,first,first_low,first_high,second,second_low,second_high,\
                  second_over_first,noise";
    lines(header, rows)
}

pub(super) fn meshes(report: &MeshReport) -> Vec<u8> {
    let rows = report.curves.iter().flat_map(|c| {
        c.points.iter().map(move |p| {
            let mut row = vec![c.method.clone(), p.size.factor.to_string(), p.size.patches.to_string()];
            row.extend([p.size.longest_edge, p.size.mean_size].map(|x| number(Some(x))));
            row.extend(estimate(p.rms));
            row.push(number(p.noise_floor));
            row
        })
    });
    lines("method,factor,patches,longest_edge,mean_size,rms,rms_std_err,rms_low,rms_high,noise_floor", rows)
}

pub(super) fn orders(report: &MeshReport) -> Vec<u8> {
    let rows = report.curves.iter().map(|c| {
        let mut row = vec![c.method.clone()];
        row.extend(slope(mesh_rate(c, report.about.confidence).as_ref()));
        row
    });
    lines("method,points,order,order_std_err,order_low,order_high", rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_come_back_to_the_bit() {
        let rms = Some(Estimate { value: 0.1 + 0.2, std_err: Some(1e-17), low: 0.29, high: 1.0 / 3.0 });
        let point = CurvePoint {
            shots: 7,
            rays: 1 << 60,
            seconds: 0.1,
            shots_since_edit: 3,
            rays_since_edit: 4,
            seconds_since_edit: 1e-9,
            rms,
            top1: None,
            noise_floor: Some(1e-5),
            top1_noise_floor: None,
        };
        let name = "hemicube:resolution=50,delta=exact, \"mine\"";
        let all = vec![
            Curve { method: name.into(), edit: 0, points: vec![point, point] },
            Curve { method: name.into(), edit: 1, points: vec![CurvePoint { top1: rms, ..point }] },
        ];
        assert_eq!(read_curves(&curves(&all)).expect("reads"), all);
    }

    #[test]
    fn what_is_no_table_of_curves_is_refused_by_line() {
        let (at, said) = read_curves(b"a,b\n1,2\n").expect_err("other columns");
        assert!(at == "line 2" && said.contains("method"), "{at} {said}");
        assert!(read_curves(b"").is_err());
        let broken = String::from_utf8(curves(&[])).expect("text") + "m,0,x,0,0,0,0,0,,,,,,,,,,\n";
        assert_eq!(read_curves(broken.as_bytes()).expect_err("not a number").0, "line 2");
    }
}
