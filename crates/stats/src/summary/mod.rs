//! What describes a sample without testing it.

pub(crate) mod confusion;
pub(crate) mod describe;
