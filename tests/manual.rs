//! Completions and manual pages, against what `--help` says.

#[path = "common/program.rs"]
mod program;

use program::{json, ok, refused};
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

/// Names that `--help` lists under "Commands:".
fn listed(help: &str) -> Vec<String> {
    let list = help.lines().skip_while(|l| *l != "Commands:").skip(1).take_while(|l| !l.is_empty());
    // Wrapped lines are indented deeper.
    let names = list.filter(|l| l.starts_with("  ") && !l.starts_with("   "));
    names.map(|l| l.split_whitespace().next().expect("a name").to_string()).filter(|n| n != "help").collect()
}

/// Every command line of the program, from its help alone: "", "scene", "scene check", ...
fn command_lines(here: &Path) -> Vec<String> {
    let mut all = vec![String::new()];
    let mut next = 0;
    while next < all.len() {
        let own = all[next].clone();
        all.extend(listed(&ok(here, &format!("{own} --help"))).iter().map(|n| format!("{own} {n}").trim().to_string()));
        next += 1;
    }
    all
}

#[test]
fn every_command_has_its_page() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "man -o pages/man1");
    let names = |folder: &str| -> BTreeSet<String> {
        let files = std::fs::read_dir(here.join(folder)).expect("made");
        files.map(|f| f.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
    };
    let lines = command_lines(here);
    assert!(lines.len() > 25 && lines.iter().any(|l| l == "scene check"), "{lines:?}");
    let page_of = |line: &String| format!("{}.1", format!("etalon {line}").trim().replace(' ', "-"));
    assert_eq!(names("pages/man1"), lines.iter().map(page_of).collect::<BTreeSet<_>>());
    // The same bytes again, and whoever made them cannot be told from them.
    let v = json(here, "man -o again");
    assert_eq!(v["pages"].as_array().map(Vec::len), Some(lines.len()));
    let home = std::env::var("HOME").unwrap_or_else(|_| "/no/such/home".into());
    for name in names("pages/man1") {
        let page = std::fs::read_to_string(here.join("pages/man1").join(&name)).expect("text");
        assert_eq!(page, std::fs::read_to_string(here.join("again").join(&name)).expect("text"), "{name}");
        assert!(page.contains(".SH NAME") && page.contains(".SH SYNOPSIS"), "{name}");
        let heading = format!("\"etalon {}\"", env!("CARGO_PKG_VERSION"));
        let title = page.lines().find(|l| l.starts_with(".TH")).expect("a title");
        assert!(title.contains(&heading), "{name}: {title}");
        assert!(!page.contains(env!("CARGO_MANIFEST_DIR")) && !page.contains(&home), "{name}");
    }
}

#[test]
fn pages_hold_every_option_of_the_help() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    ok(here, "man -o .");
    for line in ["check", "bisect", "reference", "form-factors check"] {
        let page = std::fs::read_to_string(here.join(format!("etalon-{}.1", line.replace(' ', "-")))).expect("a page");
        let plain = page.replace("\\-", "-").replace("\\fB", "").replace("\\fR", "");
        let help = ok(here, &format!("{line} --help"));
        let options = help.split_whitespace().filter(|w| w.starts_with("--") && w.len() > 2);
        let named: BTreeSet<&str> = options.map(|w| w.trim_end_matches([',', '.', ')', ':', ';'])).collect();
        assert!(named.len() > 8, "{line}: {named:?}");
        named.iter().for_each(|o| assert!(plain.contains(o), "{line}: {o}"));
    }
}

#[test]
fn completions_are_scripts_that_know_every_command() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = ok(here, &format!("completions {shell}"));
        for name in listed(&ok(here, "--help")) {
            assert!(script.contains(&name), "{shell}: {name}");
        }
        assert!(script.contains("until-decided") && !script.contains(env!("CARGO_MANIFEST_DIR")), "{shell}");
        assert_eq!(json(here, &format!("completions {shell}"))["shell"], shell);
        // Shells that are here read their script.
        std::fs::write(here.join("script"), &script).expect("writable");
        match Command::new(shell).current_dir(here).args(["-n", "script"]).output() {
            Ok(done) => assert!(done.status.success(), "{shell}: {}", String::from_utf8_lossy(&done.stderr)),
            Err(e) => println!("{shell} is not here, its script was not read: {e}"),
        }
    }
}

#[test]
fn bash_completes_options_and_values() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    std::fs::write(here.join("etalon.bash"), ok(here, "completions bash")).expect("writable");
    let ask = "source ./etalon.bash; COMP_WORDS=(etalon check --on-inconclusive ''); COMP_CWORD=3; \
               _etalon etalon '' --on-inconclusive; echo \"${COMPREPLY[@]}\"; \
               COMP_WORDS=(etalon check --max-w); COMP_CWORD=2; _etalon etalon --max-w check; echo \"${COMPREPLY[@]}\"";
    let Ok(done) = Command::new("bash").current_dir(here).args(["-c", ask]).output() else {
        println!("bash is not here: what it completes was not looked at");
        return;
    };
    let said = String::from_utf8_lossy(&done.stdout).into_owned();
    assert_eq!(said.lines().collect::<Vec<_>>(), ["pass fail", "--max-worst --max-worse"], "{done:?}");
}

#[test]
fn what_cannot_be_written_is_refused() {
    let place = tempfile::tempdir().expect("a folder");
    let here = place.path();
    std::fs::write(here.join("taken"), "a file").expect("writable");
    assert!(refused(here, "man -o taken").contains("not a folder"));
    assert!(refused(here, "completions cmd").contains("bash"));
    assert!(refused(here, "man").contains("--output"));
}
