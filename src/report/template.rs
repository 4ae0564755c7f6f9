//! Filling in the templates of pages.

use super::{Artifact, ReportError};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use minijinja::{AutoEscape, Environment, UndefinedBehavior, Value};
use std::collections::BTreeMap;

/// The template `name` filled in. Everything is escaped that a template does not call safe by name, and what is not
/// given is an error, never a blank.
pub(super) fn filled(
    templates: impl IntoIterator<Item = (&'static str, &'static str)>,
    name: &str,
    data: Value,
) -> Result<String, ReportError> {
    let mut env = Environment::new();
    env.set_auto_escape_callback(|_| AutoEscape::Html);
    env.set_undefined_behavior(UndefinedBehavior::Strict);
    env.set_trim_blocks(true);
    env.set_lstrip_blocks(true);
    for (name, text) in templates {
        env.add_template(name, text)?;
    }
    Ok(env.get_template(name)?.render(data)?)
}

/// PNG pictures as addresses that hold them, by file name: a page needs nothing but itself.
pub(super) fn inlined(pictures: &[Artifact]) -> BTreeMap<String, String> {
    let uri = |a: &Artifact| (a.name.clone(), format!("data:image/png;base64,{}", STANDARD.encode(&a.bytes)));
    pictures.iter().map(uri).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use minijinja::context;

    #[test]
    fn text_is_escaped_and_what_is_missing_is_told() {
        let page = |data| filled([("a.html", "<p>{{ x }}</p>")], "a.html", data);
        assert_eq!(page(context! { x => "<b>" }).expect("a page"), "<p>&lt;b&gt;</p>");
        assert!(matches!(page(context! { y => 1 }), Err(ReportError::Page(_))));
    }
}
