//! The words of `mimique test`'s options.

use clap::ValueEnum;
use mimique_stats::{Adjustment, Alternative, SumsOfSquares, WilcoxonVariant};

/// Comparisons of pairs.
#[derive(Clone, Copy, ValueEnum)]
pub enum PostHoc {
    /// Dunn's z of mean ranks
    Dunn,
}

/// A correction for several comparisons.
#[derive(Clone, Copy, ValueEnum)]
pub enum Adjust {
    /// Holm
    Holm,
    /// Bonferroni
    Bonferroni,
    /// Benjamini and Hochberg
    #[value(alias = "BH", alias = "fdr")]
    Bh,
    /// Benjamini and Yekutieli
    #[value(alias = "BY")]
    By,
    /// Hochberg
    Hochberg,
}

impl From<Adjust> for Adjustment {
    fn from(adjust: Adjust) -> Self {
        match adjust {
            Adjust::Holm => Self::Holm,
            Adjust::Bonferroni => Self::Bonferroni,
            Adjust::Bh => Self::Bh,
            Adjust::By => Self::By,
            Adjust::Hochberg => Self::Hochberg,
        }
    }
}

/// A variant of Wilcoxon's test.
#[derive(Clone, Copy, ValueEnum)]
pub enum Variant {
    /// Exact, conditional on the observed ranks; zeros ranked, then left out
    ExactPratt,
    /// Exact, conditional on the observed ranks; zeros dropped
    ExactWilcox,
    /// Normal; zeros ranked, then left out
    AsymptoticPratt,
    /// Normal; zeros dropped
    AsymptoticWilcox,
    /// As R of 2019
    Thesis,
}

impl From<Variant> for WilcoxonVariant {
    fn from(variant: Variant) -> Self {
        match variant {
            Variant::ExactPratt => Self::ExactPratt,
            Variant::ExactWilcox => Self::ExactWilcox,
            Variant::AsymptoticPratt => Self::AsymptoticPratt,
            Variant::AsymptoticWilcox => Self::AsymptoticWilcox,
            Variant::Thesis => Self::Thesis,
        }
    }
}

/// A direction.
#[derive(Clone, Copy, ValueEnum)]
pub enum Direction {
    /// Either
    TwoSided,
    /// The first is larger
    Greater,
    /// The first is smaller
    Less,
}

impl From<Direction> for Alternative {
    fn from(direction: Direction) -> Self {
        match direction {
            Direction::TwoSided => Self::TwoSided,
            Direction::Greater => Self::Greater,
            Direction::Less => Self::Less,
        }
    }
}

/// Type of sums of squares.
#[derive(Clone, Copy, ValueEnum)]
pub enum SsType {
    /// In the order given
    #[value(name = "1", alias = "I")]
    One,
    /// Each main effect adjusted for the other
    #[value(name = "2", alias = "II")]
    Two,
    /// Each effect adjusted for all others
    #[value(name = "3", alias = "III")]
    Three,
}

impl From<SsType> for SumsOfSquares {
    fn from(ss: SsType) -> Self {
        match ss {
            SsType::One => Self::One,
            SsType::Two => Self::Two,
            SsType::Three => Self::Three,
        }
    }
}
