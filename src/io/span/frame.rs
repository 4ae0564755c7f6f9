//! The frame of the file: first line, length, sections with checksums that depend on everything before, end mark.

use super::SPAN_FORMAT;
use super::fault::{Fault, damaged};
use crc32fast::Hasher;
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use std::borrow::Cow;
use std::io::{Read, Write};

/// Tag of the last section.
pub(super) const END: [u8; 4] = *b"end ";
/// First line with its line feed, and the length of the file.
const FRONT: usize = SPAN_FORMAT.len() + 1 + 8;
/// Tag, method, packed and whole length.
const HEAD: usize = 4 + 1 + 8 + 8;
const PLAIN: u8 = 0;
const ZLIB: u8 = 1;
/// A packed section may grow to this many times its size, or to `ALWAYS` bytes: a small file cannot ask for much memory.
const MOST_PACKED: u64 = 64;
const ALWAYS: u64 = 1 << 28;

fn may_grow(packed: u64, whole: u64) -> bool {
    whole <= ALWAYS || whole <= packed.saturating_mul(MOST_PACKED)
}

fn checksum(before: u32, bytes: &[u8]) -> u32 {
    let mut hasher = Hasher::new();
    hasher.update(&before.to_le_bytes());
    hasher.update(bytes);
    hasher.finalize()
}

/// Puts a file together.
pub(super) struct Writer {
    bytes: Vec<u8>,
    sum: u32,
}

impl Writer {
    pub(super) fn new() -> Self {
        let bytes = [SPAN_FORMAT.as_bytes(), b"\n", &[0; 8]].concat();
        // The length is not known yet: the reader compares it with that of the file.
        let sum = checksum(0, &bytes[..SPAN_FORMAT.len() + 1]);
        Self { bytes, sum }
    }

    /// Adds a section, packed where that is smaller.
    pub(super) fn section(&mut self, tag: [u8; 4], whole: &[u8]) -> Result<(), Fault> {
        let broken = |e: std::io::Error| damaged(name(tag), format!("cannot be packed: {e}"));
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(whole).map_err(broken)?;
        let packed = encoder.finish().map_err(broken)?;
        let better = packed.len() < whole.len() && may_grow(packed.len() as u64, whole.len() as u64);
        let (method, body) = if better { (ZLIB, packed.as_slice()) } else { (PLAIN, whole) };
        let begin = self.bytes.len();
        self.bytes.extend_from_slice(&tag);
        self.bytes.push(method);
        self.bytes.extend_from_slice(&(body.len() as u64).to_le_bytes());
        self.bytes.extend_from_slice(&(whole.len() as u64).to_le_bytes());
        self.bytes.extend_from_slice(body);
        self.sum = checksum(self.sum, &self.bytes[begin..]);
        self.bytes.extend_from_slice(&self.sum.to_le_bytes());
        Ok(())
    }

    pub(super) fn finish(mut self) -> Vec<u8> {
        let length = self.bytes.len() as u64;
        self.bytes[FRONT - 8..FRONT].copy_from_slice(&length.to_le_bytes());
        self.bytes
    }
}

fn name(tag: [u8; 4]) -> String {
    format!("section \"{}\"", String::from_utf8_lossy(&tag).trim_end().escape_debug())
}

/// The sections of a file, one after the other.
pub(super) struct Sections<'a> {
    rest: &'a [u8],
    sum: u32,
}

impl<'a> Sections<'a> {
    /// Looks at first line and length.
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, Fault> {
        let line = bytes.iter().take(40).position(|b| *b == b'\n').map(|end| &bytes[..end]);
        let first = line.map_or(Cow::Borrowed(""), String::from_utf8_lossy);
        if first != SPAN_FORMAT {
            return Err(foreign(&first));
        }
        let front = bytes.get(FRONT - 8..FRONT).and_then(|b| <[u8; 8]>::try_from(b).ok());
        let length = front.map(u64::from_le_bytes).ok_or_else(|| damaged("length", "the file is cut off"))?;
        let has = bytes.len() as u64;
        if length != has {
            let how = if has < length { "is cut off" } else { "has grown or is changed" };
            return Err(damaged("length", format!("the file {how}: {has} bytes, and it says {length}")));
        }
        Ok(Self { rest: &bytes[FRONT..], sum: checksum(0, &bytes[..FRONT - 8]) })
    }

    /// The next section, which must have this tag.
    pub(super) fn next(&mut self, tag: [u8; 4]) -> Result<Cow<'a, [u8]>, Fault> {
        let broken = |problem: &str| damaged(name(tag), problem);
        let head = self.rest.get(..HEAD).ok_or_else(|| broken("is not there"))?;
        let length = |at: usize| head[at..at + 8].iter().rev().fold(0, |n, b| n << 8 | u64::from(*b));
        let (packed, whole) = (length(5), length(13));
        let end = usize::try_from(packed).ok().and_then(|n| n.checked_add(HEAD));
        let section = end.and_then(|e| self.rest.get(..e)).ok_or_else(|| broken("is cut off"))?;
        let sum = self.rest.get(section.len()..section.len() + 4).ok_or_else(|| broken("is cut off"))?;
        self.sum = checksum(self.sum, section);
        if sum != self.sum.to_le_bytes() {
            return Err(broken("is changed: the checksum does not fit"));
        }
        if head[..4] != tag {
            return Err(broken("is not where it should be"));
        }
        self.rest = &self.rest[section.len() + 4..];
        let body = &section[HEAD..];
        match head[4] {
            PLAIN if packed == whole => Ok(Cow::Borrowed(body)),
            ZLIB if may_grow(packed, whole) => {
                unpack(body, whole).map(Cow::Owned).ok_or_else(|| broken("does not unpack"))
            }
            _ => Err(broken("is packed in a way that is not known")),
        }
    }

    pub(super) fn is_done(&self) -> bool {
        self.rest.is_empty()
    }
}

/// Unpacks exactly `whole` bytes; memory grows with what is there.
fn unpack(body: &[u8], whole: u64) -> Option<Vec<u8>> {
    let mut out = Vec::new();
    let mut decoder = ZlibDecoder::new(body).take(whole + 1);
    decoder.read_to_end(&mut out).ok()?;
    (out.len() as u64 == whole && decoder.get_ref().total_in() == body.len() as u64).then_some(out)
}

/// The first line is not ours.
fn foreign(first: &str) -> Fault {
    let version = SPAN_FORMAT.rsplit_once('/').map_or(SPAN_FORMAT, |(family, _)| family);
    match first.strip_prefix(version).and_then(|v| v.strip_prefix('/')) {
        Some(v) => Fault {
            place: "first line".into(),
            problem: format!("is of version {}; this program reads {SPAN_FORMAT}", v.escape_debug()),
            mend: "read it with the etalon that wrote it, or scan the scene again",
        },
        None => Fault {
            place: "first line".into(),
            problem: format!("is no span file: it does not begin with {SPAN_FORMAT}"),
            mend: "give a file that `etalon scan` has written",
        },
    }
}
