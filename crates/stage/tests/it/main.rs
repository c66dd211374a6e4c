//! The integration tests of `mimique-stage`, in one binary.

mod frame_memory;
mod framing;
mod golden;
mod pictures;
mod support;
