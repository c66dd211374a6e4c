//! The integration tests of `mimique-exertion`, in one binary.

mod bits;
mod body_work;
mod gaits;
mod state;
mod support;
