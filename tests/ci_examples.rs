//! The files of `examples/ci`, run as far as a machine without their CI can: the scripts from end to end with the solver
//! of `examples/solver`, the shell steps of the workflows one by one. What is not run: actions, images, caches and
//! artefacts of the CIs, and building etalon from a checkout.

#[path = "ci_examples/workshop.rs"]
mod workshop;

use std::fs;
use std::path::Path;
use workshop::{LIMITS, Workshop, examples, lines_under, run, sh, step, steps};

#[test]
fn check_sh_passes_a_sound_solver_and_fails_broken_ones() {
    let Some(shop) = Workshop::new() else { return };
    let solver = shop.solver("");
    let (code, said) = shop.check_sh(&[("SOLVER", &solver), ("OUTPUT", "good")]);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("PASS") && said.contains("check.sh: passed"), "{said}");
    for made in ["solution.csv", "junit.xml", "summary.md", "report/report.html"] {
        assert!(shop.here().join("good").join(made).is_file(), "{made}");
    }
    // One reference, computed once.
    let kept: Vec<_> = fs::read_dir(shop.here().join(".etalon-cache")).expect("made").collect();
    assert_eq!(kept.len(), 1, "{kept:?}");
    let stored = kept[0].as_ref().expect("an entry").path().join("reference.json");
    let stamp = || fs::metadata(&stored).and_then(|m| m.modified()).expect("a time");
    let before = stamp();
    for bug in ["swapped-materials", "missing-bounce", "no-occluder"] {
        let (code, said) = shop.check_sh(&[("SOLVER", &shop.solver(bug)), ("OUTPUT", bug)]);
        assert_eq!(code, 1, "{bug}: {said}");
        assert!(said.contains("check.sh: failed"), "{bug}: {said}");
    }
    assert_eq!(stamp(), before);
    // One patch 5 % off is far below the solver's own error: it passes, but not beside the last accepted solution.
    let bug = shop.solver("one-patch");
    assert_eq!(shop.check_sh(&[("SOLVER", &bug), ("OUTPUT", "one")]).0, 0);
    let accepted = [("ACCEPTED", "good/solution.csv"), ("OUTPUT", "one")];
    assert_eq!(shop.check_sh(&[&accepted[..], &[("SOLVER", &bug)]].concat()).0, 1);
    assert_eq!(shop.check_sh(&[&accepted[..], &[("SOLVER", &solver)]].concat()).0, 0);
}

#[test]
fn check_sh_without_a_verdict_says_so() {
    let Some(shop) = Workshop::new() else { return };
    assert_eq!(shop.check_sh(&[("SCENE", "")]).0, 2);
    assert_eq!(shop.check_sh(&[("SCENE", "no-such.toml")]).0, 2);
    // A solver that dies is not judged by what an earlier one left.
    fs::create_dir_all(shop.here().join("out")).expect("a folder");
    fs::write(shop.here().join("out/solution.csv"), "patch,r,g,b\n").expect("writable");
    let (code, said) = shop.check_sh(&[("SOLVER", "exit 7"), ("OUTPUT", "out")]);
    assert!(code == 2 && said.contains("exit code 7"), "{code}: {said}");
    assert!(!shop.here().join("out/solution.csv").exists());
    assert_eq!(shop.check_sh(&[("SOLUTION", "nowhere.csv")]).0, 2);
}

#[test]
fn bisect_sh_names_the_commit_of_the_bug() {
    let Some(shop) = Workshop::new() else { return };
    let Some(commits) = shop.history("swapped-materials", 6, 4) else { return };
    let git = |arguments: &[&str], variables: &[(&str, &str)]| run(&mut shop.git(arguments, variables));
    let script = examples().join("ci/bisect.sh");
    let script = script.to_str().expect("text");
    let variables = [
        ("BUILD", "python3 -m py_compile solver.py"),
        ("SOLVER", "python3 solver.py \"$SCENE\" \"$PATCHES\" -o \"$SOLUTION\" --points 2"),
        ("LIMITS", LIMITS),
    ];
    git(&["bisect", "start", &commits[5], &commits[0]], &[]);
    let (code, said) = git(&["bisect", "run", "sh", script], &variables);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains(&format!("{} is the first bad commit", commits[3])), "{commits:?}\n{said}");
    // A commit that does not build, or whose solver dies, is skipped; what no commit is to blame for ends it.
    let alone = |more: &[(&str, &str)]| {
        let mut command = sh(&shop.repository(), &format!("sh '{script}'"), &variables);
        run(command.envs(more.iter().copied()).env("SCENE", shop.scene())).0
    };
    assert_eq!(alone(&[("BUILD", "false")]), 125);
    assert_eq!(alone(&[("SOLVER", "exit 3")]), 125);
    assert_eq!(alone(&[("SOLVER", "true")]), 125);
    assert_eq!(alone(&[("REFERENCE", "--rays none")]), 128);
}

#[test]
fn shell_steps_of_the_workflows_are_sound() {
    for (file, count) in [("github-actions.yml", 6), ("gitlab-ci.yml", 6)] {
        let text = fs::read_to_string(examples().join("ci").join(file)).expect("a file");
        let steps = steps(&text);
        assert_eq!(steps.len(), count, "{file}: {steps:?}");
        for (name, script) in &steps {
            let place = tempfile::tempdir().expect("a folder");
            fs::write(place.path().join("step"), script).expect("writable");
            let (code, said) = run(&mut sh(place.path(), "sh -n step", &[]));
            assert_eq!(code, 0, "{file}, {name}: {said}");
        }
        // Blocks with tabs, or expressions inside shell text, are what breaks such files most.
        assert!(!text.contains('\t'), "{file}");
        assert!(steps.iter().all(|(_, script)| !script.contains("${{")), "{file}");
    }
}

#[test]
fn the_github_workflow_runs_step_by_step() {
    let Some(shop) = Workshop::new() else { return };
    let text = fs::read_to_string(examples().join("ci/github-actions.yml")).expect("a file");
    let variables = shop.project(&lines_under(&text, "env:"));
    for name in ["key", "reference", "solve", "check"] {
        let (code, said) = shop.step(&step(&text, name), &variables);
        assert_eq!(code, 0, "{name}: {said}");
    }
    assert!(shop.read("outputs").starts_with("key=etalon-reference-"), "{}", shop.read("outputs"));
    assert!(shop.read("job-summary").contains("PASS"));
    assert!(shop.read("junit.xml").contains("<testsuite") && shop.here().join("report/report.html").is_file());
    // The same with a mistake: the step fails and the summary says so.
    let broken = shop.with_bug(&variables, "missing-bounce");
    shop.step(&step(&text, "solve"), &broken);
    let (code, said) = shop.step(&step(&text, "check"), &broken);
    assert!(code == 1 && said.contains("::error::"), "{code}: {said}");
    assert!(shop.read("job-summary").contains("FAIL"));
}

#[test]
fn the_gitlab_job_runs_step_by_step() {
    let Some(shop) = Workshop::new() else { return };
    let text = fs::read_to_string(examples().join("ci/gitlab-ci.yml")).expect("a file");
    let own: Vec<_> = lines_under(&text, "variables:").into_iter().map(|(k, v)| (k, v.replace("$$", "$"))).collect();
    let variables = shop.project(&own);
    // GitLab joins the steps of a job in one shell: what one sets, the next sees.
    let all = ["reference", "solve", "check"].map(|name| step(&text, name)).concat();
    assert_eq!(shop.step(&all, &variables).0, 0);
    assert!(shop.read("junit.xml").contains("<testsuite") && shop.read("summary.md").contains("PASS"));
    assert_eq!(shop.step(&all, &shop.with_bug(&variables, "swapped-materials")).0, 1);
    assert!(text.contains("allow_failure:\n    exit_codes: 3\n"));
}

#[test]
fn exit_codes_mean_what_the_workflow_says() {
    let place = tempfile::tempdir().expect("a folder");
    let text = fs::read_to_string(examples().join("ci/github-actions.yml")).expect("a file");
    let check = step(&text, "check");
    for (from_etalon, of_step, said) in [(0, 0, ""), (1, 1, "::error::"), (3, 0, "::warning::"), (4, 4, "::error::")] {
        stand_in(place.path(), from_etalon);
        let path = format!("{}:{}", place.path().display(), std::env::var("PATH").expect("a path"));
        let variables =
            [("PATH", path.as_str()), ("SOLUTION", "s"), ("SCENE", "s"), ("LIMITS", ""), ("GITHUB_STEP_SUMMARY", "x")];
        let (code, out) = run(&mut sh(place.path(), &format!("set -e\n{check}"), &variables));
        assert_eq!(code, of_step, "{from_etalon}: {out}");
        assert!(out.contains(said), "{from_etalon}: {out}");
    }
}

#[test]
fn an_archive_is_verified_and_unpacked() {
    for (file, program) in [("github-actions.yml", "etalon/bin/etalon"), ("gitlab-ci.yml", "tools/bin/etalon")] {
        let place = tempfile::tempdir().expect("a folder");
        let here = place.path();
        fs::create_dir_all(here.join("etalon-1.0/bin")).expect("a folder");
        fs::create_dir_all(here.join("archives")).expect("a folder");
        stand_in(&here.join("etalon-1.0/bin"), 0);
        let pack = "tar -czf archives/etalon-1.0.tar.gz etalon-1.0 && cd archives && \
                    sha256sum etalon-1.0.tar.gz > etalon-1.0.sha256";
        assert_eq!(run(&mut sh(here, pack, &[])).0, 0);
        let text = fs::read_to_string(examples().join("ci").join(file)).expect("a file");
        let install = format!("set -e\n{}", step(&text, "install"));
        let home = here.to_str().expect("text");
        let variables = [("ETALON", "archives"), ("HOME", home), ("GITHUB_PATH", "path")];
        let (code, said) = run(&mut sh(here, &install, &variables));
        assert_eq!(code, 0, "{file}: {said}");
        assert!(here.join(program).is_file(), "{file}");
        // One byte changed on the way: nothing is installed.
        fs::remove_file(here.join(program)).expect("there");
        let mut bytes = fs::read(here.join("archives/etalon-1.0.tar.gz")).expect("there");
        bytes[9] ^= 1;
        fs::write(here.join("archives/etalon-1.0.tar.gz"), bytes).expect("writable");
        assert_ne!(run(&mut sh(here, &install, &variables)).0, 0, "{file}");
        assert!(!here.join(program).exists(), "{file}");
    }
}

/// A program called etalon that does nothing and ends with a code.
fn stand_in(folder: &Path, code: i32) {
    let program = folder.join("etalon");
    fs::write(&program, format!("#!/bin/sh\nexit {code}\n")).expect("writable");
    assert_eq!(run(&mut sh(folder, "chmod +x etalon", &[])).0, 0);
}
