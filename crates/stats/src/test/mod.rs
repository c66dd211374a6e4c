//! A file per statistical test. None of them knows what a study is.

pub(crate) mod aligned_rank_transform;
pub(crate) mod bradley_terry;
pub(crate) mod chi_square;
pub(crate) mod friedman;
mod kendall;
pub(crate) mod kruskal_wallis;
pub(crate) mod mann_whitney;
pub(crate) mod scheirer_ray_hare;
pub(crate) mod sign;
pub(crate) mod spearman;
pub(crate) mod wilcoxon;
