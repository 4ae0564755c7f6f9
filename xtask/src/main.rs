//! `cargo xtask demo`, `cargo xtask test`, `cargo xtask ci`: the set-up that a bare machine needs, and the work.

mod dist;
mod exact;
mod peers;

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, ExitStatus};

const HELP: &str = "\
cargo xtask demo   build, provide Embree if there is none, run the Cornell box to a report
cargo xtask test   the same set-up, then every test, also those of the feature embree4-rs
cargo xtask ci     formatting, lints and documentation, all with warnings as errors
cargo xtask dist   an archive that installs without a checkout, unpacked and run as proof (--help says more)
cargo xtask gallery  the pictures of the README, into reports/gallery; --all adds the robot room (ten minutes)
cargo xtask exact  exact form factors of obstructed pairs, from standard input to standard output
cargo xtask peers  other programs for form factors beside etalon: error against time (--help says more)
Further arguments go to `etalon demo` or `cargo test`.";

/// Examples of the library that have to run, not only to compile.
const EXAMPLES: [&str; 2] = ["check_a_solver", "examine_a_scene"];

/// What stopped a task: what was run, and how it ended.
struct Stopped(String);

fn main() -> ExitCode {
    let mut arguments = env::args().skip(1);
    let task = arguments.next();
    let rest: Vec<String> = arguments.collect();
    let done = match task.as_deref() {
        Some("demo") => demo(&rest),
        Some("test") => test(&rest),
        Some("ci") => ci(),
        Some("dist") => dist::dist(&rest),
        Some("gallery") => gallery(&rest),
        Some("peers") => peers::peers(&rest),
        Some("exact") => exact::run(threads()).map_err(Stopped),
        Some("help" | "--help" | "-h") => {
            println!("{HELP}");
            return ExitCode::SUCCESS;
        }
        _ => {
            eprintln!("{HELP}");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(Stopped(what)) => {
            eprintln!("xtask: {what}");
            ExitCode::FAILURE
        }
    }
}

fn demo(rest: &[String]) -> Result<(), Stopped> {
    set_up()?;
    run(etalon().arg("demo").args(rest))
}

fn test(rest: &[String]) -> Result<(), Stopped> {
    set_up()?;
    run(cargo().args(["test", "--release", "--workspace"]).args(rest))?;
    run(cargo().args(["test", "--release", "--features", "embree4-rs", "--test", "kernels_agree"]))?;
    EXAMPLES.iter().try_for_each(|e| run(cargo().args(["run", "--release", "--example", e])))
}

/// Makes the committed pictures again.
fn gallery(rest: &[String]) -> Result<(), Stopped> {
    set_up()?;
    let folder = workspace().join("reports").join("gallery");
    let program = target().join("release").join("etalon");
    run(cargo().args(["run", "--release", "--example", "gallery", "--"]).args(rest).arg(program).arg(folder))
}

fn ci() -> Result<(), Stopped> {
    run(cargo().args(["fmt", "--all", "--check"]))?;
    for features in [&[][..], &["--features", "embree4-rs"]] {
        let lint = ["clippy", "--workspace", "--all-targets", "--locked"];
        run(cargo().args(lint).args(features).args(["--", "-D", "warnings"]))?;
    }
    let document = ["doc", "--workspace", "--no-deps", "--document-private-items", "--locked"];
    run(cargo().args(document).env("RUSTDOCFLAGS", "-D warnings"))
}

/// Builds, and provides Embree. Doing without it is no failure.
fn set_up() -> Result<(), Stopped> {
    run(cargo().args(["build", "--release", "--locked"]))?;
    if run(etalon().args(["setup", "embree"])).is_err() {
        eprintln!("xtask: no Embree: rays are traced by the built-in kernel, several times slower,");
        eprintln!("xtask: and tests that compare the two kernels are skipped with a notice");
    }
    Ok(())
}

fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

fn cargo() -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(workspace());
    command
}

/// The program just built. It runs where the user is, so that paths mean what they say.
fn etalon() -> Command {
    Command::new(target().join("release").join("etalon"))
}

fn target() -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace().join("target"), PathBuf::from)
}

fn workspace() -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.parent().unwrap_or(own).to_owned()
}

fn run(command: &mut Command) -> Result<(), Stopped> {
    eprintln!("xtask: {}", in_words(command));
    let words = in_words(command);
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(Stopped(format!("{words} {}", how_it_ended(status)))),
        Err(e) => Err(Stopped(format!("{words} cannot be run: {e}"))),
    }
}

fn in_words(command: &Command) -> String {
    let name = Path::new(command.get_program()).file_stem().unwrap_or_default();
    let words = std::iter::once(name).chain(command.get_args());
    words.map(|w| w.to_string_lossy()).collect::<Vec<_>>().join(" ")
}

fn how_it_ended(status: ExitStatus) -> String {
    status.code().map_or_else(|| "was killed".to_owned(), |code| format!("ended with code {code}"))
}
