//! Why an input cannot be tested at all: codes with values; their words in English and French.

mod unfit;

use std::fmt;

use mimique_locale::Language;

pub use unfit::Unfit;

/// Why an input cannot be tested. Its words name the column and what to do.
#[derive(Debug, Clone, PartialEq)]
pub enum Refusal {
    /// A column has too few levels to compare.
    TooFewLevels {
        /// The column.
        column: String,
        /// Its levels.
        levels: Vec<String>,
        /// Rows left after dropping missing values.
        rows: usize,
        /// Levels needed.
        needed: usize,
    },
    /// No row has a value in every used column.
    NoRows {
        /// The first used column.
        column: String,
        /// Rows dropped.
        dropped: usize,
    },
    /// No column is named.
    NoColumns,
    /// A table does not have a column.
    NoColumn {
        /// The column.
        column: String,
        /// The columns that it has.
        columns: Vec<String>,
    },
    /// A cell of a column of numbers is none.
    NotANumber {
        /// The column.
        column: String,
        /// Line of the file, from 1.
        line: usize,
        /// The cell.
        cell: String,
    },
    /// A cell of a column of counts is none.
    NotACount {
        /// The column.
        column: String,
        /// Line of the file, from 1.
        line: usize,
        /// The number.
        value: f64,
    },
    /// A cell of a column of probabilities is none.
    NotAProbability {
        /// The column.
        column: String,
        /// Line of the file, from 1.
        line: usize,
        /// The number.
        value: f64,
    },
    /// A factor does not have a level.
    NoLevel {
        /// The column.
        column: String,
        /// The level.
        level: String,
        /// The levels that it has.
        levels: Vec<String>,
    },
    /// A level is named twice.
    RepeatedLevel {
        /// The column.
        column: String,
        /// The level.
        level: String,
    },
    /// A test of two groups is given another number of them.
    NotTwoLevels {
        /// The column.
        column: String,
        /// Its levels.
        levels: usize,
    },
    /// A block has two responses for one group.
    RepeatedInBlock {
        /// The column of blocks.
        column: String,
        /// The block.
        block: String,
        /// The column of groups.
        group: String,
        /// The group.
        level: String,
    },
    /// An option that is needed was not given.
    MissingOption {
        /// Its name, without dashes.
        option: String,
    },
    /// An option does not take a word.
    NotAChoice {
        /// Its name, without dashes.
        option: &'static str,
        /// The word.
        word: String,
        /// The words that it takes.
        choices: Vec<&'static str>,
    },
    /// An option that takes a whole number from 0 is given something else.
    OptionNotWhole {
        /// Its name, without dashes.
        option: &'static str,
        /// What was given.
        word: String,
    },
    /// An option that takes a number within bounds is given something else.
    OptionNotWithin {
        /// Its name, without dashes.
        option: &'static str,
        /// What was given.
        word: String,
        /// The least number.
        least: f64,
        /// The largest number.
        most: f64,
    },
    /// Neither two columns nor a column of differences nor groups of pairs are named.
    NoPairs,
    /// A test of several factors is given another number of them.
    NumberOfFactors {
        /// How many are named.
        named: usize,
        /// The least that it takes.
        least: usize,
        /// The most that it takes.
        most: usize,
    },
    /// Data that a model or a coefficient is not made for.
    Unfit(Unfit),
    /// More differences than an exact test is computed for.
    TooManyForExact {
        /// Differences that are not zero.
        n: usize,
        /// The most.
        most: usize,
    },
}

impl Refusal {
    /// In English.
    pub fn english(&self) -> String {
        let problem = self.problem(Language::English);
        self.option().map_or_else(|| problem.clone(), |[option, _]| format!("{problem}; {option}"))
    }

    /// In the middle of a sentence of a report, whose reader has no command line: what is wrong, without the option that
    /// helps.
    pub fn problem(&self, language: Language) -> String {
        match language {
            Language::English => self.english_problem(),
            Language::French => self.french_problem(),
        }
    }

    /// The option of the command line that helps, in English and French.
    fn option(&self) -> Option<[&'static str; 2]> {
        match self {
            Self::NotTwoLevels { .. } => {
                Some(["choose two with --levels A,B", "choisissez-en deux par --levels A,B"])
            }
            Self::Unfit(why) => why.option(),
            _ => None,
        }
    }

    fn english_problem(&self) -> String {
        match self {
            Self::TooFewLevels { column, levels, rows, needed } => {
                let found = match levels.as_slice() {
                    [] => "no level".to_owned(),
                    [one] => format!("only one level (\"{one}\")"),
                    more => format!("only {} levels ({})", more.len(), listed(more, ENGLISH)),
                };
                format!(
                    "column \"{column}\": {found} among the {rows} rows used, at least {needed} are needed; give a column that tells the groups apart"
                )
            }
            Self::NoRows { column, dropped } => format!(
                "column \"{column}\": no row is left after dropping {dropped} with missing values; check the column's name and its cells"
            ),
            Self::NoColumns => "no column is named; name the columns to use".to_owned(),
            Self::NoColumn { column, columns } => format!(
                "column \"{column}\": there is no such column; the columns are {}",
                listed(columns, ENGLISH)
            ),
            Self::NotANumber { column, line, cell } => format!(
                "column \"{column}\": line {line}: \"{cell}\" is not a number; give a number, or leave the cell blank or NA if it is missing"
            ),
            Self::NotACount { column, line, value } => format!(
                "column \"{column}\": line {line}: {value} is not a count; give whole numbers from 0"
            ),
            Self::NotAProbability { column, line, value } => format!(
                "column \"{column}\": line {line}: {value} is not a probability; give numbers from 0 to 1"
            ),
            Self::NoLevel { column, level, levels } => format!(
                "column \"{column}\": no row has the level \"{level}\"; its levels are {}",
                listed(levels, ENGLISH)
            ),
            Self::RepeatedLevel { column, level } => format!(
                "column \"{column}\": the level \"{level}\" is named twice; name each level once"
            ),
            Self::NotTwoLevels { column, levels } => format!(
                "column \"{column}\": {levels} levels, this test compares two"
            ),
            Self::RepeatedInBlock { column, block, group, level } => format!(
                "column \"{column}\": \"{block}\" has two responses for {group} \"{level}\"; give one row per block and group, e.g. the mean of its rows"
            ),
            Self::MissingOption { option } => {
                format!("--{option} is missing; give --{option} COLUMN")
            }
            Self::NotAChoice { option, word, choices } => {
                format!("--{option}: there is no \"{word}\"; give {}", choices.join(", "))
            }
            Self::OptionNotWhole { option, word } => {
                format!("--{option}: \"{word}\" is no whole number; give one from 0")
            }
            Self::OptionNotWithin { option, word, least, most } => format!(
                "--{option}: \"{word}\" is no number {}; give one",
                within(*least, *most, ["from ", " to ", " on", "up to "])
            ),
            Self::NoPairs => "no pairs are named; give --x X --y Y, or --difference D, or --response R --group G --levels A,B --pair P".to_owned(),
            Self::NumberOfFactors { named, least, most } => {
                let wanted = if least == most { format!("{least}") } else { format!("{least} to {most}") };
                format!("--factors names {named} columns; name {wanted}, separated by commas")
            }
            Self::Unfit(why) => why.english(),
            Self::TooManyForExact { n, most } => format!(
                "the exact variant is computed up to {most} non-zero differences, here are {n}; take an asymptotic variant"
            ),
        }
    }

    /// In French. Names of options stay as they are typed.
    pub fn french(&self) -> String {
        let problem = self.problem(Language::French);
        self.option().map_or_else(|| problem.clone(), |[_, option]| format!("{problem} ; {option}"))
    }

    fn french_problem(&self) -> String {
        match self {
            Self::TooFewLevels { column, levels, rows, needed } => {
                let found = match levels.as_slice() {
                    [] => "aucun niveau".to_owned(),
                    [one] => format!("un seul niveau (« {one} »)"),
                    more => format!("{} niveaux seulement ({})", more.len(), listed(more, FRENCH)),
                };
                format!(
                    "colonne « {column} » : {found} parmi les {rows} lignes utilisées, il en faut au moins {needed} ; donnez une colonne qui distingue les groupes"
                )
            }
            Self::NoRows { column, dropped } => format!(
                "colonne « {column} » : il ne reste aucune ligne, {dropped} ayant des valeurs manquantes ; vérifiez le nom de la colonne et ses cellules"
            ),
            Self::NoColumns => {
                "aucune colonne n’est nommée ; nommez les colonnes à utiliser".to_owned()
            }
            Self::NoColumn { column, columns } => format!(
                "colonne « {column} » : cette colonne n’existe pas ; les colonnes sont {}",
                listed(columns, FRENCH)
            ),
            Self::NotANumber { column, line, cell } => format!(
                "colonne « {column} » : ligne {line} : « {cell} » n’est pas un nombre ; donnez un nombre, ou laissez la cellule vide (ou NA) si la valeur manque"
            ),
            Self::NotACount { column, line, value } => format!(
                "colonne « {column} » : ligne {line} : {value} n’est pas un effectif ; donnez des nombres entiers à partir de 0"
            ),
            Self::NotAProbability { column, line, value } => format!(
                "colonne « {column} » : ligne {line} : {value} n’est pas une probabilité ; donnez des nombres de 0 à 1"
            ),
            Self::NoLevel { column, level, levels } => format!(
                "colonne « {column} » : aucune ligne n’a le niveau « {level} » ; ses niveaux sont {}",
                listed(levels, FRENCH)
            ),
            Self::RepeatedLevel { column, level } => format!(
                "colonne « {column} » : le niveau « {level} » est nommé deux fois ; nommez chaque niveau une fois"
            ),
            Self::NotTwoLevels { column, levels } => format!(
                "colonne « {column} » : {levels} niveaux, ce test en compare deux"
            ),
            Self::RepeatedInBlock { column, block, group, level } => format!(
                "colonne « {column} » : « {block} » a deux réponses pour {group} « {level} » ; donnez une ligne par bloc et par groupe, par exemple la moyenne de ses lignes"
            ),
            Self::MissingOption { option } => {
                format!("--{option} manque ; donnez --{option} COLONNE")
            }
            Self::NotAChoice { option, word, choices } => {
                format!("--{option} : « {word} » n’existe pas ; donnez {}", choices.join(", "))
            }
            Self::OptionNotWhole { option, word } => {
                format!("--{option} : « {word} » n’est pas un nombre entier ; donnez-en un à partir de 0")
            }
            Self::OptionNotWithin { option, word, least, most } => format!(
                "--{option} : « {word} » n’est pas un nombre {} ; donnez-en un",
                within(*least, *most, ["de ", " à ", " ou plus", "jusqu’à "])
            ),
            Self::NoPairs => "aucune paire n’est nommée ; donnez --x X --y Y, ou --difference D, ou --response R --group G --levels A,B --pair P".to_owned(),
            Self::NumberOfFactors { named, least, most } => {
                let wanted = if least == most { format!("{least}") } else { format!("de {least} à {most}") };
                format!("--factors nomme {named} colonnes ; nommez-en {wanted}, séparées par des virgules")
            }
            Self::Unfit(why) => why.french(),
            Self::TooManyForExact { n, most } => format!(
                "la variante exacte est calculée jusqu’à {most} différences non nulles, il y en a {n} ; prenez une variante asymptotique"
            ),
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.english())
    }
}

impl std::error::Error for Refusal {}

impl From<Unfit> for Refusal {
    fn from(why: Unfit) -> Self {
        Self::Unfit(why)
    }
}

/// Bounds in words, either of which may be infinite.
fn within(least: f64, most: f64, [from, to, on, up_to]: [&str; 4]) -> String {
    match (least.is_finite(), most.is_finite()) {
        (true, true) => format!("{from}{least}{to}{most}"),
        (true, false) => format!("{from}{least}{on}"),
        (false, true) => format!("{up_to}{most}"),
        (false, false) => String::new(),
    }
}

/// The language of a list, the marks around a name, and the word after the number of names that are not listed.
pub(crate) type Marks = (Language, [&'static str; 2], &'static str);

pub(crate) const ENGLISH: Marks = (Language::English, ["\"", "\""], "more");
pub(crate) const FRENCH: Marks = (Language::French, ["« ", " »"], "autres");

/// Names that a list has at most.
const LISTED: usize = 12;

/// At most twelve names, quoted, and how many more there are.
pub(crate) fn listed(names: &[String], (language, [open, close], more): Marks) -> String {
    let quoted = names.iter().take(LISTED).map(|name| format!("{open}{name}{close}"));
    let mut items: Vec<String> = quoted.collect();
    if names.len() > LISTED {
        items.push(format!("{} {more}", names.len() - LISTED));
    }
    language.list(&items)
}
