//! Why a statistic does not exist for the data: codes with values; their words in English and French.

mod estimate;

use std::fmt;

use mimique_locale::Language;
use serde::{Serialize, Serializer};

use crate::procedure::row::Term;
use crate::refusal::Refusal;
pub use estimate::NoEstimate;

/// Why a statistic does not exist.
#[derive(Debug, Clone, PartialEq)]
pub enum Undefined {
    /// All values of a column are equal, so their ranks do not differ.
    EqualValues {
        /// The column.
        column: String,
        /// How many.
        n: usize,
        /// The value.
        value: f64,
    },
    /// All differences are zero.
    AllDifferencesZero {
        /// The column of differences.
        column: String,
        /// How many.
        n: usize,
    },
    /// No value is left.
    NoValue {
        /// Missing values.
        missing: usize,
    },
    /// No block has a response for each group.
    NoCompleteBlock {
        /// Groups.
        groups: usize,
        /// Blocks that lack a response.
        incomplete: usize,
    },
    /// In each block all responses are equal.
    EqualWithinBlocks {
        /// Blocks.
        blocks: usize,
    },
    /// Iman and Davenport's F of a single block.
    OneBlock,
    /// Iman and Davenport's F where all blocks rank the groups alike.
    BlocksAgree,
    /// Fewer than two blocks have a response in each combination of levels.
    TooFewCompleteBlocks {
        /// Blocks with one.
        complete: usize,
        /// All blocks.
        blocks: usize,
        /// Combinations of levels.
        combinations: usize,
    },
    /// The combinations of levels have different numbers of responses.
    Unbalanced,
    /// No residual is left for an effect.
    NoResidual {
        /// The effect.
        term: Term,
    },
    /// No degrees of freedom are left for an effect.
    NoDegreesOfFreedom {
        /// The effect.
        term: Term,
    },
    /// Sums of squares of type III where combinations of levels have no observation.
    EmptyCells {
        /// The factors.
        factors: [String; 2],
        /// Combinations without an observation.
        empty: usize,
    },
    /// A correlation of 1 or -1, whose t has no finite value.
    PerfectCorrelation,
    /// An estimate or a coefficient has no value.
    Estimate(NoEstimate),
    /// The input was refused.
    Refused(Refusal),
}

impl Undefined {
    /// In English.
    pub fn english(&self) -> String {
        match self {
            Self::EqualValues { column, n, value } => format!(
                "column \"{column}\": all {n} values are equal ({value}), so ranks do not differ"
            ),
            Self::AllDifferencesZero { column, n } => {
                format!("all differences are zero ({n} of \"{column}\")")
            }
            Self::NoValue { missing } => format!("no value is left, {missing} are missing"),
            Self::NoCompleteBlock { groups, incomplete } => format!(
                "no block has a response for each of the {groups} groups; {incomplete} blocks are incomplete"
            ),
            Self::EqualWithinBlocks { blocks } => format!(
                "in each of the {blocks} blocks all responses are equal, so ranks do not differ"
            ),
            Self::OneBlock => "one block only: Iman and Davenport's F does not exist".to_owned(),
            Self::BlocksAgree => {
                "all blocks agree perfectly: Iman and Davenport's F does not exist".to_owned()
            }
            Self::TooFewCompleteBlocks { complete, blocks, combinations } => format!(
                "{complete} of {blocks} blocks have a response in each of the {combinations} combinations, at least two are needed"
            ),
            Self::Unbalanced => {
                "the combinations have different numbers of responses; the transform is for balanced designs"
                    .to_owned()
            }
            Self::NoResidual { term } => format!("{term}: no residual is left"),
            Self::NoDegreesOfFreedom { term } => {
                format!("{term}: no degrees of freedom are left")
            }
            Self::EmptyCells { factors: [first, second], empty } => format!(
                "type III sums of squares need every combination of \"{first}\" and \"{second}\"; {empty} have no observation"
            ),
            Self::PerfectCorrelation => {
                "the correlation is perfect: t has no finite value, no p is given".to_owned()
            }
            Self::Estimate(why) => why.english(),
            Self::Refused(refusal) => refusal.english(),
        }
    }

    /// In the middle of a sentence of a report.
    pub fn words(&self, language: Language) -> String {
        match (self, language) {
            (Self::Refused(refusal), _) => refusal.problem(language),
            (_, Language::English) => self.english(),
            (_, Language::French) => self.french(),
        }
    }

    /// In French.
    pub fn french(&self) -> String {
        match self {
            Self::EqualValues { column, n, value } => format!(
                "colonne « {column} » : les {n} valeurs sont égales ({value}), les rangs ne diffèrent donc pas"
            ),
            Self::AllDifferencesZero { column, n } => {
                format!("toutes les différences sont nulles ({n} de « {column} »)")
            }
            Self::NoValue { missing } => format!("il ne reste aucune valeur, {missing} manquent"),
            Self::NoCompleteBlock { groups, incomplete } => format!(
                "aucun bloc n’a de réponse pour chacun des {groups} groupes ; {incomplete} blocs sont incomplets"
            ),
            Self::EqualWithinBlocks { blocks } => format!(
                "dans chacun des {blocks} blocs toutes les réponses sont égales, les rangs ne diffèrent donc pas"
            ),
            Self::OneBlock => {
                "un seul bloc : le F d’Iman et Davenport n’existe pas".to_owned()
            }
            Self::BlocksAgree => {
                "tous les blocs concordent parfaitement : le F d’Iman et Davenport n’existe pas"
                    .to_owned()
            }
            Self::TooFewCompleteBlocks { complete, blocks, combinations } => format!(
                "{complete} blocs sur {blocks} ont une réponse dans chacune des {combinations} combinaisons, il en faut au moins deux"
            ),
            Self::Unbalanced => {
                "les combinaisons n’ont pas le même nombre de réponses ; la transformation suppose un plan équilibré"
                    .to_owned()
            }
            Self::NoResidual { term } => format!("{term} : il ne reste aucun résidu"),
            Self::NoDegreesOfFreedom { term } => {
                format!("{term} : il ne reste aucun degré de liberté")
            }
            Self::EmptyCells { factors: [first, second], empty } => format!(
                "les sommes de carrés de type III exigent toutes les combinaisons de « {first} » et « {second} » ; {empty} sont sans observation"
            ),
            Self::PerfectCorrelation => {
                "la corrélation est parfaite : t n’a pas de valeur finie, aucun p n’est donné"
                    .to_owned()
            }
            Self::Estimate(why) => why.french(),
            Self::Refused(refusal) => refusal.french(),
        }
    }
}

impl fmt::Display for Undefined {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.english())
    }
}

impl Serialize for Undefined {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.english())
    }
}

impl From<NoEstimate> for Undefined {
    fn from(why: NoEstimate) -> Self {
        Self::Estimate(why)
    }
}

impl From<Refusal> for Undefined {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(refusal)
    }
}
