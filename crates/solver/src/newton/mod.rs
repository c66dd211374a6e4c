//! Smooth objectives (norms, soft bounds) and Newton's method on them.

pub(crate) mod minimise;
pub(crate) mod objective;
