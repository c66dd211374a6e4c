//! Statistical tests, tables, figures and the report of a perceptual study.
//!
//! A file a test. Each takes columns ([`Numbers`], [`Factor`]) and returns a plain, serialisable
//! struct; what is undefined is an [`Outcome::Undefined`] with its reason, what cannot be tested a
//! [`Refusal`] that names the column. Nothing here prints, reads a file or asks the time.

mod adjust;
mod aligned_rank_transform;
mod cells;
mod chi_square;
mod coded;
mod confusion;
mod csv;
mod describe;
mod factor;
mod friedman;
mod grouped;
mod kendall;
mod kruskal_wallis;
mod mann_whitney;
mod number;
mod order_statistic;
mod outcome;
mod power;
mod preregistration;
mod proportion;
mod radix;
mod ranks;
mod report;
mod sample;
mod scheirer_ray_hare;
mod signed_rank;
mod simulate;
mod spearman;
mod special;
mod table;
mod tail;
mod tally;
mod two_way;
mod walsh;
mod wilcoxon;
mod words;

pub use adjust::{AdjustedP, Adjustment, adjust_all};
pub use aligned_rank_transform::{AlignedRankTransform, ArtEffect, aligned_rank_transform};
pub use chi_square::{ChiSquare, ChiSquareVariant, Contingency, GTest, chi_square};
pub use confusion::{Confusion, confusion};
pub use describe::{Description, describe, median, moments, quantile_sorted};
pub use factor::Factor;
pub use friedman::{Blocks, Friedman, ImanDavenport, PairwiseHolm, Quade, friedman};
pub use kruskal_wallis::{Dunn, KruskalWallis, kruskal_wallis};
pub use mann_whitney::{MannWhitney, mann_whitney};
pub use outcome::{Labelled, Outcome, Refusal};
pub use power::{
    Columns, HypothesisPower, Power, PowerError, PowerOptions, PowerPoint, Rate, no_effect, power,
    power_csv, power_curve, power_markdown, power_runs,
};
pub use preregistration::{Preregistration, preregistration};
pub use proportion::{Proportion, proportion};
pub use ranks::Ranks;
pub use report::{Language, Report, ReportFile, analyze};
pub use scheirer_ray_hare::{ScheirerRayHare, SrhTable, SumsOfSquares, scheirer_ray_hare};
pub use simulate::{
    ByLevel, Careless, Display, Dropout, Interaction, NumberAnswer, Parameters, ParametersError,
    Rating, Recognition, SimulatedSession, Simulation, Times,
};
pub use spearman::{Spearman, spearman};
pub use table::{Numbers, Table, TableError};
pub use tail::{
    Alternative, Tail, beta_quantile, chi_square_upper, f_upper, normal_quantile_upper,
    normal_tail, normal_upper, t_quantile_upper, t_two_sided, t_upper,
};
pub use walsh::HodgesLehmann;
pub use wilcoxon::{Wilcoxon, WilcoxonOptions, WilcoxonVariant, paired_differences, wilcoxon};
pub use words::{format_number, format_p};
