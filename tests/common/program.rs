//! The program as a script runs it.
#![allow(dead_code)] // Each test file uses a part of it.

use assert_cmd::Command;
use serde_json::Value;
use std::path::Path;

/// `etalon` in a folder, without colour.
pub fn etalon(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("etalon").expect("the binary");
    command.current_dir(folder).env("NO_COLOR", "1");
    command
}

/// Exit code, stdout and stderr of a command line.
pub fn run(folder: &Path, arguments: &str) -> (i32, String, String) {
    let output = etalon(folder).args(arguments.split_whitespace()).output().expect("it runs");
    let text = |b: &[u8]| String::from_utf8_lossy(b).to_string();
    (output.status.code().expect("a code"), text(&output.stdout), text(&output.stderr))
}

/// Stdout of a command that has to succeed.
pub fn ok(folder: &Path, arguments: &str) -> String {
    let (code, out, err) = run(folder, arguments);
    assert_eq!(code, 0, "{arguments}\n{out}\n{err}");
    out
}

/// The message of a command that has to be refused.
pub fn refused(folder: &Path, arguments: &str) -> String {
    let (code, out, err) = run(folder, arguments);
    assert_eq!(code, 2, "{arguments}\n{out}\n{err}");
    err
}

/// The object that a command prints with `--json`.
pub fn json(folder: &Path, arguments: &str) -> Value {
    serde_json::from_str(&ok(folder, &format!("{arguments} --json"))).expect("one JSON object")
}

/// Takes out all fields named `seconds`, which differ from run to run.
pub fn strip_seconds(value: &mut Value) {
    match value {
        Value::Object(o) => {
            o.retain(|name, _| name != "seconds" && !name.ends_with("_seconds"));
            o.values_mut().for_each(strip_seconds);
        }
        Value::Array(a) => a.iter_mut().for_each(strip_seconds),
        _ => {}
    }
}
