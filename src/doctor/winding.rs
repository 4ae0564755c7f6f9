//! Surfaces turned the wrong way: one face against its neighbours, or a whole body inside out.

use super::Patient;
use super::opening::find;
use super::probe::{Hits, RANDOMISATIONS, add};
use super::skin::Link;
use super::text::{LISTED, names, patches, percent, share, surfaces_of, verb};
use crate::math::{Bounds, DVec3, area, centroid};
use crate::scene::{Consequence, Finding, FindingKind, Place, Severity, Stage};
use std::collections::{BTreeMap, VecDeque};

/// Share of its rays that must escape before a body counts as looking outward.
const OUTWARD: f64 = 0.95;

/// What is turned the wrong way.
pub(super) struct Turned {
    /// By facet.
    pub facets: Vec<Option<How>>,
    /// By facet: number of the body it belongs to.
    pub bodies: Vec<Body>,
    pub body_of: Vec<u32>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum How {
    /// Against its neighbours.
    Alone,
    /// With the whole body.
    Body,
    /// A body that looks outward, in a scene whose light all leaves: solid, or a room inside out.
    Lone,
}

/// Facets joined along edges.
pub(super) struct Body {
    pub facets: Vec<u32>,
    /// True if none of its edges is free.
    pub closed: bool,
    /// Volume if seen from outside, negative if seen from inside, m^3; of a closed body.
    volume: f64,
    bounds: Bounds,
}

/// Finds what is turned the wrong way, by the skin and by where the light goes.
pub(super) fn turned(patient: &Patient) -> Turned {
    let stage = patient.stage;
    let (body_of, groups) = joined(patient);
    let free: Vec<bool> = free_facets(patient);
    let mut facets = vec![None; stage.facets.len()];
    let light = Light::of(patient);
    let mut bodies = Vec::new();
    for (group, links) in groups.into_iter().zip(links_of(patient, &body_of)) {
        let odd = minority(patient, &group, &links, &light);
        odd.iter().for_each(|f| facets[*f as usize] = Some(How::Alone));
        bodies.push(Body::new(stage, group, &free, &facets));
    }
    let all_leaves = (0..facets.len()).all(|f| light.escapes[f].is_none_or(|share| share > 0.999));
    for (k, body) in bodies.iter().enumerate() {
        let how = match all_leaves {
            true => body.is_solid().then_some(How::Lone),
            false => inside_out(&bodies, k, &light, &body_of, &facets).then_some(How::Body),
        };
        if how.is_some() {
            body.facets.iter().for_each(|f| facets[*f as usize] = how);
        }
    }
    Turned { facets, bodies, body_of }
}

/// Body of each facet, and the facets of each body.
fn joined(patient: &Patient) -> (Vec<u32>, Vec<Vec<u32>>) {
    let n = patient.stage.facets.len();
    let mut root: Vec<usize> = (0..n).collect();
    for l in &patient.skin.links {
        let [a, b] = l.facets.map(|f| find(&mut root, f as usize));
        root[a.max(b)] = a.min(b);
    }
    let mut number = BTreeMap::new();
    let mut groups: Vec<Vec<u32>> = Vec::new();
    let body_of = (0..n).map(|f| {
        let r = find(&mut root, f);
        let k = *number.entry(r).or_insert_with(|| {
            groups.push(Vec::new());
            groups.len() - 1
        });
        groups[k].push(f as u32);
        k as u32
    });
    (body_of.collect(), groups)
}

/// Links by body.
fn links_of(patient: &Patient, body_of: &[u32]) -> Vec<Vec<Link>> {
    let count = body_of.iter().max().map_or(0, |m| *m as usize + 1);
    let mut links = vec![Vec::new(); count];
    patient.skin.links.iter().for_each(|l| links[body_of[l.facets[0] as usize] as usize].push(*l));
    links
}

fn free_facets(patient: &Patient) -> Vec<bool> {
    let mut free = vec![false; patient.stage.facets.len()];
    patient.skin.free.iter().for_each(|e| free[e.facet as usize] = true);
    free
}

/// Where the light of each facet goes, and what lands on its back.
struct Light {
    /// Share of its rays that escape, by facet; `None` where it sends none.
    escapes: Vec<Option<f64>>,
    /// Facets whose rays land on the back of each: (sender, hits).
    on_back: Vec<Vec<(u32, u64)>>,
}

impl Light {
    fn of(patient: &Patient) -> Self {
        let n = patient.stage.facets.len();
        let (mut sent, mut escaped) = (vec![0u64; n], vec![0u64; n]);
        let mut on_back = vec![Vec::new(); n];
        for (patch, s) in patient.stage.patches.iter().zip(&patient.probe.sent) {
            let Some(s) = s else { continue };
            let f = patch.facet as usize;
            sent[f] += (patient.probe.rays * RANDOMISATIONS) as u64;
            escaped[f] += super::probe::total(&s.escapes);
            s.backs.iter().for_each(|(g, hits)| on_back[*g as usize].push((patch.facet, super::probe::total(hits))));
        }
        let share = |(s, e): (&u64, &u64)| (*s > 0).then(|| *e as f64 / *s as f64);
        Self { escapes: sent.iter().zip(&escaped).map(share).collect(), on_back }
    }

    fn back_hits(&self, facet: u32) -> u64 {
        self.on_back[facet as usize].iter().map(|(_, h)| h).sum()
    }

    /// Mean share of escapes of some facets.
    fn escaping(&self, facets: &[u32]) -> f64 {
        let shares: Vec<f64> = facets.iter().filter_map(|f| self.escapes[*f as usize]).collect();
        if shares.is_empty() { 0.0 } else { shares.iter().sum::<f64>() / shares.len() as f64 }
    }
}

/// The facets of a body that look the other way than most of it (by area, or by the light where that is even).
fn minority(patient: &Patient, body: &[u32], links: &[Link], light: &Light) -> Vec<u32> {
    let stage = patient.stage;
    let mut joined: BTreeMap<u32, Vec<(u32, bool)>> = BTreeMap::new();
    for l in links {
        let [a, b] = l.facets;
        joined.entry(a).or_default().push((b, l.agree));
        joined.entry(b).or_default().push((a, l.agree));
    }
    let mut side: BTreeMap<u32, bool> = BTreeMap::from([(body[0], false)]);
    let mut queue = VecDeque::from([body[0]]);
    while let Some(f) = queue.pop_front() {
        let mine = side[&f];
        for (g, agree) in joined.get(&f).into_iter().flatten() {
            side.entry(*g).or_insert_with(|| {
                queue.push_back(*g);
                mine == *agree
            });
        }
    }
    let class = |which: bool| body.iter().copied().filter(|f| side.get(f) == Some(&which)).collect::<Vec<u32>>();
    let (one, other) = (class(false), class(true));
    let size = |c: &[u32]| c.iter().map(|f| area(&stage.facets[*f as usize].vertices)).sum::<f64>();
    let hits = |c: &[u32]| c.iter().map(|f| light.back_hits(*f)).sum::<u64>();
    let even = (size(&one) / size(&other).max(f64::MIN_POSITIVE)).ln().abs() < 0.2;
    let first_is_odd = if even { hits(&one) > hits(&other) } else { size(&one) < size(&other) };
    let odd = if first_is_odd { one } else { other };
    // Without light on its back or its own light lost, nobody is wrong: two plates may look either way.
    if hits(&odd) > 0 || light.escaping(&odd) > OUTWARD { odd } else { Vec::new() }
}

impl Body {
    fn new(stage: &Stage, facets: Vec<u32>, free: &[bool], turned: &[Option<How>]) -> Self {
        let corners: Vec<DVec3> = facets.iter().flat_map(|f| stage.facets[*f as usize].vertices.clone()).collect();
        let bounds = Bounds::of(&corners);
        let origin = bounds.lo.midpoint(bounds.hi);
        let part = |f: &u32| {
            let v = &stage.facets[*f as usize].vertices;
            let sign = if turned[*f as usize].is_some() { -1.0 } else { 1.0 };
            sign * (centroid(v) - origin).dot(crate::math::area_vector(v)) / 3.0
        };
        let volume = facets.iter().map(part).sum();
        Self { closed: facets.iter().all(|f| !free[*f as usize]), volume, bounds, facets }
    }

    /// True if its fronts look outward.
    pub(super) fn looks_outward(&self) -> bool {
        self.volume > 0.0
    }

    /// True if it is closed and looks outward.
    pub(super) fn is_solid(&self) -> bool {
        self.closed && self.looks_outward() && self.facets.len() > 3
    }

    fn holds(&self, other: &Self) -> bool {
        self.bounds.lo.cmple(other.bounds.lo).all() && other.bounds.hi.cmple(self.bounds.hi).all()
    }
}

/// True if a whole body is turned: a closed one that looks inward and is seen from outside, or one that
/// surrounds others, is seen by them from behind and sends its own light away.
fn inside_out(bodies: &[Body], k: usize, light: &Light, body_of: &[u32], turned: &[Option<How>]) -> bool {
    let body = &bodies[k];
    if body.facets.iter().any(|f| turned[*f as usize].is_some()) {
        return false;
    }
    let mut viewers: Vec<u32> = Vec::new();
    for f in &body.facets {
        let from = light.on_back[*f as usize].iter().filter(|(s, h)| *h > 0 && body_of[*s as usize] != k as u32);
        viewers.extend(from.map(|(s, _)| body_of[*s as usize]));
    }
    if viewers.is_empty() {
        return false;
    }
    let outward = light.escaping(&body.facets) > OUTWARD;
    // A room that something sticks out of is seen from outside as well, but has that in it.
    let held = viewers.iter().any(|v| bodies[*v as usize].holds(body));
    let empty = (0..bodies.len()).all(|b| b == k || !bodies[b].bounds.meets(&body.bounds));
    let surrounds = viewers.iter().all(|v| body.holds(&bodies[*v as usize]));
    let inward = body.closed && !body.looks_outward() && body.facets.len() > 3;
    (inward && (held || empty)) || (outward && surrounds)
}

/// One finding for each surface that is turned alone and for each body that is turned as a whole.
pub(super) fn findings(patient: &Patient, turned: &Turned) -> Vec<Finding> {
    let mut groups: BTreeMap<(How, u32), Vec<u32>> = BTreeMap::new();
    for (f, how) in (0..).zip(&turned.facets) {
        match how {
            Some(How::Alone) => {
                groups.entry((How::Alone, patient.stage.facets[f as usize].surface)).or_default().push(f)
            }
            Some(how) => groups.entry((*how, turned.body_of[f as usize])).or_default().push(f),
            None => {}
        }
    }
    groups.into_iter().map(|((how, _), facets)| finding(patient, turned, how, &facets)).collect()
}

fn finding(patient: &Patient, turned: &Turned, how: How, facets: &[u32]) -> Finding {
    let stage = patient.stage;
    let is_odd = |f: u32| facets.binary_search(&f).is_ok();
    let number = |(i, p): (usize, &crate::scene::Patch)| (!p.corners.is_empty() && is_odd(p.facet)).then_some(i as u32);
    let numbers: Vec<u32> = stage.patches.iter().enumerate().filter_map(number).collect();
    let surfaces = surfaces_of(stage, facets.iter().copied());
    let of_surfaces = stage.facets.iter().filter(|f| surfaces.contains(&stage.surfaces[f.surface as usize].name));
    let who = match of_surfaces.count() == facets.len() {
        true => names(&surfaces),
        false => format!("{} of {}", patches(&numbers), names(&surfaces)),
    };
    let (face, are) = (verb(surfaces.len(), "faces", "face"), verb(surfaces.len(), "is", "are"));
    let what = match how {
        How::Alone => format!("{who} {face} the other way than what it is joined to"),
        How::Body => format!("{who} {are} inside out: the whole body shows its backs to where the light is"),
        How::Lone => {
            format!("{who} {are} closed and {} outward, where nothing is", verb(surfaces.len(), "looks", "look"))
        }
    };
    let middle = centroid(&stage.facets[facets[0] as usize].vertices);
    Finding {
        kind: FindingKind::Winding,
        severity: if how == How::Lone && stage.enclosure != Some(true) { Severity::Warning } else { Severity::Error },
        place: Place {
            surfaces,
            patches: numbers.iter().copied().take(LISTED).collect(),
            point: Some(middle.to_array()),
            ..Place::default()
        },
        what,
        consequence: Some(consequence(patient, turned, facets, &numbers)),
        mend: match how {
            How::Lone => "if it is a room, list the corners in the opposite order".into(),
            _ => "list the corners in the opposite order, or set two_sided = true if both sides are to radiate".into(),
        },
    }
}

fn consequence(patient: &Patient, turned: &Turned, facets: &[u32], numbers: &[u32]) -> Consequence {
    let stage = patient.stage;
    let others = senders(patient, turned);
    let landed = patient.probe.share(stage, &others, |s| {
        let on_backs = s.backs.iter().filter(|(f, _)| facets.binary_search(f).is_ok());
        on_backs.fold(Hits::default(), |a, (_, h)| add(a, h))
    });
    let own: Vec<usize> = numbers.iter().map(|i| *i as usize).collect();
    let lost = patient.probe.share(stage, &own, |s| s.escapes);
    let value = if others.is_empty() { &lost } else { &landed };
    let text = match others.is_empty() {
        true => format!("{} of its light leaves the scene", share(&lost)),
        false => format!(
            "{} of the light of the other surfaces is lost on black backs, and {} of its own leaves the scene",
            share(&landed),
            percent(lost.mean)
        ),
    };
    Consequence { text, value: value.mean, std_err: value.std_err(), unit: "share".into() }
}

/// Patches on facets that are not turned.
pub(super) fn senders(patient: &Patient, turned: &Turned) -> Vec<usize> {
    let sends = |i: &usize| {
        let p = &patient.stage.patches[*i];
        p.is_present() && turned.facets[p.facet as usize].is_none()
    };
    (0..patient.stage.patch_count()).filter(sends).collect()
}
