//! The integration tests of `mimique-mocap`, in one binary.

mod c3d_layouts;
mod ezc3d;
mod formats_docs;
mod hostile;
mod hostile_activity;
mod real_files;
mod repair;
mod round_trip;
mod support;
mod twins;
