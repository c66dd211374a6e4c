//! The best and the worst of several: best-worst scaling (Louviere, Flynn and Marley 2015).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::kind::{KindOfQuestion, Summary, Told, label, labels, pick};
use super::simulation::{Chance, Simulated};
use super::view::{QuestionKindView, Showing};
use super::{Choice, OptionOrder, Question, accepting, defining};
use crate::answer::AnswerProblem;
use crate::check::Issues;
use crate::study_file::LocalText;
use crate::text::Words;

/// What is picked: the parts of an answer.
const PICKS: [&str; 2] = ["best", "worst"];

/// The best and the worst of several, two different ones. The answer is `{"best": "eyes", "worst": "skin"}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct BestWorst {
    /// The options, three at least.
    pub options: Vec<Choice>,
    /// In which order they are shown.
    #[serde(default)]
    pub option_order: OptionOrder,
    /// What is asked of the best, where it is not "Best": "most natural".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub best_label: Option<LocalText>,
    /// What is asked of the worst, where it is not "Worst".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worst_label: Option<LocalText>,
}

impl KindOfQuestion for BestWorst {
    fn check(&self, place: &str, issues: &mut Issues) {
        defining::options(&self.options, place, "options", 3, issues);
    }

    fn accept(&self, answer: &Value) -> Result<(), AnswerProblem> {
        let picks = answer.as_object().ok_or(AnswerProblem::NotAnOption)?;
        for (pick, option) in picks {
            if !PICKS.contains(&pick.as_str()) {
                return Err(AnswerProblem::NotAnOption);
            }
            accepting::one_of(&self.options, option)?;
        }
        match PICKS.map(|pick| picks.get(pick)) {
            [Some(best), Some(worst)] if best == worst => Err(AnswerProblem::NotAnOption),
            [Some(_), Some(_)] => Ok(()),
            _ => Err(AnswerProblem::Incomplete),
        }
    }

    fn view(&self, showing: &Showing<'_>) -> QuestionKindView {
        let word = |own: &Option<LocalText>, other: &str| match own {
            Some(own) => showing.text(own),
            None => other.to_owned(),
        };
        QuestionKindView::BestWorst {
            best: word(&self.best_label, showing.words.best()),
            worst: word(&self.worst_label, showing.words.worst()),
            options: showing.options(),
        }
    }

    fn described(&self, language: &str) -> String {
        let options = labels(&self.options, language);
        pick(
            language,
            format!("best and worst of {options} (best-worst scaling)"),
            format!("le meilleur et le pire parmi {options} (échelle du meilleur et du pire)"),
        )
    }

    fn simulated(&self) -> Simulated<'_> {
        Simulated::Drawn { by_shares: true }
    }

    /// Random utility: the best with a probability proportional to its weight (exp of its utility), then
    /// the worst of the others with one proportional to 1 / weight.
    fn drawn(&self, weights: &[f64], chance: &mut dyn Chance) -> Value {
        const LEAST_WEIGHT: f64 = 1e-9;
        let best = chance.weighted(weights);
        let mut against: Vec<f64> =
            weights.iter().map(|weight| 1.0 / weight.max(LEAST_WEIGHT)).collect();
        against[best] = 0.0;
        let worst = chance.weighted(&against);
        json!({ "best": self.options[best].value, "worst": self.options[worst].value })
    }

    fn options(&self) -> &[Choice] {
        &self.options
    }

    fn option_order(&self) -> OptionOrder {
        self.option_order
    }

    fn is_best_worst(&self) -> bool {
        true
    }

    fn parts(&self) -> Option<Vec<&str>> {
        Some(PICKS.to_vec())
    }

    fn levels(&self) -> &[Choice] {
        &self.options
    }

    fn summary(&self) -> Summary {
        Summary::Options
    }

    fn told(&self, _asked: &Question, answer: &Value, language: &str, _words: &Words) -> Told {
        let picked = PICKS.iter().filter_map(|pick| answer.get(*pick).and_then(Value::as_str));
        picked.map(|word| label(&self.options, word, language)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::QuestionKind;
    use crate::order::Stream;
    use crate::text::words;

    fn features() -> Question {
        let options: Vec<Value> = ["eyes", "mouth", "skin", "hair"]
            .iter()
            .map(|value| json!({ "value": value, "label": { "en": value, "fr": value } }))
            .collect();
        let question = json!({
            "id": "feature", "type": "bestWorst", "prompt": "Which is best, which worst?",
            "options": options, "bestLabel": "Most lifelike",
        });
        serde_json::from_value(question).unwrap()
    }

    #[test]
    fn two_different_options_are_an_answer() {
        let question = features();
        let takes = |answer: Value| question.accept(Some(&answer));
        assert_eq!(takes(json!({ "best": "eyes", "worst": "skin" })), Ok(()));
        assert_eq!(takes(json!({ "best": "eyes" })), Err(AnswerProblem::Incomplete));
        assert_eq!(takes(json!({ "worst": "eyes" })), Err(AnswerProblem::Incomplete));
        assert_eq!(takes(json!({})), Err(AnswerProblem::Missing));
        for wrong in [
            json!({ "best": "eyes", "worst": "eyes" }),
            json!({ "best": "ears", "worst": "eyes" }),
            json!({ "best": "eyes", "worst": "skin", "second": "hair" }),
            json!(["eyes", "skin"]),
            json!("eyes"),
        ] {
            assert_eq!(takes(wrong.clone()), Err(AnswerProblem::NotAnOption), "{wrong}");
        }
        assert_eq!(question.response_ids(), ["feature.best", "feature.worst"]);
    }

    #[test]
    fn what_is_asked_is_said_in_the_study_s_words_or_the_page_s() {
        let question = features();
        for (language, wanted) in [("en", "Worst"), ("fr", "Le pire")] {
            let showing =
                Showing { question: &question, language, words: words(language), order: None };
            let QuestionKindView::BestWorst { best, worst, options } = question.kind.view(&showing)
            else {
                panic!("another control")
            };
            assert_eq!((best.as_str(), worst.as_str()), ("Most lifelike", wanted));
            assert_eq!(options.len(), 4);
        }
    }

    #[test]
    fn its_file_reads_as_it_was_written() {
        let question = features();
        let written = serde_json::to_value(&question).unwrap();
        assert_eq!(written["type"], "bestWorst");
        assert_eq!(serde_json::from_value::<Question>(written).unwrap(), question);
        assert!(matches!(question.kind, QuestionKind::BestWorst(_)));
    }

    /// A source of draws as simulations have it.
    struct Draws(Stream);

    impl Chance for Draws {
        fn below(&mut self, count: usize) -> usize {
            self.0.below(count)
        }

        fn weighted(&mut self, weights: &[f64]) -> usize {
            const PARTS: usize = 1_000_000;
            let mut left = self.0.below(PARTS) as f64 / PARTS as f64 * weights.iter().sum::<f64>();
            for (place, weight) in weights.iter().enumerate() {
                left -= weight;
                if left < 0.0 {
                    return place;
                }
            }
            weights.len() - 1
        }

        fn shuffle(&mut self, places: &mut [usize]) {
            self.0.shuffle(places);
        }
    }

    #[test]
    fn simulated_people_pick_by_random_utility() {
        let question = features();
        let weights = [4.0, 2.0, 1.0, 1.0];
        let draw = crate::Draw { seed: 7, config_hash: "x", participant: 1, condition: None };
        let mut draws = Draws(draw.stream("best-worst"));
        let (people, mut best_eyes, mut worst_eyes) = (20_000, 0, 0);
        for _ in 0..people {
            let answer = question.kind.drawn(&weights, &mut draws);
            assert_eq!(question.accept(Some(&answer)), Ok(()), "{answer}");
            best_eyes += usize::from(answer["best"] == "eyes");
            worst_eyes += usize::from(answer["worst"] == "eyes");
        }
        // The eyes are best with probability 4/8. They are worst with the sum over the other best ones:
        // 2/8 (1/4) / (1/4 + 1 + 1) + 2 * 1/8 (1/4) / (1/4 + 1/2 + 1).
        let (best, worst) = (0.5, 0.25 * 0.25 / 2.25 + 0.25 * 0.25 / 1.75);
        for (found, expected) in [(best_eyes, best), (worst_eyes, worst)] {
            let (share, people) = (found as f64 / f64::from(people), f64::from(people));
            let error = (expected * (1.0 - expected) / people).sqrt();
            assert!((share - expected).abs() < 4.0 * error, "{share} where {expected} is expected");
        }
    }
}
