//! What a solution has to keep: metric, place, limit.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// What a limit is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Metric {
    /// Eq. 7: relative area-weighted luminance RMS.
    Rms,
    /// Eq. 7 over the 1 % of patches that change most.
    Top1,
    /// Largest |difference| of any patch, relative to the reference there.
    Worst,
    /// |signed error| of the light as a whole.
    Energy,
    /// Share of the picture that is off by more than one step of the display.
    Visible,
    /// Eq. 7 of the solution less eq. 7 of a baseline: by how much it became worse.
    Worse,
}

impl Metric {
    /// Name as on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rms => "rms",
            Self::Top1 => "top1",
            Self::Worst => "worst",
            Self::Energy => "energy",
            Self::Visible => "visible",
            Self::Worse => "worse",
        }
    }
}

/// Which part of the scene a limit is on.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Place {
    /// Every patch, in luminance.
    Everywhere,
    /// The patches of one surface.
    Surface(String),
    /// The patches of one object.
    Object(String),
    /// Every patch, in one band.
    Band(String),
}

impl Place {
    /// Kind and name; `None` for everywhere.
    pub fn parts(&self) -> Option<(&'static str, &str)> {
        match self {
            Self::Everywhere => None,
            Self::Surface(name) => Some(("surface", name)),
            Self::Object(name) => Some(("object", name)),
            Self::Band(name) => Some(("band", name)),
        }
    }
}

/// One limit. Written `METRIC[@surface:NAME|@object:NAME|@band:NAME]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// What it is on.
    pub metric: Metric,
    /// Where.
    pub place: Place,
    /// The largest value allowed, a fraction.
    pub max: f64,
    /// Kept unless surely exceeded: nothing stays open. What it may have missed is stated instead.
    #[serde(default)]
    pub unless_sure: bool,
}

impl Limit {
    /// A limit on the whole scene.
    pub fn new(metric: Metric, max: f64) -> Self {
        Self { metric, place: Place::Everywhere, max, unless_sure: false }
    }

    /// The same in one place.
    pub fn at(self, place: Place) -> Self {
        Self { place, ..self }
    }

    /// Metric and place without the number: what outcomes go by.
    pub fn key(&self) -> String {
        match self.place.parts() {
            None => self.metric.name().into(),
            Some((kind, name)) => format!("{}@{kind}:{name}", self.metric.name()),
        }
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.key(), self.max)
    }
}

impl FromStr for Limit {
    type Err = String;

    /// `rms=0.05`, `worst=10%`, `rms@surface:floor=3%`.
    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!(
                "\"{text}\" is not a limit: write METRIC=X or METRIC@WHERE=X, METRIC one of rms, worst, energy, WHERE \
                 surface:NAME, object:NAME or band:NAME (rms@surface:floor=3%)"
            )
        };
        let (key, number) = text.rsplit_once('=').ok_or_else(wrong)?;
        let (metric, place) = key.split_once('@').map_or((key, None), |(m, p)| (m, Some(p)));
        let metric = match metric.trim() {
            "rms" => Metric::Rms,
            "worst" => Metric::Worst,
            "energy" => Metric::Energy,
            "top1" => return Err("a limit on the top 1 % is --max-top1: it goes for the whole scene".into()),
            "visible" => {
                return Err("a limit on what can be seen is --max-visible: it goes for the whole picture".into());
            }
            _ => return Err(wrong()),
        };
        let place = match place.map(|p| p.split_once(':').ok_or_else(wrong)).transpose()? {
            None => Place::Everywhere,
            Some(("surface", name)) => Place::Surface(name.into()),
            Some(("object", name)) => Place::Object(name.into()),
            Some(("band", name)) => Place::Band(name.into()),
            Some(_) => return Err(wrong()),
        };
        let (number, unit) = number.strip_suffix('%').map_or((number, 1.0), |n| (n, 0.01));
        let max: f64 = number.trim().parse().map_err(|_| wrong())?;
        if max.is_finite() && max >= 0.0 { Ok(Self::new(metric, max * unit).at(place)) } else { Err(wrong()) }
    }
}

/// Limits a solution has to keep. A check needs at least one.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Limits {
    list: Vec<Limit>,
}

impl Limits {
    /// A limit on eq. 7 alone, a fraction.
    pub fn rms(max: f64) -> Self {
        Self::default().and(Limit::new(Metric::Rms, max))
    }

    /// A limit on the top 1 % alone, a fraction.
    pub fn top1(max: f64) -> Self {
        Self::default().and(Limit::new(Metric::Top1, max))
    }

    /// The same with a limit on the top 1 % as well.
    pub fn and_top1(self, max: f64) -> Self {
        self.and(Limit::new(Metric::Top1, max))
    }

    /// The same with one more; all hold together.
    pub fn and(mut self, limit: Limit) -> Self {
        self.list.push(limit);
        self
    }

    /// One by one.
    pub fn list(&self) -> &[Limit] {
        &self.list
    }

    /// True if there is none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// True if there is a limit on this metric.
    pub fn has(&self, metric: Metric) -> bool {
        self.list.iter().any(|l| l.metric == metric)
    }

    /// The limit on a metric of the whole scene.
    pub fn of(&self, metric: Metric) -> Option<f64> {
        self.list.iter().find(|l| l.metric == metric && l.place == Place::Everywhere).map(|l| l.max)
    }

    /// True if every limit is a fraction of at least 0.
    pub fn are_sound(&self) -> bool {
        self.list.iter().all(|l| l.max.is_finite() && l.max >= 0.0)
    }
}

impl FromIterator<Limit> for Limits {
    fn from_iter<I: IntoIterator<Item = Limit>>(limits: I) -> Self {
        Self { list: limits.into_iter().collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_written_as_they_are_read() {
        for (text, key, max) in [
            ("rms=5%", "rms", 0.05),
            ("worst=0.1", "worst", 0.1),
            ("energy@object:box=1%", "energy@object:box", 0.01),
            ("rms@surface:a=b:c=3%", "rms@surface:a=b:c", 0.03),
            ("rms@band:450 nm=0", "rms@band:450 nm", 0.0),
        ] {
            let limit: Limit = text.parse().unwrap();
            assert_eq!((limit.key().as_str(), limit.max), (key, max));
            assert_eq!(limit.to_string().parse::<Limit>(), Ok(limit));
        }
        for bad in ["rms", "rms=x", "rms@floor=1%", "rms@face:floor=1%", "best=1", "rms=-1", "rms=inf", "top1=1%", ""] {
            assert!(bad.parse::<Limit>().is_err(), "{bad}");
        }
    }
}
