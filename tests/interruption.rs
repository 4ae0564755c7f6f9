//! Death at any moment: `etalon reference` is killed again and again, begun again with the same command, and in the
//! end has to leave the bytes of a run that nobody disturbed, and nothing else.
#![cfg(unix)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Patches with elements: both castings are to be interrupted.
const SCENE: &str = "builtin:dynamic-cube";

fn command(folder: &Path, rays: &str, threads: &str) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("etalon"));
    command.current_dir(folder).env("NO_COLOR", "1").stdout(Stdio::null()).stderr(Stdio::piped());
    command.args(["reference", SCENE, "-o", "ref", "--rays", rays, "--threads", threads]);
    command
}

/// Files of a reference but for its clock.
fn files(reference: &Path) -> Vec<(String, Vec<u8>)> {
    let mut out: Vec<_> = fs::read_dir(reference)
        .expect("a reference")
        .map(|e| e.expect("an entry").path())
        .filter(|p| p.file_name().is_some_and(|n| n != "timing.json"))
        .map(|p| (p.file_name().expect("a name").to_string_lossy().into_owned(), fs::read(&p).expect("readable")))
        .collect();
    out.sort();
    out
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .expect("a folder")
        .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// Numbers in [0, 1) that depend on the seed alone.
struct Moments(u64);

impl Moments {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Where the killed process was, by what it left.
#[derive(Debug, Default)]
struct Kills {
    /// Before the first row was on the disk.
    before: u32,
    /// While rays were cast or the system was solved.
    within: u32,
    /// While the reference was written, or after that.
    storing: u32,
    /// Runs that came to their end before they could be killed.
    escaped: u32,
    /// Runs that found rows of an earlier one.
    resumed: u32,
}

fn kill(mut child: Child) -> bool {
    let ended = child.try_wait().expect("a child").is_some();
    let _ = child.kill();
    let output = child.wait_with_output().expect("a child");
    if ended {
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{message}");
    }
    !ended
}

fn kill_at_random_moments(kills: u32, rays: &str, seed: u64) {
    let undisturbed = tempfile::tempdir().expect("a folder");
    let begin = Instant::now();
    let output = command(undisturbed.path(), rays, "2").output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let whole = begin.elapsed();
    let expected = files(&undisturbed.path().join("ref"));

    let mut moments = Moments(seed);
    let (mut count, mut done, mut chains) = (Kills::default(), 0, 0);
    while done < kills {
        let place = tempfile::tempdir().expect("a folder");
        let (target, part) = (place.path().join("ref"), place.path().join("ref.part"));
        let mut finished = false;
        // Each run goes on where the last one was killed.
        while !finished && done < kills {
            let had_rows = part.join("journal").metadata().is_ok_and(|m| m.len() > 1000);
            count.resumed += u32::from(had_rows);
            let child = command(place.path(), rays, if done % 2 == 0 { "1" } else { "2" }).spawn().expect("it runs");
            let moment = moments.next();
            match done % 3 {
                // Any time, then the beginning, then the end: both are short, and chance would pass them by.
                0 => std::thread::sleep(whole.mul_f64(1.1 * moment)),
                1 => std::thread::sleep(Duration::from_secs_f64(0.3 * moment)),
                _ => {
                    wait_for_any(&[&part.join("new"), &target]);
                    std::thread::sleep(Duration::from_secs_f64(0.03 * moment));
                }
            }
            if kill(child) {
                done += 1;
                if target.exists() || part.join("new").exists() {
                    count.storing += 1;
                } else if part.join("journal").exists() {
                    count.within += 1;
                } else {
                    count.before += 1;
                }
            } else {
                count.escaped += 1;
                finished = true;
            }
            if target.exists() {
                assert!(files(&target) == expected, "a reference that is there is whole");
                finished = true;
            }
        }
        let last = command(place.path(), rays, "2").output().expect("it runs");
        assert!(last.status.success(), "{}", String::from_utf8_lossy(&last.stderr));
        assert!(files(&target) == expected, "other bytes after {done} kills");
        assert_eq!(names(place.path()), ["ref"], "something was left behind");
        chains += 1;
    }
    println!("one run takes {whole:.1?}; {done} kills in {chains} references, all of the same bytes: {count:?}");
}

#[test]
fn killed_a_few_times() {
    kill_at_random_moments(4, "8192", 1);
}

#[test]
#[ignore = "takes some minutes"]
fn killed_fifty_times() {
    kill_at_random_moments(50, "16384", 2);
}

fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill").args([name, &child.id().to_string()]).status().expect("kill");
    assert!(sent.success());
}

fn wait_for_any(paths: &[&Path]) {
    let begin = Instant::now();
    while !paths.iter().any(|p| p.exists()) {
        assert!(begin.elapsed() < Duration::from_secs(300), "{paths:?} did not come");
        std::thread::sleep(Duration::from_millis(1));
    }
}

fn journal(folder: &Path) -> PathBuf {
    folder.join("ref.part/journal")
}

#[test]
fn interrupted_politely_it_says_what_is_kept_and_goes_on() {
    let undisturbed = tempfile::tempdir().expect("a folder");
    let place = tempfile::tempdir().expect("a folder");
    assert!(command(undisturbed.path(), "131072", "2").status().expect("it runs").success());
    for (name, code) in [("-INT", 130), ("-TERM", 143)] {
        let child = command(place.path(), "131072", "1").spawn().expect("it runs");
        wait_for_any(&[&journal(place.path())]);
        std::thread::sleep(Duration::from_millis(300));
        signal(&child, name);
        let output = child.wait_with_output().expect("a child");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{message}");
        assert!(message.contains("interrupted: ") && message.contains("rows are kept"), "{message}");
        assert!(message.contains("the same command goes on from there"), "{message}");
        assert_eq!(names(place.path()), ["ref.part"]);
        assert_eq!(names(&place.path().join("ref.part")), ["journal", "lock"]);
    }
    let output = command(place.path(), "131072", "2").output().expect("it runs");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && message.contains("going on from an interrupted run"), "{message}");
    assert!(files(&place.path().join("ref")) == files(&undisturbed.path().join("ref")));
    assert_eq!(names(place.path()), ["ref"]);
}

#[test]
fn other_commands_leave_nothing() {
    let place = tempfile::tempdir().expect("a folder");
    for arguments in [
        "form-factors builtin:cornell-box -o f.npz --rays 4194304",
        "solve builtin:cornell-box --method gather:rays=4194304 -o s.csv",
        "reference builtin:cornell-box -o ref --rays 4194304 --kernel builtin --json",
        "demo -o page",
    ] {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin("etalon"));
        command.current_dir(place.path()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let child = command.args(arguments.split_whitespace()).spawn().expect("it runs");
        std::thread::sleep(Duration::from_millis(400));
        signal(&child, "-INT");
        let output = child.wait_with_output().expect("a child");
        let (text, message) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.status.code(), Some(130), "{arguments}: {message}");
        if arguments.contains("--json") {
            assert!(message.is_empty() && text.contains("\"interrupted\""), "{text}{message}");
        } else {
            assert!(message.contains("interrupted"), "{message}");
        }
        let left: Vec<String> = names(place.path()).into_iter().filter(|n| n != "ref.part" && n != "page").collect();
        assert_eq!(left, [""; 0], "{arguments}");
    }
}

/// Whoever began the run may be gone: its end of the pipes is closed, and the last words go nowhere.
#[test]
fn nobody_needs_to_listen() {
    let place = tempfile::tempdir().expect("a folder");
    for name in ["-INT", "-TERM"] {
        let mut child = command(place.path(), "4194304", "1").spawn().expect("it runs");
        drop(child.stderr.take());
        wait_for_any(&[&place.path().join("ref.part/lock")]);
        std::thread::sleep(Duration::from_millis(300));
        signal(&child, name);
        let begin = Instant::now();
        let status = loop {
            match child.try_wait().expect("a child") {
                Some(status) => break status,
                None if begin.elapsed() > Duration::from_secs(60) => {
                    let _ = child.kill();
                    panic!("{name}: it does not end");
                }
                None => std::thread::sleep(Duration::from_millis(10)),
            }
        };
        assert_eq!(status.code(), Some(if name == "-INT" { 130 } else { 143 }));
    }
}
