//! Performances recorded as blendshape weights.

/// Blendshape weights at a rate, as an application recorded them.
#[derive(Debug, Clone, PartialEq)]
pub struct WeightTake {
    /// Names of the columns, in the file's order (N of them); rotations of head and eyes included.
    pub names: Vec<String>,
    /// Frames a second.
    pub rate_hz: f64,
    /// Frame-major: `weights[frame * N + name]`. Values above 1 or below 0 are kept.
    pub weights: Vec<f64>,
    /// Frames that were dropped and are interpolated: from the first, up to but without the second.
    pub filled: Vec<(usize, usize)>,
}

impl WeightTake {
    /// Number of frames.
    pub fn frames(&self) -> usize {
        if self.names.is_empty() { 0 } else { self.weights.len() / self.names.len() }
    }

    /// All weights of one frame.
    ///
    /// # Panics
    /// If `frame >= self.frames()`.
    pub fn frame(&self, frame: usize) -> &[f64] {
        let n = self.names.len();
        &self.weights[frame * n..(frame + 1) * n]
    }
}
