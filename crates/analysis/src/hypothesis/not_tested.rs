//! Why a hypothesis cannot be tested, and the words for it.

use mimique_locale::Language;
use mimique_study::AnswerOfPair;

/// Why a hypothesis cannot be tested.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum NotTested {
    /// Nobody answered what can be tested.
    NoAnswers { response: String },
    /// The export has neither a factor nor an answer of this name.
    NoFactor { factor: String },
    /// There is nothing to compare.
    TooFewLevels { factor: String },
    /// The hypothesis names no factor.
    NoFactorNamed,
    /// The answers are about two clips.
    OfPair(AnswerOfPair),
    /// The test is of two levels.
    NotTwoLevels { factor: String, levels: usize },
    /// The hypothesis of equivalence does not say what is small.
    NoSmallestEffect,
}

impl NotTested {
    /// What is the matter and what to do, in the middle of a sentence.
    pub(crate) fn words(&self, language: Language) -> String {
        match self {
            Self::NoAnswers { response } => language.pick(
                format!("\"{response}\" has no answers that this test can use"),
                format!("« {response} » n’a pas de réponses que ce test puisse utiliser"),
            ),
            Self::NoFactor { factor } => language.pick(
                format!("there is no factor \"{factor}\" in the export"),
                format!("l’export n’a pas de facteur « {factor} »"),
            ),
            Self::TooFewLevels { factor } => language.pick(
                format!("\"{factor}\" has fewer than two levels in the answers"),
                format!("« {factor} » a moins de deux niveaux dans les réponses"),
            ),
            Self::NoFactorNamed => {
                language.pick("no factor is named", "aucun facteur n’est nommé").to_owned()
            }
            Self::OfPair(of_pair) => of_pair_in_words(of_pair, language),
            Self::NotTwoLevels { factor, levels } => language.pick(
                format!("\"{factor}\" has {levels} levels in the answers, and equivalence is tested of two: name them in \"levels\""),
                format!("« {factor} » a {levels} niveaux dans les réponses, et l’équivalence se teste pour deux : nommez-les dans « levels »"),
            ),
            Self::NoSmallestEffect => language
                .pick(
                    "the study file does not say which difference is the smallest that matters (\"smallestEffect\")",
                    "le fichier de l’étude ne dit pas quelle est la plus petite différence qui compte (« smallestEffect »)",
                )
                .to_owned(),
        }
    }
}

/// Why answers about two clips are not told of the levels of a factor.
pub(crate) fn of_pair_in_words(of_pair: &AnswerOfPair, language: Language) -> String {
    match of_pair {
        AnswerOfPair::Choice { question, factor } => language.pick(
            format!("\"{question}\" says which of two clips: its answers are of no level of \"{factor}\"; the choices and their tests are in this report"),
            format!("« {question} » dit lequel de deux extraits : ses réponses ne sont celles d’aucun niveau de « {factor} » ; les choix et leurs tests sont dans ce rapport"),
        ),
        AnswerOfPair::Rating { question, factor, clip, beside } => language.pick(
            format!("\"{question}\" was asked of two clips together that differ in \"{factor}\", such as \"{clip}\" beside \"{beside}\": which of them is meant nobody knows; ask it in trials of one clip, or beside one and the same {factor} that is not compared"),
            format!("« {question} » a été demandé de deux extraits à la fois qui diffèrent par « {factor} », comme « {clip} » à côté de « {beside} » : nul ne sait duquel il s’agit ; posez la question dans des essais d’un seul extrait, ou à côté d’un seul et même niveau de « {factor} » qui n’est pas comparé"),
        ),
    }
}
