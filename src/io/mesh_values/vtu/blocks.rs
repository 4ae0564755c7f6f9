//! Bytes of arrays: base64, headers of lengths, blocks compressed by zlib.

use super::numbers::Read;
use base64::Engine;
use std::io::Read as _;

const CUT: &str = "is the file cut short? Save it again, or as ascii";

/// How bytes are written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coding {
    /// Least significant byte first.
    pub little: bool,
    /// Lengths of 8 bytes, not 4.
    pub wide: bool,
    pub zlib: bool,
}

/// The bytes that text in base64 stands for. Header and data may be encoded apart: padding ends a part.
pub(super) fn base64(text: &[u8]) -> Read<Vec<u8>> {
    let text: Vec<u8> = text.iter().copied().filter(|b| !b.is_ascii_whitespace()).collect();
    let mut out = Vec::with_capacity(text.len() / 4 * 3);
    let mut rest = text.as_slice();
    while !rest.is_empty() {
        let padding = rest.iter().position(|b| *b == b'=').unwrap_or(rest.len());
        let end = padding + rest[padding..].iter().take_while(|b| **b == b'=').count();
        let part = base64::engine::general_purpose::STANDARD.decode(&rest[..end]);
        out.extend(part.map_err(|e| (format!("the base64 text is broken: {e}"), CUT))?);
        rest = &rest[end..];
    }
    Ok(out)
}

/// Lengths at the head of data.
struct Header<'a> {
    bytes: &'a [u8],
    coding: Coding,
}

impl Header<'_> {
    fn next(&mut self) -> Read<usize> {
        let size = if self.coding.wide { 8 } else { 4 };
        let Some((head, rest)) = self.bytes.split_at_checked(size) else {
            return Err(("the data end within their header".into(), CUT));
        };
        self.bytes = rest;
        let fold = |total: u64, b: &u8| total << 8 | u64::from(*b);
        let value = if self.coding.little { head.iter().rev().fold(0, fold) } else { head.iter().fold(0, fold) };
        usize::try_from(value).map_err(|_| (format!("a length of {value} bytes"), CUT))
    }
}

/// The data behind their header, unpacked; `needed` bytes where that is known. What follows is left alone.
pub(super) fn data(bytes: &[u8], coding: Coding, needed: Option<usize>) -> Read<Vec<u8>> {
    // Nothing written at all stands for nothing.
    if bytes.is_empty() && needed.unwrap_or(0) == 0 {
        return Ok(Vec::new());
    }
    let mut header = Header { bytes, coding };
    let first = header.next()?;
    if coding.zlib {
        return unpacked(header, first, needed);
    }
    match header.bytes.get(..first) {
        Some(data) => Ok(data.to_vec()),
        None => Err((format!("{first} bytes are announced, but {} are there", header.bytes.len()), CUT)),
    }
}

fn unpacked(mut header: Header, blocks: usize, needed: Option<usize>) -> Read<Vec<u8>> {
    let size = header.next()?;
    let last = header.next()?;
    let least = if header.coding.wide { 8 } else { 4 };
    if blocks.saturating_mul(least) > header.bytes.len() {
        return Err((format!("{blocks} blocks are announced, more than there is room for"), CUT));
    }
    let packed = (0..blocks).map(|_| header.next()).collect::<Read<Vec<usize>>>()?;
    let mut rest = header.bytes;
    let mut out = Vec::new();
    for (k, length) in packed.into_iter().enumerate() {
        let Some((block, after)) = rest.split_at_checked(length) else {
            return Err((format!("block {k} ends beyond the data"), CUT));
        };
        rest = after;
        let whole = if k + 1 == blocks && last > 0 { last } else { size };
        let before = out.len();
        // One byte more than is announced shows that there is too much, without unpacking what a bomb would hold.
        let mut reader = flate2::read::ZlibDecoder::new(block).take(whole as u64 + 1);
        reader.read_to_end(&mut out).map_err(|e| (format!("block {k} cannot be unpacked: {e}"), CUT))?;
        if out.len() - before != whole {
            let problem = format!("block {k} does not unpack to the {whole} bytes that are announced");
            return Err((problem, CUT));
        }
        if needed.is_some_and(|n| out.len() > n) {
            return Err(("the array holds more numbers than the counts of the piece say".into(), CUT));
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn header_and_data_may_be_encoded_apart_or_together() {
        let engine = base64::engine::general_purpose::STANDARD;
        let together = engine.encode([4u8, 0, 0, 0, 1, 2, 3, 4]);
        let apart = engine.encode([4u8, 0, 0, 0]) + "\n " + &engine.encode([1u8, 2, 3, 4]);
        let coding = Coding { little: true, wide: false, zlib: false };
        for text in [together, apart] {
            assert_eq!(data(&base64(text.as_bytes()).unwrap(), coding, None).unwrap(), [1, 2, 3, 4]);
        }
        assert!(base64(b"A").is_err() && base64(b"====").is_err());
        assert!(data(&[9, 0, 0, 0, 1], coding, None).is_err() && data(&[9, 0], coding, None).is_err());
    }
}
