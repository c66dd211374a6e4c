//! Distributions: upper and lower probabilities, quantiles, and order statistics of pairs.

pub(crate) mod noncentral;
pub(crate) mod order_statistic;
mod special;
pub(crate) mod tail;
