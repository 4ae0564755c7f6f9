//! What each pixel of a sub-scanline shows, layer by layer.

use super::image::{DepthPlane, Line, Span, SpanFace, SpanImage};
use super::light::{Lamp, Volumes};
use super::merge::Depths;
use super::project::Projection;
use super::regenerate::{Part, pixels};
use super::scan::planes;
use super::shade::{Group, ShadeOptions};
use super::shader::{Bands, Place, Shader, Sight};
use super::soft::{Along, NARROW, WIDE};
use super::sunlit::picture_place;
use crate::math::{DVec2, DVec3};
use std::sync::OnceLock;

/// What one face, or the background, shows of itself in a part of a pixel.
pub(super) struct Layer<'c> {
    /// The face; `None` is the background.
    pub(super) face: Option<u32>,
    /// Share of the light of the part that comes from it: its opacity times what is left by all before it.
    pub(super) share: f64,
    /// Radiance per band.
    pub(super) colour: &'c [f64],
    /// Rays were traced for it.
    pub(super) traced: bool,
    /// Depth along the viewing direction, m; infinite for the background.
    pub(super) depth: f64,
}

/// Takes layers: pixel, length of the part in it, layer.
pub(super) type Sink<'s> = dyn FnMut(usize, f64, &Layer) + 's;

/// An image with everything that drawing needs.
pub(super) struct Painter<'a> {
    image: &'a SpanImage,
    shader: &'a Shader<'a>,
    options: &'a ShadeOptions<'a>,
    planes: Vec<DepthPlane>,
    backs: Vec<bool>,
    projection: Projection,
    /// Of faces so small that one value does, gentle light once it was asked for; `None` for the others.
    small: Vec<Option<[OnceLock<Vec<f64>>; 2]>>,
}

/// Faces of fewer pixels than this across have gentle light of one value.
const SMALL: f64 = 2.0;

/// What lies behind all that can be seen through, on a stretch of a sub-scanline.
#[derive(Default)]
struct Base {
    /// Light of skies and of other lamps with extent along the segment; none where it is not drawn.
    soft: Vec<Along>,
    /// Per lamp with sharp shadows the hidden parts, in x.
    hidden: Vec<Vec<(f64, f64)>>,
}

/// A stretch over which the same faces lie behind one another.
struct Stack<'s> {
    y: f64,
    /// Faces that can be seen through, the nearest first.
    overs: &'s [u32],
    /// What hides the rest, if anything.
    span: Option<&'s Span>,
    /// That, or the background, is drawn by this group.
    own: bool,
    base: &'s Base,
    group: &'s Group,
}

impl<'a> Painter<'a> {
    pub(super) fn new(image: &'a SpanImage, shader: &'a Shader<'a>, options: &'a ShadeOptions<'a>) -> Self {
        let (planes, backs) = planes(image);
        let projection = Projection::of(&image.camera);
        let scale = DVec2::from(options.scale);
        let small = |f: &SpanFace| {
            let places: Option<Vec<DVec2>> =
                f.vertices.iter().map(|v| projection.project(*v).map(|(x, y, _)| DVec2::new(x, y) * scale)).collect();
            let places = places?;
            let (lo, hi) = places.iter().fold((places[0], places[0]), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
            ((hi - lo).length() < SMALL).then(Default::default)
        };
        let small = image.faces.iter().map(small).collect();
        Self { image, shader, options, planes, backs, projection, small }
    }

    /// Tells the layers of sub-scanline j, as far as a group draws them.
    pub(super) fn draw(&self, j: u32, scale: f64, width: usize, group: &Group, sink: &mut Sink) {
        let line = &self.image.lines[j as usize];
        let y = f64::from(j) / f64::from(self.image.per_line);
        let right = f64::from(self.image.camera.size[0]);
        let mut x = 0.0;
        for span in &line.solid {
            self.stretch(None, (x, span.from), y, line, (scale, width), group, sink);
            self.stretch(Some(span), (span.from, span.to), y, line, (scale, width), group, sink);
            x = span.to;
        }
        self.stretch(None, (x, right), y, line, (scale, width), group, sink);
    }

    /// A segment or a gap with all that stands before it.
    fn stretch(
        &self,
        span: Option<&Span>,
        (from, to): (f64, f64),
        y: f64,
        line: &Line,
        (scale, width): (f64, usize),
        group: &Group,
        sink: &mut Sink,
    ) {
        if to <= from {
            return;
        }
        let overs: Vec<&Span> = line.over.iter().filter(|o| o.from < to && o.to > from).collect();
        let drawn = |face: u32| group.volumes(face).is_some();
        let own = span.map_or(group.open, |s| drawn(s.face));
        if !own && !overs.iter().any(|o| drawn(o.face)) {
            return;
        }
        let base = self.base(span, y, scale, group);
        let mut ends: Vec<f64> = overs.iter().flat_map(|o| [o.from, o.to]).filter(|x| *x > from && *x < to).collect();
        let depths = Depths::at_row(&self.planes, &self.backs, y);
        for (k, a) in overs.iter().enumerate() {
            // Where two go through each other their order changes.
            let crossings = overs[k + 1..].iter().map(|b| depths.crossing(a.face, b.face));
            ends.extend(crossings.filter(|x| *x > from && *x < to));
        }
        ends.extend([from, to]);
        ends.sort_by(f64::total_cmp);
        for pair in ends.windows(2) {
            let middle = 0.5 * (pair[0] + pair[1]);
            let mut here: Vec<u32> =
                overs.iter().filter(|o| o.from <= middle && middle < o.to).map(|o| o.face).collect();
            here.sort_by(|a, b| depths.value(*b, middle).total_cmp(&depths.value(*a, middle)).then(a.cmp(b)));
            let stack = Stack { y, overs: &here, span, own, base: &base, group };
            for part in pixels(pair[0], pair[1], scale, width) {
                self.part(&part, &stack, sink);
            }
        }
    }

    fn base(&self, span: Option<&Span>, y: f64, scale: f64, group: &Group) -> Base {
        let Some((span, volumes)) = span.and_then(|s| Some((s, group.volumes(s.face)?))) else {
            return Base::default();
        };
        let bands = self.image.photometry.bands.len();
        let side = self.shader.side(span.face);
        let mut soft = Vec::new();
        for skies in [true, false] {
            if side.radiates && self.shader.has_soft(skies) {
                soft.push(self.along(span, y, scale, bands, volumes, skies));
            }
        }
        Base { soft, hidden: self.hidden(span, y, volumes) }
    }

    /// Light of skies, or of other lamps with extent, along a segment.
    fn along(&self, span: &Span, y: f64, scale: f64, bands: usize, volumes: &[Volumes], skies: bool) -> Along {
        let normal = self.shader.side(span.face).normal;
        let face = span.face;
        if let Some(held) = &self.small[face as usize] {
            let one = held[usize::from(skies)].get_or_init(|| {
                let mut out = vec![0.0; bands];
                let vertices = &self.image.faces[face as usize].vertices;
                let point = vertices.iter().sum::<DVec3>() / vertices.len() as f64;
                self.shader.add_soft(Place { face, point, normal }, volumes, Some(skies), &mut out);
                out
            });
            return Along::constant(span.from, span.to, one);
        }
        // The shadow of a chair's leg is a pixel or two broad; under a sky it has no edge.
        let lamps = 0..volumes.len();
        let shadowed =
            self.options.shadows && lamps.into_iter().any(|k| !self.shader.is_sky(k) && volumes[k].count() > 0);
        let stride = if !skies && shadowed { NARROW } else { WIDE };
        Along::new(span.from, span.to, scale, bands, (stride, self.options.tolerance), |x, out| {
            self.shader.add_soft(Place { face, point: self.point(face, x, y), normal }, volumes, Some(skies), out);
        })
    }

    /// Shadows of the lamps with sharp edges; that of the parallel light which the segments hold is known.
    fn hidden(&self, span: &Span, y: f64, volumes: &[Volumes]) -> Vec<Vec<(f64, f64)>> {
        let ends = [span.from, span.to].map(|x| (x, self.planes[span.face as usize].value(x, y)));
        let points = ends.map(|(x, w)| self.projection.point(x, y, w));
        let of = |(k, lamp): (usize, &Lamp)| {
            let mut out = Vec::new();
            match (self.options.shadows, self.shader.is_marked(k)) {
                (false, _) => {}
                (true, true) => out.extend((!span.lit).then_some((span.from, span.to))),
                (true, false) if lamp.is_hard() => {
                    lamp.hidden(points[0], points[1], span.face, &volumes[k], &mut out);
                    let place = |t| picture_place(ends[0], ends[1], t);
                    out.iter_mut().for_each(|(a, b)| (*a, *b) = (place(*a), place(*b)));
                }
                _ => {}
            }
            out
        };
        self.shader.lamps().iter().enumerate().map(of).collect()
    }

    fn point(&self, face: u32, x: f64, y: f64) -> DVec3 {
        self.projection.point(x, y, self.planes[face as usize].value(x, y))
    }

    /// The layers of a part of a pixel, the nearest first.
    fn part(&self, part: &Part, stack: &Stack, sink: &mut Sink) {
        let (y, x) = (stack.y, 0.5 * (part.from + part.to));
        let sight = Sight { origin: self.image.camera.eye, direction: self.projection.ray(x, y).normalize(), depth: 0 };
        let depth = |face: u32| 1.0 / self.planes[face as usize].value(x, y);
        let bands = self.image.photometry.bands.len();
        let mut colour = Bands::new(bands);
        let colour = colour.get();
        let mut through = 1.0;
        for face in stack.overs {
            let point = self.point(*face, x, y);
            let drawn = stack.group.volumes(*face);
            let (opacity, traced) = self.shader.over(*face, point, &sight, drawn, colour);
            if drawn.is_some() && opacity > 0.0 {
                let share = through * opacity;
                sink(part.pixel, part.length, &Layer { face: Some(*face), share, colour, traced, depth: depth(*face) });
            }
            through *= 1.0 - opacity;
        }
        if !stack.own || through <= 0.0 {
            return;
        }
        let Some(span) = stack.span else {
            self.shader.background(&sight, Some([x, y]), colour);
            let layer = Layer { face: None, share: through, colour, traced: false, depth: f64::INFINITY };
            return sink(part.pixel, part.length, &layer);
        };
        let side = self.shader.side(span.face);
        let mut place = Place { face: span.face, point: self.point(span.face, x, y), normal: side.normal };
        let mut light = Bands::new(bands);
        let light = light.get();
        if side.radiates {
            place = self.shader.bumped(place);
            stack.base.soft.iter().for_each(|along| along.add_at(x, light));
            if side.bumpy {
                self.shader.tilt(side.normal, place, light);
            }
            let hidden = &stack.base.hidden;
            self.shader.hard(place, light, |k| 1.0 - covered(&hidden[k], part.from, part.to));
        }
        let traced = self.shader.surface(place, &sight, light, colour);
        let layer = Layer { face: Some(span.face), share: through, colour, traced, depth: depth(span.face) };
        sink(part.pixel, part.length, &layer);
    }
}

/// Share of [a, b] that sorted intervals cover.
fn covered(intervals: &[(f64, f64)], a: f64, b: f64) -> f64 {
    let sum: f64 = intervals.iter().map(|(l, r)| (r.min(b) - l.max(a)).max(0.0)).sum();
    (sum / (b - a)).min(1.0)
}
