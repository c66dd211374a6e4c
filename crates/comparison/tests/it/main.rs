//! The integration tests of `mimique-comparison`, in one binary.

mod motions;
mod studies;
