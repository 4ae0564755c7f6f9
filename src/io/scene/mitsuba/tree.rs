//! The elements of a Mitsuba scene, includes put in place and `$names` filled in.

use crate::io::scene::check::{Check, Checked, LARGEST, known_names};
use crate::io::scene::error::Refusal;
use crate::io::scene::source::Source;
use crate::math::DVec3;
use std::collections::BTreeMap;
use std::ops::Range;

/// Number of an element in [`Tree::elements`].
pub(super) type Id = usize;

/// One XML element.
pub(super) struct Element {
    pub tag: String,
    pub attributes: Vec<(String, String)>,
    pub children: Vec<Id>,
    /// Index into [`Tree::sources`].
    pub file: usize,
    /// Its opening tag.
    pub span: Range<usize>,
}

/// All elements of a scene and the files that it includes.
#[derive(Default)]
pub(super) struct Tree {
    pub sources: Vec<Source>,
    pub elements: Vec<Element>,
    /// What stands directly in the scene, in order.
    pub top: Vec<Id>,
    /// Elements by their `id`.
    pub ids: BTreeMap<String, Id>,
}

impl Tree {
    pub(super) fn check(&self, at: Id) -> Check<'_> {
        Check { source: &self.sources[self.elements[at].file] }
    }

    pub(super) fn refuse<T>(
        &self,
        at: Id,
        refusal: Refusal,
        message: impl Into<String>,
        mend: impl Into<String>,
    ) -> Checked<T> {
        self.check(at).refuse(refusal, self.elements[at].span.clone(), message, mend)
    }

    /// `file:line` of an element.
    pub(super) fn place(&self, at: Id) -> String {
        self.check(at).source.at(&self.elements[at].span)
    }

    pub(super) fn tag(&self, at: Id) -> &str {
        &self.elements[at].tag
    }

    pub(super) fn children(&self, at: Id) -> impl Iterator<Item = Id> + '_ {
        self.elements[at].children.iter().copied()
    }

    pub(super) fn attribute(&self, at: Id, name: &str) -> Option<&str> {
        self.elements[at].attributes.iter().find(|(n, _)| n == name).map(|(_, v)| v.as_str())
    }

    /// An attribute that must be there.
    pub(super) fn needed(&self, at: Id, name: &str) -> Checked<&str> {
        match self.attribute(at, name) {
            Some(value) => Ok(value),
            None => self.refuse(
                at,
                Refusal::Key,
                format!("<{}> has no {name}", shown(self.tag(at))),
                format!("add {name}=\"...\""),
            ),
        }
    }

    /// The `type` of a plugin.
    pub(super) fn kind(&self, at: Id) -> Checked<&str> {
        self.needed(at, "type")
    }

    /// The `name` of a parameter.
    pub(super) fn name(&self, at: Id) -> &str {
        self.attribute(at, "name").unwrap_or_default()
    }

    /// What an element is called in messages and as a surface or material: its id, else its type.
    pub(super) fn title(&self, at: Id) -> &str {
        self.attribute(at, "id").or(self.attribute(at, "type")).unwrap_or_else(|| self.tag(at))
    }

    /// The element that a `<ref>` means; others mean themselves.
    pub(super) fn resolved(&self, at: Id) -> Checked<Id> {
        if self.tag(at) != "ref" {
            return Ok(at);
        }
        let id = self.needed(at, "id")?;
        match self.ids.get(id) {
            Some(found) => Ok(*found),
            None => {
                let message = format!("nothing has the id \"{}\"", shown(id));
                self.refuse(at, Refusal::Name, message, known_names(id, self.ids.keys().map(String::as_str)))
            }
        }
    }

    /// Refuses attributes beyond those named.
    pub(super) fn only(&self, at: Id, known: &[&str]) -> Checked<()> {
        match self.elements[at].attributes.iter().find(|(n, _)| !known.contains(&n.as_str())) {
            None => Ok(()),
            Some((name, _)) => {
                let message = format!("<{}> has an unknown attribute \"{}\"", shown(self.tag(at)), shown(name));
                self.refuse(at, Refusal::Key, message, known_names(name, known.iter().copied()))
            }
        }
    }

    /// A parameter that is not known here.
    pub(super) fn unknown<T>(&self, at: Id, of: &str, known: &[&str]) -> Checked<T> {
        let (tag, name) = (shown(self.tag(at)), self.name(at));
        let message = match name {
            "" => format!("<{tag}> does not belong in {of}"),
            name => format!("{of} has no parameter \"{}\" (<{tag}>)", shown(name)),
        };
        self.refuse(at, Refusal::Key, message, known_names(name, known.iter().copied()))
    }

    /// Numbers of an attribute, parted by commas and blanks.
    pub(super) fn numbers(&self, at: Id, attribute: &str) -> Checked<Vec<f64>> {
        let text = self.needed(at, attribute)?;
        let words = text.split(|c: char| c.is_whitespace() || c == ',').filter(|w| !w.is_empty());
        words.map(|w| self.parsed(at, attribute, w)).collect()
    }

    /// A finite number within reach from a word.
    pub(super) fn parsed(&self, at: Id, of: &str, word: &str) -> Checked<f64> {
        match word.parse::<f64>() {
            Ok(v) if v.is_finite() && v.abs() <= LARGEST => Ok(v),
            Ok(v) => {
                let message = format!("{of} is {v}: not finite, or beyond {LARGEST:e}");
                self.refuse(at, Refusal::Number, message, "give a finite number")
            }
            Err(_) => {
                let message = format!("{of}: \"{}\" is not a number", shown(word));
                self.refuse(at, Refusal::Syntax, message, "give decimal numbers")
            }
        }
    }

    /// One number.
    pub(super) fn number(&self, at: Id, attribute: &str) -> Checked<f64> {
        match self.numbers(at, attribute)?[..] {
            [v] => Ok(v),
            ref list => {
                let message = format!("{attribute} has {} numbers", list.len());
                self.refuse(at, Refusal::Number, message, "give one")
            }
        }
    }

    /// Three numbers.
    pub(super) fn triple(&self, at: Id, attribute: &str) -> Checked<DVec3> {
        match self.numbers(at, attribute)?[..] {
            [x, y, z] => Ok(DVec3::new(x, y, z)),
            ref list => {
                let message = format!("{attribute} has {} numbers", list.len());
                self.refuse(at, Refusal::Number, message, "give three: \"x, y, z\"")
            }
        }
    }

    /// x, y and z of their own, or together as `value`; what is missing is `default`.
    pub(super) fn vector(&self, at: Id, default: f64) -> Checked<DVec3> {
        if self.attribute(at, "value").is_some() {
            return match self.numbers(at, "value")?[..] {
                [v] if self.tag(at) == "scale" => Ok(DVec3::splat(v)),
                _ => self.triple(at, "value"),
            };
        }
        let own = |name| self.attribute(at, name).map_or(Ok(default), |_| self.number(at, name));
        Ok(DVec3::new(own("x")?, own("y")?, own("z")?))
    }

    /// `true` or `false`.
    pub(super) fn truth(&self, at: Id) -> Checked<bool> {
        match self.needed(at, "value")?.trim() {
            "true" => Ok(true),
            "false" => Ok(false),
            other => {
                let message = format!("\"{}\" is neither true nor false", shown(other));
                self.refuse(at, Refusal::Syntax, message, "write value=\"true\" or value=\"false\"")
            }
        }
    }
}

/// A word of the file as it can stand in a message.
pub(super) fn shown(word: &str) -> String {
    word.chars().take(60).collect::<String>().escape_debug().to_string()
}
