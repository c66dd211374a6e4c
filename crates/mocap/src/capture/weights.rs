//! The vocabulary of recorded performances: blendshape weights over time.

/// Blendshape weights over time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WeightsTable {
    /// Names of the N columns, in the file's or the avatar's order; an application's rotations of
    /// head and eyes included.
    pub shape_names: Vec<String>,
    /// Number of each frame, as in the capture.
    pub frames: Vec<u64>,
    /// Seconds of each frame.
    pub times: Vec<f64>,
    /// Frame-major: `weights[frame * N + shape]`. Values above 1 or below 0 are kept.
    pub weights: Vec<f64>,
    /// Rows that the recording had dropped and that are interpolated: from the first, up to but
    /// without the second.
    pub filled: Vec<(usize, usize)>,
}

/// What the caller of a reader of weights knows.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WeightOptions<'a> {
    /// Frames per second, for a file without times.
    pub rate_hz: Option<f64>,
    /// Names of the columns, for a file without names: an avatar's shapes in their order.
    pub shape_names: &'a [String],
}

impl WeightsTable {
    /// The rows of a take: frames numbered from `first_frame`, at a rate.
    pub fn at_rate(
        shape_names: Vec<String>,
        weights: Vec<f64>,
        first_frame: u64,
        rate_hz: f64,
    ) -> Self {
        let count = weights.len() / shape_names.len().max(1);
        Self {
            shape_names,
            frames: (0..count as u64).map(|f| first_frame + f).collect(),
            times: (0..count).map(|f| f as f64 / rate_hz).collect(),
            weights,
            filled: Vec::new(),
        }
    }

    /// The same at another rate: straight between the two nearest rows, as the stage shows them.
    /// Frames are numbered at the new rate. A table of fewer than two rows stays as it is.
    pub fn resampled(&self, rate_hz: f64) -> Self {
        let Some(recorded_hz) = self.rate_hz() else { return self.clone() };
        let (step, last) = (recorded_hz / rate_hz, self.frames.len() - 1);
        // The last new row is not after the last old one, but for rounding.
        let rows = (last as f64 / step + 1e-9).floor() as usize + 1;
        let weights = (0..rows).flat_map(|row| {
            let at = (row as f64 * step).min(last as f64);
            let (low, part) = (at.floor() as usize, at.fract());
            let pair = self.row(low).iter().zip(self.row((low + 1).min(last)));
            pair.map(move |(a, b)| a + part * (b - a)).collect::<Vec<_>>()
        });
        let first = (self.frames[0] as f64 / step).round() as u64;
        Self::at_rate(self.shape_names.clone(), weights.collect(), first, rate_hz)
    }

    /// The N weights of row `row`.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn row(&self, row: usize) -> &[f64] {
        let n = self.shape_names.len();
        &self.weights[row * n..(row + 1) * n]
    }

    /// Frames per second, from the times; `None` below two frames.
    pub fn rate_hz(&self) -> Option<f64> {
        let (first, last) = (self.times.first()?, self.times.last()?);
        let rate = (self.times.len() - 1) as f64 / (last - first);
        (rate.is_finite() && rate > 0.0).then_some(rate)
    }
}
