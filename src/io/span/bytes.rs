//! Numbers as bytes: variable length, planes, least significant byte first.

use super::fault::{Fault, damaged};

/// Appends a number in groups of seven bits, lowest first; the top bit says that more follow.
pub(super) fn put(out: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

/// Small numbers of either sign become small numbers: 0, -1, 1, -2, ... to 0, 1, 2, 3, ...
pub(super) fn fold(value: i64) -> u64 {
    ((value << 1) ^ (value >> 63)) as u64
}

/// The inverse of [`fold`].
pub(super) fn unfold(value: u64) -> i64 {
    (value >> 1) as i64 ^ -((value & 1) as i64)
}

/// The bytes of words in planes: all lowest bytes, then all second bytes, ...
pub(super) fn planes(words: &[u64]) -> Vec<u8> {
    (0..8).flat_map(|k| words.iter().map(move |w| (w >> (8 * k)) as u8)).collect()
}

/// The inverse of [`planes`]; `None` for a length that is no multiple of 8.
pub(super) fn words(planes: &[u8]) -> Option<Vec<u64>> {
    let n = planes.len() / 8;
    let word = |i: usize| (0..8).fold(0, |w, k| w | u64::from(planes[k * n + i]) << (8 * k));
    planes.len().is_multiple_of(8).then(|| (0..n).map(word).collect())
}

/// A reader of one section's bytes.
pub(super) struct Reader<'a> {
    rest: &'a [u8],
    section: &'static str,
}

impl<'a> Reader<'a> {
    pub(super) fn new(section: &'static str, bytes: &'a [u8]) -> Self {
        Self { rest: bytes, section }
    }

    /// Bytes not yet read: what follows cannot hold more things than these.
    pub(super) fn left(&self) -> usize {
        self.rest.len()
    }

    pub(super) fn byte(&mut self) -> Result<u8, Fault> {
        let (byte, rest) = self.rest.split_first().ok_or_else(|| damaged(self.section, "ends too early"))?;
        self.rest = rest;
        Ok(*byte)
    }

    /// The inverse of [`put`].
    pub(super) fn number(&mut self) -> Result<u64, Fault> {
        let mut value = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err(damaged(self.section, "a number has more than 64 bits"))
    }

    /// A number that fits into 32 bits.
    pub(super) fn index(&mut self) -> Result<u32, Fault> {
        let value = self.number()?;
        u32::try_from(value).map_err(|_| damaged(self.section, format!("the number {value} is out of range")))
    }

    /// Everything must have been read.
    pub(super) fn done(&self) -> Result<(), Fault> {
        match self.rest.len() {
            0 => Ok(()),
            left => Err(damaged(self.section, format!("{left} bytes are left over"))),
        }
    }
}
