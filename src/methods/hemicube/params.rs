//! What a hemi-cube can be told, and how it is written: `resolution=200,delta=exact,rotation=30,tolerance=0.1%`,
//! and `turn=7,jitter=7` where hemi-cubes are turned and shifted at random.

use super::HemicubeError;
use std::fmt;
use std::str::FromStr;

/// Keys of the written form.
const KEYS: &str = "resolution, delta, rotation, tolerance, turn, jitter";

/// What a seed must be.
const SEED: &str = "a seed, a whole number from 0 to 18446744073709551615";

/// How the delta form factor of a pixel is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Delta {
    /// The integrand at the pixel's centre times the pixel's area, as in 1985: the table sums to 1 + 0.542 / N^2.
    #[default]
    Midpoint,
    /// The integral over the pixel: the table sums to 1.
    Exact,
}

/// Settings of the hemi-cube.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Pixels along an edge of the top face: even, 4 to 4096. Side faces are half as high.
    pub resolution: u32,
    /// Delta form factors.
    pub delta: Delta,
    /// Turn of the hemi-cube about the patch normal, degrees, counter-clockwise seen from the front; at 0 its
    /// x axis lies along the patch's first edge.
    pub rotation: f64,
    /// Gauss-Seidel stops when no radiosity changes by more than this fraction of itself.
    pub tolerance: f64,
    /// Seed of random turns: every hemi-cube is turned further about its normal by an angle of its own, even over
    /// [0, 90) degrees, so that pixels and edges of neighbours do not line up in the same way. `None`: not turned.
    pub turn: Option<u64>,
    /// Seed of random shifts: every hemi-cube looks through a point of its own within its pixels, even over the
    /// pixel and the same in all its pixels, so that beats become noise. `None`: through the centres.
    pub jitter: Option<u64>,
}

impl Default for Params {
    fn default() -> Self {
        Self { resolution: 100, delta: Delta::Midpoint, rotation: 0.0, tolerance: 1e-3, turn: None, jitter: None }
    }
}

impl Params {
    /// Reads `key=value,key=value`; what is not named keeps its default, the empty text is all defaults.
    pub fn parse(text: &str) -> Result<Self, HemicubeError> {
        let mut params = Self::default();
        let mut seen: Vec<&str> = Vec::new();
        for part in text.split(',').map(str::trim).filter(|p| !p.is_empty()) {
            let (key, value) =
                part.split_once('=').ok_or_else(|| HemicubeError::NotAPair { text: part.to_string(), keys: KEYS })?;
            let (key, value) = (key.trim(), value.trim());
            if seen.contains(&key) {
                return Err(HemicubeError::RepeatedKey { key: key.to_string() });
            }
            seen.push(key);
            params.set(key, value)?;
        }
        params.validated()
    }

    fn set(&mut self, key: &str, value: &str) -> Result<(), HemicubeError> {
        match key {
            "resolution" => self.resolution = number(key, value, "an even whole number from 4 to 4096")?,
            "delta" => self.delta = delta(value)?,
            "rotation" => self.rotation = number(key, value, "an angle in degrees")?,
            "tolerance" => self.tolerance = fraction(key, value)?,
            "turn" => self.turn = Some(number(key, value, SEED)?),
            "jitter" => self.jitter = Some(number(key, value, SEED)?),
            _ => return Err(HemicubeError::UnknownKey { key: key.to_string(), keys: KEYS }),
        }
        Ok(())
    }

    /// Refuses settings that no hemi-cube can have.
    pub fn validated(self) -> Result<Self, HemicubeError> {
        if !(4..=4096).contains(&self.resolution) || !self.resolution.is_multiple_of(2) {
            return Err(HemicubeError::Resolution { got: self.resolution });
        }
        let bad = |key: &str, value: f64, wanted| Err(bad_value(key, &value.to_string(), wanted));
        if !self.rotation.is_finite() {
            return bad("rotation", self.rotation, "an angle in degrees");
        }
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return bad("tolerance", self.tolerance, "a fraction above 0 and below 1, or a percentage such as 0.1%");
        }
        Ok(self)
    }
}

impl FromStr for Params {
    type Err = HemicubeError;

    fn from_str(text: &str) -> Result<Self, HemicubeError> {
        Self::parse(text)
    }
}

impl fmt::Display for Params {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let delta = match self.delta {
            Delta::Midpoint => "midpoint",
            Delta::Exact => "exact",
        };
        let Self { resolution, rotation, tolerance, .. } = self;
        write!(f, "resolution={resolution},delta={delta},rotation={rotation},tolerance={tolerance}")?;
        self.turn.map_or(Ok(()), |seed| write!(f, ",turn={seed}"))?;
        self.jitter.map_or(Ok(()), |seed| write!(f, ",jitter={seed}"))
    }
}

fn bad_value(key: &str, value: &str, wanted: &'static str) -> HemicubeError {
    HemicubeError::BadValue { key: key.to_string(), value: value.to_string(), wanted }
}

fn number<T: FromStr>(key: &str, value: &str, wanted: &'static str) -> Result<T, HemicubeError> {
    value.parse().map_err(|_| bad_value(key, value, wanted))
}

fn delta(value: &str) -> Result<Delta, HemicubeError> {
    match value {
        "midpoint" => Ok(Delta::Midpoint),
        "exact" => Ok(Delta::Exact),
        _ => Err(bad_value("delta", value, "midpoint or exact")),
    }
}

/// A fraction, or a percentage with its sign.
fn fraction(key: &str, value: &str) -> Result<f64, HemicubeError> {
    let wanted = "a fraction above 0 and below 1, or a percentage such as 0.1%";
    match value.strip_suffix('%') {
        Some(percent) => number::<f64>(key, percent.trim_end(), wanted).map(|p| p / 100.0),
        None => number(key, value, wanted),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back() {
        let p = Params::parse("resolution=50, delta=exact,tolerance = 0.5%").unwrap();
        assert_eq!(
            p,
            Params { resolution: 50, delta: Delta::Exact, rotation: 0.0, tolerance: 0.005, ..Params::default() }
        );
        assert_eq!(p.to_string(), "resolution=50,delta=exact,rotation=0,tolerance=0.005");
        let random = Params::parse("turn=3,jitter=18446744073709551615").unwrap();
        assert_eq!((random.turn, random.jitter), (Some(3), Some(u64::MAX)));
        assert_eq!(random.to_string().parse::<Params>().unwrap(), random);
        assert!(Params { jitter: None, ..random }.to_string().ends_with("tolerance=0.001,turn=3"));
        assert_eq!(p.to_string().parse::<Params>().unwrap(), p);
        assert_eq!(Params::parse("").unwrap(), Params::default());
    }

    #[test]
    fn refusals_name_the_key_and_the_mend() {
        let said = |text: &str| Params::parse(text).unwrap_err().to_string();
        for odd in ["3", "51", "2", "4098", "0"] {
            assert!(said(&format!("resolution={odd}")).contains("even, from 4 to 4096"), "{odd}");
        }
        assert!(said("resolution=ten").contains("`ten`"));
        assert!(said("resolution=-4").contains("resolution"));
        assert!(said("size=100").contains("resolution, delta, rotation, tolerance"));
        assert!(said("resolution").contains("key=value"));
        assert!(said("delta=best").contains("midpoint or exact"));
        assert!(said("rotation=nan").contains("degrees"));
        assert!(said("tolerance=0").contains("fraction"));
        assert!(said("tolerance=100%").contains("fraction"));
        assert!(said("turn=-1").contains("turn cannot be `-1`") && said("jitter=0.5").contains("whole number"));
        assert!(said("rotation=1,rotation=2").contains("twice"));
    }
}
