//! What goes to the terminal: results on stdout, everything else on stderr, bars only for people.

use super::args::Global;
use super::exit::Failure;
use crate::reference::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::Value;
use std::io::{IsTerminal, Write};
use std::sync::Mutex;

/// The user's terminal.
pub struct Console {
    json: bool,
    quiet: bool,
    verbose: bool,
    bar: Mutex<ProgressBar>,
}

impl Console {
    /// The console that the options ask for.
    pub fn new(global: &Global) -> Self {
        Self { json: global.json, quiet: global.quiet, verbose: global.verbose, bar: Mutex::new(ProgressBar::hidden()) }
    }

    /// Prints one JSON object on stdout.
    pub fn print_json(value: &Value) {
        Self::print(&serde_json::to_string_pretty(value).expect("values serialise"));
    }

    /// Prints a line on stdout; a reader that has gone away is not an error.
    pub fn print(line: &str) {
        let _ = writeln!(std::io::stdout(), "{line}");
    }

    /// Prints a line on stderr; nobody listening is no reason to die of a panic.
    pub fn tell(line: &str) {
        let _ = writeln!(std::io::stderr(), "{line}");
    }

    /// A result: `text` for people, `json` for programs.
    pub fn result(&self, text: &str, json: &Value) {
        if self.json {
            Self::print_json(json);
        } else {
            Self::print(text);
        }
    }

    /// True if only what was asked for is to be said.
    pub fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// Something the user should know, on stderr.
    pub fn notice(&self, text: &str) {
        if !self.quiet && !self.json {
            self.above_bar(&format!("note: {text}"));
        }
    }

    /// Something for the curious, on stderr.
    pub fn detail(&self, text: &str) {
        if self.verbose && !self.json {
            self.above_bar(text);
        }
    }

    /// Why the command ended.
    pub fn failure(&self, failure: &Failure) {
        self.end();
        if self.json {
            Self::print_json(&failure.json());
            return;
        }
        match &failure.drawn {
            Some(drawn) => Self::tell(drawn),
            None => Self::tell(&format!("error: {}", failure.message)),
        }
    }

    /// Takes the progress bar away.
    pub fn end(&self) {
        self.bar.lock().unwrap_or_else(std::sync::PoisonError::into_inner).finish_and_clear();
    }

    fn above_bar(&self, line: &str) {
        self.bar.lock().unwrap_or_else(std::sync::PoisonError::into_inner).suspend(|| Self::tell(line));
    }

    fn shows_bars(&self) -> bool {
        !self.quiet && !self.json && std::io::stderr().is_terminal()
    }
}

impl Progress for Console {
    fn begin(&self, what: &str, total: Option<u64>) {
        self.end();
        if !self.shows_bars() {
            return;
        }
        let known = "{msg:<24} {bar:32} {percent:>3}%  {per_sec}  {eta} left";
        let unknown = "{msg:<24} {spinner} {human_pos}  {per_sec}  {elapsed}";
        let template = if total.is_some() { known } else { unknown };
        let bar = ProgressBar::with_draw_target(total, ProgressDrawTarget::stderr());
        bar.set_style(ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.set_message(what.to_string());
        *self.bar.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = bar;
    }

    fn advance(&self, steps: u64) {
        self.bar.lock().unwrap_or_else(std::sync::PoisonError::into_inner).inc(steps);
    }
}
