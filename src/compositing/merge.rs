//! Which of two lists of segments is seen where: the span buffers A, B and C of one sub-scanline [NINT89 fig. 6].

use super::image::{DepthPlane, Span};

/// Reciprocal depths that differ by less than this share are the same: two faces in one plane.
const SAME_DEPTH: f64 = 1e-11;

/// Depth of all faces along one sub-scanline, and who comes first where two are equally deep.
pub(super) struct Depths<'a> {
    planes: &'a [DepthPlane],
    /// True for faces that turn their back to the eye: of two faces in one plane the front is seen.
    backs: &'a [bool],
    y: f64,
}

impl<'a> Depths<'a> {
    pub(super) fn at_row(planes: &'a [DepthPlane], backs: &'a [bool], y: f64) -> Self {
        Self { planes, backs, y }
    }

    pub(super) fn value(&self, face: u32, x: f64) -> f64 {
        self.planes[face as usize].value(x, self.y)
    }

    /// Positive where `a` is nearer than `b`; exactly zero where they are in one place.
    fn lead(&self, a: u32, b: u32, x: f64) -> f64 {
        let (va, vb) = (self.value(a, x), self.value(b, x));
        let d = va - vb;
        if d.abs() <= SAME_DEPTH * va.abs().max(vb.abs()) { 0.0 } else { d }
    }

    fn wins_tie(&self, a: u32, b: u32) -> bool {
        (self.backs[a as usize], a) < (self.backs[b as usize], b)
    }

    /// Where the planes of two faces cross; the same bits whichever is named first.
    pub(super) fn crossing(&self, a: u32, b: u32) -> f64 {
        let (a, b) = (a.min(b), a.max(b));
        let (p, q) = (&self.planes[a as usize], &self.planes[b as usize]);
        ((p.at - q.at) + (p.along_y - q.along_y) * self.y) / (q.along_x - p.along_x)
    }

    /// Who is seen in [from, to], where both `a` and `b` are: the first to the returned place, the second from there.
    pub(super) fn seen(&self, a: u32, b: u32, from: f64, to: f64) -> (u32, f64, u32) {
        let (l, r) = (self.lead(a, b, from), self.lead(a, b, to));
        let whole = |f: u32| (f, to, f);
        match (l > 0.0, l < 0.0, r > 0.0, r < 0.0) {
            (true, _, _, true) => (a, self.crossing(a, b).clamp(from, to), b),
            (_, true, true, _) => (b, self.crossing(a, b).clamp(from, to), a),
            (true, ..) | (_, _, true, _) => whole(a),
            (_, true, ..) | (_, _, _, true) => whole(b),
            _ => whole(if self.wins_tie(a, b) { a } else { b }),
        }
    }
}

/// Appends a segment; one that goes on with the same face grows the last.
pub(super) fn push(out: &mut Vec<Span>, span: Span) {
    if span.to <= span.from {
        return;
    }
    match out.last_mut() {
        Some(last) if last.face == span.face && last.lit == span.lit && last.to == span.from => last.to = span.to,
        _ => out.push(span),
    }
}

/// What is seen of both lists: not crossing, crossing and overlapping segments alike. Lists are sorted, without overlaps.
pub(super) fn merge(a: &[Span], b: &[Span], depths: &Depths, out: &mut Vec<Span>) {
    out.clear();
    let (mut i, mut j) = (0, 0);
    let mut x = f64::NEG_INFINITY;
    while i < a.len() || j < b.len() {
        // What of the two lists covers x, and how far that stays so.
        let cover = |list: &[Span], k: usize| match list.get(k) {
            None => (None, f64::INFINITY),
            Some(s) if s.from > x => (None, s.from),
            Some(s) => (Some(s.face), s.to),
        };
        let ((fa, ea), (fb, eb)) = (cover(a, i), cover(b, j));
        let end = ea.min(eb);
        let mut emit = |face: u32, from: f64, to: f64| push(out, Span { from, to, face, lit: true });
        match (fa, fb) {
            (Some(f), None) | (None, Some(f)) => emit(f, x, end),
            (Some(f), Some(g)) => {
                let (first, change, second) = depths.seen(f, g, x, end);
                emit(first, x, change);
                emit(second, change, end);
            }
            (None, None) => {}
        }
        x = end;
        i += usize::from(a.get(i).is_some_and(|s| s.to <= x));
        j += usize::from(b.get(j).is_some_and(|s| s.to <= x));
    }
}

/// The front of any number of segments: lists of one each, merged two by two.
pub(super) fn front(segments: &[Span], depths: &Depths) -> Vec<Span> {
    let mut lists: Vec<Vec<Span>> = segments.iter().map(|s| vec![*s]).collect();
    while lists.len() > 1 {
        let merged = |pair: &[Vec<Span>]| match pair {
            [a, b] => {
                let mut out = Vec::with_capacity(a.len() + b.len());
                merge(a, b, depths, &mut out);
                out
            }
            [a] => a.clone(),
            _ => Vec::new(),
        };
        lists = lists.chunks(2).map(merged).collect();
    }
    lists.pop().unwrap_or_default()
}

/// The parts of a segment that stand before everything in `solid`.
pub(super) fn in_front(span: &Span, solid: &[Span], depths: &Depths, out: &mut Vec<Span>) {
    let mut seen = Vec::new();
    merge(std::slice::from_ref(span), solid, depths, &mut seen);
    seen.iter().filter(|s| s.face == span.face).for_each(|s| push(out, *s));
}
