//! The integration tests of `mimique-clip`, in one binary.

mod gaze;
mod packs;
