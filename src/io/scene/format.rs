//! The format line, and what the TOML reader has to say.

use super::check::{Check, Checked, nearest};
use super::error::{Refusal, SceneFileError};
use super::raw;
use super::source::Source;

/// The format line first: whatever else is unknown in a newer file is no mistake of its author.
pub(super) fn check_format(check: Check, own: &str) -> Checked<()> {
    let read: raw::FormatLine = toml::from_str(&check.source.text).map_err(|e| syntax(check.source, &e))?;
    let write_it = format!("write format = \"{own}\" in the first line");
    let Some(format) = read.format else {
        let first = 0..check.source.text.lines().next().map_or(0, str::len);
        return check.refuse(Refusal::Format, first, "the format line is missing", write_it);
    };
    let found = format.get_ref();
    if found == own {
        return Ok(());
    }
    let family = own.trim_end_matches(|c: char| c.is_ascii_digit());
    let newer = found.strip_prefix(family).and_then(|v| v.parse::<u32>().ok()).is_some_and(|v| v > 1);
    let shown = found.escape_debug();
    match newer {
        true => check.refuse(
            Refusal::Format,
            format.span(),
            format!("the format \"{shown}\" is newer than this program, which reads {own}"),
            "update etalon",
        ),
        false => check.refuse(Refusal::Format, format.span(), format!("unknown format \"{shown}\""), write_it),
    }
}

/// A message of the TOML reader, with the nearest key where one is unknown.
pub(super) fn syntax(source: &Source, e: &toml::de::Error) -> SceneFileError {
    let span = e.span().unwrap_or(0..0);
    let message = e.message().trim().replace('\n', ", ");
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let (refusal, mend) = match quoted.as_slice() {
        [unknown, known @ ..] if message.starts_with("unknown field") => {
            let mend = match nearest(unknown, known.iter().copied()) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => "leave it out; references/scene-format.md lists all keys".into(),
            };
            (Refusal::Key, mend)
        }
        [key, ..] if message.starts_with("missing field") => (Refusal::Key, format!("add {key} = ...")),
        _ => (Refusal::Syntax, "correct the line".into()),
    };
    SceneFileError::new(source, refusal, span, message).mend(mend)
}
