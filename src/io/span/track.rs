//! Where the ends of segments go from line to line: straight edges make straight tracks, so the next end is foretold to
//! a few last bits.

/// One end of one segment, as it was on the last lines.
#[derive(Clone, Copy, Default)]
struct Track {
    /// Last place, and the one before.
    last: f64,
    before: f64,
    /// Line of `last`.
    line: u32,
    /// Lines without a gap up to `line`: 0, 1, or 2 for more.
    run: u8,
}

impl Track {
    fn set(&mut self, line: u32, x: f64) {
        let goes_on = self.run > 0 && line == self.line + 1;
        *self = Self { last: x, before: self.last, line, run: if goes_on { 2 } else { 1 } };
    }

    /// How well it foretells the end on `line`, and what.
    fn forecast(&self, line: u32) -> (u8, f64) {
        match (self.run, line.wrapping_sub(self.line)) {
            (0, _) => (0, 0.0),
            (2, 1) => (3, 2.0 * self.last - self.before),
            (_, 1) => (2, self.last),
            _ => (1, self.last),
        }
    }
}

/// Both ends of the segments of one face; the n-th on a line goes on from the n-th on lines before.
#[derive(Clone, Default)]
struct OfFace {
    /// Line on which `seen` were seen.
    line: u32,
    seen: usize,
    ends: Vec<[Track; 2]>,
}

/// The tracks of all faces.
pub(super) struct Tracks {
    faces: Vec<OfFace>,
    /// Number of the current line, from 1.
    line: u32,
}

/// A segment on the current line: its face, and how many of that face came before it.
#[derive(Clone, Copy)]
pub(super) struct Seat {
    face: usize,
    turn: usize,
}

impl Tracks {
    pub(super) fn new(faces: usize) -> Self {
        Self { faces: vec![OfFace::default(); faces], line: 0 }
    }

    pub(super) fn next_line(&mut self) {
        self.line += 1;
    }

    /// The place of the next segment of a face on this line. The face must exist.
    pub(super) fn seat(&mut self, face: u32) -> Seat {
        let own = &mut self.faces[face as usize];
        if own.line != self.line {
            (own.line, own.seen) = (self.line, 0);
        }
        own.seen += 1;
        Seat { face: face as usize, turn: own.seen - 1 }
    }

    fn forecast(&self, seat: Seat, end: usize) -> (u8, f64) {
        self.faces[seat.face].ends.get(seat.turn).map_or((0, 0.0), |t| t[end].forecast(self.line))
    }

    /// Where a segment should begin: by its own track, or by the end of the one before it (`left`) where that is longer.
    pub(super) fn begins(&self, seat: Seat, left: Option<Seat>, else_at: f64) -> f64 {
        let own = self.forecast(seat, 0);
        let other = left.map_or((0, 0.0), |l| self.forecast(l, 1));
        let best = if other.0 > own.0 { other } else { own };
        if best.0 == 0 { else_at } else { best.1 }
    }

    /// Where a segment should end that begins at `from`.
    pub(super) fn ends(&self, seat: Seat, from: f64) -> f64 {
        let own = self.forecast(seat, 1);
        if own.0 == 0 { from } else { own.1 }
    }

    /// Notes the ends of a segment, once all of the line are known.
    pub(super) fn note(&mut self, seat: Seat, ends: [f64; 2]) {
        let own = &mut self.faces[seat.face].ends;
        if own.len() <= seat.turn {
            own.resize(seat.turn + 1, [Track::default(); 2]);
        }
        (0..2).for_each(|e| own[seat.turn][e].set(self.line, ends[e]));
    }
}
