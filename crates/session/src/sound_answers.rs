//! The answers of the sound check (`static/sound/check.js`): what its page is finished with.
//!
//! | answer | holds |
//! |---|---|
//! | `sound_check` | `heard`; `miscounted`; `not_heard`, as the participant says |
//! | `sound_check_correct` | rounds of the last attempt that were right |
//! | `sound_check_attempts` | how often the rounds were gone through |
//! | `sound_check_rounds` | every round: how many tones were played, and how many the participant counted |

use mimique_study::Answers;
use serde_json::Value;

/// Most rounds in all: those of ten attempts with twenty each.
const MOST_ROUNDS: usize = 200;

/// Whether these are answers that the sound check gives.
pub(crate) fn are_of_sound_check(answers: &Answers) -> bool {
    let is_small =
        |value: &Value| value.as_u64().is_some_and(|number| number <= MOST_ROUNDS as u64);
    let is_round = |round: &Value| {
        round.as_array().is_some_and(|pair| pair.len() == 2 && pair.iter().all(is_small))
    };
    let fits = |(name, value): (&String, &Value)| match name.as_str() {
        "sound_check" => {
            value.as_str().is_some_and(|word| ["heard", "miscounted", "not_heard"].contains(&word))
        }
        "sound_check_correct" | "sound_check_attempts" => is_small(value),
        "sound_check_rounds" => value
            .as_array()
            .is_some_and(|rounds| rounds.len() <= MOST_ROUNDS && rounds.iter().all(is_round)),
        _ => false,
    };
    answers.contains_key("sound_check") && answers.iter().all(fits)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn only_what_the_check_gives_is_taken() {
        let answers = |text: Value| -> Answers { serde_json::from_value(text).unwrap() };
        let whole = json!({ "sound_check": "heard", "sound_check_correct": 2, "sound_check_attempts": 1, "sound_check_rounds": [[1, 1], [4, 3]] });
        assert!(are_of_sound_check(&answers(whole)));
        for wrong in [
            json!({}),
            json!({ "sound_check_correct": 2 }),
            json!({ "sound_check": "loud" }),
            json!({ "sound_check": "heard", "sound_check_rounds": [[1]] }),
            json!({ "sound_check": "heard", "sound_check_correct": -1 }),
            json!({ "sound_check": "heard", "age": 4 }),
            json!({ "sound_check": "heard", "sound_check_rounds": vec![[1, 1]; 201] }),
        ] {
            assert!(!are_of_sound_check(&answers(wrong.clone())), "{wrong}");
        }
    }
}
