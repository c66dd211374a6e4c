//! Estimates with their intervals: a location or a shift, a proportion.

pub(crate) mod hodges_lehmann;
mod pairs;
pub(crate) mod proportion;
pub(crate) mod resampled;
