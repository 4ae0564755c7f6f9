//! The records of a View3D file: lines of words, comments taken out.

use crate::io::scene::source::Source;
use std::ops::Range;

/// A word and where it stands.
#[derive(Debug, Clone)]
pub(super) struct Word<'a> {
    pub text: &'a str,
    pub span: Range<usize>,
}

/// What one line says; in the geometry 3a also the numbers on the lines that follow.
#[derive(Debug)]
pub(super) struct Record<'a> {
    /// First letter of the first word, a capital; other characters as they are.
    pub key: char,
    /// The words, the first included.
    pub words: Vec<Word<'a>>,
    /// The rest of the line after the first word, comments included: titles hold anything.
    pub rest: &'a str,
}

impl Record<'_> {
    /// From the first word to the last.
    pub(super) fn span(&self) -> Range<usize> {
        self.words[0].span.start..self.words[self.words.len() - 1].span.end
    }
}

/// All records before the end of data (`E...`, `*`, or the end of the file).
pub(super) fn records(source: &Source) -> Vec<Record<'_>> {
    let mut records = Vec::new();
    let mut start = 0;
    for line in source.text.split_inclusive('\n') {
        let words = words(line, start);
        start += line.len();
        let Some(first) = words.first() else { continue };
        let key = first.text.chars().next().map_or(' ', |c| c.to_ascii_uppercase());
        if matches!(key, 'E' | '*') {
            break;
        }
        let rest = source.text[first.span.end..start].trim();
        records.push(Record { key, words, rest });
    }
    records
}

/// Words are parted by blanks, tabs and commas; `!`, or `/` at the start of a word, begins a comment.
fn words(line: &str, start: usize) -> Vec<Word<'_>> {
    let code = line.split('!').next().unwrap_or_default();
    let mut words: Vec<Word> = Vec::new();
    let mut from = None;
    let ends = code.char_indices().chain(std::iter::once((code.len(), ' ')));
    for (at, c) in ends {
        let parts = c.is_whitespace() || c == ',' || c == '\u{feff}';
        match (from, parts) {
            (None, false) if c == '/' => break,
            (None, false) => from = Some(at),
            (Some(begin), true) => {
                words.push(Word { text: &code[begin..at], span: start + begin..start + at });
                from = None;
            }
            _ => {}
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn comments_go_and_the_end_ends() {
        let text = "T a title! with / marks\n! all\n/ all\n s 1, 2\t3 ! four\n\nEnd of data\nV 1 0 0 0\n";
        let source = Source::new(Path::new("a.vs3"), text.into());
        let found = records(&source);
        assert_eq!(found.iter().map(|r| r.key).collect::<String>(), "TS");
        assert_eq!(found[0].rest, "a title! with / marks");
        assert_eq!(found[1].words.iter().map(|w| w.text).collect::<Vec<_>>(), ["s", "1", "2", "3"]);
        assert_eq!(&text[found[1].words[3].span.clone()], "3");
    }
}
