//! One row of form factors from a shooter to its receivers, or the difference of two.

/// Form factors F_je from patch j to the elements: of all rays, and of the rays of each randomisation where it has any.
/// What is lost has places of its own behind the elements.
#[derive(Debug, Clone, Default)]
pub(super) struct Row {
    pub sinks: Vec<u32>,
    mean: Vec<f64>,
    /// Where the parts of each sink end.
    ends: Vec<u32>,
    /// (channel, form factor): channel r + 1 is randomisation r.
    parts: Vec<(u16, f64)>,
}

/// The form factor to one place.
pub(super) struct Entry<'a> {
    pub sink: usize,
    pub mean: f64,
    /// By channel; channels left out are 0.
    pub parts: &'a [(u16, f64)],
}

impl Row {
    pub fn push(&mut self, sink: u32, mean: f64, parts: impl Iterator<Item = (u16, f64)>) {
        self.sinks.push(sink);
        self.mean.push(mean);
        self.parts.extend(parts);
        self.ends.push(self.parts.len() as u32);
    }

    /// A form factor without noise.
    pub fn push_exact(&mut self, sink: u32, factor: f64) {
        self.push(sink, factor, std::iter::empty());
    }

    pub fn iter(&self) -> impl Iterator<Item = Entry<'_>> {
        let mut start = 0;
        self.sinks.iter().zip(&self.mean).zip(&self.ends).map(move |((sink, mean), end)| {
            let first = std::mem::replace(&mut start, *end as usize);
            Entry { sink: *sink as usize, mean: *mean, parts: &self.parts[first..*end as usize] }
        })
    }

    /// Half the sum of all changes: the share of the shooter's power that a difference of rows takes elsewhere.
    pub fn moved(&self) -> f64 {
        self.mean.iter().map(|f| f.abs()).sum::<f64>() / 2.0
    }
}
