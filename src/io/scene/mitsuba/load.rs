//! From XML to elements: includes, defaults, substitution, ids.

use super::tree::{Element, Id, Tree, shown};
use crate::io::scene::check::{Check, Checked, known_names};
use crate::io::scene::error::{Refusal, SceneFileError};
use crate::io::scene::folder::{Folder, text_of};
use crate::io::scene::source::Source;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Files within files, as deep as Mitsuba goes.
const MAX_INCLUDES: usize = 15;
/// Files that one scene may include, repeated ones counted again.
const MAX_FILES: usize = 1000;
/// Elements within elements.
const MAX_DEPTH: usize = 50;
/// Elements of a scene, includes counted.
const MAX_ELEMENTS: usize = 4_000_000;
/// Bytes of an attribute after `$names` are filled in: defaults may name defaults.
const MAX_FILLED: usize = 1 << 16;

struct Loader<'a> {
    folder: &'a Folder,
    tree: Tree,
    /// Values of `<default>`, in the order in which they come.
    parameters: BTreeMap<String, String>,
    /// `<alias>` elements: resolved when all ids are known.
    aliases: Vec<Id>,
    /// Files that are being read, the outermost first.
    open: Vec<PathBuf>,
}

/// Reads a scene file and what it includes.
pub(super) fn load(path: &Path, text: String, folder: &Folder) -> Checked<Tree> {
    let parameters = BTreeMap::new();
    let mut loader = Loader { folder, tree: Tree::default(), parameters, aliases: Vec::new(), open: Vec::new() };
    let real = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    loader.tree.top = loader.file(&real, text)?;
    loader.resolve_aliases()?;
    Ok(loader.tree)
}

impl Loader<'_> {
    /// The elements of one file.
    fn file(&mut self, path: &Path, text: String) -> Checked<Vec<Id>> {
        let source = Source::new(path, text.clone());
        let options = roxmltree::ParsingOptions { nodes_limit: MAX_ELEMENTS as u32, ..Default::default() };
        let read = roxmltree::Document::parse_with_options(&text, options);
        let document = read.map_err(|e| not_well_formed(&source, &e))?;
        let root = document.root_element();
        check_root(&source, root)?;
        self.open.push(path.to_path_buf());
        self.tree.sources.push(source);
        let top = self.children(root, self.tree.sources.len() - 1, 1)?;
        self.open.pop();
        Ok(top)
    }

    /// What stands in an element; `<include>` stands for the elements of its file.
    fn children(&mut self, parent: roxmltree::Node, file: usize, depth: usize) -> Checked<Vec<Id>> {
        let mut found = Vec::new();
        for node in parent.children().filter(roxmltree::Node::is_element) {
            let at = self.element(node, file)?;
            match node.tag_name().name() {
                "include" => found.extend(self.include(at)?),
                "default" => self.default(at)?,
                "alias" => self.aliases.push(at),
                _ if depth >= MAX_DEPTH => {
                    let message = format!("elements lie more than {MAX_DEPTH} deep in one another");
                    return self.tree.refuse(at, Refusal::Syntax, message, "no scene needs that: take them apart");
                }
                _ => {
                    self.tree.elements[at].children = self.children(node, file, depth + 1)?;
                    found.push(at);
                }
            }
        }
        Ok(found)
    }

    /// One element, its attributes filled in, its id noted.
    fn element(&mut self, node: roxmltree::Node, file: usize) -> Checked<Id> {
        let range = node.range();
        let tag = node.tag_name().name().to_string();
        let span = range.start..(range.start + 1 + tag.len()).min(range.end);
        let at = self.tree.elements.len();
        if at >= MAX_ELEMENTS {
            let message = format!("the scene has more than {MAX_ELEMENTS} elements");
            let check = Check { source: &self.tree.sources[file] };
            return check.refuse(Refusal::Counts, span, message, "put geometry into .ply or .obj files");
        }
        self.tree.elements.push(Element { tag, attributes: Vec::new(), children: Vec::new(), file, span });
        for attribute in node.attributes() {
            let value = self.filled(at, attribute.value())?;
            self.tree.elements[at].attributes.push((attribute.name().to_string(), value));
        }
        let refers = matches!(self.tree.tag(at), "ref" | "alias");
        if let Some(id) = self.tree.attribute(at, "id").filter(|_| !refers).map(String::from)
            && self.tree.ids.insert(id.clone(), at).is_some()
        {
            let message = format!("a second element with the id \"{}\"", shown(&id));
            return self.tree.refuse(at, Refusal::Name, message, "give every element its own id");
        }
        Ok(at)
    }

    /// A value with its `$names` filled in, the longest known name first.
    fn filled(&self, at: Id, value: &str) -> Checked<String> {
        let mut parts = value.split('$');
        let mut out = parts.next().unwrap_or_default().to_string();
        for part in parts {
            let known = self.parameters.iter().filter(|(name, _)| part.starts_with(name.as_str()));
            let Some((name, text)) = known.max_by_key(|(name, _)| name.len()) else {
                let name: String = part.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                let message = format!("the parameter \"${}\" has no value", shown(&name));
                let near = known_names(&name, self.parameters.keys().map(String::as_str));
                let mend = format!("add <default name=\"{}\" value=\"...\"/> before it; {near}", shown(&name));
                return self.tree.refuse(at, Refusal::Name, message, mend);
            };
            out += text;
            out += &part[name.len()..];
            if out.len() > MAX_FILLED {
                let message = "an attribute becomes too long when its parameters are filled in";
                return self.tree.refuse(at, Refusal::Counts, message, "use shorter values");
            }
        }
        Ok(out)
    }

    /// The first `<default>` of a name counts, as in Mitsuba.
    fn default(&mut self, at: Id) -> Checked<()> {
        let (name, value) = (self.tree.needed(at, "name")?.to_string(), self.tree.needed(at, "value")?.to_string());
        if name.is_empty() {
            return self.tree.refuse(at, Refusal::Name, "<default> has an empty name", "give it a name");
        }
        self.parameters.entry(name).or_insert(value);
        Ok(())
    }

    fn include(&mut self, at: Id) -> Checked<Vec<Id>> {
        let tree = &self.tree;
        let name = tree.needed(at, "filename")?.to_string();
        let span = tree.elements[at].span.clone();
        // All names start at the folder of the outermost file, as in Mitsuba.
        let path = self.folder.locate(tree.check(at), span, Path::new(""), &name)?;
        if self.open.contains(&path) || self.open.len() >= MAX_INCLUDES || tree.sources.len() >= MAX_FILES {
            let message = format!("\"{}\" includes itself, or too many files are included", shown(&name));
            return tree.refuse(at, Refusal::Path, message, "include every file once");
        }
        match text_of(&path) {
            Ok(text) => self.file(&path, text),
            Err(why) => {
                let message = format!("cannot read \"{}\": {why}", shown(&name));
                self.tree.refuse(at, Refusal::Unreadable, message, "name a file that is there and can be read")
            }
        }
    }

    /// `<alias id="old" as="new"/>`.
    fn resolve_aliases(&mut self) -> Checked<()> {
        for at in std::mem::take(&mut self.aliases) {
            let (old, new) = (self.tree.needed(at, "id")?.to_string(), self.tree.needed(at, "as")?.to_string());
            let Some(meant) = self.tree.ids.get(&old).copied() else {
                let message = format!("nothing has the id \"{}\"", shown(&old));
                let mend = known_names(&old, self.tree.ids.keys().map(String::as_str));
                return self.tree.refuse(at, Refusal::Name, message, mend);
            };
            if self.tree.ids.insert(new.clone(), meant).is_some() {
                let message = format!("a second element with the id \"{}\"", shown(&new));
                return self.tree.refuse(at, Refusal::Name, message, "choose another name");
            }
        }
        Ok(())
    }
}

/// A fault of the XML itself.
fn not_well_formed(source: &Source, e: &roxmltree::Error) -> SceneFileError {
    let row = e.pos().row.max(1) as usize;
    let start: usize = source.text.split_inclusive('\n').take(row - 1).map(str::len).sum();
    let length = source.text[start..].lines().next().map_or(0, str::len);
    let text = e.to_string();
    // The reader ends its messages with the position, which the place says already.
    let message = text.split(" at ").next().unwrap_or(&text).to_string();
    let mend = match e {
        roxmltree::Error::DtdDetected => "take the DOCTYPE out: entities are not read",
        _ => "correct the XML: every element is closed, every value stands in quotes",
    };
    SceneFileError::new(source, Refusal::Syntax, start..start + length, format!("not well-formed XML: {message}"))
        .mend(mend)
}

/// A scene of a version that can be read.
fn check_root(source: &Source, root: roxmltree::Node) -> Checked<()> {
    let check = Check { source };
    let range = root.range();
    let span = range.start..(range.start + 1 + root.tag_name().name().len()).min(range.end);
    if root.tag_name().name() != "scene" {
        let message = format!("the file is a <{}>, not a <scene>", shown(root.tag_name().name()));
        return check.refuse(Refusal::Format, span, message, "give a Mitsuba 3 scene");
    }
    let Some(version) = root.attribute("version") else {
        let mend = "write <scene version=\"3.0.0\">";
        return check.refuse(Refusal::Format, span, "the scene has no version", mend);
    };
    match version.split('.').next().and_then(|major| major.trim().parse::<u32>().ok()) {
        Some(2 | 3) => Ok(()),
        Some(0 | 1) => {
            let message = format!("the scene is of version {}, whose names differ", shown(version));
            let mend = "bring it to version 3: toWorld is to_world there, and so on (Mitsuba 3 does it when it loads the file)";
            check.refuse(Refusal::Format, span, message, mend)
        }
        _ => {
            let message = format!("the version \"{}\" is not known", shown(version));
            check.refuse(Refusal::Format, span, message, "write <scene version=\"3.0.0\">")
        }
    }
}
