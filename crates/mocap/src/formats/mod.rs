//! The table of formats, from which all else follows: what is read and written, how a file is
//! recognised, the formats that errors name, the table of the documentation, and the samples that
//! the tests want of each.
//!
//! To add a format, write its reader in a file of this folder, which defines a [`Format`], put
//! samples into `fuzz/corpus/ID`, and add the format here.

mod bvh;
mod c3d;
mod format;
mod live_link;
mod long_csv;
mod motive_csv;
mod npy;
pub(crate) mod plausibility;
mod qtm_tsv;
pub(crate) mod source;
pub(crate) mod text;
mod tracker_csv;
mod trc;
mod vicon_csv;
pub(crate) mod weight_rows;
mod weights_csv;
mod weights_json;
mod wide_csv;

pub use c3d::{C3dOptions, C3dStorage, Processor, write_c3d};
pub use format::Format;
pub(crate) use format::{Read, Recognise, Write};
pub use npy::{VertexArray, npy_header, read_vertex_array};
use tracker_csv::{mediapipe as mediapipe_csv, openface, py_feat};
pub use trc::write_trc;
use weights_json::{
    arkit as arkit_json, audio2face as audio2face_json, mediapipe as mediapipe_json,
};
pub use wide_csv::{FORMAT as WIDE_CSV, write_csv};

/// Every format. Where a file could be of two, it is of the one that stands first.
static FORMATS: [&Format; 19] = [
    &c3d::FORMAT,
    &npy::VERTICES,
    &npy::FORMAT,
    &npy::npz::FORMAT,
    &audio2face_json::FORMAT,
    &mediapipe_json::FORMAT,
    &arkit_json::FORMAT,
    &trc::FORMAT,
    &bvh::FORMAT,
    &qtm_tsv::FORMAT,
    &motive_csv::FORMAT,
    &vicon_csv::FORMAT,
    &live_link::FORMAT,
    &openface::FORMAT,
    &py_feat::FORMAT,
    &mediapipe_csv::FORMAT,
    &long_csv::FORMAT,
    &wide_csv::FORMAT,
    &weights_csv::FORMAT,
];

/// Every format that is read.
pub fn formats() -> &'static [&'static Format] {
    &FORMATS
}

impl Format {
    /// The format of that [`Format::id`].
    pub fn by_id(id: &str) -> Option<&'static Self> {
        FORMATS.into_iter().find(|format| format.id == id)
    }
}
