//! The integration tests of `mimique-arena`, in one binary.

mod planted;
mod schema;
