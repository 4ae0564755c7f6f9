//! What the shooting methods can be told: `rays=16384,unshot=0.1%`, and for redistribution `strategy=two`.

use super::ShootingError;
use crate::estimate::Plan;
use crate::methods::hemicube;
use std::fmt;

/// Where form factors come from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Factors {
    /// Rays from points of the shooter, cosine-distributed.
    Rays {
        /// Rays of each shot over all randomisations; rounded up to R 2^m.
        rays: u64,
        /// Independent randomisations R, from which standard errors come.
        randomisations: u16,
    },
    /// A hemi-cube at the centre of the shooter.
    Hemicube(hemicube::Params),
}

/// When to stop; whatever is met first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// At this share of the emitted luminous power unshot, with nothing left to redistribute.
    pub unshot: f64,
    /// After so many shots (of each state).
    pub shots: Option<u64>,
    /// After so many seconds (of each state).
    pub seconds: Option<f64>,
    /// At this bound on what is missing of the luminance, area-weighted: unshot / (1 - rho) of all luminous power.
    pub error: Option<f64>,
}

/// How redistribution and propagation take turns [GSG90 fig. 4].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strategy {
    /// Redistribute first, down to a threshold; then whichever is larger.
    One,
    /// Always whichever is larger.
    Two,
}

/// How the patch with most energy to redistribute is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ranking {
    /// By what a differential receiver at so many sample points of the object, always facing the patch, receives.
    Samples(u32),
    /// By tracing every patch's diverted rays: what the estimate is measured against.
    Exact,
}

impl Ranking {
    /// Sample points of an object; 0 for the exact ranking, which needs none.
    pub(super) fn samples(self) -> usize {
        match self {
            Self::Samples(n) => n as usize,
            Self::Exact => 0,
        }
    }
}

/// Settings of progressive refinement and redistribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Form factors.
    pub factors: Factors,
    /// Patches that emit shoot so many times the rays of others: direct light is most of the error that is seen.
    pub lamps: u32,
    /// When to stop.
    pub stop: Stop,
    /// Whether the ambient estimate is added to what is written: for pictures.
    pub ambient: bool,
    /// Which shots come first after an edit.
    pub strategy: Strategy,
    /// Strategy one: share of the emitted luminous power below which a redistribution no longer goes first.
    pub threshold: f64,
    /// Order of redistribution.
    pub ranking: Ranking,
    /// Share of power unshot at which a state is left for the next edit.
    pub before: f64,
}

impl Default for Params {
    fn default() -> Self {
        let plan = Plan::default();
        Self {
            factors: Factors::Rays { rays: plan.rays, randomisations: plan.randomisations },
            lamps: 16,
            stop: Stop { unshot: 1e-3, shots: None, seconds: None, error: None },
            ambient: false,
            strategy: Strategy::One,
            threshold: 0.0,
            ranking: Ranking::Samples(1),
            before: 1e-3,
        }
    }
}

const PROGRESSIVE: &str = "rays=N, randomisations=R (8 to 4096), lamps=N (1 to 1024: times the rays of others), factors=rays|hemicube, resolution=N, delta=midpoint|exact, \
    rotation=DEGREES, turn=SEED, jitter=SEED, unshot=F, shots=N, seconds=S, error=F, ambient=yes|no";
const REDISTRIBUTION: &str = ", strategy=one|two, threshold=F, samples=N (1 to 64), ranking=samples|exact, before=F \
    (share unshot when an edit comes)";

impl Params {
    /// Reads the settings of progressive refinement.
    pub fn progressive(text: &str) -> Result<Self, ShootingError> {
        Self::parse(text, false)
    }

    /// Reads the settings of redistribution: those of progressive refinement and its own.
    pub fn redistribution(text: &str) -> Result<Self, ShootingError> {
        Self::parse(text, true)
    }

    fn parse(text: &str, redistribution: bool) -> Result<Self, ShootingError> {
        let wrong = |part: &str| ShootingError::Setting {
            method: if redistribution { "redistribution" } else { "progressive" },
            text: part.into(),
            settings: format!("{PROGRESSIVE}{}", if redistribution { REDISTRIBUTION } else { "" }),
        };
        let mut params = Self::default();
        let mut seen: Vec<&str> = Vec::new();
        let mut cube: Option<Vec<&str>> = None;
        for part in text.split(',').map(str::trim).filter(|p| !p.is_empty()) {
            let (key, value) = part.split_once('=').ok_or_else(|| wrong(part))?;
            if seen.contains(&key) {
                return Err(wrong(&format!("{key} twice")));
            }
            seen.push(key);
            match key {
                "factors" if value == "hemicube" => _ = cube.get_or_insert_default(),
                "resolution" | "delta" | "rotation" | "turn" | "jitter" => cube.get_or_insert_default().push(part),
                _ => params.set(key, value, redistribution).ok_or_else(|| wrong(part))?,
            }
        }
        if let Some(parts) = cube {
            if let Some(part) = seen.iter().find(|k| matches!(**k, "rays" | "randomisations")) {
                return Err(wrong(&format!("{part} beside hemi-cubes")));
            }
            params.factors = Factors::Hemicube(hemicube::Params::parse(&parts.join(","))?);
        }
        Ok(params)
    }

    fn set(&mut self, key: &str, value: &str, redistribution: bool) -> Option<()> {
        match (key, &mut self.factors) {
            ("factors", _) if value == "rays" => {}
            ("rays", Factors::Rays { rays, .. }) => *rays = value.parse().ok().filter(|n| (1..=1 << 24).contains(n))?,
            ("randomisations", Factors::Rays { randomisations, .. }) => {
                *randomisations = value.parse().ok().filter(|r| (8..=4096).contains(r))?;
            }
            ("lamps", _) => self.lamps = value.parse().ok().filter(|n| (1..=1024).contains(n))?,
            ("unshot", _) => self.stop.unshot = fraction(value)?,
            ("shots", _) => self.stop.shots = Some(value.parse().ok()?),
            ("seconds", _) => {
                self.stop.seconds = Some(value.parse().ok().filter(|s: &f64| s.is_finite() && *s > 0.0)?);
            }
            ("error", _) => self.stop.error = Some(fraction(value)?),
            ("ambient", _) => self.ambient = yes(value)?,
            ("strategy", _) if redistribution => {
                self.strategy = match value {
                    "one" => Strategy::One,
                    "two" => Strategy::Two,
                    _ => return None,
                }
            }
            ("threshold", _) if redistribution => self.threshold = fraction(value)?,
            ("samples", _) if redistribution => {
                self.ranking = Ranking::Samples(value.parse().ok().filter(|n| (1..=64).contains(n))?);
            }
            ("ranking", _) if redistribution => match value {
                "exact" => self.ranking = Ranking::Exact,
                "samples" => {}
                _ => return None,
            },
            ("before", _) if redistribution => self.before = fraction(value)?,
            _ => return None,
        }
        Some(())
    }

    /// As written for redistribution: all settings that are not at their default.
    pub fn written(&self) -> String {
        let default = Self::default();
        let mut parts = vec![match self.factors {
            Factors::Rays { rays, randomisations } => format!("rays={rays},randomisations={randomisations}"),
            Factors::Hemicube(p) => {
                let hemicube::Params { resolution, rotation, .. } = p;
                let delta = if p.delta == hemicube::Delta::Exact { "exact" } else { "midpoint" };
                let drawn = |key: &str, seed: Option<u64>| seed.map_or(String::new(), |s| format!(",{key}={s}"));
                let (turn, jitter) = (drawn("turn", p.turn), drawn("jitter", p.jitter));
                format!("factors=hemicube,resolution={resolution},delta={delta},rotation={rotation}{turn}{jitter}")
            }
        }];
        parts.extend((self.lamps != default.lamps).then(|| format!("lamps={}", self.lamps)));
        parts.push(format!("unshot={}", self.stop.unshot));
        parts.extend(self.stop.shots.map(|n| format!("shots={n}")));
        parts.extend(self.stop.seconds.map(|s| format!("seconds={s}")));
        parts.extend(self.stop.error.map(|e| format!("error={e}")));
        parts.extend(self.ambient.then(|| "ambient=yes".into()));
        parts.extend((self.strategy == Strategy::Two).then(|| "strategy=two".into()));
        parts.extend((self.threshold != default.threshold).then(|| format!("threshold={}", self.threshold)));
        match self.ranking {
            Ranking::Samples(1) => {}
            Ranking::Samples(n) => parts.push(format!("samples={n}")),
            Ranking::Exact => parts.push("ranking=exact".into()),
        }
        parts.extend((self.before != default.before).then(|| format!("before={}", self.before)));
        parts.join(",")
    }
}

impl fmt::Display for Params {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.written())
    }
}

/// A fraction from 0 to below 1, or a percentage with its sign.
fn fraction(value: &str) -> Option<f64> {
    let f = match value.strip_suffix('%') {
        Some(percent) => percent.trim_end().parse::<f64>().ok()? / 100.0,
        None => value.parse().ok()?,
    };
    (0.0..1.0).contains(&f).then_some(f)
}

fn yes(value: &str) -> Option<bool> {
    match value {
        "yes" => Some(true),
        "no" => Some(false),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back_and_nonsense_refused() {
        let all = "rays=4096,randomisations=32,lamps=4,unshot=1%,shots=7,seconds=2.5,error=0.5%,ambient=yes,strategy=two,\
                   threshold=2%,samples=7,before=0";
        let p = Params::redistribution(all).unwrap();
        assert_eq!(Params::redistribution(&p.to_string()).unwrap(), p);
        let cube = Params::redistribution("factors=hemicube,resolution=50,delta=exact,ranking=exact").unwrap();
        assert_eq!(Params::redistribution(&cube.to_string()).unwrap(), cube);
        assert_eq!(
            Params::progressive("resolution=50").unwrap().factors,
            Params::progressive("factors=hemicube,resolution=50").unwrap().factors
        );
        for bad in [
            "rays",
            "rays=0",
            "unshot=2",
            "unshot=-1",
            "strategy=two",
            "foo=1",
            "rays=8,resolution=50",
            "shots=1,shots=2",
            "resolution=51",
        ] {
            assert!(Params::progressive(bad).is_err(), "{bad}");
        }
        for bad in ["strategy=three", "samples=0", "ranking=best", "before=1"] {
            assert!(Params::redistribution(bad).is_err(), "{bad}");
        }
    }
}
