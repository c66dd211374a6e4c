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
    /// What is worth saying of the file: shapes that its tracker hardly sees, uneven times.
    pub notes: Vec<String>,
}

/// What applications write beside the weights: rotations of head and eyes, in radians (Live Link Face).
pub(crate) const ROTATIONS: [&str; 9] = [
    "HeadYaw",
    "HeadPitch",
    "HeadRoll",
    "LeftEyeYaw",
    "LeftEyePitch",
    "LeftEyeRoll",
    "RightEyeYaw",
    "RightEyePitch",
    "RightEyeRoll",
];

/// What the caller of a reader of weights knows.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WeightOptions<'a> {
    /// Frames per second, for a file without times.
    pub rate_hz: Option<f64>,
    /// Names of the columns, for a file without names: the shapes of an avatar's face in their order.
    pub shape_names: &'a [String],
    /// Which of a file's animations, by its name or its number counted from 1; the first that has weights where it is
    /// not given. Only files of animations (glTF) have any.
    pub animation: Option<&'a str>,
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
            notes: Vec::new(),
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

    /// Takes the rotations of head and eyes off, which are no weights of shapes. Answers their names.
    pub fn take_rotations_off(&mut self) -> Vec<String> {
        let is_rotation = |name: &String| ROTATIONS.contains(&name.as_str());
        let n = self.shape_names.len();
        let kept: Vec<usize> = (0..n).filter(|&k| !is_rotation(&self.shape_names[k])).collect();
        if kept.len() == n {
            return Vec::new();
        }
        let rows = self.weights.chunks_exact(n);
        self.weights = rows.flat_map(|row| kept.iter().map(|&k| row[k])).collect();
        let (rotations, shapes) =
            std::mem::take(&mut self.shape_names).into_iter().partition(is_rotation);
        self.shape_names = shapes;
        rotations
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_go_and_weights_stay() {
        let names = ["HeadYaw", "jawOpen", "LeftEyeRoll", "smile"].map(str::to_owned).to_vec();
        let weights = vec![9.0, 0.1, 9.0, 0.2, 9.0, 0.3, 9.0, 0.4];
        let mut table = WeightsTable::at_rate(names, weights, 0, 60.0);
        assert_eq!(table.take_rotations_off(), ["HeadYaw", "LeftEyeRoll"]);
        assert_eq!(table.shape_names, ["jawOpen", "smile"]);
        assert_eq!(table.weights, [0.1, 0.2, 0.3, 0.4]);
        assert!(table.take_rotations_off().is_empty());
        let mut only = WeightsTable::at_rate(vec!["HeadYaw".to_owned()], vec![1.0, 2.0], 0, 60.0);
        assert_eq!(only.take_rotations_off(), ["HeadYaw"]);
        assert!(only.weights.is_empty());
    }
}
