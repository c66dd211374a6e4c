//! Attention checks: fair to whoever reads the prompt.
//!
//! A check must have an answer that fits, be required, and say in its prompt which answer to give:
//! Prolific accepts no check that needs memory, guessing or free text.

use super::Subject;
use super::issue::{Issues, below};
use super::problem::Problem;
use crate::question::{KindOfQuestion as _, Question};
use crate::study_file::Multilingual as _;

pub(super) fn examine(
    subject: &Subject<'_>,
    question: &Question,
    place: &str,
    issues: &mut Issues,
) {
    let Some(check) = &question.attention_check else { return };
    let pointer = below(place, "attentionCheck");
    if question.accept(Some(&check.expected)).is_err() {
        let place = below(&pointer, "expected");
        issues.error(place, Problem::NoAnswer { answer: check.expected.clone() });
        return;
    }
    if question.kind.is_free_text() {
        issues.error(&pointer, Problem::CheckAsksForText);
    }
    if !question.required {
        issues.error(&pointer, Problem::CheckIsOptional);
    }
    for language in &subject.study.languages {
        let words = subject.study.words(language);
        let prompt = question.prompt.in_language(language);
        let told = question.kind.told(question, &check.expected, language, &words);
        let untold = told.into_iter().find(|ways| !ways.iter().any(|way| says(prompt, way)));
        if let Some(wanted) = untold.as_ref().and_then(|ways| ways.first()) {
            issues.error(
                &pointer,
                Problem::CheckUntold { language: language.clone(), answer: wanted.clone() },
            );
        }
    }
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
}
