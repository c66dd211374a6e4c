//! The integration tests of `mimique-actor`, in one binary.

mod built_in_head;
mod built_in_parts;
mod built_in_performance;
