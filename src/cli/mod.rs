//! Raw arguments, validated plans, progress, exit codes. Results to stdout or the named file, all else to stderr.

mod args;
mod commands;
mod console;
pub mod doctor;
mod exit;
mod interrupt;
pub mod setup;
mod values;

use args::Cli;
use clap::Parser;
use clap::error::ErrorKind;
use console::Console;
use exit::Failure;
use std::ffi::OsString;
use std::sync::Arc;

/// Runs the program on these arguments (the first is its own name); returns the exit code.
pub fn run(arguments: Vec<OsString>) -> u8 {
    let wants_json = arguments.iter().any(|a| a == "--json");
    match Cli::try_parse_from(&arguments) {
        Ok(cli) => std::panic::catch_unwind(|| execute(cli)).unwrap_or_else(|_| report_bug(wants_json)),
        Err(e) if matches!(e.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) => {
            let _ = e.print();
            exit::DONE
        }
        Err(e) if wants_json => {
            Console::print_json(&Failure::input(usage_message(&e)).json());
            exit::BAD_INPUT
        }
        Err(e) => {
            let _ = e.print();
            exit::BAD_INPUT
        }
    }
}

/// The first paragraph of a usage error, on one line.
fn usage_message(e: &clap::Error) -> String {
    let text = e.render().to_string();
    let first: Vec<&str> = text.lines().take_while(|l| !l.trim().is_empty()).map(str::trim).collect();
    first.join(" ").trim_start_matches("error: ").to_string()
}

fn execute(cli: Cli) -> u8 {
    let console = Arc::new(Console::new(&cli.global));
    interrupt::watch(console.clone());
    if let Some(n) = cli.global.threads {
        // Fails only where a pool exists already: in tests that run several commands in one process.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(n.into()).build_global();
    }
    let result = commands::run(&cli, &console);
    interrupt::give_way();
    match result {
        Ok(code) => code,
        Err(failure) => {
            console.failure(&failure);
            failure.code
        }
    }
}

fn report_bug(json: bool) -> u8 {
    let failure = Failure {
        code: exit::BUG,
        message: "this is a bug in etalon, not in your input; the lines above say where".into(),
        place: String::new(),
        drawn: None,
    };
    if json {
        Console::print_json(&failure.json());
    } else {
        Console::tell(&format!("error: {}", failure.message));
    }
    exit::BUG
}
