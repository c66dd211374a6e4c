//! Statistical tests on columns of a table, for people and programs that know nothing of a study.
//!
//! A [`Table`] is read from a CSV file; its columns are [`Numbers`] and [`Factor`]s. Each test takes
//! columns and returns a plain, serialisable struct; what is undefined is an [`Outcome::Undefined`]
//! with its reason, what cannot be tested is a [`Refusal`] that names the column. Nothing here prints,
//! reads a file or asks the time.
//!
//! ```
//! use mimique_stats::{Outcome, Table, mann_whitney};
//!
//! let table = Table::parse("method,rating\nbox,2\nbox,3\nbox,1\nlsts,5\nlsts,4\nlsts,6\n")?;
//! let tested = mann_whitney(&table.numbers("rating")?, &table.factor("method")?)?;
//! let Outcome::Ok(result) = tested else { panic!("the ratings differ") };
//! assert_eq!(result.pair.to_string(), "box | lsts");
//! // Of 20 ways to part six values, 2 are as far apart.
//! assert!((result.p_value - 0.1).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod adjust;
mod distributions;
mod effect;
mod estimate;
mod numerics;
mod outcome;
mod procedure;
mod ranks;
mod refusal;
mod summary;
mod table;
mod test;
mod undefined;

pub use adjust::{AdjustedP, Adjustment, adjust_all};
pub use distributions::tail::{
    Alternative, Tail, beta_quantile, binomial_half_at_least, chi_square_upper, f_quantile,
    f_upper, normal_quantile_upper, normal_tail, normal_upper, t_quantile_upper, t_two_sided,
    t_upper,
};
pub use effect::{
    EffectSize, EffectSizeKind, cliff_delta, kendall_w_interval, paired_dominance,
    standardised_difference,
};
pub use estimate::hodges_lehmann::HodgesLehmann;
pub use estimate::proportion::{Proportion, proportion};
pub use estimate::resampled::resampled_interval;
pub use numerics::dot;
pub use numerics::largest::FEWEST_PERMUTATIONS;
pub use numerics::minimise::{Minimum, Stop, minimise};
pub use numerics::random::Stream;
pub use numerics::support_vector_dual::{DualOptimum, KernelMatrix, SupportVectorDual};
pub use outcome::{Labelled, Outcome};
pub use procedure::arguments::{Arguments, Choice, ProcedureOption, Required, Takes};
pub use procedure::row::{Term, TestNames, TestResult, TestRow};
pub use procedure::{Answer, PROCEDURES, Procedure, Sample};
pub use ranks::Ranks;
pub use refusal::{Refusal, Unfit};
pub use summary::confusion::{Confusion, confusion};
pub use summary::describe::{Description, describe, median, moments, quantile_sorted};
pub use table::blocks::Blocks;
pub use table::comparisons::{Chosen, Compared, PairedComparisons, Presentation};
pub use table::contingency::Contingency;
pub use table::factor::Factor;
pub use table::number::parse_number;
pub use table::pairs::{paired_differences, rounded};
pub use table::{Numbers, Table, TableError};
pub use test::aligned_rank_transform::{AlignedRankTransform, ArtEffect, aligned_rank_transform};
pub use test::bradley_terry::{
    BradleyTerry, BradleyTerryOptions, DefaultTest, EqualWorths, LackOfFit, LikelihoodRatio,
    PenalisedWorths, Resampling, Separation, SideOrTie, WORTHS_RATIO, WinsTest, WorthContrast,
    WorthEstimates, bradley_terry,
};
pub use test::chi_square::{ChiSquare, ChiSquareVariant, GTest, chi_square};
pub use test::cluster_permutation::{
    ClusterPermutation, ClusterPermutationOptions, TimeCluster, cluster_permutation,
};
pub use test::consistency::{Consistency, JudgeConsistency, consistency};
pub use test::cronbach::{Cronbach, Reversed, cronbach};
pub use test::detection::{
    DetectedCategory, Detection, MeanTest, PersonSensitivity, Sensitivity, SignalCounts, detection,
};
pub use test::difference_scaling::{DifferenceJudgement, DifferenceScale, difference_scaling};
pub use test::equivalence::{
    EQUIVALENCE_PAIRED_T, EQUIVALENCE_WELCH, EquivalenceMannWhitney, EquivalenceOfGroups,
    EquivalenceOfPairs, EquivalenceOptions, EquivalenceT, EquivalenceVerdict, EquivalenceWilcoxon,
    equivalence_of_groups, equivalence_of_pairs,
};
pub use test::friedman::{Friedman, ImanDavenport, PairwiseHolm, Quade, friedman};
pub use test::intraclass_correlation::{
    IccForm, IntraclassCorrelation, RatingMeanSquares, intraclass_correlation,
};
pub use test::krippendorff::{
    AlphaEstimate, Krippendorff, MeasurementLevel, UnitValues, krippendorff,
};
pub use test::kruskal_wallis::{Dunn, KruskalWallis, kruskal_wallis};
pub use test::lagged_correlation::{
    CoupledPlay, Couplings, Courses, LagWindow, LaggedCorrelation, LaggedCorrelationOptions,
    PersonCoupling, Surrogates, lagged_correlation, resampled_course,
};
pub use test::mann_whitney::{MannWhitney, mann_whitney};
pub use test::min_f::{MinFPrime, RepeatedMeasuresF, min_f_prime};
pub use test::mixed_model::linear::{
    ChosenOverOthers, LinearCoefficient, LinearComparisonModel, LinearEffect, LinearMean,
    LinearMixedModel, LinearMixedModelOptions, LinearPair, linear_comparison_model,
    linear_mixed_model,
};
pub use test::mixed_model::{
    MIXED_MODEL_CATEGORIES, MIXED_MODEL_LEVELS, MixedCoefficient, MixedEffectRatio,
    MixedGroupingRatio, MixedModel, MixedModelOptions, MixedPair, MixedShares, mixed_model,
};
pub use test::panel::{Panel, PanelOptions, PanelRatings, ScreenedPerson, panel};
pub use test::psychometric::{
    BootstrapInterval, Lapse, LevelCount, PsychometricFit, PsychometricOptions, ThresholdPlace,
    bootstrap, bootstrap_through, psychometric,
};
pub use test::reverse_correlation::{
    CategoryImages, GroupImage, PersonImage, ReverseCorrelation, ReverseCorrelationOptions,
    ReverseTrial, ReverseTrials, UnitCourse, UnitImage, UnitTest, reverse_correlation,
};
pub use test::roc::{CategoryRoc, PersonArea, Roc, RocCurve, roc};
pub use test::scheirer_ray_hare::{ScheirerRayHare, SrhTable, SumsOfSquares, scheirer_ray_hare};
pub use test::sign::{Sign, sign};
pub use test::spearman::{Spearman, bonett_wright_interval, fisher_interval, spearman};
pub use test::thurstone::{Thurstone, thurstone};
pub use test::wilcoxon::{Wilcoxon, WilcoxonOptions, WilcoxonVariant, wilcoxon};
pub use undefined::{NoEstimate, Undefined};
