//! The studies of `study-config`, and small ones.

pub mod golden;
pub mod small;

pub use mimique_test_support::{study_folder, study_text};
