//! Which of the p-values of Wilcoxon's test is the answer.

use crate::distributions::tail::Alternative;
use crate::procedure::arguments::{Choice, ProcedureOption};
use crate::refusal::Refusal;

/// Up to this many non-zero differences the conditional distribution is computed exactly.
pub(crate) const EXACT_UP_TO: usize = 200;

/// Which p-value is the answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WilcoxonVariant {
    /// Exact conditional with Pratt's ranks up to 200 differences, asymptotic Pratt beyond.
    #[default]
    Automatic,
    /// Exact conditional, zeros ranked and then left out.
    ExactPratt,
    /// Exact conditional, zeros dropped before ranking.
    ExactWilcox,
    /// Normal with Pratt's ranks.
    AsymptoticPratt,
    /// Normal, zeros dropped before ranking.
    AsymptoticWilcox,
    /// R of 2019: zeros dropped; exact below 50 differences with neither ties nor zeros, else normal
    /// with continuity correction.
    Thesis,
}

/// Options of [`wilcoxon`](super::wilcoxon).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WilcoxonOptions {
    /// Which p-value is the answer.
    pub variant: WilcoxonVariant,
    /// Continuity correction of the asymptotic variants.
    pub continuity: bool,
    /// Direction.
    pub alternative: Alternative,
}

impl WilcoxonVariant {
    /// The variant that a word of `--variant` names.
    pub(crate) fn from_name(name: &str) -> Self {
        match name {
            "exact-pratt" => Self::ExactPratt,
            "exact-wilcox" => Self::ExactWilcox,
            "asymptotic-pratt" => Self::AsymptoticPratt,
            "asymptotic-wilcox" => Self::AsymptoticWilcox,
            "thesis" => Self::Thesis,
            _ => Self::Automatic,
        }
    }
}

/// `--variant`.
pub(crate) const VARIANT: ProcedureOption = ProcedureOption::one_of(
    "variant",
    "Zeros, ties and approximation [default: exact-pratt up to 200 differences, else asymptotic-pratt]",
    &[
        Choice::new(
            "exact-pratt",
            "Exact, conditional on the observed ranks; zeros ranked, then left out",
        ),
        Choice::new("exact-wilcox", "Exact, conditional on the observed ranks; zeros dropped"),
        Choice::new("asymptotic-pratt", "Normal; zeros ranked, then left out"),
        Choice::new("asymptotic-wilcox", "Normal; zeros dropped"),
        Choice::new("thesis", "As R of 2019"),
    ],
    None,
);

/// The continuity correction in words.
pub(crate) fn in_words(continuity: bool) -> &'static str {
    if continuity { "with continuity correction" } else { "without continuity correction" }
}

/// A variant with its options resolved.
#[derive(Clone, Copy)]
pub(crate) enum Chosen {
    ExactPratt,
    ExactWilcox,
    Pratt { continuity: bool },
    Wilcox { continuity: bool },
    Thesis,
}

impl Chosen {
    /// Refuses an exact variant of more differences than are computed exactly.
    pub(crate) fn of(options: WilcoxonOptions, n_used: usize) -> Result<Self, Refusal> {
        let continuity = options.continuity;
        let exact = |chosen: Self| {
            if n_used <= EXACT_UP_TO {
                return Ok(chosen);
            }
            Err(Refusal::TooManyForExact { n: n_used, most: EXACT_UP_TO })
        };
        match options.variant {
            WilcoxonVariant::Automatic if n_used <= EXACT_UP_TO => Ok(Self::ExactPratt),
            WilcoxonVariant::Automatic | WilcoxonVariant::AsymptoticPratt => {
                Ok(Self::Pratt { continuity })
            }
            WilcoxonVariant::ExactPratt => exact(Self::ExactPratt),
            WilcoxonVariant::ExactWilcox => exact(Self::ExactWilcox),
            WilcoxonVariant::AsymptoticWilcox => Ok(Self::Wilcox { continuity }),
            WilcoxonVariant::Thesis => Ok(Self::Thesis),
        }
    }

    /// Its key among the p-values of all variants.
    pub(crate) fn key(self) -> &'static str {
        match self {
            Self::ExactPratt => "exact_conditional_pratt",
            Self::ExactWilcox => "exact_conditional_wilcox_zeros",
            Self::Pratt { continuity: true } => "normal_pratt_cc",
            Self::Pratt { continuity: false } => "normal_pratt_nocc",
            Self::Wilcox { continuity: true } => "normal_wilcox_zeros_cc",
            Self::Wilcox { continuity: false } => "normal_wilcox_zeros_nocc",
            Self::Thesis => "R_le_4.5_default (thesis era)",
        }
    }
}
