//! Data that a model or a coefficient is not made for: codes with values, words in both languages.

use super::{ENGLISH, FRENCH, Marks, listed};

/// Data that a model or a coefficient is not made for.
#[derive(Debug, Clone, PartialEq)]
pub enum Unfit {
    /// An item was compared with itself.
    ItemBesideItself {
        /// The item.
        item: String,
        /// Row below the header, from 1.
        row: usize,
    },
    /// A cell is no answer about the two items of its row.
    NotAnAnswer {
        /// The column.
        column: String,
        /// Row below the header, from 1.
        row: usize,
        /// What stands there.
        word: String,
        /// The two items.
        pair: [String; 2],
    },
    /// No answer joins some of the items.
    Disconnected {
        /// The items that answers join, part by part.
        parts: Vec<Vec<String>>,
    },
    /// Ties are among the answers of a model without ties.
    TiesNotModelled {
        /// How many.
        tied: u64,
    },
    /// The orders in which items were shown do not tell a side bias from the worths.
    SideNotTold,
    /// A judge of a complete tournament finds two items the same.
    TiedTournament {
        /// The judge.
        judge: String,
        /// The two items.
        pair: [String; 2],
    },
    /// A judge has not chosen once of each pair.
    IncompleteTournament {
        /// The judge.
        judge: String,
        /// The two items.
        pair: [String; 2],
        /// How often the judge chose between them.
        times: usize,
    },
    /// Fewer than two questions are added up.
    TooFewQuestions {
        /// Questions.
        questions: usize,
    },
    /// Too few people have answered.
    TooFewPeople {
        /// The column.
        column: String,
        /// People.
        people: usize,
        /// People needed.
        needed: usize,
    },
    /// An answer lies outside the range of answers.
    OutsideRange {
        /// The column.
        column: String,
        /// The answer.
        value: f64,
        /// Lowest answer that can be given.
        low: f64,
        /// Highest answer that can be given.
        high: f64,
    },
    /// An option that takes two ascending numbers is given something else.
    NotARange {
        /// Its name, without dashes.
        option: &'static str,
        /// What was given.
        word: String,
    },
    /// Bounds of equivalence that hold nothing between them, or a level that is none.
    EquivalenceBounds {
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
        /// Level of each of the two tests.
        alpha: f64,
    },
    /// Names where a level of measurement needs numbers.
    NameWhereNumber {
        /// The name.
        value: String,
        /// The level of measurement.
        level: &'static str,
    },
    /// A cell that must be 0 or 1.
    NotZeroOrOne {
        /// The column.
        column: String,
        /// Line of the file, from 1.
        line: usize,
        /// The number.
        value: f64,
    },
    /// Difference scaling takes three columns of levels, or four.
    NumberOfLevelColumns {
        /// Columns named.
        named: usize,
    },
    /// A parameter was shown at too few levels.
    TooFewStimulusLevels {
        /// Levels.
        levels: usize,
        /// Levels needed.
        needed: usize,
    },
    /// A row of a psychometric function has no level, or more right answers than answers.
    CountsOfLevel {
        /// Row below the header, from 1.
        row: usize,
        /// The level.
        level: f64,
        /// Answers.
        n: u64,
        /// Right ones.
        correct: u64,
    },
    /// A Weibull function of a level below 0.
    LevelNotPositive {
        /// The level.
        level: f64,
    },
    /// More different ratings than a model has thresholds for.
    TooManyRatings {
        /// The column.
        column: String,
        /// Different ratings.
        ratings: usize,
        /// The most that are taken.
        most: usize,
    },
    /// Shares of guesses and lapses that leave nothing to be seen.
    GuessAndLapse {
        /// Share of right answers by chance.
        guess: f64,
        /// Share of wrong answers where all is seen.
        lapse: f64,
    },
    /// A row is no course of an action unit.
    NoCourse {
        /// Row below the header, from 1.
        row: usize,
    },
    /// The rows of one trial have different answers, or different intensities.
    TwoAnswersToTrial {
        /// The person.
        participant: String,
        /// The trial.
        trial: String,
    },
    /// Two rows of one trial are of the same unit.
    UnitTwice {
        /// The person.
        participant: String,
        /// The trial.
        trial: String,
        /// The unit.
        unit: String,
    },
}

impl Unfit {
    /// The option of the command line that helps, in English and French.
    pub(super) fn option(&self) -> Option<[&'static str; 2]> {
        Some(match self {
            Self::Disconnected { .. } => [
                "choose items with --items that answers join, or ask about pairs between them",
                "choisissez par --items des éléments que des réponses relient, ou posez la question pour des paires entre eux",
            ],
            Self::OutsideRange { .. } => [
                "give the range of answers with --range",
                "donnez l’étendue des réponses par --range",
            ],
            Self::NameWhereNumber { .. } => ["take --level nominal", "prenez --level nominal"],
            Self::LevelNotPositive { .. } => ["take --function normal", "prenez --function normal"],
            _ => return None,
        })
    }

    /// In English, without [`Unfit::option`].
    pub(super) fn english(&self) -> String {
        match self {
            Self::ItemBesideItself { item, row } => format!(
                "row {row}: \"{item}\" is compared with itself; give two items"
            ),
            Self::NotAnAnswer { column, row, word, pair: [left, right] } => format!(
                "column \"{column}\": row {row}: \"{word}\" is no answer about \"{left}\" and \"{right}\"; give left, right or same, or in all rows the name of the item that was chosen"
            ),
            Self::Disconnected { parts } => format!(
                "no answer compares the items of {}",
                in_parts(parts, ENGLISH, " with those of ")
            ),
            Self::TiesNotModelled { tied } => format!(
                "{tied} answers are \"same\", and the model has no ties; leave them in the model, or out of the data"
            ),
            Self::SideNotTold => {
                "no pair was shown in orders that tell a side bias from the worths; leave the side bias out".to_owned()
            }
            Self::TiedTournament { judge, pair: [a, b] } => format!(
                "\"{judge}\" finds \"{a}\" and \"{b}\" the same; consistency is of choices without ties"
            ),
            Self::IncompleteTournament { judge, pair: [a, b], times } => format!(
                "\"{judge}\" has chosen {times} times between \"{a}\" and \"{b}\"; consistency needs one choice of each pair by each judge"
            ),
            Self::TooFewQuestions { questions } => format!(
                "{questions} questions are named, at least 2 are needed; name those that are added up"
            ),
            Self::TooFewPeople { column, people, needed } => format!(
                "column \"{column}\": {people} people have answered all questions, at least {needed} are needed"
            ),
            Self::OutsideRange { column, value, low, high } => format!(
                "column \"{column}\": {value} is no answer from {low} to {high}"
            ),
            Self::NotARange { option, word } => format!(
                "--{option}: \"{word}\" is not two numbers, the lower one first; give them as in --{option} 1,7"
            ),
            Self::EquivalenceBounds { low, high, alpha } => format!(
                "bounds {low} and {high} at level {alpha}: give a lower bound that is less than the upper one, and a level between 0 and 0.5"
            ),
            Self::NameWhereNumber { value, level } => format!(
                "\"{value}\" is no number, which {level} values must be"
            ),
            Self::NotZeroOrOne { column, line, value } => format!(
                "column \"{column}\": line {line}: {value} is neither 0 nor 1"
            ),
            Self::NumberOfLevelColumns { named } => format!(
                "--levels names {named} columns; name three of a triad, or four of two pairs"
            ),
            Self::TooFewStimulusLevels { levels, needed } => format!(
                "{levels} levels were shown, at least {needed} are needed"
            ),
            Self::CountsOfLevel { row, level, n, correct } => format!(
                "row {row}: {correct} right answers of {n} at level {level}; give a level that is a number and no more right answers than answers"
            ),
            Self::LevelNotPositive { level } => format!(
                "level {level} is below 0, where a Weibull function has no value"
            ),
            Self::TooManyRatings { column, ratings, most } => format!(
                "column \"{column}\": {ratings} different ratings, of which each has a threshold; at most {most} are taken: round them to fewer steps, or take min-f"
            ),
            Self::GuessAndLapse { guess, lapse } => format!(
                "guess {guess} and lapse {lapse}: give shares from 0 to 1 that add up to less than 1"
            ),
            Self::NoCourse { row } => format!(
                "row {row}: no course of a unit; give an onset from 0, a later peak, a still later offset, an amplitude above 0 to 1, and shares of half the height between 0 and 1"
            ),
            Self::TwoAnswersToTrial { participant, trial } => format!(
                "trial \"{trial}\" of \"{participant}\": its rows differ in answer or intensity; give one row per unit of a trial, each with the trial's answer"
            ),
            Self::UnitTwice { participant, trial, unit } => format!(
                "trial \"{trial}\" of \"{participant}\": \"{unit}\" is in two rows; give one row per unit of a trial"
            ),
        }
    }

    /// In French, without [`Unfit::option`].
    pub(super) fn french(&self) -> String {
        match self {
            Self::ItemBesideItself { item, row } => format!(
                "ligne {row} : « {item} » est comparé à lui-même ; donnez deux éléments"
            ),
            Self::NotAnAnswer { column, row, word, pair: [left, right] } => format!(
                "colonne « {column} » : ligne {row} : « {word} » n’est pas une réponse au sujet de « {left} » et « {right} » ; donnez left, right ou same, ou dans toutes les lignes le nom de l’élément choisi"
            ),
            Self::Disconnected { parts } => format!(
                "aucune réponse ne compare les éléments de {}",
                in_parts(parts, FRENCH, " à ceux de ")
            ),
            Self::TiesNotModelled { tied } => format!(
                "{tied} réponses sont « same », et le modèle n’a pas d’égalités ; laissez-les dans le modèle, ou ôtez-les des données"
            ),
            Self::SideNotTold => {
                "aucune paire n’a été montrée dans des ordres qui distinguent un biais de côté des valeurs ; retirez le biais de côté".to_owned()
            }
            Self::TiedTournament { judge, pair: [a, b] } => format!(
                "« {judge} » trouve « {a} » et « {b} » égaux ; la cohérence est celle de choix sans égalités"
            ),
            Self::IncompleteTournament { judge, pair: [a, b], times } => format!(
                "« {judge} » a choisi {times} fois entre « {a} » et « {b} » ; la cohérence exige un choix par juge pour chaque paire"
            ),
            Self::TooFewQuestions { questions } => format!(
                "{questions} questions sont nommées, il en faut au moins 2 ; nommez celles qui s’additionnent"
            ),
            Self::TooFewPeople { column, people, needed } => format!(
                "colonne « {column} » : {people} personnes ont répondu à toutes les questions, il en faut au moins {needed}"
            ),
            Self::OutsideRange { column, value, low, high } => format!(
                "colonne « {column} » : {value} n’est pas une réponse de {low} à {high}"
            ),
            Self::NotARange { option, word } => format!(
                "--{option} : « {word} » n’est pas deux nombres, le plus petit d’abord ; donnez-les comme dans --{option} 1,7"
            ),
            Self::EquivalenceBounds { low, high, alpha } => format!(
                "bornes {low} et {high} au niveau {alpha} : donnez une borne inférieure plus petite que la supérieure, et un niveau entre 0 et 0,5"
            ),
            Self::NameWhereNumber { value, level } => format!(
                "« {value} » n’est pas un nombre, ce que des valeurs de niveau {level} doivent être"
            ),
            Self::NotZeroOrOne { column, line, value } => format!(
                "colonne « {column} » : ligne {line} : {value} n’est ni 0 ni 1"
            ),
            Self::NumberOfLevelColumns { named } => format!(
                "--levels nomme {named} colonnes ; nommez-en trois d’une triade, ou quatre de deux paires"
            ),
            Self::TooFewStimulusLevels { levels, needed } => format!(
                "{levels} niveaux ont été montrés, il en faut au moins {needed}"
            ),
            Self::CountsOfLevel { row, level, n, correct } => format!(
                "ligne {row} : {correct} réponses justes sur {n} au niveau {level} ; donnez un niveau qui soit un nombre et pas plus de réponses justes que de réponses"
            ),
            Self::LevelNotPositive { level } => format!(
                "le niveau {level} est inférieur à 0, où une fonction de Weibull n’a pas de valeur"
            ),
            Self::TooManyRatings { column, ratings, most } => format!(
                "colonne « {column} » : {ratings} notes différentes, chacune ayant son seuil ; {most} au plus sont prises : arrondissez-les à moins d’échelons, ou prenez min-f"
            ),
            Self::GuessAndLapse { guess, lapse } => format!(
                "hasard {guess} et inattention {lapse} : donnez des parts de 0 à 1 dont la somme est inférieure à 1"
            ),
            Self::NoCourse { row } => format!(
                "ligne {row} : ce n’est pas le cours d’une unité ; donnez un début à partir de 0, un sommet plus tard, une fin plus tard encore, une amplitude au-dessus de 0 et jusqu’à 1, et des parts de la demi-hauteur entre 0 et 1"
            ),
            Self::TwoAnswersToTrial { participant, trial } => format!(
                "essai « {trial} » de « {participant} » : ses lignes diffèrent par la réponse ou l’intensité ; donnez une ligne par unité d’un essai, chacune avec la réponse de l’essai"
            ),
            Self::UnitTwice { participant, trial, unit } => format!(
                "essai « {trial} » de « {participant} » : « {unit} » est dans deux lignes ; donnez une ligne par unité d’un essai"
            ),
        }
    }
}

/// The parts, each in brackets.
fn in_parts(parts: &[Vec<String>], marks: Marks, between: &str) -> String {
    let part = |part: &Vec<String>| format!("({})", listed(part, marks));
    parts.iter().map(part).collect::<Vec<_>>().join(between)
}
