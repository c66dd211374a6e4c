//! A file per statistical test. None of them knows what a study is.

pub(crate) mod aligned_rank_transform;
pub(crate) mod bradley_terry;
pub(crate) mod chi_square;
pub(crate) mod cluster_permutation;
pub(crate) mod consistency;
pub(crate) mod cronbach;
pub(crate) mod detection;
pub(crate) mod difference_scaling;
pub(crate) mod equivalence;
pub(crate) mod friedman;
pub(crate) mod intraclass_correlation;
mod kendall;
pub(crate) mod krippendorff;
pub(crate) mod kruskal_wallis;
pub(crate) mod lagged_correlation;
pub(crate) mod mann_whitney;
pub(crate) mod min_f;
pub(crate) mod mixed_model;
pub(crate) mod panel;
pub(crate) mod psychometric;
pub(crate) mod reverse_correlation;
pub(crate) mod roc;
pub(crate) mod scheirer_ray_hare;
pub(crate) mod sign;
pub(crate) mod spearman;
pub(crate) mod thurstone;
pub(crate) mod wilcoxon;
