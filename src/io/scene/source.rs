//! The text of a file that is being read, and where in it one is.

use std::ops::Range;
use std::path::Path;

/// A file's name and text.
#[derive(Debug, Clone)]
pub(super) struct Source {
    /// File name without its folder, as messages show it.
    pub name: String,
    pub text: String,
}

/// Headers of the blocks that have a name, with the word for them.
const BLOCKS: [(&str, &str); 8] = [
    ("[[surface]]", "surface"),
    ("[[material]]", "material"),
    ("[[camera]]", "camera"),
    ("[[light]]", "light"),
    ("[[receiver]]", "receiver"),
    ("[[edit]]", "edit"),
    ("[[tree]]", "tree"),
    ("[[finish]]", "finish"),
];

impl Source {
    pub(super) fn new(path: &Path, text: String) -> Self {
        let name = path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned());
        Self { name, text }
    }

    /// Line of a byte offset, counted from 1.
    pub(super) fn line(&self, offset: usize) -> usize {
        let end = offset.min(self.text.len());
        self.text.as_bytes()[..end].iter().filter(|b| **b == b'\n').count() + 1
    }

    /// `file:line` of a stretch of the text.
    pub(super) fn at(&self, span: &Range<usize>) -> String {
        format!("{}:{}", self.name, self.line(span.start))
    }

    /// The block of a scene file that a stretch of text lies in: `surface "floor"`, `edit 2`; empty outside.
    pub(super) fn block(&self, span: &Range<usize>) -> String {
        let mut start = 0;
        let mut found: Option<(usize, &str)> = None;
        let mut edits = 0;
        for line in self.text.split_inclusive('\n') {
            if start > span.start {
                break;
            }
            let head = line.split('#').next().unwrap_or_default().trim();
            if head.starts_with('[') && head.ends_with(']') && !head.contains(',') && !head.contains('=') {
                let header = head.replace(' ', "");
                let known = BLOCKS.iter().find(|(h, _)| header == *h);
                edits += usize::from(known.is_some_and(|k| k.1 == "edit"));
                // A table within the block ([material.specular]) does not end it.
                let within = found.is_some_and(|(_, word)| header.starts_with(&format!("[{word}.")));
                if !within {
                    found = known.map(|(_, word)| (start, *word));
                }
            }
            start += line.len();
        }
        match found {
            None => String::new(),
            Some((_, "edit")) => format!("edit {edits}"),
            Some((at, word)) => match name_in_block(&self.text[at..]) {
                Some(name) => format!("{word} \"{name}\""),
                None => word.to_string(),
            },
        }
    }
}

/// The value of `name = "..."` in the block that a text begins with.
fn name_in_block(text: &str) -> Option<&str> {
    let block = text.lines().skip(1).take_while(|l| !l.trim_start().starts_with("[["));
    let value = block.filter_map(|l| l.trim().strip_prefix("name")?.trim_start().strip_prefix('=')).next()?;
    let value = value.trim_start();
    let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    value[1..].split(quote).next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_block_around_an_offset_is_named() {
        let text = "format = 1\n[[material]]\nname = 'm'\n[[surface]] # first\npolygon = [\n [0,0,0]]\nname = \"floor\"\n[[edit]]\n[[edit]]\nadd = 1\n";
        let source = Source::new(Path::new("/somewhere/a.toml"), text.into());
        let at = |needle: &str| text.find(needle).map(|i| i..i + 1).unwrap();
        assert_eq!(source.at(&at("polygon")), "a.toml:5");
        assert_eq!(source.block(&at("polygon")), "surface \"floor\"");
        assert_eq!(source.block(&at("[0,0")), "surface \"floor\"");
        assert_eq!(source.block(&at("'m'")), "material \"m\"");
        assert_eq!(source.block(&at("add")), "edit 2");
        assert_eq!(source.block(&at("format")), "");
    }
}
