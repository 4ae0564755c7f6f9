//! Black backs that light falls on: plates seen from behind, and bodies that others reach into.

use super::Patient;
use super::probe::{Hits, add, total};
use super::text::{LISTED, names, percent, share, surfaces_of, verb};
use super::winding::{Turned, senders};
use crate::math::centroid;
use crate::scene::{Consequence, Finding, FindingKind, Place, Severity};
use std::collections::{BTreeMap, BTreeSet};

/// One finding for each surface whose backs are seen, those turned the wrong way left out.
pub(super) fn findings(patient: &Patient, turned: &Turned) -> Vec<Finding> {
    let mut seen: BTreeMap<Whose, BTreeSet<u32>> = BTreeMap::new();
    for i in senders(patient, turned) {
        for f in patient.probe.sent[i].iter().flat_map(|s| s.backs.keys()) {
            if turned.facets[*f as usize].is_none() {
                seen.entry(Whose::of(patient, turned, *f)).or_default().insert(*f);
            }
        }
    }
    seen.into_iter().map(|(whose, facets)| finding(patient, turned, whose, &facets)).collect()
}

/// What a back belongs to: a body that closes it off, so that only what is inside can see it, or a plate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Whose {
    Surface(u32),
    Body(u32),
}

impl Whose {
    fn of(patient: &Patient, turned: &Turned, facet: u32) -> Self {
        let number = turned.body_of[facet as usize];
        let body = &turned.bodies[number as usize];
        match body.closed && body.looks_outward() {
            true => Self::Body(number),
            false => Self::Surface(patient.stage.facets[facet as usize].surface),
        }
    }
}

fn finding(patient: &Patient, turned: &Turned, whose: Whose, facets: &BTreeSet<u32>) -> Finding {
    let stage = patient.stage;
    let landed = |s: &super::probe::Sent| {
        s.backs.iter().filter(|(f, _)| facets.contains(f)).fold(Hits::default(), |a, (_, h)| add(a, h))
    };
    let all = senders(patient, turned);
    let lost = patient.probe.share(stage, &all, landed);
    let hits = |i: usize| patient.probe.sent[i].as_ref().map_or(0, |s| total(&landed(s)));
    let mut from: Vec<(u64, u32)> = all.iter().map(|i| (hits(*i), *i as u32)).filter(|(h, _)| *h > 0).collect();
    from.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut viewers: Vec<String> = Vec::new();
    for (_, i) in &from {
        let name = stage.surface_name(*i as usize);
        if !viewers.iter().any(|v| v == name) {
            viewers.push(name.to_string());
        }
    }
    let owners = surfaces_of(stage, facets.iter().copied());
    let first = facets.first().copied().unwrap_or_default();
    let buried = matches!(whose, Whose::Body(_));
    let (viewing, owning) = (names(&viewers), names(&owners));
    let what = match buried {
        true => format!(
            "{viewing} {} into the body of {owning}: rays start inside it",
            verb(viewers.len(), "reaches", "reach")
        ),
        false => format!("the black back of {owning} is seen by {viewing}"),
    };
    let of_worst = patient.probe.share(stage, &[from[0].1 as usize], landed);
    Finding {
        kind: FindingKind::BacksSeen,
        severity: if stage.enclosure == Some(true) { Severity::Error } else { Severity::Warning },
        place: Place {
            surfaces: owners.into_iter().chain(viewers).collect(),
            patches: from.iter().map(|(_, i)| *i).take(LISTED).collect(),
            values: Vec::new(),
            point: Some(centroid(&stage.facets[first as usize].vertices).to_array()),
        },
        what,
        consequence: Some(Consequence {
            text: format!(
                "{} of the scene's light is lost there, {} of that of patch {}",
                share(&lost),
                percent(of_worst.mean),
                from[0].1
            ),
            value: lost.mean,
            std_err: lost.std_err(),
            unit: "share".into(),
        }),
        mend: match buried {
            true => "give the body a bottom that faces outward and stands on the surface (what it covers is then left out), \
                     or cut the surface where it enters"
                .into(),
            false => "set two_sided = true if both sides radiate, or turn it over".into(),
        },
    }
}
