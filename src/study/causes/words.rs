//! Numbers and lists in sentences.

/// A share as per cent with three significant digits: `0.0123` as "1.23 %".
pub(super) fn percent(share: f64) -> String {
    format!("{} %", digits(100.0 * share))
}

/// Three significant digits, without trailing zeros.
pub(super) fn digits(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let places = (2 - x.abs().log10().floor() as i32).clamp(0, 12) as usize;
    let text = format!("{x:.places$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

/// One value per band: a single one where they are alike.
pub(super) fn per_band(values: &[f64]) -> String {
    let text: Vec<String> = values.iter().map(|v| digits(*v)).collect();
    match text.first() {
        Some(first) if text.iter().all(|t| t == first) => first.clone(),
        _ => format!("[{}]", text.join(", ")),
    }
}

/// "3 % too bright", "3 % too dark" for a factor.
pub(super) fn too_bright(factor: f64) -> String {
    let word = if factor > 1.0 { "bright" } else { "dark" };
    format!("{} too {word}", percent((factor - 1.0).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(percent(0.012_34), "1.23 %");
        assert_eq!(percent(1.0), "100 %");
        assert_eq!(digits(0.6), "0.6");
        assert_eq!(digits(1234.5), "1234");
        assert_eq!(digits(0.0), "0");
        assert_eq!(per_band(&[0.61, 0.61]), "0.61");
        assert_eq!(per_band(&[0.61, 0.5]), "[0.61, 0.5]");
        assert_eq!(too_bright(0.5), "50 % too dark");
    }
}
