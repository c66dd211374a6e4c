//! What is measured of each clip of a study, as numbers with the names of columns: what ratings are held against.

use serde::{Deserialize, Serialize};

use crate::{Difference, Measures};

/// What is measured of a clip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ClipMeasures {
    /// The clip.
    pub clip: String,
    /// Names and values. What cannot be measured of the clip is not among them:
    ///
    /// | name | what |
    /// |---|---|
    /// | `range_mm_forehead` … `range_mm_face` | root mean square distance of a part's vertices from the neutral face, millimetres |
    /// | `jerk_m_per_s3` | root mean square of the third derivative of the vertices' places |
    /// | `widest_mouth_mm` | largest distance of the lips beyond that at rest |
    /// | `residual_mm` | root mean square of what the markers ask for and the skin does not do, millimetres |
    /// | `marker_correlation` | median correlation of the skin at a marker with the marker |
    /// | `recorded_rms_mm` | root mean square distance from the face of the recorded weights of the same segment |
    /// | `recorded_largest_mm` | the largest such distance |
    /// | `recorded_lip_vertex_error_mm` | the lips' largest distance from there, its mean over the frames |
    /// | `recorded_lip_closure_misses` | share of the frames in which those lips are shut and these are not |
    pub values: Vec<(String, f64)>,
}

impl ClipMeasures {
    /// What a clip's motion tells by itself.
    pub(crate) fn of_motion(clip: &str, measures: &Measures) -> Self {
        let range = |(part, mm): &(&str, f64)| (format!("range_mm_{}", part.to_lowercase()), *mm);
        let mut values: Vec<(String, f64)> = measures.range_mm.iter().map(range).collect();
        values.push(("jerk_m_per_s3".to_owned(), measures.jerk));
        let mut found = Self { clip: clip.to_owned(), values };
        found.add("widest_mouth_mm", measures.widest_mouth_mm);
        found
    }

    /// Adds what is known.
    pub(crate) fn add(&mut self, name: &str, value: Option<f64>) {
        self.values.extend(value.map(|value| (name.to_owned(), value)));
    }

    /// Adds how far it is from the recorded face.
    pub(crate) fn add_recorded(&mut self, difference: &Difference) {
        let face = difference.parts.last();
        self.add("recorded_rms_mm", face.map(|part| part.rms_mm));
        self.add("recorded_largest_mm", face.map(|part| part.largest_mm));
        self.add("recorded_lip_vertex_error_mm", difference.lip_vertex_error_mm);
        self.add("recorded_lip_closure_misses", difference.lip_closure_misses);
    }
}
