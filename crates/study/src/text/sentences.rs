//! Texts in which something is filled in, or which are chosen by what has happened.

use std::collections::BTreeMap;

use super::table::{NAMES, Place};
use super::{Shown, Words};
use crate::answer::AnswerProblem;
use crate::device::Unmet;
use crate::study_file::UnknownCondition;

impl Words {
    /// "Clip 3 of 12".
    pub fn trial_of(&self, number: usize, of: usize) -> String {
        self.fill(Place::trial_of, &[("number", &number), ("of", &of)])
    }

    /// "Practice clip 1 of 2".
    pub fn training_of(&self, number: usize, of: usize) -> String {
        self.fill(Place::training_of, &[("number", &number), ("of", &of)])
    }

    /// "Play B": one clip of a panel alone.
    pub fn play_alone(&self, name: &str) -> String {
        self.fill(Place::play_alone, &[("name", &name)])
    }

    /// The answers are in this browser alone.
    pub fn kept_here(&self, email: &str) -> String {
        self.fill(Place::kept_here, &[("email", &email)])
    }

    /// "You must be at least 18 years old to take part."
    pub fn minimum_age(&self, years: u32) -> String {
        self.fill(Place::minimum_age, &[("years", &years)])
    }

    /// The page goes back by itself.
    pub fn go_back_in(&self, seconds: u64) -> String {
        self.fill(Place::go_back_in, &[("seconds", &seconds)])
    }

    /// Why something could not be shown, by the code that the stage gives and the values that its words
    /// name (`static/stage/failure.js`).
    pub fn stage_failure(&self, code: &str, values: &BTreeMap<String, String>) -> String {
        let text = self.by_name(&format!("failed_{code}"));
        let mut text = text.unwrap_or_else(|| self.at(Place::failed_unknown)).to_owned();
        for (name, value) in values {
            text = text.replace(&format!("{{{name}}}"), value);
        }
        text
    }

    /// "You can go on in 12 seconds."
    pub fn wait_seconds(&self, seconds: u64) -> String {
        self.fill(Place::wait_seconds, &[("seconds", &seconds)])
    }

    /// Where to sit.
    pub fn distance_stated(&self, centimetres: f64) -> String {
        self.fill(Place::distance_stated, &[("centimetres", &centimetres)])
    }

    /// What to correct in an answer.
    pub fn problem(&self, problem: &AnswerProblem) -> String {
        match problem {
            AnswerProblem::Missing => self.at(Place::answer_missing).to_owned(),
            AnswerProblem::NotAnOption => self.at(Place::answer_not_an_option).to_owned(),
            AnswerProblem::NotANumber => self.at(Place::answer_not_a_number).to_owned(),
            AnswerProblem::NotWhole => self.at(Place::answer_not_whole).to_owned(),
            AnswerProblem::TooLow(least) => self.fill(Place::answer_too_low, &[("least", least)]),
            AnswerProblem::TooHigh(most) => self.fill(Place::answer_too_high, &[("most", most)]),
            AnswerProblem::TooLong(most) => self.fill(Place::answer_too_long, &[("most", most)]),
            AnswerProblem::TooFew(least) => self.fill(Place::answer_too_few, &[("least", least)]),
            AnswerProblem::TooMany(most) => self.fill(Place::answer_too_many, &[("most", most)]),
            AnswerProblem::Incomplete => self.at(Place::answer_incomplete).to_owned(),
        }
    }

    /// What is missing, and what to do about it.
    pub fn unmet(&self, unmet: &Unmet) -> (String, String) {
        let (what, remedy) = match unmet {
            Unmet::Width { least, found } => (
                self.fill(Place::lacks_width, &[("least", least), ("found", found)]),
                Place::lacks_width_remedy,
            ),
            Unmet::Height { least, found } => (
                self.fill(Place::lacks_height, &[("least", least), ("found", found)]),
                Place::lacks_height_remedy,
            ),
            Unmet::Kind => {
                (self.at(Place::lacks_computer).to_owned(), Place::lacks_computer_remedy)
            }
            Unmet::Backend => {
                (self.at(Place::lacks_graphics).to_owned(), Place::lacks_graphics_remedy)
            }
            Unmet::Refresh { least, found } => {
                let values: [(&str, &dyn Shown); 2] =
                    [("least", &least.round()), ("found", &found.round())];
                (self.fill(Place::lacks_refresh, &values), Place::lacks_refresh_remedy)
            }
            Unmet::Fullscreen => {
                (self.at(Place::lacks_fullscreen).to_owned(), Place::lacks_fullscreen_remedy)
            }
        };
        (what, self.at(remedy).to_owned())
    }

    /// "You answered: joy".
    pub fn feedback_given(&self, answer: Option<&str>) -> String {
        match answer {
            Some(answer) => self.fill(Place::feedback_given, &[("answer", &answer)]),
            None => self.at(Place::feedback_none).to_owned(),
        }
    }

    /// "Right is: fear".
    pub fn feedback_answer(&self, answer: &str) -> String {
        self.fill(Place::feedback_answer, &[("answer", &answer)])
    }

    /// The round was not good enough and begins again.
    pub fn practise_again(&self, right: u32, of: usize) -> String {
        self.fill(Place::practise_again, &[("right", &right), ("of", &of)])
    }

    /// "Time left: 12 s".
    pub fn seconds_left(&self, seconds: u64) -> String {
        match (seconds / 60, seconds % 60) {
            (0, rest) => self.fill(Place::seconds_left, &[("seconds", &rest)]),
            (minutes, rest) => {
                let rest = format!("{rest:02}");
                self.fill(Place::minutes_left, &[("minutes", &minutes), ("seconds", &rest)])
            }
        }
    }

    /// There will be a limit.
    pub fn time_limit(&self, seconds: f64) -> String {
        self.fill(Place::time_limit, &[("seconds", &seconds)])
    }

    /// The end is near.
    pub fn time_warning(&self, extendable: bool) -> &str {
        self.at(if extendable { Place::time_warning_extendable } else { Place::time_warning })
    }

    /// Why a session ended at its attention checks.
    pub fn checks_failed_text(&self, failed: u32) -> String {
        self.fill(Place::checks_failed_text, &[("failed", &failed)])
    }

    /// Why nobody begins by this address, and what can be done.
    pub fn unknown_condition(&self, unknown: &UnknownCondition) -> (String, String) {
        let values: [(&str, &dyn Shown); 2] =
            [("conditions", &unknown.conditions), ("name", &unknown.name)];
        let message = self.fill(Place::unknown_condition, &values);
        (message, self.at(Place::unknown_condition_remedy).to_owned())
    }

    /// Why the server does not take a participant, and what can be done: message and remedy. `None`
    /// for refusals that are not a participant's.
    pub fn refusal(&self, code: &str) -> Option<(&str, &str)> {
        let remedy = self.by_code(&format!("{code}_remedy"))?;
        Some((self.by_code(code)?, remedy))
    }

    /// What a refusal means for the participant; of a code that is not among the texts, and of people who
    /// cannot begin, the server's own words (those come in the participant's language already).
    pub fn refused(&self, code: &str, message: &str, remedy: &str) -> String {
        match self.by_code(code) {
            Some(text) if self.refusal(code).is_none() => text.to_owned(),
            _ => format!("{message} {remedy}").trim().to_owned(),
        }
    }

    /// What is said of a refusal of the server, by its code.
    fn by_code(&self, code: &str) -> Option<&str> {
        self.by_name(&format!("refused_{}", code.replace('-', "_")))
    }

    /// The text of a name; none where no text has it.
    fn by_name(&self, name: &str) -> Option<&str> {
        let place = NAMES.iter().position(|known| *known == name)?;
        Some(self.own.get(name).map_or(self.built_in[place], String::as_str))
    }
}
