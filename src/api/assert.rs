//! Verdicts in tests.

/// Panics unless a [`Check`](crate::Check) has the verdict `Pass` (or the one named), saying limits, intervals
/// and the worst patches. An inconclusive check passes no assertion of `Pass`: ask for more rays.
///
/// ```
/// # fn main() -> Result<(), etalon::Error> {
/// use etalon::{Limits, Reference, ReferenceOptions, assert_verdict, open_scene, solve};
/// let stage = open_scene("builtin:cube-one-emitter")?.at(0)?;
/// let reference = Reference::compute(&stage, &ReferenceOptions::default().rays(4096))?;
/// let mine = solve(&stage, "hemicube:resolution=100", 0)?;
/// assert_verdict!(reference.check(&mine, &Limits::rms(0.05))?);
/// let mut dark = mine.clone();
/// dark.values.iter_mut().for_each(|b| *b *= 0.8);
/// assert_verdict!(reference.check(&dark, &Limits::rms(0.05))?, Fail);
/// # Ok(())
/// # }
/// ```
#[macro_export]
macro_rules! assert_verdict {
    ($check:expr $(,)?) => {
        $crate::assert_verdict!($check, Pass)
    };
    ($check:expr, $verdict:ident $(,)?) => {{
        let check = &$check;
        assert!(
            check.verdict() == $crate::Verdict::$verdict,
            "the verdict is not {}: {check}",
            stringify!($verdict).to_lowercase()
        );
    }};
}
