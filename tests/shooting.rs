//! The shooting solver against closed forms, dense solutions with the same rays, and itself taken up again.

#[path = "common/dense.rs"]
mod dense;

use dense::{RANDOMISATIONS, SEED, below, dense, params, rows, scene, solve, solve_for};
use etalon::KernelKind;
use etalon::io::scene::builtin;
use etalon::math::DVec3;
use etalon::methods::shooting::{
    Budget, End, Factors, Params, Ranking, Saved, Shooting, ShootingError, Step, Stop, Strategy,
};
use etalon::raycast::specimen::Numbers;
use etalon::scene::{Edit, Scene, Stage, Transform};
use std::ops::ControlFlow;

fn moved(object: &str, by: [f64; 3]) -> Edit {
    let translate = DVec3::from_array(by);
    let transform = Transform { axis: DVec3::Z, angle: 0.0, about: DVec3::ZERO, translate };
    Edit::Move { object: object.into(), transform }
}

fn open(scene: &Scene, params: Params) -> Shooting {
    Shooting::open(scene, 0, params, KernelKind::Builtin, SEED).unwrap()
}

fn shots(solver: &mut Shooting, shots: u64) -> End {
    solver.run(Budget { shots: Some(shots), time: None }, &mut |_, _| ControlFlow::Continue(()))
}

fn factors(stage: &Stage) -> Vec<Vec<f64>> {
    dense(&rows(stage, KernelKind::Builtin, true))
}

fn gap(a: &[f64], b: &[f64]) -> f64 {
    let size = b.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    a.iter().zip(b).map(|(x, y)| (x - y).abs() / size).fold(0.0, f64::max)
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|x| x.to_bits()).collect()
}

mod drag {
    use super::*;

    /// What is shown while an object is dragged: all that has been shot, as it would have arrived with the object there.
    fn shown(stage: &Stage, shot: &[f64], object: &[usize]) -> Vec<f64> {
        let (n, bands, f) = (stage.patch_count(), stage.band_count(), factors(stage));
        let mut b = vec![0.0; n * bands];
        for i in (0..n).filter(|i| stage.patches[*i].is_present()) {
            for c in 0..bands {
                let q = |j: usize| {
                    if object.contains(&j) { stage.patches[j].area * stage.emission(j)[c] } else { shot[j * bands + c] }
                };
                let arrived: f64 = (0..n).map(|j| f[j][i] * q(j)).sum();
                b[i * bands + c] = stage.emission(i)[c] + stage.reflectance(i)[c] * arrived / stage.patches[i].area;
            }
        }
        b
    }

    fn power_shot(solver: &Shooting) -> Vec<f64> {
        let (b, u, bands) = (solver.radiosity(), solver.unshot(), solver.stage().band_count());
        (0..b.values.len()).map(|k| solver.stage().patches[k / bands].area * (b.values[k] - u.values[k])).collect()
    }

    /// A random drag of a box or of a lamp, on a solution that may be unfinished.
    fn history(seed: u64) {
        let mut n = Numbers::new(seed);
        let mut scene = scene();
        scene.absent.clear();
        let object = ["box", "glow", "plate"][below(&mut n, 3)];
        let mut solver = open(&scene, params());
        shots(&mut solver, [0, 5, 30, 10_000][below(&mut n, 4)]);
        solver.select(object).unwrap();
        let settle = below(&mut n, 2) == 0;
        if settle {
            solver.converge();
        }
        let (state, shot) = (solver.state(), power_shot(&solver));
        let base = solver.unshot();
        let mut last = Vec::new();
        for _ in 0..1 + below(&mut n, 4) {
            let by = n.point(DVec3::splat(-0.1), DVec3::splat(0.1));
            let edits = vec![moved(object, [by.x, by.y, by.z.max(0.0)]), moved(object, [0.0, 0.0, 0.02])];
            if solver.drag(&edits).is_err() {
                continue;
            }
            last.clone_from(&edits);
            if !settle {
                shots(&mut solver, [0, 2, 20][below(&mut n, 3)]);
                assert!(solver.energy().gap() < 1e-9);
                continue;
            }
            assert_eq!(solver.error_bound(), None, "nothing is shown yet");
            solver.converge();
            assert_eq!(bits(&solver.unshot().values), bits(&base.values), "the drag changed what lies beneath");
            let mut there = scene.clone();
            there.edits = vec![Edit::Remove { object: object.into() }];
            there.edits.extend(edits);
            there.edits.push(Edit::Add { object: object.into() });
            let stage = there.at(there.edits.len()).unwrap();
            let own: Vec<usize> =
                (0..stage.patch_count()).filter(|i| !solver.stage().patches[*i].is_present()).collect();
            let gap = gap(&solver.radiosity().values, &shown(&stage, &shot, &own));
            assert!(gap < 1e-9, "history {seed}: what is shown of {object} is off by {gap:e}");
        }
        solver.release().unwrap();
        assert!(matches!(solver.release(), Err(ShootingError::NothingSelected)));
        assert_eq!(solver.state(), state + last.len() + 1);
        for entry in solver.log().iter().filter(|e| e.state < state) {
            let count = |word: &str| entry.edits.iter().filter(|e| e.starts_with(word)).count();
            assert_eq!((count("remove"), count("move"), count("add")), (1, last.len(), 1), "{:?}", entry.edits);
        }
        solver.converge();
        let exact = solve(solver.stage(), &factors(solver.stage()));
        let gap = gap(&solver.radiosity().values, &exact);
        assert!(gap < 1e-9, "history {seed}: off by {gap:e} after the drag of {object}");
    }

    #[test]
    fn what_is_shown_and_what_is_left_agree_with_dense_solutions() {
        (0..40).for_each(history);
    }

    #[test]
    fn what_was_shot_towards_the_last_place_is_kept() {
        let counted = |shown: u64| {
            let mut solver = open(&scene(), params());
            solver.converge();
            solver.select("box").unwrap();
            solver.converge();
            solver.drag(&[moved("box", [-0.1, 0.1, 0.2])]).unwrap();
            shots(&mut solver, shown);
            let before = solver.costs().redistributions;
            solver.release().unwrap();
            solver.converge();
            solver.costs().redistributions - before
        };
        let (none, some, all) = (counted(0), counted(8), counted(10_000));
        println!("redistributions after the release: {none}, {some} after 8 shots of the drag, {all} after all");
        assert!(some + 8 == none && all == 0, "{none} {some} {all}");
    }
}

mod errors {
    use super::*;
    use statrs::distribution::{Binomial, ContinuousCDF, DiscreteCDF, StudentsT};

    /// Form factors between faces of a cube: opposite, and side by side.
    const OPPOSITE: f64 = 0.199_824_895_698_387_46;
    const ADJACENT: f64 = 0.200_043_776_075_403_16;

    /// One patch of each seed: misses of the 95 % interval must be binomial. False alarms: 1e-4.
    fn assert_covered(what: &str, seeds: u64, deviation: impl Fn(u64) -> f64) {
        let limit = StudentsT::new(0.0, 1.0, f64::from(RANDOMISATIONS - 1)).unwrap().inverse_cdf(0.975);
        let misses = (0..seeds).filter(|s| deviation(*s).abs() > limit).count() as u64;
        let binomial = Binomial::new(0.05, seeds).unwrap();
        let (below, above) = (binomial.cdf(misses), if misses == 0 { 1.0 } else { 1.0 - binomial.cdf(misses - 1) });
        println!("{what}: {misses} of {seeds} outside of the 95 % interval");
        assert!(below > 5e-5 && above > 5e-5, "{what}: {misses} of {seeds} outside of the 95 % interval");
    }

    fn standardised(solver: &Shooting, exact: &[f64], k: usize) -> f64 {
        let b = solver.radiosity();
        (b.values[k] - exact[k]) / b.std_err.unwrap()[k]
    }

    fn coarse(unshot: f64) -> Params {
        Params { stop: Stop { unshot, ..params().stop }, ..params() }
    }

    #[test]
    fn intervals_hold_the_closed_form_converged_or_not() {
        let scene = builtin("cube-one-emitter").unwrap();
        let stage = scene.at(0).unwrap();
        assert_eq!(stage.patch_count(), 6);
        let facing = |i: usize, j: usize| stage.patches[i].normal.dot(stage.patches[j].normal) < -0.5;
        let f = |i: usize, j: usize| {
            if i == j {
                0.0
            } else if facing(i, j) {
                OPPOSITE
            } else {
                ADJACENT
            }
        };
        let f: Vec<Vec<f64>> = (0..6).map(|i| (0..6).map(|j| f(i, j)).collect()).collect();
        let lamp = (0..6).find(|i| stage.emission(*i)[0] > 0.0).unwrap();
        let bands = stage.band_count();
        let converged = solve(&stage, &f);
        let direct: Vec<f64> = (0..6 * bands)
            .map(|k| {
                stage.emission(k / bands)[k % bands]
                    + stage.reflectance(k / bands)[k % bands] * f[lamp][k / bands] * stage.emission(lamp)[k % bands]
            })
            .collect();
        for (what, exact, limit) in [("converged", &converged, u64::MAX), ("one shot", &direct, 1)] {
            assert_covered(what, 300, |seed| {
                let mut solver = Shooting::open(&scene, 0, coarse(1e-7), KernelKind::Builtin, seed).unwrap();
                shots(&mut solver, limit);
                // The lamp's own radiosity is known without rays after one shot.
                let i = (lamp + 1 + seed as usize % 5) % 6;
                standardised(&solver, exact, i * bands)
            });
        }
    }

    #[test]
    fn intervals_hold_after_an_edit() {
        let edited = |params: Params, seed: u64| {
            let mut solver = Shooting::open(&scene(), 0, params, KernelKind::Builtin, seed).unwrap();
            solver.converge();
            solver.apply(moved("box", [-0.2, 0.3, 0.3])).unwrap();
            solver.converge();
            solver
        };
        let fine = Factors::Rays { rays: 1 << 16, randomisations: 8 };
        let exact = edited(Params { factors: fine, ..coarse(1e-6) }, 77).radiosity().values;
        assert_covered("after an edit", 150, |seed| {
            standardised(&edited(coarse(1e-6), 1000 + seed), &exact, (seed as usize * 7 % 24) * 3)
        });
    }
}

mod known {
    use super::*;

    #[test]
    fn a_furnace_is_two_everywhere() {
        let scene = builtin("furnace").unwrap();
        let mut solver = open(&scene, params());
        solver.converge();
        let expected = |rho: f64, e: f64, excess: f64| e / (1.0 - rho * (1.0 + excess));
        let stage = solver.stage().clone();
        let (rho, e) = (stage.reflectance(0)[0], stage.emission(0)[0]);
        let mean = |s: &Shooting| {
            let (b, bands) = (s.radiosity(), stage.band_count());
            let sum: f64 = (0..stage.patch_count()).map(|i| stage.patches[i].area * b.values[i * bands]).sum();
            sum / stage.areas().iter().sum::<f64>()
        };
        assert!((mean(&solver) - expected(rho, e, 0.0)).abs() < 1e-10, "{}", mean(&solver));
        let cube = Params::progressive("factors=hemicube,resolution=50,unshot=1e-12").unwrap();
        let mut solver = open(&scene, cube);
        solver.converge();
        assert!((mean(&solver) - expected(rho, e, 0.000_216_849_203)).abs() < 1e-8, "{}", mean(&solver));
        assert_eq!(solver.radiosity().std_err, None);
        // All power shot is B A but for what is unshot: the table hands out 0.542 / N^2 of it.
        let (energy, area) = (solver.energy(), stage.areas().iter().sum::<f64>());
        let share = energy.excess[0] / (mean(&solver) * area);
        assert!((share * 2500.0 / 0.542 - 1.0).abs() < 0.02, "excess {share:e}");
        assert!(energy.gap() < 1e-12);
    }

    #[test]
    fn an_open_scene_loses_what_escapes_and_what_meets_backs() {
        let mut scene = scene();
        scene.surfaces[0].faces.remove(5);
        scene.edits = vec![moved("plate", [0.0, 0.0, -0.3])];
        let mut solver = open(&scene, params());
        solver.converge();
        for _ in 0..2 {
            let e = solver.energy();
            assert!(e.escaped[0] > 0.05 * e.emitted[0], "{e:?}");
            assert!(e.gap() < 1e-10 && e.excess.iter().all(|x| *x == 0.0));
            if solver.apply_next().is_err() {
                break;
            }
            solver.converge();
        }
    }

    #[test]
    fn ambient_light_is_near_what_is_missing_and_changes_nothing_else() {
        let scene = builtin("furnace").unwrap();
        let (mut plain, mut shown) = (open(&scene, params()), open(&scene, Params { ambient: true, ..params() }));
        for solver in [&mut plain, &mut shown] {
            shots(solver, 1);
        }
        assert_eq!(bits(&plain.unshot().values), bits(&shown.unshot().values));
        assert_eq!(plain.error_bound(), shown.error_bound());
        let mean = |s: &Shooting| s.radiosity().values.iter().sum::<f64>() / s.radiosity().values.len() as f64;
        let (before, after) = (mean(&plain), mean(&shown));
        plain.converge();
        shown.converge();
        let exact = mean(&plain);
        println!("mean radiosity after one shot: {before}, with ambient {after}, of {exact}");
        assert!((after - exact).abs() < 0.05 * (exact - before), "{before} {after} {exact}");
        assert!(gap(&shown.radiosity().values, &plain.radiosity().values) < 1e-12);
    }

    #[test]
    fn no_band_is_left_unshot() {
        let mut scene = scene();
        scene.photometry.weights = vec![0.0, 1.0, 0.0];
        scene.materials[1].emission = vec![10.0, 0.0, 0.0];
        let mut solver = open(&scene, params());
        solver.converge();
        let exact = solve(solver.stage(), &factors(solver.stage()));
        assert!(gap(&solver.radiosity().values, &exact) < 1e-9);
        assert!(
            open(&scene, Params { stop: Stop { unshot: 0.0, ..params().stop }, ..params() }).converge()
                == End::Converged
        );
    }

    #[test]
    fn a_lamp_still_shoots_first_after_a_second_edit() {
        let mut solver = open(&scene(), params());
        solver.converge();
        solver.apply(Edit::Add { object: "glow".into() }).unwrap();
        solver.apply(moved("box", [-0.1, 0.0, 0.0])).unwrap();
        let mut first = None;
        solver.run(Budget { shots: Some(1), time: None }, &mut |_, e| {
            first = Some(e.step);
            ControlFlow::Break(())
        });
        let Some(Step::Propagated { patch }) = first else { panic!("{first:?}") };
        assert_eq!(solver.stage().surface_name(patch), "glow");
        let one = Params { factors: Factors::Rays { rays: 64, randomisations: 1 }, ..params() };
        assert!(Shooting::open(&scene(), 0, one, KernelKind::Builtin, 1).is_err(), "no errors from one randomisation");
    }
}

mod log {
    use super::*;

    /// At any moment the log says exactly what the solution lacks.
    #[test]
    fn it_states_what_is_missing() {
        let mut loaded = 0;
        for seed in 0..30 {
            let mut n = Numbers::new(seed);
            let mut solver = open(&scene(), params());
            let mut known = vec![factors(solver.stage())];
            for k in 0..2 {
                shots(&mut solver, [3, 20, 10_000][below(&mut n, 3)]);
                solver.apply(moved(["box", "plate"][k], [-0.1, 0.1, 0.05 + n.between(0.0, 0.1)])).unwrap();
                known.push(factors(solver.stage()));
                shots(&mut solver, 1 + below(&mut n, 10) as u64);
            }
            let (stage, log) = (solver.stage().clone(), solver.log());
            loaded += usize::from(!log.is_empty());
            let (patches, bands) = (stage.patch_count(), stage.band_count());
            let (b, mut rest) = (solver.radiosity().values, solver.unshot().values);
            let shot: Vec<f64> = b.iter().zip(&rest).map(|(b, u)| b - u).collect();
            let now = &known[solver.state()];
            for entry in &log {
                let then = &known[entry.state];
                for (j, power) in &entry.patches {
                    for i in (0..patches).filter(|i| stage.patches[*i].is_present()) {
                        for c in 0..bands {
                            let lacks = (now[*j][i] - then[*j][i]) * power[c];
                            rest[i * bands + c] += stage.reflectance(i)[c] * lacks / stage.patches[i].area;
                        }
                    }
                }
            }
            // B* - S = (U + what is missing, reflected) and all its reflections.
            let more = solve_for(&stage, now, &rest);
            let stated: Vec<f64> = shot.iter().zip(&more).map(|(s, m)| s + m).collect();
            assert!(gap(&stated, &solve(&stage, now)) < 1e-9, "history {seed}");
        }
        assert!(loaded > 20, "{loaded}");
    }
}

mod order {
    use super::*;

    fn luminous(stage: &Stage, power: &[f64]) -> f64 {
        power.iter().zip(&stage.photometry.weights).map(|(p, w)| p.abs() * w).sum()
    }

    /// Redistributions until 90 % of the power that has to move has moved, by the dense rows.
    fn until_ninety(scene: &Scene, edit: &Edit, ranking: Ranking) -> (usize, u64) {
        let mut solver = open(scene, Params { ranking, threshold: 0.0, ..params() });
        solver.converge();
        let before = factors(solver.stage());
        solver.apply(edit.clone()).unwrap();
        let after = factors(solver.stage());
        let stage = solver.stage().clone();
        let moved = |j: usize, power: &[f64]| {
            before[j].iter().zip(&after[j]).map(|(a, b)| (a - b).abs()).sum::<f64>() / 2.0 * luminous(&stage, power)
        };
        let amounts: Vec<(usize, f64)> =
            solver.log().iter().flat_map(|e| e.patches.iter().map(|(j, p)| (*j, moved(*j, p)))).collect();
        let all: f64 = amounts.iter().map(|(_, a)| a).sum();
        let (mut done, mut count, rays) = (0.0, 0, solver.costs().rays);
        solver.run(Budget::default(), &mut |_, e| {
            if let Step::Redistributed { patch, .. } = e.step {
                done += amounts.iter().filter(|(j, _)| *j == patch).map(|(_, a)| a).sum::<f64>();
                count += 1;
            }
            if done >= 0.9 * all { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        (count, solver.costs().rays - rays)
    }

    /// Scenes that keep the estimate's conditions, and break each of them.
    fn cases() -> Vec<(&'static str, Scene, Edit)> {
        let reshaped = |object: &str, scale: [f64; 3], about: [f64; 3]| Edit::Reshape {
            object: object.into(),
            scale: DVec3::from_array(scale),
            about: DVec3::from_array(about),
        };
        let add = |object: &str| Edit::Add { object: object.into() };
        let mut hidden = scene();
        // The box's middle is behind the plate, its sides are not.
        hidden.edits = vec![reshaped("plate", [0.5, 0.5, 1.0], [0.7, 0.3, 0.4])];
        let absent = |mut s: Scene, object: &str| {
            s.absent = vec![object.into(), "glow".into()];
            s
        };
        vec![
            ("small", scene(), add("glow")),
            ("large against its distance", scene(), reshaped("box", [1.5, 1.5, 2.0], [0.7, 0.25, 0.0])),
            ("plate, edge-on", absent(scene(), "plate"), add("plate")),
            ("hidden middle", absent(hidden, "box"), add("box")),
        ]
    }

    #[test]
    fn what_the_estimate_costs_where_its_conditions_are_broken() {
        println!("{:28} {:>8} {:>8} {:>8}", "redistributions to 90 %", "exact", "1 point", "9 points");
        for (name, scene, edit) in cases() {
            let count = |ranking| until_ninety(&scene, &edit, ranking).0;
            let (exact, one, nine) = (count(Ranking::Exact), count(Ranking::Samples(1)), count(Ranking::Samples(9)));
            println!("{name:28} {exact:8} {one:8} {nine:8}");
            assert!(exact <= one && exact <= nine, "{name}: {exact} {one} {nine}");
        }
    }

    #[test]
    fn both_strategies_reach_the_same_solution() {
        println!("{:28} {:>10} {:>10}", "shots to 3 % of the change", "one", "two");
        for (name, scene, edit) in cases() {
            let reached = |strategy| {
                let mut solver = open(&scene, Params { strategy, ..params() });
                solver.converge();
                let (before, stage) = (solver.radiosity(), solver.stage().clone());
                solver.apply(edit.clone()).unwrap();
                let exact = solve(solver.stage(), &factors(solver.stage()));
                let bands = stage.band_count();
                let y = |b: &[f64], i: usize| luminous(&stage, &b[i * bands..][..bands]);
                let changed = |i: &usize| (y(&exact, *i) - y(&before.values, *i)).abs() > 1e-6;
                let mut count = None;
                let start = solver.costs().shots;
                solver.run(Budget::default(), &mut |s, e| {
                    let (b, patches) = (s.radiosity().values, &s.stage().patches);
                    let over = |f: &dyn Fn(usize) -> f64| -> f64 {
                        (0..patches.len()).filter(changed).map(|i| patches[i].area * f(i).powi(2)).sum()
                    };
                    let error =
                        (over(&|i| y(&exact, i) - y(&b, i)) / over(&|i| y(&exact, i) - y(&before.values, i))).sqrt();
                    if error < 0.03 {
                        count.get_or_insert(e.costs.shots - start);
                    } else {
                        count = None;
                    }
                    ControlFlow::Continue(())
                });
                assert!(gap(&solver.radiosity().values, &exact) < 1e-9);
                count.unwrap()
            };
            println!("{name:28} {:10} {:10}", reached(Strategy::One), reached(Strategy::Two));
        }
    }

    /// A redistribution traces the shadow volume alone.
    /// Strategy one without a threshold redistributes everything before it propagates anything, also what the estimates see
    /// nothing of: left for later, each of those shots would cost a convergence of its own.
    #[test]
    fn all_is_redistributed_before_anything_is_propagated() {
        let scene = {
            let mut s = scene();
            s.absent.clear();
            s
        };
        let mut solver = open(&scene, params());
        solver.converge();
        solver.apply(moved("box", [-0.1, 0.1, 0.1])).unwrap();
        let (mut redistributed, mut late, mut propagated) = (0, 0, 0);
        solver.run(Budget::default(), &mut |_, e| {
            match e.step {
                Step::Propagated { .. } => propagated += 1,
                _ if propagated > 0 => late += 1,
                _ => redistributed += 1,
            }
            ControlFlow::Continue(())
        });
        assert!(redistributed > 10 && propagated > 10 && late == 0, "{redistributed} {propagated} {late}");
    }

    #[test]
    fn few_rays_are_traced_again() {
        let rays = 1 << 13;
        let scene = {
            let mut s = scene();
            s.absent.clear();
            s
        };
        let many = Params {
            factors: Factors::Rays { rays, randomisations: 8 },
            stop: Stop { unshot: 1e-3, ..params().stop },
            ..params()
        };
        let mut solver = open(&scene, many);
        solver.converge();
        solver.apply(moved("glow", [0.05, 0.0, 0.05])).unwrap();
        let (mut before, mut traced, mut whole) = (solver.costs().rays, 0, 0);
        let own = |s: &Shooting, i: usize| s.stage().surface_name(i) == "glow";
        solver.run(Budget::default(), &mut |s, e| {
            if let Step::Redistributed { patch, .. } = e.step
                && !own(s, patch)
            {
                traced += e.costs.rays - before;
                whole += rays;
            }
            before = e.costs.rays;
            ControlFlow::Continue(())
        });
        println!("traced again: {traced} of {whole} rays, {} patches spared", solver.costs().spared);
        assert!(traced * 4 < whole, "{traced} of {whole}");
    }
}

mod again {
    use super::*;

    fn edits() -> Scene {
        let mut scene = scene();
        let paint = Edit::Material { material: 0, reflectance: Some(vec![0.5, 0.7, 0.4]), emission: None };
        scene.edits = vec![
            moved("box", [-0.1, 0.1, 0.1]),
            paint,
            Edit::Add { object: "glow".into() },
            moved("plate", [0.1, 0.1, 0.0]),
        ];
        scene
    }

    /// The same history in budgets of some shots.
    fn run(each: u64) -> Vec<u64> {
        let mut solver = open(&edits(), params());
        let mut seen = Vec::new();
        for state in 0..5 {
            let mut left = [200, 9, 30, 15, u64::MAX][state];
            while left > 0 && shots(&mut solver, each.min(left)) == End::Spent {
                left -= each.min(left);
            }
            seen.extend(bits(&solver.element_radiosity().values));
            _ = solver.apply_next();
        }
        seen.extend(bits(&solver.radiosity().std_err.unwrap()));
        seen
    }

    #[test]
    fn same_bits_in_any_budgets_and_on_any_threads() {
        let on = |threads: usize, each: u64| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| run(each))
        };
        let once = on(1, u64::MAX);
        for (threads, each) in [(2, u64::MAX), (4, u64::MAX), (2, 1), (2, 7)] {
            assert!(on(threads, each) == once, "{threads} threads, budgets of {each}");
        }
    }

    fn restore(scene: &Scene, saved: &Saved) -> Result<Shooting, ShootingError> {
        Shooting::restore(scene, params(), KernelKind::Builtin, SEED, saved)
    }

    #[test]
    fn a_saved_state_goes_on_bit_by_bit() {
        for count in [0, 1, 4, 12, 40] {
            let scene = edits();
            let mut solver = open(&scene, params());
            for _ in 0..4 {
                shots(&mut solver, count);
                solver.apply_next().unwrap();
                let text = serde_json::to_string(&solver.save().unwrap()).unwrap();
                let saved: Saved = serde_json::from_str(&text).unwrap();
                let mut other = restore(&scene, &saved).unwrap();
                assert_eq!(other.log(), solver.log());
                assert_eq!(other.costs(), solver.costs());
                for s in [&mut solver, &mut other] {
                    shots(s, count + 3);
                }
                assert_eq!(other.save().unwrap().version_states, solver.save().unwrap().version_states);
                assert_eq!(bits(&other.element_radiosity().values), bits(&solver.element_radiosity().values));
                solver = other;
            }
        }
    }

    #[test]
    fn what_is_foreign_or_damaged_is_refused() {
        let scene = edits();
        let mut solver = open(&scene, params());
        shots(&mut solver, 20);
        solver.apply_next().unwrap();
        shots(&mut solver, 5);
        let saved = solver.save().unwrap();
        let refused = |change: &dyn Fn(&mut Saved)| {
            let mut s = saved.clone();
            change(&mut s);
            restore(&scene, &s).err().map(|e| e.to_string()).unwrap_or_default()
        };
        assert_eq!(refused(&|_| ()), "");
        for (n, change) in [
            &(|s: &mut Saved| s.patches[3] *= 1.01) as &dyn Fn(&mut Saved),
            &|s| s.shot[0] += 0.1,
            &|s| s.version_shot.iter_mut().for_each(|q| *q *= 0.5),
            &|s| s.elements[0] = f64::NAN,
            &|s| _ = s.elements.pop(),
            &|s| s.version_states.reverse(),
            &|s| s.version_states.clear(),
            &|s| s.lamps.push(1 << 40),
        ]
        .iter()
        .enumerate()
        {
            assert!(refused(change).contains("damaged"), "{n}: {}", refused(change));
        }
        assert!(refused(&|s| s.state = 99).contains("more edits"));
        let mut other = scene.clone();
        other.materials[0].reflectance[0] = 0.1;
        let foreign = |r: Result<Shooting, ShootingError>| r.err().unwrap().to_string();
        assert!(foreign(restore(&other, &saved)).contains("another scene"));
        assert!(foreign(Shooting::restore(&scene, params(), KernelKind::Builtin, 99, &saved)).contains("another seed"));
        let longer = Params { stop: Stop { unshot: 1e-3, ..params().stop }, ..params() };
        assert!(Shooting::restore(&scene, longer, KernelKind::Builtin, SEED, &saved).is_ok());
        solver.apply(moved("box", [0.0, 0.0, 0.1])).unwrap();
        assert!(solver.save().err().unwrap().to_string().contains("1 edits"));
        solver.select("box").unwrap();
        assert!(matches!(solver.save(), Err(ShootingError::Selected(_))));
    }
}
