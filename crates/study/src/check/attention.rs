//! Attention checks: fair to whoever reads the prompt.
//!
//! A check must have an answer that fits, be required, and say in its prompt which answer to give:
//! Prolific accepts no check that needs memory, guessing or free text.

use serde_json::Value;

use super::Subject;
use super::issue::{Issues, below};
use crate::study_file::{Choice, LocalText, Question, QuestionKind};
use crate::text::Words;

pub(super) fn examine(
    subject: &Subject<'_>,
    question: &Question,
    place: &str,
    issues: &mut Issues,
) {
    let Some(check) = &question.attention_check else { return };
    let pointer = below(place, "attentionCheck");
    if question.accept(Some(&check.expected)).is_err() {
        let message = format!("{} is no answer to this question", check.expected);
        let place = below(&pointer, "expected");
        issues.error(place, "bad-answer", message, "write an answer that can be given");
        return;
    }
    if matches!(question.kind, QuestionKind::ShortText(_) | QuestionKind::LongText(_)) {
        let message = "an attention check that asks for free text";
        let hint = "take a choice or a scale; Prolific does not accept free text";
        issues.error(&pointer, "unfair-check", message, hint);
    }
    if !question.required {
        let message = "an attention check that may be left out";
        issues.error(&pointer, "unfair-check", message, "remove \"required\": false");
    }
    for language in &subject.study.languages {
        let words = subject.study.words(language);
        let prompt = question.prompt.in_language(language);
        let untold = told(question, &check.expected, language, &words)
            .into_iter()
            .find(|ways| !ways.iter().any(|way| says(prompt, way)));
        if let Some(wanted) = untold.as_ref().and_then(|ways| ways.first()) {
            let message =
                format!("the prompt in \"{language}\" does not say to answer \"{wanted}\"");
            let hint =
                format!("tell which answer to give (\"Please choose {wanted}\"), as Prolific asks");
            issues.error(&pointer, "unfair-check", message, hint);
        }
    }
}

/// What the prompt must say for an answer, each thing in one of several ways.
fn told(asked: &Question, answer: &Value, language: &str, words: &Words) -> Vec<Vec<String>> {
    let kind = &asked.kind;
    let label = |options: &[Choice], value: &str| {
        let option = options.iter().find(|option| option.value == value);
        vec![option.map_or(value, |option| option.label.in_language(language)).to_owned()]
    };
    let each = |value: &Value| value.as_str().map(|word| label(kind.options(), word));
    match (kind, answer) {
        (QuestionKind::Comparison(_), Value::String(side)) => vec![match asked.sign(side) {
            Some(own) => vec![own.label.in_language(language).to_owned()],
            None => side_in_words(side, words),
        }],
        (QuestionKind::Matrix(matrix), Value::Object(rows)) => rows
            .iter()
            .flat_map(|(row, chosen)| {
                // With one row there is nothing to tell apart.
                let row = (matrix.rows.len() > 1).then(|| label(&matrix.rows, row));
                row.into_iter().chain(each(chosen))
            })
            .collect(),
        (QuestionKind::Likert(scale), answer) => {
            let mut ways = vec![answer.to_string()];
            let mut named = |label: Option<&LocalText>| {
                ways.extend(label.map(|label| label.in_language(language).to_owned()));
            };
            if let Some(point) = answer.as_i64() {
                named(
                    usize::try_from(point.saturating_sub(scale.start))
                        .ok()
                        .and_then(|it| scale.labels.get(it)),
                );
                named(scale.left_label.as_ref().filter(|_| point == scale.start));
                named(scale.right_label.as_ref().filter(|_| point == scale.end()));
            }
            vec![ways]
        }
        (_, Value::Array(chosen)) => chosen.iter().filter_map(each).collect(),
        (_, Value::Object(parts)) => parts.values().map(|each| vec![each.to_string()]).collect(),
        (_, Value::String(word)) => vec![label(kind.options(), word)],
        (_, other) => vec![vec![other.to_string()]],
    }
}

/// The words for a side: those of its button that the other side's has not ("left", "gauche").
fn side_in_words(side: &str, words: &Words) -> Vec<String> {
    let (mine, other) = match side {
        "left" => (words.left_one(), words.right_one()),
        "right" => (words.right_one(), words.left_one()),
        _ => return vec![words.both_alike().to_owned()],
    };
    let plain = |text: &str| -> Vec<String> {
        let words = text.split(|letter: char| !letter.is_alphanumeric());
        words.filter(|word| !word.is_empty()).map(str::to_lowercase).collect()
    };
    let other = plain(other);
    let mut ways = plain(mine);
    ways.retain(|word| !other.contains(word));
    if ways.is_empty() { vec![mine.to_owned()] } else { ways }
}

/// Whether a prompt says something as whole words or a whole number, whatever its capitals: "12"
/// does not say 1, nor does "enjoy" say joy.
fn says(prompt: &str, wanted: &str) -> bool {
    let (prompt, wanted) = (prompt.to_lowercase(), wanted.trim().to_lowercase());
    // Decimals are written with a comma in some languages.
    let with_comma = wanted.replace('.', ",");
    let number = wanted.parse::<f64>().is_ok();
    finds(&prompt, &wanted) || (number && finds(&prompt, &with_comma))
}

fn finds(prompt: &str, wanted: &str) -> bool {
    let digit = |letter: Option<char>| letter.is_some_and(|letter| letter.is_ascii_digit());
    let joined = |inside: Option<char>, outside: Option<char>| {
        inside.is_some_and(is_in_word) && outside.is_some_and(is_in_word)
    };
    !wanted.is_empty()
        && prompt.match_indices(wanted).any(|(start, found)| {
            let (before, after) = (&prompt[..start], &prompt[start + found.len()..]);
            let (mut left, mut right) = (before.chars().rev(), after.chars());
            let (last, next) = (left.next(), right.next());
            // "2" is neither in "1.2" nor in "2,5" nor in "-2".
            let begins_inside = digit(found.chars().next())
                && (matches!(last, Some('.' | ',')) && digit(left.next())
                    || matches!(last, Some('-' | '\u{2212}'))
                        && !left.next().is_some_and(is_in_word));
            let ends_inside = digit(found.chars().next_back())
                && matches!(next, Some('.' | ','))
                && digit(right.next());
            !joined(found.chars().next(), last)
                && !joined(found.chars().next_back(), next)
                && !begins_inside
                && !ends_inside
        })
}

/// Whether words are parted from one another at this letter. Scripts from Thai on in Unicode's order
/// part no words.
fn is_in_word(letter: char) -> bool {
    letter.is_alphanumeric() && letter < '\u{e00}'
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::words;

    #[test]
    fn a_prompt_says_whole_words_and_whole_numbers() {
        for (prompt, wanted) in [
            ("Please choose 1.", "1"),
            ("Choisissez 2,5 ici", "2.5"),
            ("Bitte wählen Sie „Blau“", "blau"),
            ("Choose -3", "-3"),
            ("between 3-4: take 4", "4"),
            ("喜びを選んでください", "喜び"),
            ("Choisissez l’orange", "Orange"),
        ] {
            assert!(says(prompt, wanted), "{prompt}: {wanted}");
        }
        for (prompt, wanted) in [
            ("Please choose 12", "1"),
            ("Please choose 12", "2"),
            ("Please choose 1.5", "1"),
            ("Please choose 1,5", "5"),
            ("Please choose -3", "3"),
            ("Enjoy this!", "joy"),
            ("", "joy"),
            ("Choose", ""),
        ] {
            assert!(!says(prompt, wanted), "{prompt}: {wanted}");
        }
    }

    #[test]
    fn a_side_is_told_by_the_words_that_differ() {
        assert!(side_in_words("left", words("en")).contains(&"left".to_owned()));
        assert!(side_in_words("left", words("fr")).contains(&"gauche".to_owned()));
        assert!(side_in_words("right", words("fr")).contains(&"droite".to_owned()));
        assert!(!side_in_words("right", words("fr")).contains(&"gauche".to_owned()));
        assert_eq!(side_in_words("same", words("en")), ["No difference"]);
    }
}
