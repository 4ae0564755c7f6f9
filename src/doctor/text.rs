//! Numbers and lists as the findings write them.

use crate::math::DVec3;
use crate::scene::Stage;
use crate::stats::Moments;

/// Patches listed at most: the worst first, the text says how many there are.
pub(super) const LISTED: usize = 64;

/// A number with about three digits: "0.334", "12.5", "2.1e-7".
pub(super) fn digits(x: f64) -> String {
    match x.abs() {
        0.0 => "0".into(),
        a if (1e-3..1e5).contains(&a) => {
            let decimals = (2.0 - a.log10().floor()).clamp(0.0, 5.0) as usize;
            let text = format!("{x:.decimals$}");
            if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
        }
        _ => format!("{x:.1e}"),
    }
}

/// "3.2 %".
pub(super) fn percent(share: f64) -> String {
    format!("{} %", digits(100.0 * share))
}

/// "0.3304 ± 0.0020 %": a share with its standard error, two digits of that.
pub(super) fn share(m: &Moments) -> String {
    match m.std_err() {
        Some(e) if e > 0.0 => {
            let decimals = (1.0 - (100.0 * e).log10().floor()).clamp(0.0, 12.0) as usize;
            format!("{:.decimals$} ± {:.decimals$} %", 100.0 * m.mean, 100.0 * e)
        }
        _ => percent(m.mean),
    }
}

/// "(1.5, 0, 2.25)", metres.
pub(super) fn point(p: DVec3) -> String {
    let [x, y, z] = p.to_array().map(|c| {
        let rounded = (c * 1e4).round() / 1e4;
        if c != 0.0 && rounded == 0.0 { format!("{c:.1e}") } else { (rounded + 0.0).to_string() }
    });
    format!("({x}, {y}, {z})")
}

/// A length in the unit that suits it.
pub(super) fn metres(length: f64) -> String {
    match length {
        0.0 => "0 m".into(),
        l if (1e-6..1.0).contains(&l) => format!("{} mm", digits(l * 1e3)),
        l => format!("{} m", digits(l)),
    }
}

/// "floor", "lamp" and 3 more.
pub(super) fn names<S: AsRef<str>>(names: &[S]) -> String {
    let shown: Vec<String> = names.iter().take(4).map(|n| format!("\"{}\"", n.as_ref())).collect();
    match names.len() {
        n if n > 4 => format!("{} and {} more", shown.join(", "), n - 4),
        _ => shown.join(", "),
    }
}

/// "patch 3", "patches 3, 4 and 12 more".
pub(super) fn patches(numbers: &[u32]) -> String {
    let shown: Vec<String> = numbers.iter().take(4).map(u32::to_string).collect();
    match numbers.len() {
        1 => format!("patch {}", shown[0]),
        n if n > 4 => format!("patches {} and {} more", shown.join(", "), n - 4),
        _ => format!("patches {}", shown.join(", ")),
    }
}

/// "is" or "are".
pub(super) fn verb(count: usize, one: &'static str, many: &'static str) -> &'static str {
    if count == 1 { one } else { many }
}

/// Names of the surfaces of some facets, each once, in order.
pub(super) fn surfaces_of(stage: &Stage, facets: impl IntoIterator<Item = u32>) -> Vec<String> {
    let mut numbers: Vec<u32> = facets.into_iter().map(|f| stage.facets[f as usize].surface).collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers.into_iter().map(|s| stage.surfaces[s as usize].name.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_true() {
        assert_eq!(
            [0.0, 0.33444, 12.345, 1234.6, 2.13e-7, 100.0].map(digits),
            ["0", "0.334", "12.3", "1235", "2.1e-7", "100"]
        );
        assert_eq!([0.0, 0.005, 1.7320508, 1e-9].map(metres), ["0 m", "5 mm", "1.73 m", "1.0e-9 m"]);
        assert_eq!(share(&[0.00329, 0.00331].into_iter().collect()), "0.3300 ± 0.0010 %");
        assert_eq!(share(&[1.0, 1.0].into_iter().collect()), "100 %");
        assert_eq!(names(&["a", "b", "c", "d", "e", "f"]), "\"a\", \"b\", \"c\", \"d\" and 2 more");
        assert_eq!(point(DVec3::new(0.1 + 0.2, -0.0, 1e-7)), "(0.3, 0, 1.0e-7)");
    }
}
