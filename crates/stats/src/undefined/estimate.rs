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
