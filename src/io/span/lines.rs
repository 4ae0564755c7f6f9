//! The run-length lines: counts, codes of segments, and their ends as differences from what tracks foretell.

use super::bytes::{Reader, fold, planes, put, unfold, words};
use super::fault::{Fault, damaged};
use super::frame::{Sections, Writer};
use super::head::Head;
use super::track::{Seat, Tracks};
use crate::compositing::{Line, Span, SpanImage};

const CODE: &str = "section \"code\"";
const ROWS: &str = "section \"rows\"";
const ENDS: &str = "section \"ends\"";
/// The segment is lit.
const LIT: u64 = 1;
/// Its end is written: the next does not begin there.
const APART: u64 = 2;

pub(super) fn write(image: &SpanImage, out: &mut Writer) -> Result<(), Fault> {
    let (mut rows, mut codes, mut ends) = (Vec::new(), Vec::new(), Vec::new());
    let (mut seats, faces) = (Vec::new(), image.faces.len());
    for over in [false, true] {
        let mut tracks = Tracks::new(faces);
        for line in &image.lines {
            let spans = if over { &line.over } else { &line.solid };
            put(&mut rows, spans.len() as u64);
            write_line(spans, &mut tracks, &mut seats, &mut codes, &mut ends);
        }
    }
    out.section(*b"rows", &rows)?;
    out.section(*b"code", &codes)?;
    out.section(*b"ends", &planes(&ends))
}

/// True where a segment ends elsewhere than the next begins, to the bit.
fn is_apart(spans: &[Span], k: usize) -> bool {
    spans.get(k + 1).is_none_or(|next| next.from.to_bits() != spans[k].to.to_bits())
}

fn write_line(spans: &[Span], tracks: &mut Tracks, seats: &mut Vec<Seat>, codes: &mut Vec<u8>, ends: &mut Vec<u64>) {
    tracks.next_line();
    seats.clear();
    let mut off = |x: f64, foretold: f64| ends.push(fold((x.to_bits() as i64).wrapping_sub(foretold.to_bits() as i64)));
    let (mut face, mut at) = (0, 0.0);
    for (k, span) in spans.iter().enumerate() {
        let apart = is_apart(spans, k);
        let marks = if apart { APART } else { 0 } | if span.lit { LIT } else { 0 };
        put(codes, fold(i64::from(span.face) - face) << 2 | marks);
        let left = seats.last().copied().filter(|_| k > 0 && !is_apart(spans, k - 1));
        let seat = tracks.seat(span.face);
        off(span.from, tracks.begins(seat, left, at));
        if apart {
            off(span.to, tracks.ends(seat, span.from));
        }
        seats.push(seat);
        (face, at) = (i64::from(span.face), if apart { span.to } else { span.from });
    }
    seats.iter().zip(spans).for_each(|(seat, s)| tracks.note(*seat, [s.from, s.to]));
}

pub(super) fn read(head: &Head, sections: &mut Sections) -> Result<Vec<Line>, Fault> {
    let (rows, codes, ends) = (sections.next(*b"rows")?, sections.next(*b"code")?, sections.next(*b"ends")?);
    let ends = words(&ends).ok_or_else(|| damaged(ENDS, "has a length that is no multiple of 8"))?;
    // A line takes two bytes of counts, a segment a code and an end: what is short of that is refused before memory is taken.
    let segments = head.segments[0].saturating_add(head.segments[1]);
    if head.lines.saturating_mul(2) > rows.len() || segments > codes.len().min(ends.len()) as u64 {
        return Err(damaged(ROWS, "has not the lines and segments that the header counts"));
    }
    let mut rows = Reader::new(ROWS, &rows);
    let mut source = Source { codes: Reader::new(CODE, &codes), ends: ends.iter(), faces: head.faces };
    let mut lines = vec![Line::default(); head.lines];
    let mut seats = Vec::new();
    for (part, count) in head.segments.into_iter().enumerate() {
        let mut tracks = Tracks::new(head.faces);
        let mut total = 0u64;
        for line in &mut lines {
            let n = rows.number()?;
            total = total.saturating_add(n);
            if n > source.codes.left() as u64 {
                return Err(damaged(ROWS, "counts more segments than there are"));
            }
            let spans = source.line(n as usize, &mut tracks, &mut seats)?;
            *(if part == 0 { &mut line.solid } else { &mut line.over }) = spans;
        }
        if total != count {
            return Err(damaged(ROWS, format!("counts {total} segments, the header {count}")));
        }
    }
    rows.done()?;
    source.codes.done()?;
    match source.ends.len() {
        0 => Ok(lines),
        left => Err(damaged(ENDS, format!("{left} numbers are left over"))),
    }
}

/// What lines are read from.
struct Source<'a> {
    codes: Reader<'a>,
    ends: std::slice::Iter<'a, u64>,
    faces: usize,
}

impl Source<'_> {
    /// The next end, from what was foretold.
    fn end(&mut self, foretold: f64) -> Result<f64, Fault> {
        let off = self.ends.next().ok_or_else(|| damaged(ENDS, "ends too early"))?;
        Ok(f64::from_bits((foretold.to_bits() as i64).wrapping_add(unfold(*off)) as u64))
    }

    fn line(&mut self, count: usize, tracks: &mut Tracks, seats: &mut Vec<Seat>) -> Result<Vec<Span>, Fault> {
        tracks.next_line();
        seats.clear();
        let mut spans: Vec<Span> = Vec::with_capacity(count);
        let (mut face, mut at, mut joined) = (0i64, 0.0, false);
        for k in 0..count {
            let code = self.codes.number()?;
            let number = face.wrapping_add(unfold(code >> 2));
            let known = u32::try_from(number).ok().filter(|f| (*f as usize) < self.faces);
            let number = known.ok_or_else(|| damaged(CODE, format!("there is no face {number}")))?;
            let left = seats.last().copied().filter(|_| joined);
            let seat = tracks.seat(number);
            let from = self.end(tracks.begins(seat, left, at))?;
            if joined {
                spans[k - 1].to = from;
            }
            joined = code & APART == 0;
            let to = if joined { from } else { self.end(tracks.ends(seat, from))? };
            spans.push(Span { from, to, face: number, lit: code & LIT != 0 });
            seats.push(seat);
            (face, at) = (i64::from(number), to);
        }
        if joined {
            return Err(damaged(CODE, "the last segment of a line has no end"));
        }
        seats.iter().zip(&spans).for_each(|(seat, s)| tracks.note(*seat, [s.from, s.to]));
        Ok(spans)
    }
}
