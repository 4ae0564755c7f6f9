//! One row of form factors from a shooter to its receivers, or the difference of two.

/// Form factors F_je from patch j to the elements, per channel: the mean first, then one for each randomisation left
/// out. What is lost has places of its own behind the elements.
#[derive(Debug, Clone)]
pub(super) struct Row {
    pub channels: usize,
    pub sinks: Vec<u32>,
    /// `channels` values for each sink.
    pub factors: Vec<f64>,
}

impl Row {
    pub fn new(channels: usize) -> Self {
        Self { channels, sinks: Vec::new(), factors: Vec::new() }
    }

    pub fn push(&mut self, sink: u32, factors: impl Iterator<Item = f64>) {
        self.sinks.push(sink);
        self.factors.extend(factors);
    }

    /// Sinks with their factors.
    pub fn iter(&self) -> impl Iterator<Item = (usize, &[f64])> {
        self.sinks.iter().map(|s| *s as usize).zip(self.factors.chunks_exact(self.channels))
    }

    /// Half the sum of all changes, channel of the mean: the share of the shooter's power that a difference of rows
    /// takes elsewhere.
    pub fn moved(&self) -> f64 {
        self.factors.iter().step_by(self.channels).map(|f| f.abs()).sum::<f64>() / 2.0
    }
}
