//! What the gather method can be told: `rays=4096,randomisations=16,estimator=auto`.

use crate::estimate::{Estimator, Plan};
use std::fmt;
use std::str::FromStr;

/// Settings of the ray-cast gather.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Rays per patch over all randomisations.
    pub rays: u64,
    /// Independent randomisations.
    pub randomisations: u16,
    /// Whether pairs are settled without rays first.
    pub estimator: Estimator,
}

impl Params {
    /// What may be spent on rays.
    pub fn plan(&self) -> Plan {
        let Self { rays, randomisations, estimator } = *self;
        Plan { rays, randomisations, estimator, ..Plan::default() }
    }
}

/// A setting that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "gather: `{text}` is not a setting; settings are rays=N (at least 1), randomisations=R (8 to 4096) and estimator=auto|rays"
)]
pub struct ParamsError {
    /// What was written.
    pub text: String,
}

impl Default for Params {
    fn default() -> Self {
        let plan = Plan::default();
        Self { rays: plan.rays, randomisations: plan.randomisations, estimator: plan.estimator }
    }
}

impl FromStr for Params {
    type Err = ParamsError;

    fn from_str(text: &str) -> Result<Self, ParamsError> {
        let mut params = Self::default();
        for part in text.split(',').map(str::trim).filter(|p| !p.is_empty()) {
            let wrong = || ParamsError { text: part.into() };
            match part.split_once('=').ok_or_else(wrong)? {
                ("rays", n) => params.rays = n.parse().ok().filter(|n| *n > 0).ok_or_else(wrong)?,
                ("randomisations", r) => {
                    params.randomisations = r.parse().ok().filter(|r| (8..=4096).contains(r)).ok_or_else(wrong)?;
                }
                ("estimator", "auto") => params.estimator = Estimator::Auto,
                ("estimator", "rays") => params.estimator = Estimator::Rays,
                _ => return Err(wrong()),
            }
        }
        Ok(params)
    }
}

impl fmt::Display for Params {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "rays={},randomisations={}", self.rays, self.randomisations)?;
        match self.estimator {
            Estimator::Rays => Ok(()),
            Estimator::Auto => write!(f, ",estimator=auto"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back_and_nonsense_refused() {
        let p: Params = "rays=100,randomisations=32,estimator=auto".parse().unwrap();
        assert_eq!(p.to_string().parse::<Params>().unwrap(), p);
        for bad in ["rays", "rays=0", "randomisations=7", "foo=1", "rays=-1"] {
            assert!(bad.parse::<Params>().is_err(), "{bad}");
        }
    }
}
