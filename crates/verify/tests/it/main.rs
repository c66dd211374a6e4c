//! The integration tests of `mimique-verify`, in one binary.

mod planted;
mod shared_data;
