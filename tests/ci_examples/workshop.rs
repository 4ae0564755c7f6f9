//! A project of somebody who has a solver: its scene, its solver, its history; and the shell that a CI would run.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What the solver keeps with 2 x 2 points a patch (5.7 %), and no planted mistake does (12 % and more).
pub const LIMITS: &str = "--reflected --max-rms 8%";
/// One second, and noise far below the limit.
const REFERENCE: &str = "--rays 4096";

/// A temporary project.
pub struct Workshop {
    place: tempfile::TempDir,
}

impl Workshop {
    /// None, with a note, where there is no Python that the solver runs on.
    pub fn new() -> Option<Self> {
        let python = Command::new("python3").args(["-c", "import tomllib"]).output();
        if !python.is_ok_and(|o| o.status.success()) {
            println!("no Python 3.11 here: the solver in Python was not run, nor what checks it");
            return None;
        }
        Some(Self { place: tempfile::tempdir().expect("a folder") })
    }

    /// Its folder.
    pub fn here(&self) -> &Path {
        self.place.path()
    }

    /// The folder of its history.
    pub fn repository(&self) -> PathBuf {
        self.here().join("repository")
    }

    /// The scene: the coarse Cornell box.
    pub fn scene(&self) -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("references/scenes/cornell-box-coarse.toml")
    }

    /// Text of a file.
    pub fn read(&self, file: &str) -> String {
        fs::read_to_string(self.here().join(file)).unwrap_or_else(|e| panic!("{file}: {e}"))
    }

    /// The command that solves, with a planted bug if one is named.
    pub fn solver(&self, bug: &str) -> String {
        let program = examples().join("solver/solver.py");
        let bug = if bug.is_empty() { String::new() } else { format!(" --bug {bug}") };
        format!("python3 '{}' \"$SCENE\" \"$PATCHES\" -o \"$SOLUTION\" --points 2{bug}", program.display())
    }

    /// Runs check.sh from a folder that is not its own.
    pub fn check_sh(&self, variables: &[(&str, &str)]) -> (i32, String) {
        let script = format!("sh '{}'", examples().join("ci/check.sh").display());
        let mut command = sh(self.here(), &script, &[("LIMITS", LIMITS), ("REFERENCE", REFERENCE)]);
        run(command.env("SCENE", self.scene()).envs(variables.iter().copied()))
    }

    /// Lays out the project that a workflow takes for granted; returns its variables, with fewer rays and points.
    pub fn project(&self, own: &[(String, String)]) -> Vec<(String, String)> {
        fs::create_dir(self.here().join("scenes")).expect("a folder");
        fs::copy(self.scene(), self.here().join("scenes/room.toml")).expect("a copy");
        fs::copy(examples().join("solver/solver.py"), self.here().join("solver.py")).expect("a copy");
        assert!(["SCENE", "SOLVER", "SOLUTION", "REFERENCE", "LIMITS"].iter().all(|k| own.iter().any(|(o, _)| o == k)));
        let change = |(key, value): &(String, String)| match key.as_str() {
            "SOLVER" => (key.clone(), format!("{value} --points 2")),
            "REFERENCE" => (key.clone(), REFERENCE.into()),
            "LIMITS" => (key.clone(), LIMITS.into()),
            _ => (key.clone(), value.clone()),
        };
        own.iter().map(change).collect()
    }

    /// The same variables with a planted bug.
    pub fn with_bug(&self, variables: &[(String, String)], bug: &str) -> Vec<(String, String)> {
        let change = |(key, value): &(String, String)| match key.as_str() {
            "SOLVER" => (key.clone(), format!("{value} --bug {bug}")),
            _ => (key.clone(), value.clone()),
        };
        variables.iter().map(change).collect()
    }

    /// Runs a step as a CI does: it ends at the first command that fails.
    pub fn step(&self, script: &str, variables: &[(String, String)]) -> (i32, String) {
        let files = [("GITHUB_OUTPUT", "outputs"), ("GITHUB_STEP_SUMMARY", "job-summary")];
        let own = variables.iter().map(|(k, v)| (k.as_str(), v.as_str()));
        run(sh(self.here(), &format!("set -e\n{script}"), &files).envs(own))
    }

    /// A git repository of the solver with a bug from one of its commits on (counted from 1); none without git.
    pub fn history(&self, bug: &str, commits: usize, planted: usize) -> Option<Vec<String>> {
        if Command::new("git").arg("--version").output().is_err() {
            println!("no git here: nothing was bisected");
            return None;
        }
        let sound = fs::read_to_string(examples().join("solver/solver.py")).expect("a file");
        let line = "parser.add_argument(\"--bug\", ";
        assert!(sound.contains(line), "the solver has another line for --bug");
        let broken = sound.replace(line, &format!("{line}default=\"{bug}\", "));
        fs::create_dir(self.repository()).expect("a folder");
        assert_eq!(run(&mut self.git(&["init", "--quiet"], &[])).0, 0);
        let commit = |number: usize| {
            let text = if number < planted { &sound } else { &broken };
            fs::write(self.repository().join("solver.py"), format!("{text}\n# Change {number}\n")).expect("writable");
            for arguments in [&["add", "solver.py"][..], &["commit", "--quiet", "-m", "a change"]] {
                let (code, said) = run(&mut self.git(arguments, &[]));
                assert_eq!(code, 0, "{said}");
            }
            run(&mut self.git(&["rev-parse", "HEAD"], &[])).1.trim().to_string()
        };
        Some((1..=commits).map(commit).collect())
    }

    /// Git in the history, whatever the settings of this machine.
    pub fn git(&self, arguments: &[&str], variables: &[(&str, &str)]) -> Command {
        let mut command = Command::new("git");
        let author = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"];
        command.args(author).args(arguments).current_dir(self.repository());
        command.env("GIT_CONFIG_GLOBAL", "/dev/null").env("GIT_CONFIG_NOSYSTEM", "1");
        command.env("PATH", path()).env("SCENE", self.scene()).env("REFERENCE", REFERENCE);
        command.envs(variables.iter().copied());
        command
    }
}

/// The folder that is put to use.
pub fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples")
}

/// A PATH that finds the program under test first.
fn path() -> String {
    let program = assert_cmd::Command::cargo_bin("etalon").expect("the binary").get_program().to_owned();
    let folder = Path::new(&program).parent().expect("a folder").display().to_string();
    format!("{folder}:{}", std::env::var("PATH").expect("a path"))
}

/// A shell with a script, in a folder; variables of its callers that would change it are taken away.
pub fn sh(folder: &Path, script: &str, variables: &[(&str, &str)]) -> Command {
    let mut command = Command::new("sh");
    command.args(["-c", script]).current_dir(folder).env("PATH", path()).env("NO_COLOR", "1");
    for inherited in ["SCENE", "SOLVER", "SOLUTION", "LIMITS", "ACCEPTED", "CHANGE", "OUTPUT", "CACHE", "ETALON"] {
        command.env_remove(inherited);
    }
    command.env("REFERENCE", REFERENCE).envs(variables.iter().copied());
    command
}

/// Exit code, and what was said on both channels.
pub fn run(command: &mut Command) -> (i32, String) {
    let output = command.output().expect("it runs");
    let said = [output.stdout, output.stderr].concat();
    (output.status.code().expect("a code"), String::from_utf8_lossy(&said).into_owned())
}

/// Name and shell text of every block that begins with "# step: NAME".
pub fn steps(text: &str) -> Vec<(String, String)> {
    let lines: Vec<&str> = text.lines().collect();
    let begins = |line: &str| line.trim_start().strip_prefix("# step: ").map(str::to_owned);
    let depth = |line: &str| line.len() - line.trim_start().len();
    let block = |(at, line): (usize, &&str)| {
        let name = begins(line)?;
        let own = depth(line);
        let body = lines[at..].iter().take_while(|l| l.trim().is_empty() || depth(l) >= own);
        Some((name, body.map(|l| format!("{}\n", l.get(own..).unwrap_or_default())).collect()))
    };
    lines.iter().enumerate().filter_map(block).collect()
}

/// One of them.
pub fn step(text: &str, name: &str) -> String {
    let found = steps(text).into_iter().find(|(n, _)| n == name);
    found.unwrap_or_else(|| panic!("no step {name}")).1
}

/// Keys and values of the block under a line, comments taken off.
pub fn lines_under(text: &str, heading: &str) -> Vec<(String, String)> {
    let depth = |line: &str| line.len() - line.trim_start().len();
    let mut lines = text.lines().skip_while(|l| l.trim() != heading);
    let own = depth(lines.next().unwrap_or_else(|| panic!("no {heading}")));
    let pair = |line: &str| {
        let (key, value) = line.trim().split_once(": ").unwrap_or_else(|| panic!("not a pair: {line}"));
        let value = value.split_once(" # ").map_or(value, |(v, _)| v);
        (key.to_string(), value.trim().to_string())
    };
    lines.take_while(|l| depth(l) > own).map(pair).collect()
}
