//! From words to primitives: modifier, type, identifier, arguments.

use super::genbox::genbox;
use super::words::{Word, Words};
use crate::io::scene::check::{Check, Checked, LARGEST, nearest};
use crate::io::scene::error::Refusal;
use std::ops::Range;

/// Types of surfaces.
pub(super) const SURFACES: [&str; 11] =
    ["polygon", "sphere", "bubble", "cone", "cup", "cylinder", "tube", "ring", "source", "instance", "mesh"];
/// Types of materials, mixtures, patterns and textures.
const MODIFIERS: [&str; 48] = [
    "plastic",
    "metal",
    "trans",
    "plastic2",
    "metal2",
    "trans2",
    "ashik2",
    "dielectric",
    "interface",
    "glass",
    "light",
    "illum",
    "glow",
    "spotlight",
    "mirror",
    "mist",
    "prism1",
    "prism2",
    "antimatter",
    "BRTDfunc",
    "plasfunc",
    "metfunc",
    "transfunc",
    "plasdata",
    "metdata",
    "transdata",
    "BSDF",
    "aBSDF",
    "WGMDfunc",
    "mixfunc",
    "mixdata",
    "mixpict",
    "mixtext",
    "brightfunc",
    "brightdata",
    "brighttext",
    "colorfunc",
    "colordata",
    "colorpict",
    "colortext",
    "texfunc",
    "texdata",
    "spectrum",
    "specfile",
    "specfunc",
    "specdata",
    "specpict",
    "alias",
];

/// One primitive of the file.
#[derive(Debug, Clone)]
pub(super) struct Primitive {
    pub modifier: String,
    pub kind: String,
    pub name: String,
    /// What an alias stands for.
    pub alias: Option<String>,
    pub reals: Vec<f64>,
    /// From its modifier to its name.
    pub span: Range<usize>,
}

impl Primitive {
    pub(super) fn is_surface(&self) -> bool {
        SURFACES.contains(&self.kind.as_str())
    }
}

/// Reads all primitives of a file; boxes of `!genbox` are written out.
pub(super) fn parse(check: Check) -> Checked<Vec<Primitive>> {
    let mut words = Words::of(check.source);
    let mut found = Vec::new();
    loop {
        if let Some(command) = words.command() {
            found.extend(run(check, &command)?);
            continue;
        }
        let Some(modifier) = words.next() else { break };
        found.push(Reader { check, words: &mut words, span: modifier.span.clone() }.primitive(&modifier)?);
    }
    Ok(found)
}

/// A command in the file: boxes are known, nothing is ever run.
fn run(check: Check, command: &Word) -> Checked<Vec<Primitive>> {
    let arguments: Vec<&str> = command.text.split_whitespace().filter(|w| *w != "\\").collect();
    match arguments.first() {
        Some(&"genbox") => genbox(check, &arguments[1..], &command.span),
        first => {
            let message = format!("the command \"!{}\" is not run", shown(first.unwrap_or(&"")));
            let mend = "write it out first: xform scene.rad > expanded.rad";
            check.refuse(Refusal::Reserved, command.span.clone(), message, mend)
        }
    }
}

/// One primitive being read.
struct Reader<'a, 'w> {
    check: Check<'a>,
    words: &'w mut Words<'a>,
    span: Range<usize>,
}

impl<'a> Reader<'a, '_> {
    fn refuse<T>(&self, refusal: Refusal, span: Range<usize>, message: String, mend: &str) -> Checked<T> {
        self.check.refuse(refusal, span, message, mend)
    }

    fn word(&mut self, of: &str) -> Checked<Word<'a>> {
        match self.words.next() {
            Some(word) => Ok(word),
            None => {
                let message = format!("the file ends before {of}");
                self.refuse(Refusal::Syntax, self.span.clone(), message, "complete the primitive")
            }
        }
    }

    fn primitive(&mut self, modifier: &Word) -> Checked<Primitive> {
        let kind = self.word("a type")?;
        if !SURFACES.contains(&kind.text) && !MODIFIERS.contains(&kind.text) {
            let message = format!("there is no type \"{}\"", shown(kind.text));
            let mend = match nearest(kind.text, SURFACES.into_iter().chain(MODIFIERS)) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => "write: modifier type identifier, then the counts of arguments with the arguments".into(),
            };
            return self.refuse(Refusal::Key, kind.span, message, &mend);
        }
        let name = self.word("an identifier")?;
        self.span = modifier.span.start..name.span.end;
        let mut found = Primitive {
            modifier: modifier.text.into(),
            kind: kind.text.into(),
            name: name.text.into(),
            alias: None,
            reals: Vec::new(),
            span: self.span.clone(),
        };
        if kind.text == "alias" {
            found.alias = Some(self.word("what the alias stands for")?.text.into());
            return Ok(found);
        }
        for _ in 0..self.count("strings")? {
            self.word("its strings")?;
        }
        for _ in 0..self.count("whole numbers")? {
            self.real()?;
        }
        for _ in 0..self.count("numbers")? {
            let value = self.real()?;
            found.reals.push(value);
        }
        Ok(found)
    }

    fn count(&mut self, of: &str) -> Checked<usize> {
        let word = self.word(&format!("the count of {of}"))?;
        match word.text.parse::<usize>() {
            Ok(n) => Ok(n),
            Err(_) => {
                let message = format!("the count of {of} is \"{}\"", shown(word.text));
                let mend =
                    "three counts follow the identifier, each with its arguments: strings, whole numbers, numbers";
                self.refuse(Refusal::Syntax, word.span, message, mend)
            }
        }
    }

    fn real(&mut self) -> Checked<f64> {
        let word = self.word("its numbers")?;
        match word.text.parse::<f64>() {
            Ok(v) if v.is_finite() && v.abs() <= LARGEST => Ok(v),
            Ok(v) => {
                let message = format!("the number {v} is not finite, or beyond {LARGEST:e}");
                self.refuse(Refusal::Number, word.span, message, "give a finite number")
            }
            Err(_) => {
                let message = format!("\"{}\" is not a number", shown(word.text));
                self.refuse(Refusal::Syntax, word.span, message, "give as many numbers as their count says")
            }
        }
    }
}

/// A word of the file as it can stand in a message.
pub(super) fn shown(word: &str) -> String {
    word.chars().take(60).collect::<String>().escape_debug().to_string()
}
