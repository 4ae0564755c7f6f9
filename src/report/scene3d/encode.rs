//! Numbers as text that a page decodes in one step: little-endian, base64.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// Single-precision numbers; NaN where there is none.
pub(super) fn numbers(values: impl IntoIterator<Item = Option<f64>>) -> String {
    let one = |v: Option<f64>| v.map_or(f32::NAN, |v| v as f32).to_le_bytes();
    bytes(&values.into_iter().flat_map(one).collect::<Vec<u8>>())
}

/// Whole numbers.
pub(super) fn counts(values: impl IntoIterator<Item = u32>) -> String {
    bytes(&values.into_iter().flat_map(u32::to_le_bytes).collect::<Vec<u8>>())
}

/// Bytes as they are.
pub(super) fn bytes(values: &[u8]) -> String {
    STANDARD.encode(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_encoded_is_little_endian_and_missing_is_not_zero() {
        let back = |text: &str| STANDARD.decode(text).expect("base64");
        assert_eq!(back(&numbers([Some(1.5)])), [0x00, 0x00, 0xc0, 0x3f]);
        assert_eq!(back(&counts([1, 258])), [1, 0, 0, 0, 2, 1, 0, 0]);
        let missing = back(&numbers([None]));
        assert!(f32::from_le_bytes(missing.try_into().expect("four bytes")).is_nan());
    }
}
