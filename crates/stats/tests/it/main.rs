//! The integration tests of `mimique-stats`, in one binary.

mod agreement;
mod factors;
mod invariance;
mod replay;
mod worths;
