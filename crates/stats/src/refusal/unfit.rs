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
}

impl Unfit {
    /// In English.
    pub fn english(&self) -> String {
        match self {
            Self::ItemBesideItself { item, row } => format!(
                "row {row}: \"{item}\" is compared with itself; give two items"
            ),
            Self::NotAnAnswer { column, row, word, pair: [left, right] } => format!(
                "column \"{column}\": row {row}: \"{word}\" is no answer about \"{left}\" and \"{right}\"; give left, right or same, or in all rows the name of the item that was chosen"
            ),
            Self::Disconnected { parts } => format!(
                "no answer compares the items of {}; choose items with --items that answers join, or ask about pairs between them",
                in_parts(parts, ENGLISH, " with those of ")
            ),
            Self::TiesNotModelled { tied } => format!(
                "{tied} answers are \"same\", and the model has no ties; leave them in the model, or out of the data"
            ),
            Self::SideNotTold => {
                "no pair was shown in orders that tell a side bias from the worths; leave the side bias out".to_owned()
            }
        }
    }

    /// In French.
    pub fn french(&self) -> String {
        match self {
            Self::ItemBesideItself { item, row } => format!(
                "ligne {row} : « {item} » est comparé à lui-même ; donnez deux éléments"
            ),
            Self::NotAnAnswer { column, row, word, pair: [left, right] } => format!(
                "colonne « {column} » : ligne {row} : « {word} » n’est pas une réponse au sujet de « {left} » et « {right} » ; donnez left, right ou same, ou dans toutes les lignes le nom de l’élément choisi"
            ),
            Self::Disconnected { parts } => format!(
                "aucune réponse ne compare les éléments de {} ; choisissez par --items des éléments que des réponses relient, ou posez la question pour des paires entre eux",
                in_parts(parts, FRENCH, " à ceux de ")
            ),
            Self::TiesNotModelled { tied } => format!(
                "{tied} réponses sont « same », et le modèle n’a pas d’égalités ; laissez-les dans le modèle, ou ôtez-les des données"
            ),
            Self::SideNotTold => {
                "aucune paire n’a été montrée dans des ordres qui distinguent un biais de côté des valeurs ; retirez le biais de côté".to_owned()
            }
        }
    }
}

/// The parts, each in brackets.
fn in_parts(parts: &[Vec<String>], marks: Marks, between: &str) -> String {
    let part = |part: &Vec<String>| format!("({})", listed(part, marks));
    parts.iter().map(part).collect::<Vec<_>>().join(between)
}
