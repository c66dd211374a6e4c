//! What is measured of each clip of a study, as numbers with the names of columns: what ratings are held against.

use serde::{Deserialize, Serialize};

use crate::{ClipCourses, Difference, Measures};

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
    /// | `obj_range_mm_forehead` … `obj_range_mm_face` | [range](crate::Measures::range_mm) of a part, millimetres |
    /// | `obj_jerk_m_per_s3` | root mean square of the third derivative of the vertices' places |
    /// | `obj_widest_mouth_mm` | largest distance of the lips beyond that at rest |
    /// | `obj_residual_mm` | root mean square of what the markers ask for and the skin does not do, millimetres |
    /// | `obj_marker_correlation` | median correlation of the skin at a marker with the marker |
    ///
    /// and from the face of the recorded weights of the same segment, as [`Difference`] defines them:
    ///
    /// | name | what |
    /// |---|---|
    /// | `obj_recorded_rmse_mm` | root mean square distance of the vertices |
    /// | `obj_recorded_largest_mm` | the largest such distance |
    /// | `obj_recorded_lip_vertex_error_mm`, `…_mm2` | the lips' largest distance, and its square; means over the frames |
    /// | `obj_recorded_upper_face_deviation_mm2` | upper-face dynamics deviation |
    /// | `obj_recorded_lip_gap_error_mm` | by how much the lips' distance is another |
    /// | `obj_recorded_lip_closures_kept` | share of the frames with shut lips in which these are shut, too |
    pub values: Vec<(String, f64)>,
    /// How its shapes move, in studies that measure participants' faces; none of others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub courses: Option<ClipCourses>,
}

impl ClipMeasures {
    /// What a clip's motion tells by itself.
    pub(crate) fn of_motion(clip: &str, measures: &Measures) -> Self {
        let range =
            |(part, mm): &(&str, f64)| (format!("obj_range_mm_{}", part.to_lowercase()), *mm);
        let mut values: Vec<(String, f64)> = measures.range_mm.iter().map(range).collect();
        values.push(("obj_jerk_m_per_s3".to_owned(), measures.jerk));
        let mut found = Self { clip: clip.to_owned(), values, courses: None };
        found.add("obj_widest_mouth_mm", measures.widest_mouth_mm);
        found
    }

    /// Adds what is known.
    pub(crate) fn add(&mut self, name: &str, value: Option<f64>) {
        self.values.extend(value.map(|value| (name.to_owned(), value)));
    }

    /// Adds how far it is from the recorded face.
    pub(crate) fn add_recorded(&mut self, difference: &Difference) {
        let face = difference.parts.last();
        let kept = difference.lip_closures.and_then(|closures| closures.share_kept());
        self.add("obj_recorded_rmse_mm", face.map(|part| part.rms_mm));
        self.add("obj_recorded_largest_mm", face.map(|part| part.largest_mm));
        self.add("obj_recorded_lip_vertex_error_mm", difference.lip_vertex_error_mm);
        self.add("obj_recorded_lip_vertex_error_mm2", difference.lip_vertex_error_mm2);
        self.add("obj_recorded_upper_face_deviation_mm2", difference.upper_face_deviation_mm2);
        self.add("obj_recorded_lip_gap_error_mm", difference.lip_gap_error_mm);
        self.add("obj_recorded_lip_closures_kept", kept);
    }
}
