//! How each of ARKit's shapes moves in a clip: what participants' own faces are held against.

use mimique_avatar::{ARKIT_SHAPES, arkit_shapes};
use serde::{Deserialize, Serialize};

/// Weights over the frames of a clip, by the names of ARKit's shapes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ClipCourses {
    /// Frames per second.
    pub rate_hz: f64,
    /// Of each shape that the clip moves its name and its weight in every frame, in the order of ARKit's list.
    pub shapes: Vec<(String, Vec<f64>)>,
}

impl ClipCourses {
    /// Of weights frame by frame in the order of shapes of these names. Shapes whose name means several of ARKit's (`AU12`)
    /// move all of them; of several shapes that mean one of ARKit's the largest weight counts. Weights are rounded to
    /// 1e-6. A shape that rests in all frames is not among them.
    pub(crate) fn of(shape_names: &[String], weights: &[f64], rate_hz: f64) -> Self {
        let meant: Vec<Vec<&str>> = shape_names.iter().map(|name| arkit_shapes(name)).collect();
        let course = |shape: &&'static str| -> Option<(String, Vec<f64>)> {
            let own: Vec<usize> = (0..meant.len()).filter(|&k| meant[k].contains(shape)).collect();
            let at = |row: &[f64]| own.iter().map(|&k| row[k]).max_by(f64::total_cmp);
            let rows = weights.chunks_exact(shape_names.len().max(1));
            let course: Vec<f64> = rows
                .map(at)
                .map(|weight| weight.map(|w| (w * 1e6).round() / 1e6))
                .collect::<Option<_>>()?;
            let moves = course.iter().any(|weight| *weight != course[0]);
            moves.then(|| ((*shape).to_owned(), course))
        };
        Self { rate_hz, shapes: ARKIT_SHAPES.iter().filter_map(course).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_of_any_vocabulary_move_what_they_mean_in_arkit() {
        let names = ["AU12", "jaw_open", "nothing of it", "browInnerUp"].map(str::to_owned);
        let weights = [0.0, 0.0, 0.3, 0.5, 0.4, 0.2, 0.6, 0.5, 0.8, 0.1234567, 0.9, 0.5];
        let found = ClipCourses::of(&names, &weights, 30.0);
        let shapes: Vec<(&str, &[f64])> =
            found.shapes.iter().map(|(name, course)| (name.as_str(), &course[..])).collect();
        assert_eq!(
            shapes,
            [
                ("jawOpen", &[0.0, 0.2, 0.123457][..]),
                ("mouthSmileLeft", &[0.0, 0.4, 0.8][..]),
                ("mouthSmileRight", &[0.0, 0.4, 0.8][..]),
            ]
        );
    }
}
