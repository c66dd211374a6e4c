//! The kinds of questions: what each can be asked, and the one list of them.
//!
//! A kind is one file of this folder (its definition, its check, what an answer to it is, its parts and
//! columns in the export, how people are simulated, what the page shows, its tests) and one line in
//! [`QuestionKind`]; the page has a control for what it shows. Everything else asks [`KindOfQuestion`].

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use enum_dispatch::enum_dispatch;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::best_worst::BestWorst;
use super::comparison::Comparison;
use super::likert::Likert;
use super::long_text::LongText;
use super::matrix::Matrix;
use super::multiple_choice::MultipleChoice;
use super::number::NumberField;
use super::ranking::Ranking;
use super::short_text::ShortText;
use super::simulation::{Chance, Scale, Simulated};
use super::single_choice::SingleChoice;
use super::slider::Slider;
use super::valence_arousal::Grid;
use super::view::{QuestionKindView, Showing};
use super::{Choice, OptionOrder, Question};
use crate::answer::AnswerProblem;
use crate::check::Issues;
use crate::columns::ColumnKind;
use crate::study_file::LocalText;
use crate::text::Words;

/// What kind of answer is asked for.
#[enum_dispatch(KindOfQuestion)]
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "camelCase")]
#[non_exhaustive]
pub enum QuestionKind {
    /// One of several: radio buttons. With `truth`, a forced choice.
    SingleChoice(SingleChoice),
    /// Any of several: check boxes.
    MultipleChoice(MultipleChoice),
    /// A rating scale, coded as shown.
    Likert(Likert),
    /// A number on a line.
    Slider(Slider),
    /// A number typed.
    Number(NumberField),
    /// A line of text.
    ShortText(ShortText),
    /// Several lines of text.
    LongText(LongText),
    /// One choice in each of several rows.
    Matrix(Matrix),
    /// Options put in order.
    Ranking(Ranking),
    /// A point on a grid of valence and arousal.
    ValenceArousal(Grid),
    /// Which of the two clips shown side by side.
    Comparison(Comparison),
    /// The best and the worst of several: best-worst scaling.
    BestWorst(BestWorst),
}

/// What can be shown of many answers together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Summary {
    /// How often each option was chosen.
    Options,
    /// How often each of these answers was given, which the page has its own words for.
    Sides(Vec<&'static str>),
    /// How often each point was chosen.
    Points(RangeInclusive<i64>),
    /// Least, mean and greatest.
    Numbers,
    /// How many there are.
    Texts,
}

/// What every kind of question defines.
#[enum_dispatch]
pub trait KindOfQuestion {
    /// What is wrong with its definition; `place` is the question's JSON pointer.
    fn check(&self, place: &str, issues: &mut Issues);

    /// Whether an answer that is not empty can be taken.
    fn accept(&self, answer: &Value) -> Result<(), AnswerProblem>;

    /// What the page shows.
    fn view(&self, showing: &Showing<'_>) -> QuestionKindView;

    /// What is measured, in English or French, as a preregistration says it.
    fn described(&self, language: &str) -> String;

    /// How people are simulated.
    fn simulated(&self) -> Simulated<'_>;

    /// An answer of a simulated person, for a kind that is [`Simulated::Drawn`]. `weights` has one for
    /// each option: how likely it is chosen.
    fn drawn(&self, _weights: &[f64], _chance: &mut dyn Chance) -> Value {
        Value::Null
    }

    /// Its options.
    fn options(&self) -> &[Choice] {
        &[]
    }

    /// Its rows, each of which is answered.
    fn rows(&self) -> &[Choice] {
        &[]
    }

    /// The key of each option that is answered by a key while the clip plays, by its value; none of other questions.
    fn keys(&self) -> Option<&BTreeMap<String, String>> {
        None
    }

    /// Whether the answer is the course of a line that is moved while the clip plays.
    fn is_traced(&self) -> bool {
        false
    }

    /// In which order the options are shown.
    fn option_order(&self) -> OptionOrder {
        OptionOrder::Fixed
    }

    /// The factor of the clip that holds the right answer.
    fn truth(&self) -> Option<&str> {
        None
    }

    /// The rating that says how sure the answer is.
    fn confidence(&self) -> Option<&str> {
        None
    }

    /// Whether it compares the two clips of a trial.
    fn compares_clips(&self) -> bool {
        false
    }

    /// Whether it asks for the best and the worst of its options.
    fn is_best_worst(&self) -> bool {
        false
    }

    /// The parts of a kind that gives several answers, each a response of its own.
    fn parts(&self) -> Option<Vec<&str>> {
        None
    }

    /// What an answer says of a part; null where it says nothing.
    fn part_of(&self, answer: &Value, part: &str) -> Value {
        answer.get(part).cloned().unwrap_or_default()
    }

    /// What the columns of its answers hold.
    fn column_kind(&self) -> ColumnKind {
        ColumnKind::Text
    }

    /// Whether a test can take its answers for numbers.
    fn is_numeric(&self) -> bool {
        self.column_kind() != ColumnKind::Text
    }

    /// The options that the data dictionary lists as levels of its column.
    fn levels(&self) -> &[Choice] {
        &[]
    }

    /// Every answer that can be given, where they are few and an analysis can group people by them.
    fn few_answers(&self) -> Vec<String> {
        Vec::new()
    }

    /// The scale of each of its answers, where they are points of one.
    fn scale(&self) -> Option<Scale> {
        None
    }

    /// The first and the last point of a scale of few points.
    fn points(&self) -> Option<RangeInclusive<i64>> {
        None
    }

    /// What the first and the last point of a rating scale mean, in its own words.
    fn ends(&self) -> Option<[Option<&LocalText>; 2]> {
        None
    }

    /// The least and the greatest answer, each where there is one; `None` where answers are no single
    /// numbers.
    fn bounds(&self) -> Option<[Option<f64>; 2]> {
        None
    }

    /// Whether several options can be chosen at once.
    fn takes_several(&self) -> bool {
        false
    }

    /// Whether people write their answer.
    fn is_free_text(&self) -> bool {
        false
    }

    /// What can be shown of many answers together.
    fn summary(&self) -> Summary {
        Summary::Numbers
    }

    /// What the page says for an answer that is no option of the study's own.
    fn answer_in_words(&self, _asked: &Question, answer: &str, _language: &str) -> String {
        answer.to_owned()
    }

    /// The values that `signs` can have, for a kind that shows them as its options.
    fn sign_values(&self) -> Option<Vec<&'static str>> {
        None
    }

    /// What the prompt of an attention check must say for people to know that `answer` is expected: each
    /// thing in one of several ways.
    fn told(&self, _asked: &Question, answer: &Value, language: &str, _words: &Words) -> Told {
        told_by_options(self.options(), answer, language)
    }
}

/// What a prompt must say, each thing in one of several ways.
pub type Told = Vec<Vec<String>>;

/// What the prompt must say for an answer that names options, or a number.
pub(super) fn told_by_options(options: &[Choice], answer: &Value, language: &str) -> Told {
    match answer {
        Value::Array(chosen) => chosen
            .iter()
            .filter_map(|each| each.as_str().map(|word| label(options, word, language)))
            .collect(),
        Value::Object(parts) => parts.values().map(|each| vec![each.to_string()]).collect(),
        Value::String(word) => vec![label(options, word, language)],
        other => vec![vec![other.to_string()]],
    }
}

/// The label of an option: the one way to say it.
pub(super) fn label(options: &[Choice], value: &str, language: &str) -> Vec<String> {
    let option = options.iter().find(|option| option.value == value);
    vec![option.map_or(value, |option| option.label.in_language(language)).to_owned()]
}

/// Of English and French, the text in a language.
pub(super) fn pick<T>(language: &str, english: T, french: T) -> T {
    if mimique_locale::primary_language(language) == "fr" { french } else { english }
}

/// The labels of options, joined.
pub(super) fn labels(options: &[Choice], language: &str) -> String {
    let labels: Vec<&str> =
        options.iter().map(|option| option.label.in_language(language)).collect();
    labels.join(", ")
}

/// ` (very weak – very strong)`, where both ends have words.
pub(super) fn between(
    left: &Option<LocalText>,
    right: &Option<LocalText>,
    language: &str,
) -> String {
    match (left, right) {
        (Some(left), Some(right)) => {
            format!(" ({} – {})", left.in_language(language), right.in_language(language))
        }
        _ => String::new(),
    }
}
