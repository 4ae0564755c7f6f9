//! Colours and marks.

/// What a colour stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::report) enum Paint {
    /// The k-th method: the same in every chart.
    Method(usize),
    /// Too dark.
    Cold,
    /// About right.
    Even,
    /// Too bright.
    Warm,
    /// The k-th class of pixels covered, few to many.
    Pixels(usize),
    /// What is expected.
    Ink,
}

/// Colours that stay apart for colour-blind readers [Okabe & Ito 2008].
const METHODS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#b58900", "#56b4e9", "#4d4d4d"];
const PIXELS: [&str; 5] = ["#c2402f", "#e08a2c", "#a9a13a", "#3f9d8c", "#2f62b5"];

/// Shapes of marks: curves stay apart in black and white.
pub(super) const MARKS: [&str; 6] = ["circle", "square", "triangle-up", "diamond", "triangle-down", "cross"];

impl Paint {
    /// On white.
    pub(super) fn hex(self) -> &'static str {
        match self {
            Self::Method(k) => METHODS[k % METHODS.len()],
            Self::Pixels(k) => PIXELS[k % PIXELS.len()],
            Self::Cold => "#2f62b5",
            Self::Even => "#8f98a1",
            Self::Warm => "#c2402f",
            Self::Ink => "#1c2024",
        }
    }

    /// Name of its variable in the page's style, which knows light and dark.
    pub(super) fn variable(self) -> String {
        match self {
            Self::Method(k) => format!("method-{}", k % METHODS.len()),
            Self::Pixels(k) => format!("pixels-{}", k % PIXELS.len()),
            Self::Cold => "cold".into(),
            Self::Even => "even".into(),
            Self::Warm => "warm".into(),
            Self::Ink => "ink".into(),
        }
    }

    /// Number of its mark.
    pub(super) fn mark(self) -> usize {
        match self {
            Self::Method(k) | Self::Pixels(k) => k % MARKS.len(),
            _ => 0,
        }
    }

    /// True where colours have been used up and dashes have to tell methods apart.
    pub(super) fn is_again(self) -> bool {
        matches!(self, Self::Method(k) if k >= METHODS.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pages_style_has_every_colour_twice() {
        let style = super::super::STYLE.1;
        let all = (0..7).map(Paint::Method).chain((0..5).map(Paint::Pixels));
        for p in all.chain([Paint::Cold, Paint::Even, Paint::Warm]) {
            assert!(style.contains(&format!("--{}: {};", p.variable(), p.hex())), "{p:?}");
            assert_eq!(style.matches(&format!("--{}:", p.variable())).count(), 2, "{p:?}: light and dark");
        }
    }

    #[test]
    fn seven_by_six_methods_differ_in_colour_or_mark() {
        let looks: std::collections::BTreeSet<_> = (0..42).map(Paint::Method).map(|p| (p.hex(), p.mark())).collect();
        assert_eq!(looks.len(), 42);
    }
}
