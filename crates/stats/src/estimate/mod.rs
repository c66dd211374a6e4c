//! Estimates with their intervals: a location or a shift, a proportion.

pub(crate) mod hodges_lehmann;
pub(crate) mod proportion;
