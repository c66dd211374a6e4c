//! Why an estimate or a coefficient has no value: codes with values, words in both languages.

use crate::refusal::{ENGLISH, FRENCH, Marks, listed};
use crate::test::bradley_terry::Separation;

/// Why an estimate or a coefficient has no value.
#[derive(Debug, Clone, PartialEq)]
pub enum NoEstimate {
    /// The answers are separated: the likelihood rises for ever along some direction of the worths.
    Separated(Separation),
    /// The information is singular at the estimate.
    Singular,
    /// Participants are too few for a covariance that is clustered by them.
    TooFewParticipants {
        /// Participants.
        participants: usize,
        /// Items, more than which there must be.
        items: usize,
    },
    /// One judge agrees with nobody.
    OneJudge,
    /// The agreement of two judges has no test.
    TwoJudges,
    /// What is compared does not vary.
    NoVariance,
    /// All values are equal, so that nobody could disagree.
    NoDisagreementPossible,
    /// Only signals were shown, or only noise.
    OnlySignalsOrNoise,
    /// A rate is 0 or 1, whose normal quantile is infinite.
    RateAtBound,
    /// People are too few, or do not differ, for a test of their mean.
    NoSpreadOfPeople,
    /// Too few people, or segments, have all methods.
    TooFewWholeUnits {
        /// Those that have.
        whole: usize,
        /// All of them.
        units: usize,
    },
    /// The judgements do not tell the levels of a difference scale apart.
    LevelsNotTold,
    /// The judgements of a difference scale are separated.
    JudgementsSeparated,
    /// Answers step from one share to the other between two levels.
    StepBetweenLevels {
        /// The lower level.
        low: f64,
        /// The upper level.
        high: f64,
    },
    /// The search for the maximum of the likelihood did not end at one.
    NotConverged {
        /// Largest element of the gradient where it ended.
        gradient: f64,
    },
    /// A coefficient grows for ever with the likelihood: the answers at some level are all at one end.
    NoFiniteCoefficient {
        /// The coefficient.
        name: String,
    },
    /// The share of right answers does not rise over the levels.
    NoRise,
    /// Each level of what is tested has one unit of a grouping, such as one segment.
    OneUnitPerLevel {
        /// The grouping.
        grouping: String,
    },
}

impl NoEstimate {
    /// In English.
    pub fn english(&self) -> String {
        match self {
            Self::Separated(why) => separation_english(why),
            Self::Singular => {
                "the answers do not determine the estimates: their information is singular"
                    .to_owned()
            }
            Self::TooFewParticipants { participants, items } => format!(
                "{participants} participants are too few for a test of {items} items that is clustered by participant; at least {items} are needed"
            ),
            Self::OneJudge => "one judge only: there is nobody to agree with".to_owned(),
            Self::TwoJudges => {
                "two judges only: the test of their agreement needs at least three".to_owned()
            }
            Self::NoVariance => "what is compared does not vary".to_owned(),
            Self::NoDisagreementPossible => {
                "no clip has two values, or all values are equal: there is no disagreement to measure"
                    .to_owned()
            }
            Self::OnlySignalsOrNoise => {
                "only signals were shown, or only noise: sensitivity is of both".to_owned()
            }
            Self::RateAtBound => {
                "a rate is 0 or 1, whose normal quantile is infinite; read the log-linear one"
                    .to_owned()
            }
            Self::NoSpreadOfPeople => {
                "people are too few, or do not differ: their mean has no test".to_owned()
            }
            Self::TooFewWholeUnits { whole, units } => format!(
                "{whole} of {units} have a rating of each method, at least two are needed"
            ),
            Self::LevelsNotTold => {
                "the judgements do not tell all levels apart: some are in no judgement that bears on them".to_owned()
            }
            Self::JudgementsSeparated => {
                "the judgements are separated: some scale explains them all, and has no finite estimate"
                    .to_owned()
            }
            Self::StepBetweenLevels { low, high } => format!(
                "the answers step between levels {low} and {high}: the slope has no finite estimate"
            ),
            Self::NotConverged { gradient } => format!(
                "the model did not converge: the largest slope of the likelihood is {gradient:.1e} where the search ended, and no p is given"
            ),
            Self::NoFiniteCoefficient { name } => format!(
                "the coefficient {name} has no finite estimate: the answers there are all at one end"
            ),
            Self::NoRise => {
                "right answers do not rise over the levels: the threshold has no finite estimate"
                    .to_owned()
            }
            Self::OneUnitPerLevel { grouping } => format!(
                "each level has only one unit of \"{grouping}\", so that nothing tells the levels from what is drawn at random"
            ),
        }
    }

    /// In French.
    pub fn french(&self) -> String {
        match self {
            Self::Separated(why) => separation_french(why),
            Self::Singular => {
                "les réponses ne déterminent pas les estimations : leur information est singulière"
                    .to_owned()
            }
            Self::TooFewParticipants { participants, items } => format!(
                "{participants} participants ne suffisent pas à un test de {items} éléments groupé par participant ; il en faut au moins {items}"
            ),
            Self::OneJudge => "un seul juge : il n’y a personne avec qui s’accorder".to_owned(),
            Self::TwoJudges => {
                "deux juges seulement : le test de leur accord en exige au moins trois".to_owned()
            }
            Self::NoVariance => "ce qui est comparé ne varie pas".to_owned(),
            Self::NoDisagreementPossible => {
                "aucun clip n’a deux valeurs, ou toutes les valeurs sont égales : il n’y a aucun désaccord à mesurer"
                    .to_owned()
            }
            Self::OnlySignalsOrNoise => {
                "seuls des signaux, ou seul du bruit, ont été montrés : la sensibilité est celle aux deux"
                    .to_owned()
            }
            Self::RateAtBound => {
                "un taux vaut 0 ou 1, dont le quantile normal est infini ; lisez celui qui est log-linéaire"
                    .to_owned()
            }
            Self::NoSpreadOfPeople => {
                "les personnes sont trop peu nombreuses, ou ne diffèrent pas : leur moyenne n’a pas de test"
                    .to_owned()
            }
            Self::TooFewWholeUnits { whole, units } => format!(
                "{whole} sur {units} ont une évaluation de chaque méthode, il en faut au moins deux"
            ),
            Self::LevelsNotTold => {
                "les jugements ne distinguent pas tous les niveaux".to_owned()
            }
            Self::JudgementsSeparated => {
                "les jugements sont séparés : une échelle les explique tous, et n’a pas d’estimation finie"
                    .to_owned()
            }
            Self::StepBetweenLevels { low, high } => format!(
                "les réponses changent d’un coup entre les niveaux {low} et {high} : la pente n’a pas d’estimation finie"
            ),
            Self::NotConverged { gradient } => format!(
                "le modèle n’a pas convergé : la plus grande pente de la vraisemblance est {gradient:.1e} là où la recherche s’est arrêtée, et aucun p n’est donné"
            ),
            Self::NoFiniteCoefficient { name } => format!(
                "le coefficient {name} n’a pas d’estimation finie : les réponses y sont toutes à une extrémité"
            ),
            Self::NoRise => {
                "les réponses justes n’augmentent pas avec les niveaux : le seuil n’a pas d’estimation finie"
                    .to_owned()
            }
            Self::OneUnitPerLevel { grouping } => format!(
                "chaque niveau n’a qu’une unité de « {grouping} », si bien que rien ne distingue les niveaux de ce qui est tiré au hasard"
            ),
        }
    }
}

/// The items of a list, and whether they are several.
fn items(names: &[String], marks: Marks) -> (String, bool) {
    (listed(names, marks), names.len() > 1)
}

fn separation_english(why: &Separation) -> String {
    let tied = if why.with_ties { " nor tied" } else { "" };
    let (best, _) = items(&why.items_without_defeat, ENGLISH);
    let (worst, _) = items(&why.items_without_win, ENGLISH);
    let (group, _) = items(&why.group, ENGLISH);
    let reason = match (best.is_empty(), worst.is_empty()) {
        (false, true) => format!("{best} never lost{tied}"),
        (true, false) => format!("{worst} never won{tied}"),
        (false, false) => format!("{best} never lost{tied}, {worst} never won{tied}"),
        (true, true) if !group.is_empty() => {
            format!("none of {group} ever lost{tied} to another item")
        }
        (true, true) => match (why.side, why.tie) {
            (true, false) => "the answers follow the side on which items stand".to_owned(),
            (false, true) => "the answers follow whether items tie".to_owned(),
            _ => "the answers follow side and ties together".to_owned(),
        },
    };
    format!("{reason}: the worths have no finite estimate")
}

fn separation_french(why: &Separation) -> String {
    let tied = if why.with_ties { " ni fait jeu égal" } else { "" };
    let (best, several) = items(&why.items_without_defeat, FRENCH);
    let (worst, many) = items(&why.items_without_win, FRENCH);
    let (group, _) = items(&why.group, FRENCH);
    let have = |several: bool| if several { "n’ont" } else { "n’a" };
    let lost = format!("{best} {} jamais perdu{tied}", have(several));
    let won = format!("{worst} {} jamais gagné{tied}", have(many));
    let reason = match (best.is_empty(), worst.is_empty()) {
        (false, true) => lost,
        (true, false) => won,
        (false, false) => format!("{lost}, {won}"),
        (true, true) if !group.is_empty() => {
            format!("aucun de {group} n’a jamais perdu{tied} contre un autre élément")
        }
        (true, true) => match (why.side, why.tie) {
            (true, false) => "les réponses suivent le côté où se tiennent les éléments".to_owned(),
            (false, true) => "les réponses suivent le fait que les éléments se valent".to_owned(),
            _ => "les réponses suivent ensemble le côté et les égalités".to_owned(),
        },
    };
    format!("{reason} : les valeurs n’ont pas d’estimation finie")
}
