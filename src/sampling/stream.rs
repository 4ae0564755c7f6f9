//! Keyed streams of random bits.

use serde::{Deserialize, Serialize};

/// Who draws. Different roles never share a ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// The reference.
    Judge,
    /// A method under test.
    Candidate,
    /// Self-checks of the reference.
    Witness,
}

/// A stream addressed by (role, seed, purpose ...): `at(k)` is its k-th 64-bit word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stream(u64);

impl Stream {
    /// The stream of a role under a seed.
    pub fn new(role: Role, seed: u64) -> Self {
        let role = match role {
            Role::Judge => 1,
            Role::Candidate => 2,
            Role::Witness => 3,
        };
        Self(mix(mix(role) ^ seed))
    }

    /// A stream of its own under this one.
    pub fn child(self, key: u64) -> Self {
        Self(mix(self.0 ^ mix(key.wrapping_add(0x9e37_79b9_7f4a_7c15))))
    }

    /// Word k: 64 random bits.
    pub fn at(self, k: u64) -> u64 {
        mix(self.0.wrapping_add(k.wrapping_mul(0x9e37_79b9_7f4a_7c15)))
    }

    /// Word k as a number in [0, 1).
    pub fn unit(self, k: u64) -> f64 {
        (self.at(k) >> 11) as f64 * f64::powi(2.0, -53)
    }
}

/// A bijective 64-bit mixer (the finaliser of splitmix64).
pub(super) fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_balanced_and_roles_differ() {
        let s = Stream::new(Role::Judge, 0).child(7);
        for bit in 0..64 {
            let ones = (0..10_000).filter(|k| s.at(*k) >> bit & 1 == 1).count() as f64;
            // 64 bits, |z| < 5: false alarm 4e-5.
            assert!((ones - 5000.0).abs() < 5.0 * 50.0, "bit {bit}: {ones}");
        }
        assert_ne!(s.at(0), Stream::new(Role::Candidate, 0).child(7).at(0));
        assert_ne!(s.at(0), Stream::new(Role::Judge, 1).child(7).at(0));
        assert_ne!(s.at(0), Stream::new(Role::Judge, 0).child(8).at(0));
    }
}
