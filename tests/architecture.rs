//! Who may know whom: the map of the modules, enforced.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Each module with the modules it may use; `*` stands for all above it, `-name` takes one out again.
const MAP: &[(&str, &[&str])] = &[
    ("math", &[]),
    ("stats", &["math"]),
    ("sampling", &["math"]),
    ("view", &["math"]),
    ("world", &["math", "view"]),
    ("scene", &["math", "view"]),
    ("solution", &["math", "stats"]),
    ("raycast", &["math", "scene"]),
    ("formfactor", &["math", "stats", "scene", "solution"]),
    ("compositing", &["math", "view", "scene", "raycast", "formfactor"]),
    ("estimate", &["math", "stats", "sampling", "scene", "solution", "raycast", "formfactor"]),
    ("doctor", &["math", "stats", "sampling", "scene", "raycast", "estimate"]),
    ("solver", &["math", "solution"]),
    ("carry", &["math", "sampling", "scene", "solution"]),
    ("reference", &["*", "-doctor"]),
    ("methods", &["*", "-reference", "-doctor"]),
    ("metrics", &["math", "stats", "solution", "view"]),
    ("render", &["math", "view", "world", "scene", "solution", "raycast"]),
    ("audit", &["*", "-reference", "-doctor"]),
    ("io", &["math", "view", "world", "scene", "solution", "compositing"]),
    ("study", &["*"]),
    (
        "report",
        &[
            "math",
            "stats",
            "view",
            "world",
            "scene",
            "solution",
            "metrics",
            "render",
            "audit",
            "study",
            "io",
            "compositing",
        ],
    ),
    ("api", &["*", "-report"]),
    ("cli", &["*", "-api"]),
];

/// The map with the shorthand written out.
fn written_out() -> BTreeMap<&'static str, BTreeSet<&'static str>> {
    let expand = |(position, (module, uses)): (usize, &(&'static str, &[&'static str]))| {
        let mut all: BTreeSet<&str> = uses.iter().copied().filter(|u| !u.starts_with(['*', '-'])).collect();
        if uses.contains(&"*") {
            all.extend(MAP[..position].iter().map(|(m, _)| *m));
        }
        all.retain(|m| !uses.contains(&format!("-{m}").as_str()));
        (*module, all)
    };
    MAP.iter().enumerate().map(expand).collect()
}

fn source_files(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a readable folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            source_files(&path, out);
        } else if path.extension().is_some_and(|e| e == "rs") {
            out.push(path);
        }
    }
}

/// Modules named after `crate::`, also in grouped imports, outside of comments and test modules.
fn modules_used(text: &str) -> BTreeSet<String> {
    let shipped = text.split("#[cfg(test)]\nmod tests").next().unwrap_or("");
    let code: Vec<&str> = shipped.lines().filter(|l| !l.trim_start().starts_with("//")).collect();
    let code = code.join("\n");
    let name = |rest: &str| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    code.match_indices("crate::").map(|(at, m)| name(&code[at + m.len()..])).filter(|n| !n.is_empty()).collect()
}

#[test]
fn imports_run_one_way() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let allowed = written_out();
    let mut wrong = Vec::new();
    let mut seen = BTreeSet::new();
    let mut files = Vec::new();
    source_files(&src, &mut files);
    for file in files {
        let relative = file.strip_prefix(&src).expect("below src");
        let module = relative.components().next().expect("a name").as_os_str().to_string_lossy().to_string();
        if module.ends_with(".rs") {
            continue;
        }
        seen.insert(module.clone());
        let Some(may_use) = allowed.get(module.as_str()) else {
            wrong.push(format!("{module} is not in the map"));
            continue;
        };
        // Test-only files are exempt: tests may look across.
        if relative.file_stem().is_some_and(|s| s == "tests" || s == "testing") {
            continue;
        }
        for used in modules_used(&std::fs::read_to_string(&file).expect("readable")) {
            if used != module && allowed.contains_key(used.as_str()) && !may_use.contains(used.as_str()) {
                wrong.push(format!("{}: {module} may not use {used}", relative.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let unused: Vec<_> = MAP.iter().filter(|(m, _)| !seen.contains(*m)).map(|(m, _)| m).collect();
    assert!(unused.is_empty(), "in the map but not in src: {unused:?}");
}

#[test]
fn the_map_has_no_circles() {
    let order: Vec<&str> = MAP.iter().map(|(m, _)| *m).collect();
    for (module, uses) in written_out() {
        let own = order.iter().position(|m| *m == module);
        for used in uses {
            let above = order.iter().position(|m| *m == used) < own;
            assert!(above && order.contains(&used), "{module} uses {used}, which does not stand above it");
        }
    }
}

#[test]
fn the_parser_sees_grouped_and_inline_paths() {
    let text = "use crate::math::{a, b};\n// crate::cli::x\nfn f() { crate::io::g() }\n#[cfg(test)]\nmod tests { use crate::cli; }";
    assert_eq!(modules_used(text).into_iter().collect::<Vec<_>>(), ["io", "math"]);
}

#[test]
fn unsafe_code_stays_where_foreign_code_is() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    source_files(&src, &mut files);
    for file in files {
        let relative = file.strip_prefix(&src).expect("below src").to_string_lossy().replace('\\', "/");
        let text = std::fs::read_to_string(&file).expect("readable");
        let opened = text.contains("allow(unsafe_code)");
        assert!(!opened || relative.starts_with("raycast/embree"), "{relative} opens the door to unsafe code");
    }
}
