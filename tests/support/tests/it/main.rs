//! The integration tests of `mimique-test-support`, in one binary.

mod dependencies;
mod one_binary;
