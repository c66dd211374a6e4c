//! Dense matrices in an order of operations that is the same on every processor.

pub(crate) mod cholesky;
pub(crate) mod dense;
pub(crate) mod exp;
pub(crate) mod small;
