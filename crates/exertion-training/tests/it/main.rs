//! The integration tests of `mimique-exertion-training`, in one binary.

mod lessons;
