//! Methods as a list on the command line: `gather:rays=1024|4096,estimator=rays,hemicube`.

use crate::estimate::Estimator;
use crate::methods::{Method, MethodError};

/// A method with all the parameter values that make up its curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// As written: what the curve is called.
    pub name: String,
    /// One run each.
    pub variants: Vec<Method>,
}

/// Why a list of methods cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum EntryError {
    /// No such method, or no such parameter.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// The same twice.
    #[error("{name} stands twice in --methods; name each once")]
    Twice {
        /// As written.
        name: String,
    },
    /// A place between commas is empty.
    #[error("--methods \"{text}\" has an empty place; write METHOD or METHOD:key=value, with commas between")]
    Empty {
        /// As written.
        text: String,
    },
}

/// Reads a list of methods. A comma separates methods as well as parameters: what has no `=` before its colon begins
/// a method. `a|b` stands for one run with each value. Gathers that do not say how they find form factors take
/// `estimator`.
///
/// # Errors
/// What is unknown, empty or doubled.
pub fn parse_methods(text: &str, estimator: Estimator) -> Result<Vec<Entry>, EntryError> {
    let mut written: Vec<String> = Vec::new();
    for part in text.split(',').map(str::trim) {
        if part.is_empty() {
            return Err(EntryError::Empty { text: text.into() });
        }
        let begins = !part.split(':').next().unwrap_or(part).contains('=');
        match written.last_mut() {
            Some(last) if !begins => {
                last.push(if last.contains(':') { ',' } else { ':' });
                last.push_str(part);
            }
            _ => written.push(part.into()),
        }
    }
    let mut entries: Vec<Entry> = Vec::new();
    for name in written {
        if entries.iter().any(|e| e.name == name) {
            return Err(EntryError::Twice { name });
        }
        let variants = expand(&name).iter().map(|v| variant(v, estimator)).collect::<Result<_, _>>()?;
        entries.push(Entry { name, variants });
    }
    Ok(entries)
}

fn variant(text: &str, estimator: Estimator) -> Result<Method, MethodError> {
    let mut method: Method = text.parse()?;
    if let Method::Gather(p) = &mut method
        && !text.contains("estimator=")
    {
        p.estimator = estimator;
    }
    Ok(method)
}

/// Every combination of alternatives, the last parameter running fastest.
fn expand(text: &str) -> Vec<String> {
    let (name, parameters) = text.split_once(':').unwrap_or((text, ""));
    let mut out = vec![String::new()];
    for part in parameters.split(',').filter(|p| !p.is_empty()) {
        let (key, values) = part.split_once('=').unwrap_or((part, ""));
        let both = |so_far: &String, value: &str| match value.is_empty() && !part.contains('=') {
            true => format!("{so_far},{key}"),
            false => format!("{so_far},{key}={value}"),
        };
        out = out.iter().flat_map(|s| values.split('|').map(move |v| both(s, v.trim()))).collect();
    }
    out.into_iter().map(|p| format!("{name}:{}", p.trim_start_matches(','))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> Vec<(String, Vec<String>)> {
        let entries = parse_methods(text, Estimator::Rays).expect("a list");
        entries.into_iter().map(|e| (e.name, e.variants.iter().map(ToString::to_string).collect())).collect()
    }

    #[test]
    fn commas_separate_methods_and_parameters() {
        let list = names("gather:rays=4096, randomisations=8,hemicube:resolution=50,gather,hemicube");
        let written: Vec<&str> = list.iter().map(|(n, _)| n.as_str()).collect();
        assert_eq!(written, ["gather:rays=4096,randomisations=8", "hemicube:resolution=50", "gather", "hemicube"]);
        assert!(list.iter().all(|(_, v)| v.len() == 1));
    }

    #[test]
    fn bars_stand_for_one_run_each() {
        let (name, variants) = names("hemicube:resolution=50|100,delta=midpoint|exact").remove(0);
        assert_eq!(name, "hemicube:resolution=50|100,delta=midpoint|exact");
        let tail = "rotation=0,tolerance=0.001";
        let known = [
            format!("hemicube:resolution=50,delta=midpoint,{tail}"),
            format!("hemicube:resolution=50,delta=exact,{tail}"),
            format!("hemicube:resolution=100,delta=midpoint,{tail}"),
            format!("hemicube:resolution=100,delta=exact,{tail}"),
        ];
        assert_eq!(variants, known);
    }

    #[test]
    fn the_estimator_is_filled_in_where_it_is_left_open() {
        let of = |text: &str| match parse_methods(text, Estimator::Auto).expect("a list")[0].variants[0] {
            Method::Gather(p) => p.estimator,
            _ => panic!("not a gather"),
        };
        assert_eq!((of("gather"), of("gather:estimator=rays")), (Estimator::Auto, Estimator::Rays));
    }

    #[test]
    fn what_cannot_be_run_is_refused() {
        let said = |text: &str| parse_methods(text, Estimator::Rays).expect_err(text).to_string();
        assert!(said("gather,photon-map:rays=5").contains("methods are gather"));
        assert!(said("gather,,hemicube").contains("empty place") && said("").contains("empty place"));
        assert!(said("gather,gather").contains("twice"));
        assert!(said("hemicube:resolution=50|51").contains("even"));
        assert!(said("hemicube:resolution=").contains("resolution"));
        assert!(said("rays=5").contains("methods are gather"));
    }
}
