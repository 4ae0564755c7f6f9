//! The reference store in the hands of impatient people: asked twice, by two at once, on full and forbidden disks.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

fn etalon(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("etalon"));
    command.current_dir(folder).env("NO_COLOR", "1").args(arguments.split_whitespace());
    command
}

fn run(folder: &Path, arguments: &str) -> Output {
    etalon(folder, arguments).output().expect("it runs")
}

fn ok(folder: &Path, arguments: &str) -> (String, String) {
    let out = run(folder, arguments);
    let text = |b: &[u8]| String::from_utf8_lossy(b).into_owned();
    assert_eq!(out.status.code(), Some(0), "{arguments}\n{}{}", text(&out.stdout), text(&out.stderr));
    (text(&out.stdout), text(&out.stderr))
}

fn refused(folder: &Path, arguments: &str) -> String {
    let out = run(folder, arguments);
    let message = String::from_utf8_lossy(&out.stderr).into_owned();
    assert_eq!(out.status.code(), Some(2), "{arguments}\n{message}");
    message
}

/// Bytes and times of the files of a folder.
fn state(folder: &Path) -> Vec<(String, Vec<u8>, std::time::SystemTime)> {
    let mut out: Vec<_> = fs::read_dir(folder)
        .expect("a folder")
        .map(|e| e.expect("an entry").path())
        .map(|p| {
            let changed = p.metadata().and_then(|m| m.modified()).expect("a time");
            (p.display().to_string(), fs::read(&p).expect("readable"), changed)
        })
        .collect();
    out.sort();
    out
}

fn bytes(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let of = |s: (String, Vec<u8>, _)| (s.0.rsplit('/').next().expect("a name").to_string(), s.1);
    state(folder).into_iter().map(of).filter(|(n, _)| n != "timing.json").collect()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .expect("a folder")
        .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

const BASE: &str = "reference builtin:cube-one-emitter --estimator rays -o ref";

#[test]
fn a_reference_that_suffices_is_not_computed_again() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, &format!("{BASE} --rays 4096"));
    let before = state(&here.join("ref"));
    for more in ["--rays 4096", "--rays 2048", "--rays 4000", "--target-error 50%", "--rays 4096 --threads 1"] {
        let (text, message) = ok(here, &format!("{BASE} {more}"));
        assert!(text.contains("already there") && message.is_empty(), "{more}: {text}{message}");
        assert!(state(&here.join("ref")) == before, "{more}: something was written");
    }
    let (text, _) = ok(here, &format!("{BASE} --rays 1024 --json"));
    let json: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!((json["already_there"].as_bool(), json["rays_per_patch"].as_u64()), (Some(true), Some(4096)));
    assert_eq!(names(here), ["ref"]);
}

#[test]
fn a_reference_that_falls_short_is_computed_again_and_the_reason_is_told() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    for (more, reason) in [
        ("--rays 2048", ""),
        ("--rays 4096", "rays per patch 2048, not 4096"),
        ("--rays 4096 --seed 1", "seed 0, not 1"),
        ("--rays 4096 --seed 1 --randomisations 8", "randomisations 16, not 8"),
        ("--rays 4096 --seed 1 --randomisations 8 --kernel builtin", "ray kernel"),
        ("--target-error 0.1% --seed 1 --randomisations 8 --kernel builtin", "relative error"),
        ("--rays 512 --max-edge 0.5", "another scene"),
    ] {
        // Where there is no second kernel the built-in one is in use all the time.
        let (text, message) = ok(here, &format!("{BASE} {more}"));
        let one_kernel = reason == "ray kernel" && text.contains("already there");
        assert!(one_kernel || message.contains(reason), "{more}: {message}");
        assert!(one_kernel || text.contains("written to"), "{more}: {text}");
        // It is what a fresh folder would get.
        ok(here, &format!("{} {more}", BASE.replace("-o ref", "-o fresh")));
        assert!(bytes(&here.join("ref")) == bytes(&here.join("fresh")), "{more}");
        fs::remove_dir_all(here.join("fresh")).expect("removable");
    }
    let clock = here.join("ref/timing.json");
    let before = clock.metadata().and_then(|m| m.modified()).expect("a time");
    let (text, _) = ok(here, &format!("{BASE} --rays 512 --max-edge 0.5 --force"));
    assert!(text.contains("written to") && clock.metadata().and_then(|m| m.modified()).expect("a time") > before);
    // A damaged one is replaced.
    let means = here.join("ref/reference.csv");
    fs::write(&means, "patch,y\n").expect("writable");
    let (_, message) = ok(here, &format!("{BASE} --rays 512 --max-edge 0.5"));
    assert!(message.contains("cannot be used") && message.contains("checksum"), "{message}");
    assert!(fs::read(&means).expect("readable").len() > 20);
    assert_eq!(names(here), ["ref"]);
}

#[test]
fn names_and_cameras_are_stored_and_count() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    let source = include_str!("../references/scenes/opposed-squares.toml");
    fs::write(here.join("s.toml"), source).expect("writable");
    ok(here, "reference s.toml -o ref --rays 256");
    fs::write(here.join("s.toml"), source.replace("name = \"lower\"", "name = \"floor\"")).expect("writable");
    let (_, message) = ok(here, "reference s.toml -o ref --rays 256");
    assert!(message.contains("other names"), "{message}");
    fs::write(here.join("s.toml"), format!("# a comment\n{source}").replace("\"lower\"", "\"floor\""))
        .expect("writable");
    let (text, _) = ok(here, "reference s.toml -o ref --rays 256");
    assert!(text.contains("already there"), "{text}");
}

/// A process that does not outlive a failed test.
struct Ended(std::process::Child);

impl Drop for Ended {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn two_at_once_do_not_mix() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    let long = "reference builtin:cornell-box -o ref --rays 4194304";
    let mut first = Ended(etalon(here, long).stderr(Stdio::null()).stdout(Stdio::null()).spawn().expect("it runs"));
    let begin = Instant::now();
    while !fs::read_to_string(here.join("ref.part/lock")).is_ok_and(|t| t.trim() == first.0.id().to_string()) {
        assert!(begin.elapsed() < Duration::from_secs(60), "the first does not begin");
        std::thread::sleep(Duration::from_millis(10));
    }
    let message = refused(here, "reference builtin:cornell-box -o ref --rays 256");
    assert!(message.contains(&format!("number {}", first.0.id())) && message.contains("wait until"), "{message}");
    let message = refused(here, "reference builtin:furnace -o ./ref/ --rays 256");
    assert!(message.contains("being written"), "{message}");
    // Death is enough: nobody has to remove a lock.
    first.0.kill().expect("killed");
    first.0.wait().expect("ended");
    let (_, message) = ok(here, "reference builtin:furnace -o ref --rays 256");
    assert!(!message.contains("going on"), "{message}");
    assert_eq!(names(here), ["ref"]);
}

/// Runs a command that dies by SIGKILL as soon as its journal holds something whole: a death within the first write
/// leaves nothing to go on from, so the file has to have stood still for a while. A run too fast for that is run again.
#[cfg(unix)]
fn killed_with_a_journal(here: &Path, arguments: &str) {
    for _ in 0..20 {
        if dies_with_a_journal(here, arguments) {
            return;
        }
        let _ = fs::remove_dir_all(here.join("ref"));
        let _ = fs::remove_dir_all(here.join("ref.part"));
    }
    panic!("twenty runs, and none was killed while it had a journal");
}

#[cfg(unix)]
fn dies_with_a_journal(here: &Path, arguments: &str) -> bool {
    let mut child =
        Ended(etalon(here, arguments).stderr(Stdio::null()).stdout(Stdio::null()).spawn().expect("it runs"));
    let journal = here.join("ref.part/journal");
    let begin = Instant::now();
    let (mut before, mut still) = (0, 0);
    while still < 5 {
        assert!(begin.elapsed() < Duration::from_secs(60), "no journal");
        if child.0.try_wait().expect("a child").is_some() {
            return false;
        }
        std::thread::sleep(Duration::from_millis(5));
        let length = journal.metadata().map_or(0, |m| m.len());
        still = if length > 1000 && length == before { still + 1 } else { 0 };
        before = length;
    }
    child.0.kill().expect("killed");
    child.0.wait().expect("ended");
    journal.is_file()
}

#[cfg(unix)]
#[test]
fn a_journal_is_used_only_where_it_fits_and_as_far_as_it_is_sound() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    let command = "reference builtin:cornell-box -o ref --rays 16384";
    ok(here, &command.replace("-o ref", "-o whole"));
    let whole = bytes(&here.join("whole"));
    killed_with_a_journal(here, &format!("{command} --threads 1"));
    let journal = here.join("ref.part/journal");
    let sound = fs::read(&journal).expect("readable");
    let damages: [(&str, Vec<u8>); 4] = [
        ("sound", sound.clone()),
        ("torn", sound[..sound.len() - 7].to_vec()),
        ("changed", {
            let mut changed = sound.clone();
            changed[sound.len() / 2] ^= 4;
            changed
        }),
        ("not a journal", vec![b'x'; 3000]),
    ];
    for (what, damaged) in damages {
        fs::create_dir_all(here.join("ref.part")).expect("a folder");
        fs::write(&journal, damaged).expect("writable");
        let (_, message) = ok(here, command);
        assert_eq!(message.contains("going on"), what == "sound", "{what}: {message}");
        assert!(bytes(&here.join("ref")) == whole, "{what}");
        fs::remove_dir_all(here.join("ref")).expect("removable");
    }
    fs::create_dir_all(here.join("ref.part")).expect("a folder");
    fs::write(&journal, &sound).expect("writable");
    let (_, message) = ok(here, "reference builtin:cornell-box -o ref --rays 256");
    assert!(message.contains("other settings") && message.contains("dropped"), "{message}");
    assert_eq!(names(here), ["ref", "whole"]);
}

/// A run that stops by itself goes through waves; it has to find its way through them again.
#[cfg(unix)]
#[test]
fn waves_go_on_too() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    let command = "reference builtin:cornell-box -o ref --target-error 0.2%";
    ok(here, &command.replace("-o ref", "-o whole"));
    killed_with_a_journal(here, &format!("{command} --threads 1"));
    let (_, message) = ok(here, command);
    assert!(message.contains("going on"), "{message}");
    assert!(bytes(&here.join("ref")) == bytes(&here.join("whole")));
}

#[test]
fn strays_of_the_dead_are_cleared_away() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    fs::write(here.join(".etalon-dead.part"), "half a file").expect("writable");
    fs::write(here.join(".etalon-notes"), "somebody's own").expect("writable");
    ok(here, "solve builtin:furnace --method gather:rays=256 -o s.csv");
    assert_eq!(names(here), [".etalon-notes", "s.csv"]);
}

/// The limit on the size of files stands for a full disk: writing fails in the middle.
#[cfg(unix)]
#[test]
fn a_disk_without_room_is_told_and_nothing_is_left() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    let program = assert_cmd::cargo::cargo_bin("etalon");
    let limited = |arguments: &str| {
        let line = format!("ulimit -f 16; exec {} {arguments}", program.display());
        Command::new("sh").current_dir(here).args(["-c", &line]).output().expect("a shell")
    };
    for (arguments, place) in [
        ("reference builtin:cornell-box-coarse -o ref --rays 1024", "ref: "),
        ("form-factors builtin:cornell-box-coarse -o f.csv --rays 1024", "f.csv"),
        ("scene patches builtin:cornell-box -o p.csv", "p.csv"),
        ("solve builtin:cornell-box --method gather:rays=256 -o s.csv", "s.csv"),
    ] {
        let out = limited(arguments);
        let message = String::from_utf8_lossy(&out.stderr);
        assert_eq!(out.status.code(), Some(2), "{arguments}: {message}");
        assert!(message.contains(place) && message.contains("File too large"), "{arguments}: {message}");
    }
    // The work is kept, and with room it is done at once.
    assert!(names(here).iter().all(|n| n == "ref.part"), "{:?}", names(here));
    ok(here, "reference builtin:cornell-box-coarse -o ref --rays 1024");
    assert_eq!(names(here), ["ref"]);
    if Path::new("/dev/full").exists() {
        #[cfg(unix)]
        std::os::unix::fs::symlink("/dev/full", here.join("full.csv")).expect("a link");
        let message = refused(here, "scene patches builtin:furnace -o full.csv");
        assert!(message.contains("full.csv") && message.contains("No space left"), "{message}");
    }
}

/// Processor time of this process, or of its thread of this name, seconds.
#[cfg(target_os = "linux")]
fn processor_seconds(thread: Option<&str>) -> f64 {
    let tasks = fs::read_dir("/proc/self/task").expect("threads").map(|t| t.expect("a thread").path());
    let named = |t: &std::path::PathBuf| fs::read_to_string(t.join("comm")).is_ok_and(|n| Some(n.trim()) == thread);
    let of = match thread {
        Some(_) => tasks.into_iter().find(named).expect("the thread"),
        None => "/proc/self".into(),
    };
    let stat = fs::read_to_string(of.join("stat")).expect("readable");
    let fields: Vec<&str> = stat.rsplit(')').next().expect("fields").split_whitespace().collect();
    fields[11..13].iter().map(|t| t.parse::<f64>().expect("ticks")).sum::<f64>() / 100.0
}

/// A share is robust where seconds are not: on a busy machine both sides are slow together.
#[cfg(target_os = "linux")]
#[test]
#[ignore = "a measurement; prints what keeping rows costs"]
fn what_keeping_costs() {
    use etalon::estimate::{Block, Checkpoint, FinishedRow, Plan};
    use etalon::io::scene::{SceneOptions, open_scene};
    use etalon::reference::{Kept, Options, Progress};
    use etalon::study::{KeptWork, Session, reference_on};
    use std::sync::atomic::{AtomicU64, Ordering};
    struct Silent;
    impl Progress for Silent {
        fn begin(&self, _: &str, _: Option<u64>) {}
        fn advance(&self, _: u64) {}
    }
    struct Timed<'a>(&'a dyn Checkpoint, AtomicU64);
    impl Checkpoint for Timed<'_> {
        fn restore(&self, block: Block, take: &mut dyn FnMut(FinishedRow)) {
            self.0.restore(block, take);
        }
        fn keep(&self, block: Block, row: &FinishedRow) {
            let begin = Instant::now();
            self.0.keep(block, row);
            self.1.fetch_add(begin.elapsed().as_nanos() as u64, Ordering::Relaxed);
        }
    }
    let scene = open_scene("builtin:cornell-box", &SceneOptions::default()).expect("a scene");
    let stage = scene.at(0).expect("a state");
    let session = Session::open(&stage, etalon::raycast::KernelKind::Auto).expect("a kernel");
    let place = tempfile::tempdir().expect("a folder");
    for rays in [16_384, 65_536, 262_144] {
        let options = Options { plan: Plan { rays, ..Plan::default() }, seed: 0 };
        let path = place.path().join(rays.to_string());
        let work = KeptWork::open(&path, &session, &options).expect("a journal");
        let patches = Timed(work.kept().patches, AtomicU64::new(0));
        let begin = processor_seconds(None);
        let kept = Kept { patches: &patches, ..work.kept() };
        reference_on(&session, &options, &Silent, kept).expect("solvable");
        work.flush();
        let all = processor_seconds(None) - begin;
        let (keeping, writing) = (patches.1.into_inner() as f64 * 1e-9, processor_seconds(Some("journal")));
        println!(
            "{rays} rays per patch: {all:.2} s of processor time, of it {keeping:.3} s to keep rows and {writing:.2} s \
             to write {:.1} MB: {:.2} %",
            path.metadata().expect("a journal").len() as f64 * 1e-6,
            100.0 * (keeping + writing) / all
        );
    }
}
