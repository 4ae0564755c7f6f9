//! From records to surfaces with their corners, numbers checked.

use super::shape::{blast, vertices};
use super::words::{Record, Word, records};
use crate::io::scene::check::{Check, Checked};
use crate::io::scene::error::Refusal;
use crate::math::DVec3;
use std::ops::Range;

/// What View3D puts in place of emittances near 0: some absorption keeps its equations solvable.
const LEAST_EMITTANCE: f64 = 0.001;

/// A View3D file as written.
pub(super) struct File {
    /// `encl=1`: the author says that the surfaces form an enclosure.
    pub encloses: bool,
    pub entries: Vec<Entry>,
    pub notices: Vec<String>,
}

/// What a surface is there for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// `S`: takes part.
    Radiating,
    /// `N`: takes its area from its base.
    Null,
    /// `O`: only blocks.
    Obstruction,
}

/// A surface of the file; its number is its index + 1.
pub(super) struct Entry {
    pub kind: Kind,
    pub corners: Vec<DVec3>,
    /// Number of its base surface, 0 for none.
    pub base: usize,
    /// Number of the surface it is combined with, 0 for none.
    pub combine: usize,
    pub emittance: f64,
    pub name: String,
    /// Where it stands.
    pub span: Range<usize>,
}

/// One record being read word by word.
pub(super) struct Reader<'a> {
    check: Check<'a>,
    words: std::slice::Iter<'a, Word<'a>>,
    span: Range<usize>,
    /// `surface 3`: for messages.
    what: String,
}

impl<'a> Reader<'a> {
    fn new(check: Check<'a>, record: &'a Record<'a>, what: &str) -> Self {
        let mut words = record.words.iter();
        words.next();
        Self { check, words, span: record.span(), what: what.into() }
    }

    pub(super) fn refuse<T>(&self, refusal: Refusal, message: &str, mend: &str) -> Checked<T> {
        self.check.refuse(refusal, self.span.clone(), format!("{}: {message}", self.what), mend)
    }

    pub(super) fn word(&mut self, of: &str) -> Checked<&'a Word<'a>> {
        match self.words.next() {
            Some(word) => Ok(word),
            None => self.refuse(Refusal::Syntax, &format!("{of} is missing"), "complete the line"),
        }
    }

    pub(super) fn number(&mut self, of: &str) -> Checked<f64> {
        let word = self.word(of)?;
        match word.text.parse::<f64>().ok().filter(|v| v.is_finite()) {
            Some(v) => Ok(v),
            None => self.wrong(word, of, "a number"),
        }
    }

    pub(super) fn count(&mut self, of: &str) -> Checked<usize> {
        let word = self.word(of)?;
        word.text.parse().or_else(|_| self.wrong(word, of, "a whole number"))
    }

    fn wrong<T>(&self, word: &Word, of: &str, kind: &str) -> Checked<T> {
        let message = format!("{}: {of} is \"{}\", not {kind}", self.what, word.text.escape_debug());
        self.check.refuse(Refusal::Syntax, word.span.clone(), message, "correct the word, or its place in the line")
    }

    /// The number a record carries, which has to be the next.
    fn sequence(&mut self, next: usize) -> Checked<()> {
        let number = self.count("its number")?;
        if number == next {
            return Ok(());
        }
        self.refuse(
            Refusal::Number,
            &format!("it has the number {number}"),
            "number from 1 without gaps, in file order",
        )
    }
}

/// Reads the records of a file.
pub(super) fn parse(check: Check) -> Checked<File> {
    let mut records = records(check.source);
    let blast = is_blast(check, &records)?;
    if blast {
        join(&mut records);
    }
    let mut file = File { encloses: false, entries: Vec::new(), notices: Vec::new() };
    let mut corners: Vec<DVec3> = Vec::new();
    for record in records.iter().filter(|r| r.key == 'V') {
        let next = corners.len() + 1;
        let mut reader = Reader::new(check, record, &format!("vertex {next}"));
        reader.sequence(next)?;
        corners.push(DVec3::new(reader.number("x")?, reader.number("y")?, reader.number("z")?));
    }
    for record in &records {
        match record.key {
            'T' | 'F' | 'V' => {}
            'C' => control(check, record, &mut file)?,
            'S' | 'M' | 'N' | 'O' => {
                let entry = surface(check, record, &file.entries, (!blast).then_some(&corners), &mut file.notices)?;
                file.entries.push(entry);
            }
            'X' => file.notices.push(format!(
                "{}: coordinate transformations (X) are left out, as View3D does",
                check.source.at(&record.span())
            )),
            _ => {
                let word = &record.words[0];
                let message = format!("no record begins with \"{}\"", word.text.escape_debug());
                let mend = "lines begin with T, C, F, V, S, N, O, E, or ! for a comment";
                return check.refuse(Refusal::Syntax, word.span.clone(), message, mend);
            }
        }
    }
    if !file.entries.iter().any(|e| e.kind == Kind::Radiating) {
        let mend = "add lines beginning with S; results of View3D are matrices, not scenes";
        return check.refuse(Refusal::Empty, 0..0, "the file has no surface", mend);
    }
    Ok(file)
}

/// Whether the geometry is that of BLAST (`F 3a`): origin and angles instead of vertices.
fn is_blast(check: Check, records: &[Record]) -> Checked<bool> {
    let Some(record) = records.iter().find(|r| r.key == 'F') else { return Ok(false) };
    let (span, form) = record.words.get(1).map_or((record.span(), ""), |w| (w.span.clone(), w.text));
    match form {
        "3" => Ok(false),
        "3a" | "3A" => Ok(true),
        _ => {
            let message = format!("the geometry \"{}\" is not read", form.escape_debug());
            check.refuse(
                Refusal::Format,
                span,
                message,
                "write F 3 (vertices and surfaces) or F 3a (origin and angles)",
            )
        }
    }
}

/// In the geometry 3a the numbers of a surface stand on the lines after it.
fn join(records: &mut Vec<Record>) {
    let mut joined: Vec<Record> = Vec::with_capacity(records.len());
    for mut record in records.drain(..) {
        let goes_on = record.key.is_ascii_digit() || matches!(record.key, '-' | '+' | '.');
        match joined.last_mut().filter(|last| goes_on && matches!(last.key, 'S' | 'M' | 'N' | 'O')) {
            Some(last) => last.words.append(&mut record.words),
            None => joined.push(record),
        }
    }
    *records = joined;
}

/// The control line. What steers View3D's own integration says nothing about the scene.
fn control(check: Check, record: &Record, file: &mut File) -> Checked<()> {
    let place = check.source.at(&record.span());
    let code = record.rest.split('!').next().unwrap_or_default();
    let mut words = code.split([' ', '\t', ',', '=']).filter(|w| !w.is_empty());
    while let Some(key) = words.next() {
        let value = words.next().unwrap_or_default();
        let set = value.parse::<i64>().is_ok_and(|v| v != 0);
        match key.to_ascii_lowercase().as_str() {
            "encl" if value.parse::<i64>().is_err() => {
                let message = format!("encl is \"{}\", not a whole number", value.escape_debug());
                return check.refuse(
                    Refusal::Number,
                    record.span(),
                    message,
                    "write encl=1 for an enclosure, else encl=0",
                );
            }
            "encl" => file.encloses = set,
            "emit" if set => file.notices.push(format!(
                "{place}: emit=1 asks View3D for factors with reflections (script-F); form factors here are geometric, \
                 and emittances enter as reflectances when the scene is solved"
            )),
            "row" | "col" if set => {
                file.notices.push(format!("{place}: {key}={value} is left out: all rows and columns are computed"));
            }
            "eps" | "epsu" | "epso" | "maxu" | "maxo" | "mino" | "list" | "out" | "prjd" | "maxv" | "emit" | "row"
            | "col" => {}
            _ => file.notices.push(format!("{place}: the control word \"{}\" is not known", key.escape_debug())),
        }
    }
    Ok(())
}

/// A surface line, with vertices by number or (`None`) the geometry 3a.
fn surface(
    check: Check,
    record: &Record,
    before: &[Entry],
    corners: Option<&Vec<DVec3>>,
    notices: &mut Vec<String>,
) -> Checked<Entry> {
    let number = before.len() + 1;
    let mut reader = Reader::new(check, record, &format!("surface {number}"));
    reader.sequence(number)?;
    let kind = match record.key {
        'N' => Kind::Null,
        'O' => Kind::Obstruction,
        'M' => {
            let mend = "write N if the covered area is to take no part, or leave it out and give what covers it as S";
            return reader.refuse(Refusal::Reserved, "masking surfaces (M) are not read", mend);
        }
        _ => Kind::Radiating,
    };
    if kind != Kind::Obstruction && before.last().is_some_and(|e| e.kind == Kind::Obstruction) {
        return reader.refuse(Refusal::Number, "it comes after an obstruction", "put all lines with O last");
    }
    let shape = match corners {
        Some(corners) => Err(vertices(&mut reader, corners)?),
        None => Ok(reader.word("its shape (R, Q or T)")?),
    };
    let (mut base, mut combine, mut emittance) = (0, 0, 1.0);
    let mut name = format!("obstruction-{number}");
    if kind != Kind::Obstruction {
        base = reader.count("the base surface")?;
        combine = reader.count("the surface it is combined with")?;
        emittance = emittance_of(&mut reader, &check.source.at(&record.span()), notices)?;
        name = reader.word("its name")?.text.chars().map(|c| if c.is_control() { '_' } else { c }).collect();
    }
    let corners = match shape {
        Err(corners) => corners,
        Ok(shape) => blast(&mut reader, shape)?,
    };
    Ok(Entry { kind, corners, base, combine, emittance, name, span: record.span() })
}

fn emittance_of(reader: &mut Reader, place: &str, notices: &mut Vec<String>) -> Checked<f64> {
    let emittance = reader.number("the emittance")?;
    if !(0.0..=1.0).contains(&emittance) {
        let message = format!("the emittance {emittance} is outside [0, 1]");
        return reader.refuse(Refusal::Number, &message, "give 0.9 for most building materials");
    }
    if emittance < LEAST_EMITTANCE {
        notices.push(format!("{place}: the emittance {emittance} is taken as {LEAST_EMITTANCE}, as View3D does"));
    }
    Ok(emittance.max(LEAST_EMITTANCE))
}
