//! Regression by a Gaussian process that learns from a range-of-motion take (thesis 3.3.1).

pub(crate) mod exact;
pub(crate) mod hyper_parameters;
pub(crate) mod input_scale;
pub(crate) mod regression;
pub(crate) mod sparse;
