//! Every equation cited in the code stands in `references/papers/<key>.md`, and every one listed there with a
//! function is cited in the code.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn files(folder: &Path, ending: &str, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a readable folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files(&path, ending, out);
        } else if path.extension().is_some_and(|e| e == ending) {
            out.push(path);
        }
    }
}

/// Tags `[KEY eq. 7]`, `[KEY fig. 7a]` in a text; KEY is capitals and digits.
fn tags(text: &str) -> BTreeSet<String> {
    text.match_indices('[')
        .filter_map(|(at, _)| {
            let inner = text[at + 1..].split(']').next()?;
            let (key, what) = inner.split_once(' ')?;
            let is_key = key.len() >= 3 && key.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit());
            let is_place = (what.starts_with("eq. ") || what.starts_with("fig. ")) && what.len() < 16;
            (is_key && is_place).then(|| inner.to_string())
        })
        .collect()
}

fn all_tags(folder: &str, ending: &str) -> BTreeSet<String> {
    let mut list = Vec::new();
    files(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), ending, &mut list);
    list.iter().flat_map(|f| tags(&std::fs::read_to_string(f).expect("readable"))).collect()
}

#[test]
fn no_tag_dangles() {
    let (code, papers) = (all_tags("src", "rs"), all_tags("references/papers", "md"));
    let unlisted: Vec<_> = code.difference(&papers).collect();
    assert!(unlisted.is_empty(), "cited in src but not listed in references/papers: {unlisted:?}");
    let uncited: Vec<_> = papers.difference(&code).collect();
    assert!(uncited.is_empty(), "listed in references/papers but cited nowhere in src: {uncited:?}");
    assert!(!code.is_empty(), "no tag found at all: is the parser broken?");
}

#[test]
fn tags_are_recognised() {
    let found = tags("see [CG85 eq. 7] and [GSG90 fig. 6b], not [a link](x) or [CG85]");
    assert_eq!(found.into_iter().collect::<Vec<_>>(), ["CG85 eq. 7", "GSG90 fig. 6b"]);
}
