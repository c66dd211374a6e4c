//! The integration tests of `mimique-avatar`, in one binary.

mod pack;
