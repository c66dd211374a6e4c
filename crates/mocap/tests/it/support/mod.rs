//! What the tests of this crate share.

pub mod activity_invariants;
pub mod activity_seeds;
pub mod binary_twins;
pub mod invariants;
pub mod seeds;
pub mod twin_forms;
pub mod twins;
