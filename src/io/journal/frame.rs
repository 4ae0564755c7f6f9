//! The journal's file: a header that says what it is about, then frames of records, each with a checksum that
//! depends on the header and on its place.

use crc32fast::Hasher;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};

/// Format, on the first line.
const FORMAT: &str = "etalon-journal/1";
/// First bytes of each frame.
const MAGIC: u32 = u32::from_le_bytes(*b"rows");
/// Bytes before the records: magic, length, records, number of the frame, section, checksum.
const HEAD: usize = 28;
/// Longest header that is read.
const MOST_HEADER: u64 = 1 << 16;

/// What stands before the frames.
pub(super) fn header(key: &str) -> Vec<u8> {
    format!("{FORMAT}\n{key}\n").into_bytes()
}

/// Records of one section, not yet in the file.
#[derive(Debug, Default)]
pub(super) struct Frame {
    /// Section.
    pub section: u64,
    /// Number of records.
    pub records: u32,
    /// Records, each after its length.
    pub payload: Vec<u8>,
}

impl Frame {
    /// Adds a record.
    pub(super) fn push(&mut self, record: &[u8]) {
        self.payload.extend_from_slice(&(record.len() as u32).to_le_bytes());
        self.payload.extend_from_slice(record);
        self.records += 1;
    }

    /// The frame's head as frame `number` of a file with this header.
    pub(super) fn head(&self, header: &[u8], number: u32) -> [u8; HEAD] {
        let mut head = [0; HEAD];
        let fields = [MAGIC, self.payload.len() as u32, self.records, number];
        for (bytes, field) in head.chunks_mut(4).zip(fields) {
            bytes.copy_from_slice(&field.to_le_bytes());
        }
        head[16..24].copy_from_slice(&self.section.to_le_bytes());
        let sum = checksum(header, &head[..24], &self.payload);
        head[24..].copy_from_slice(&sum.to_le_bytes());
        head
    }
}

fn checksum(header: &[u8], head: &[u8], payload: &[u8]) -> u32 {
    let mut hasher = Hasher::new();
    [header, head, payload].iter().for_each(|part| hasher.update(part));
    hasher.finalize()
}

/// Records of a payload; stops where lengths do not fit.
pub(super) fn records(payload: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = payload;
    std::iter::from_fn(move || {
        let (length, after) = rest.split_first_chunk::<4>()?;
        let (record, after) = after.split_at_checked(u32::from_le_bytes(*length) as usize)?;
        rest = after;
        Some(record)
    })
}

/// A frame in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Placed {
    pub section: u64,
    pub records: u32,
    /// Where its head begins, bytes from the beginning of the file.
    pub at: u64,
    pub number: u32,
}

/// The valid part of a journal.
#[derive(Debug, Default)]
pub(super) struct Contents {
    pub frames: Vec<Placed>,
    /// Bytes of header and valid frames.
    pub end: u64,
}

/// The key that a journal is about, `None` if it is none.
pub(super) fn key(file: &File) -> io::Result<Option<String>> {
    let mut begin = Vec::new();
    let mut file = file;
    file.seek(SeekFrom::Start(0))?;
    file.take(MOST_HEADER).read_to_end(&mut begin)?;
    let mut lines = begin.splitn(3, |b| *b == b'\n');
    let format = lines.next().unwrap_or_default();
    let key = lines.next().unwrap_or_default();
    let complete = format == FORMAT.as_bytes() && lines.next().is_some();
    Ok(complete.then(|| String::from_utf8_lossy(key).into_owned()))
}

/// Reads frames until the first that is torn, changed or out of place.
pub(super) fn scan(file: &File, header: &[u8]) -> io::Result<Contents> {
    let length = file.metadata()?.len();
    let mut reader = BufReader::new(file);
    reader.seek(SeekFrom::Start(header.len() as u64))?;
    let mut contents = Contents { frames: Vec::new(), end: header.len() as u64 };
    loop {
        let number = contents.frames.len() as u32;
        let Some(frame) = read_frame(&mut reader, header, number, length - contents.end)? else { break };
        contents.frames.push(Placed { section: frame.section, records: frame.records, at: contents.end, number });
        contents.end += (HEAD + frame.payload.len()) as u64;
    }
    Ok(contents)
}

/// Reads one frame again.
pub(super) fn read_at(file: &File, header: &[u8], placed: Placed) -> io::Result<Option<Frame>> {
    let length = file.metadata()?.len();
    let mut reader = file;
    reader.seek(SeekFrom::Start(placed.at))?;
    read_frame(&mut reader, header, placed.number, length.saturating_sub(placed.at))
}

/// The next frame; `None` if what follows is not that frame, whole and unchanged.
fn read_frame(reader: &mut impl Read, header: &[u8], number: u32, left: u64) -> io::Result<Option<Frame>> {
    let mut head = [0; HEAD];
    if left < HEAD as u64 {
        return Ok(None);
    }
    reader.read_exact(&mut head)?;
    let field = |k: usize| u32::from_le_bytes([head[4 * k], head[4 * k + 1], head[4 * k + 2], head[4 * k + 3]]);
    let length = u64::from(field(1));
    // A damaged length must not ask for memory.
    if field(0) != MAGIC || field(3) != number || length > left - HEAD as u64 {
        return Ok(None);
    }
    let mut payload = vec![0; length as usize];
    reader.read_exact(&mut payload)?;
    if checksum(header, &head[..24], &payload) != field(6) {
        return Ok(None);
    }
    let section = u64::from(field(4)) | u64::from(field(5)) << 32;
    Ok(Some(Frame { section, records: field(2), payload }))
}
