//! `etalon completions` and `etalon man`: written from the one definition of the command line.

use crate::cli::args::{Cli, CompletionsArgs, ManArgs};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::io::atomic;
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use serde_json::json;

/// Prints the script that completes commands and options in a shell.
pub fn completions(args: &CompletionsArgs, console: &Console) -> Result<u8, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "etalon", &mut script);
    let script = String::from_utf8_lossy(&script);
    console.result(script.trim_end(), &json!({ "shell": args.shell.to_string(), "script": script }));
    Ok(exit::DONE)
}

/// Writes a manual page per command. Pages carry the version and no date: the same version writes the same bytes.
pub fn man(args: &ManArgs, console: &Console) -> Result<u8, Failure> {
    let pages = pages();
    atomic::create_folder(&args.output)?;
    for (name, page) in &pages {
        atomic::write(&args.output.join(name), page)?;
    }
    let names: Vec<&str> = pages.iter().map(|(name, _)| name.as_str()).collect();
    let folder = args.output.display().to_string();
    let text = format!("{} manual pages written to {folder}; man -l {folder}/etalon.1 shows the first", names.len());
    console.result(&text, &json!({ "folder": folder, "pages": names }));
    Ok(exit::DONE)
}

/// File names and contents, a command before its subcommands.
fn pages() -> Vec<(String, Vec<u8>)> {
    let mut program = Cli::command().disable_help_subcommand(true);
    program.build();
    let mut pages = Vec::new();
    collect(&program, &mut pages);
    pages
}

fn collect(command: &Command, pages: &mut Vec<(String, Vec<u8>)>) {
    // Before `Man` renames it: a page of a subcommand is of this program and its version too.
    let source = format!("etalon {}", env!("CARGO_PKG_VERSION"));
    let page = Man::new(command.clone()).source(source).manual("etalon");
    let mut bytes = Vec::new();
    page.render(&mut bytes).expect("memory takes everything");
    pages.push((page.get_filename(), bytes));
    command.get_subcommands().filter(|c| !c.is_hide_set()).for_each(|c| collect(c, pages));
}
