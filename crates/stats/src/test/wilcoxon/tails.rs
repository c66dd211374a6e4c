//! The tail of every variant of the signed rank test, and which one is reported.

use crate::distributions::tail::{Alternative, Tail};
use crate::ranks::signed_rank::{Magnitudes, SignedRanks, Zeros};

use super::EXACT_UP_TO;
use super::variant::{Chosen, in_words};

/// How many differences there are, and how many of them are not zero.
#[derive(Clone, Copy)]
pub(super) struct Counts {
    pub all: usize,
    pub used: usize,
}

/// The tails of all variants, and the ranks that they are of.
pub(super) struct Tails<'m> {
    /// Zeros dropped before ranking.
    pub dropping: SignedRanks<'m>,
    /// Zeros ranked.
    pub pratt: SignedRanks<'m>,
    split: Tail,
    exact_dropping: Option<Tail>,
    exact_pratt: Option<Tail>,
    wilcox_cc: Tail,
    wilcox: Tail,
    pratt_cc: Tail,
    pratt_normal: Tail,
    counts: Counts,
}

impl<'m> Tails<'m> {
    pub(super) fn of(magnitudes: &'m Magnitudes, counts: Counts, alternative: Alternative) -> Self {
        let dropping = SignedRanks::of(magnitudes, Zeros::Drop);
        let pratt = match counts.all > counts.used {
            true => SignedRanks::of(magnitudes, Zeros::Pratt),
            false => dropping.clone(),
        };
        let exact = |ranks: &SignedRanks<'_>| {
            (counts.used <= EXACT_UP_TO).then(|| ranks.exact(alternative))
        };
        Self {
            split: SignedRanks::of(magnitudes, Zeros::Split).normal(alternative, false),
            exact_dropping: exact(&dropping),
            exact_pratt: exact(&pratt),
            wilcox_cc: dropping.normal(alternative, true),
            wilcox: dropping.normal(alternative, false),
            pratt_cc: pratt.normal(alternative, true),
            pratt_normal: pratt.normal(alternative, false),
            counts,
            dropping,
            pratt,
        }
    }

    fn has_zeros(&self) -> bool {
        self.counts.all > self.counts.used
    }

    /// Whether R of 2019 computed it exactly.
    pub(super) fn thesis_is_exact(&self) -> bool {
        self.counts.used < 50 && !self.dropping.has_ties() && !self.has_zeros()
    }

    fn thesis(&self) -> Tail {
        self.exact_dropping.filter(|_| self.thesis_is_exact()).unwrap_or(self.wilcox_cc)
    }

    /// The tail of a variant, its ranks, and what was computed.
    pub(super) fn chosen(&self, chosen: Chosen) -> (Tail, &SignedRanks<'m>, String) {
        match chosen {
            Chosen::ExactPratt => (
                self.exact_pratt.unwrap_or(self.pratt_normal),
                &self.pratt,
                "exact conditional on the ranks, zeros by Pratt".to_owned(),
            ),
            Chosen::ExactWilcox => (
                self.exact_dropping.unwrap_or(self.wilcox),
                &self.dropping,
                "exact conditional on the ranks, zeros dropped".to_owned(),
            ),
            Chosen::Pratt { continuity } => (
                if continuity { self.pratt_cc } else { self.pratt_normal },
                &self.pratt,
                format!("normal, corrected for ties, zeros by Pratt, {}", in_words(continuity)),
            ),
            Chosen::Wilcox { continuity } => (
                if continuity { self.wilcox_cc } else { self.wilcox },
                &self.dropping,
                format!("normal, corrected for ties, zeros dropped, {}", in_words(continuity)),
            ),
            Chosen::Thesis => (
                self.thesis(),
                &self.dropping,
                match self.thesis_is_exact() {
                    true => "as R of 2019: exact, no ties, no zeros",
                    false => "as R of 2019: normal, corrected for ties, zeros dropped, with continuity correction",
                }
                .to_owned(),
            ),
        }
    }

    /// p of every variant by its key. R and SciPy differ between their versions.
    pub(super) fn by_semantics(&self) -> Vec<(String, Option<f64>)> {
        let n = self.counts.all;
        let r_4_6 = self.exact_pratt.filter(|_| n < 50).unwrap_or(self.wilcox_cc);
        let r_4_7 = self.exact_pratt.filter(|_| n < 50).unwrap_or(self.pratt_cc);
        let is_plain = !self.dropping.has_ties() && !self.has_zeros();
        let scipy_is_exact = n <= 50 && (is_plain || n <= 13);
        let scipy = self.exact_dropping.filter(|_| scipy_is_exact).unwrap_or(self.wilcox);
        [
            ("R_le_4.5_default (thesis era)", Some(self.thesis())),
            ("R_4.6.0_default", Some(r_4_6)),
            ("R_4.7_devel_default", Some(r_4_7)),
            ("scipy_default", Some(scipy)),
            ("normal_wilcox_zeros_cc", Some(self.wilcox_cc)),
            ("normal_wilcox_zeros_nocc", Some(self.wilcox)),
            ("normal_pratt_nocc", Some(self.pratt_normal)),
            ("normal_pratt_cc", Some(self.pratt_cc)),
            ("normal_zsplit_nocc", Some(self.split)),
            ("exact_conditional_wilcox_zeros", self.exact_dropping),
            ("exact_conditional_pratt", self.exact_pratt),
        ]
        .into_iter()
        .map(|(key, tail)| (key.to_owned(), tail.map(|tail| tail.p)))
        .collect()
    }
}
