//! One row of form factors from a shooter to its receivers, or the difference of two.

/// Form factors F_je from patch j to the elements: of all rays, and of the rays of each randomisation. What is lost has
/// places of its own behind the elements.
#[derive(Debug, Clone, Default)]
pub(super) struct Row {
    /// Places that it reaches.
    pub sinks: Vec<u32>,
    /// Form factor to each.
    pub mean: Vec<f64>,
    /// Per randomisation: where its rays end; -1 for a ray that no longer does.
    pub rays: Vec<Vec<(u32, i8)>>,
    /// What one ray is worth in its randomisation.
    pub share: f64,
}

impl Row {
    /// Adds a form factor without noise.
    pub fn push_exact(&mut self, sink: u32, factor: f64) {
        self.sinks.push(sink);
        self.mean.push(factor);
    }

    /// Places with their form factors.
    pub fn iter(&self) -> impl Iterator<Item = (u32, f64)> {
        self.sinks.iter().copied().zip(self.mean.iter().copied())
    }

    /// Half the sum of all changes: the share of the shooter's power that a difference of rows takes elsewhere.
    pub fn moved(&self) -> f64 {
        self.mean.iter().map(|f| f.abs()).sum::<f64>() / 2.0
    }
}
