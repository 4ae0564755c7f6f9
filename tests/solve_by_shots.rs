//! `etalon solve --method progressive|redistribution` from outside: what it writes, tells and refuses.

#[path = "common/program.rs"]
mod program;

use program::{json, ok, refused};
use serde_json::Value;
use std::fs;
use tempfile::tempdir;

const SCENE: &str = "builtin:dynamic-cube";
const RAYS: &str = "rays=256,randomisations=8";

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// The first band of a solution, by patch.
fn red(path: &std::path::Path) -> Vec<f64> {
    let text = fs::read_to_string(path).expect("a solution");
    text.lines().skip(1).map(|l| l.split(',').nth(1).and_then(|x| x.parse().ok()).expect("a number")).collect()
}

#[test]
fn both_methods_end_in_the_same_solution_and_balance_their_energy() {
    let folder = tempdir().expect("a folder");
    let folder = folder.path();
    for (method, output) in [("progressive", "p.csv"), ("redistribution", "r.csv")] {
        let command = format!("solve {SCENE} --method {method}:{RAYS},unshot=1e-8 -o {output} --kernel builtin");
        let told = json(folder, &command);
        assert_eq!(told["end"], "converged");
        assert!(number(&told["energy"]["gap"]) < 1e-9 && number(&told["unshot"]) <= 1e-8, "{told}");
        assert!(told["log"].as_array().is_some_and(Vec::is_empty));
        let before = (method == "redistribution").then(|| number(&told["redistributions"]));
        assert!(before.is_none_or(|n| n > 0.0), "nothing was redistributed");
    }
    let (p, r) = (red(&folder.join("p.csv")), red(&folder.join("r.csv")));
    let size = p.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    assert!(p.len() == r.len() && p.iter().zip(&r).all(|(a, b)| (a - b).abs() < 1e-6 * size));
}

/// Radiosities and standard errors of all bands, by patch.
fn with_errors(path: &std::path::Path) -> Vec<(f64, f64)> {
    let text = fs::read_to_string(path).expect("a solution");
    let mut lines = text.lines().map(|l| l.split(',').collect::<Vec<_>>());
    let header = lines.next().expect("a header");
    let errors: Vec<(usize, usize)> = (0..header.len())
        .filter_map(|e| {
            let band = header[e].strip_suffix("_std_err")?;
            Some((header.iter().position(|h| *h == band)?, e))
        })
        .collect();
    let value = |l: &Vec<&str>, c: usize| l[c].parse::<f64>().expect("a number");
    let of = |l: Vec<&str>| errors.iter().map(|(v, e)| (value(&l, *v), value(&l, *e))).collect::<Vec<_>>();
    lines.flat_map(of).collect()
}

/// The redistributed solution against the judge, within both errors: of the differences over their joint standard errors,
/// 5 % are to lie beyond Student's t of 15 degrees. Differences within a run go together, runs do not: by the spread of
/// the eight shares their mean has a standard error of about 0.5 %, so that the bounds are eight and nine of these away.
#[test]
fn redistribution_agrees_with_the_judge_within_both_errors() {
    const T_95: f64 = 2.131;
    let folder = tempdir().expect("a folder");
    let folder = folder.path();
    ok(folder, &format!("reference {SCENE} --rays 1024 -o ref --kernel builtin --quiet"));
    let judge = with_errors(&folder.join("ref/reference.csv"));
    let mut outside = Vec::new();
    for seed in 1..=8 {
        let method = "redistribution:rays=1024,lamps=1,unshot=1e-4";
        ok(folder, &format!("solve {SCENE} --method {method} --seed {seed} -o r.csv --kernel builtin --quiet"));
        let ours = with_errors(&folder.join("r.csv"));
        assert_eq!(ours.len(), judge.len());
        let beyond = |((b, s), (r, t)): (&(f64, f64), &(f64, f64))| (b - r).abs() > T_95 * s.hypot(*t);
        // Lamps that reflect next to nothing have next to no error on either side.
        let noisy = ours.iter().zip(&judge).filter(|((b, s), _)| *s > 1e-9 * b);
        let (all, out) = noisy.fold((0.0, 0.0), |(n, k), pair| (n + 1.0, k + f64::from(u8::from(beyond(pair)))));
        outside.push(out / all);
    }
    let mean = outside.iter().sum::<f64>() / 8.0;
    println!("beyond the 95 % intervals: {:.1} % of the differences, by run {outside:.3?}", 100.0 * mean);
    assert!((0.005..0.09).contains(&mean), "{mean}: {outside:?}");
}

#[test]
fn snapshots_are_a_series_that_converge_reads() {
    let folder = tempdir().expect("a folder");
    let folder = folder.path();
    let solve = format!("solve {SCENE} --method redistribution:{RAYS} -o r.csv --kernel builtin --snapshots s");
    ok(folder, &format!("{solve} --snapshot-shots 0,1,5 --quiet"));
    let index = fs::read_to_string(folder.join("s/index.csv")).expect("an index");
    assert_eq!(index.lines().next(), Some("file,seconds,shots,rays,edit"));
    let last: Vec<&str> = index.lines().last().expect("a line").split(',').collect();
    assert_eq!(red(&folder.join("s").join(last[0])), red(&folder.join("r.csv")));
    let judge = "--rays 64 --randomisations 8 --estimator rays --kernel builtin --quiet";
    let told = json(folder, &format!("converge {SCENE} --series mine=s -o c {judge}"));
    assert!(told.is_object());
    let curves = fs::read_to_string(folder.join("c/curves.csv")).expect("curves");
    assert!(curves.lines().count() > index.lines().count() / 2 && curves.contains("mine,"));
}

#[test]
fn a_run_that_goes_on_ends_where_one_without_a_stop_does() {
    let folder = tempdir().expect("a folder");
    let folder = folder.path();
    let solve = |stop: &str, rest: &str| {
        ok(folder, &format!("solve {SCENE} --method progressive:{RAYS}{stop} --kernel builtin --quiet {rest}"));
    };
    solve("", "-o whole.csv");
    solve(",shots=40", "-o part.csv --resume state.json");
    assert_ne!(fs::read(folder.join("part.csv")).unwrap(), fs::read(folder.join("whole.csv")).unwrap());
    solve("", "-o part.csv --resume state.json");
    assert_eq!(fs::read(folder.join("part.csv")).unwrap(), fs::read(folder.join("whole.csv")).unwrap());
    let other = refused(folder, &format!("solve {SCENE} --method progressive:rays=128 -o x.csv --resume state.json"));
    assert!(other.contains("state.json") && other.contains("delete it"), "{other}");
    fs::write(folder.join("state.json"), "{}").unwrap();
    let damaged = refused(folder, &format!("solve {SCENE} --method progressive:{RAYS} -o x.csv --resume state.json"));
    assert!(damaged.contains("state.json") && !folder.join("x.csv").exists(), "{damaged}");
}

#[test]
fn what_shooting_cannot_do_is_refused_with_the_mend() {
    let folder = tempdir().expect("a folder");
    let folder = folder.path();
    for (rest, said) in [
        ("--method progressive:strategy=two", "settings are"),
        ("--method redistribution:samples=0", "samples=N"),
        ("--method progressive:resolution=51", "even"),
        ("--method progressive --form-factors f.npz", "shot by shot"),
        ("--method progressive --snapshots s --snapshot-shots 5,1", "ascend"),
        ("--method hemicube --snapshots s", "methods that shoot"),
        ("--method hemicube --resume s", "methods that shoot"),
        ("--method shooting", "progressive and redistribution"),
    ] {
        let message = refused(folder, &format!("solve {SCENE} -o x.csv {rest}"));
        assert!(message.contains(said), "{rest}: {message}");
        assert!(fs::read_dir(folder).unwrap().next().is_none(), "{rest} left something");
    }
}
