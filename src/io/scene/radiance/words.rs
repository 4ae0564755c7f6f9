//! The words of a Radiance file: comments taken out, commands kept whole.

use crate::io::scene::source::Source;
use std::ops::Range;

/// A word and where it stands.
#[derive(Debug, Clone)]
pub(super) struct Word<'a> {
    pub text: &'a str,
    pub span: Range<usize>,
}

/// Walks over a file.
pub(super) struct Words<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Words<'a> {
    pub(super) fn of(source: &'a Source) -> Self {
        Self { text: &source.text, at: 0 }
    }

    /// Moves to the next word; `#` at its start begins a comment.
    fn skip(&mut self) {
        loop {
            let rest = &self.text[self.at..];
            self.at += rest.len() - rest.trim_start_matches(|c: char| c.is_whitespace() || c == '\u{feff}').len();
            let rest = &self.text[self.at..];
            if !rest.starts_with('#') {
                return;
            }
            self.at += rest.find('\n').unwrap_or(rest.len());
        }
    }

    /// The next word; those that begin with a quotation mark go on to the next one.
    pub(super) fn next(&mut self) -> Option<Word<'a>> {
        self.skip();
        let rest = &self.text[self.at..];
        let first = rest.chars().next()?;
        let start = self.at;
        if matches!(first, '"' | '\'')
            && let Some(length) = rest[1..].find(first)
        {
            self.at += length + 2;
            return Some(Word { text: &rest[1..1 + length], span: start..self.at });
        }
        let length = rest.find(char::is_whitespace).unwrap_or(rest.len());
        self.at += length;
        Some(Word { text: &rest[..length], span: start..self.at })
    }

    /// The command that stands here (`!` to the end of the line, which a backslash carries on), if one does.
    pub(super) fn command(&mut self) -> Option<Word<'a>> {
        self.skip();
        let rest = &self.text[self.at..];
        if !rest.starts_with('!') {
            return None;
        }
        let mut length = 0;
        for line in rest.split_inclusive('\n') {
            length += line.len();
            if !line.trim_end_matches(['\n', '\r']).ends_with('\\') {
                break;
            }
        }
        let start = self.at;
        self.at += length;
        Some(Word { text: &rest[1..length], span: start..start + rest[..length].trim_end().len() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn comments_go_and_commands_stay_whole() {
        let text = "# first\n a b#c # more\n!genbox m b \\\n 1 2 3 # not a comment\n\"two words\" d";
        let source = Source::new(Path::new("a.rad"), text.into());
        let mut words = Words::of(&source);
        assert!(words.command().is_none());
        assert_eq!([words.next(), words.next()].map(|w| w.unwrap().text), ["a", "b#c"]);
        let command = words.command().unwrap();
        assert_eq!(command.text.split_whitespace().collect::<Vec<_>>()[..4], ["genbox", "m", "b", "\\"]);
        let quoted = words.next().unwrap();
        assert_eq!((quoted.text, &text[quoted.span.clone()]), ("two words", "\"two words\""));
        assert_eq!(words.next().unwrap().text, "d");
        assert!(words.next().is_none());
    }
}
