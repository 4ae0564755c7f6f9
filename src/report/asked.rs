//! What was asked of the judge, as the record's settings tell.

use crate::study::Record;

/// What is judged: patches, or the elements they are divided into.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Level {
    Patch,
    Element,
}

impl Level {
    pub(super) fn of(record: &Record) -> Self {
        if is_set(record, "--per", "element") { Self::Element } else { Self::Patch }
    }

    /// Name of one of what is judged.
    pub(super) fn noun(self) -> &'static str {
        match self {
            Self::Patch => "patch",
            Self::Element => "element",
        }
    }

    /// Names of many.
    pub(super) fn nouns(self) -> &'static str {
        match self {
            Self::Patch => "patches",
            Self::Element => "elements",
        }
    }

    /// The patch that a judged number stands for; `None` for a number the scene does not have.
    pub(super) fn patch(self, record: &Record, number: usize) -> Option<usize> {
        match self {
            Self::Patch => (number < record.stage.patch_count()).then_some(number),
            Self::Element => record.stage.elements.get(number).map(|e| e.patch as usize),
        }
    }
}

/// True if the metrics are of B - E.
pub(super) fn is_reflected(record: &Record) -> bool {
    is_set(record, "--reflected", "true")
}

fn is_set(record: &Record, name: &str, value: &str) -> bool {
    record.settings.iter().any(|s| s.name == name && s.value == value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::testing::{record, set};

    #[test]
    fn elements_lead_to_their_patches() {
        let mut r = record();
        assert_eq!((Level::of(&r), is_reflected(&r)), (Level::Patch, false));
        assert_eq!(Level::Patch.patch(&r, usize::MAX), None);
        set(&mut r, "--per", "element");
        set(&mut r, "--reflected", "true");
        r.stage.elements[7].patch = 3;
        assert_eq!((Level::of(&r), is_reflected(&r)), (Level::Element, true));
        assert_eq!(Level::Element.patch(&r, 7), Some(3));
    }
}
