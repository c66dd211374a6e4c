//! The trials that a reader of a capsule chooses from: a line per person and trial, with its answers.

use std::collections::{BTreeMap, BTreeSet};

use mimique_session::flow::Plays;
use serde::Serialize;

use super::answers::Answers;

/// The plays of each person, by step.
pub type PlaysOfPeople = BTreeMap<String, BTreeMap<String, Plays>>;

/// What the reader's script is told.
#[derive(Serialize)]
pub struct Trials {
    participants: Vec<String>,
    clips: BTreeSet<String>,
    trials: Vec<Trial>,
}

/// A trial of a person.
#[derive(Serialize)]
struct Trial {
    participant: String,
    step: String,
    order: String,
    stimulus: String,
    beside: String,
    answers: Vec<(String, String)>,
    late: String,
    /// How many plays can be drawn again.
    plays: usize,
}

impl Trials {
    /// Of the answers and the plays.
    pub fn of(answers: &Answers, plays: &PlaysOfPeople) -> Self {
        let mut trials: Vec<Trial> = Vec::new();
        let mut places = BTreeMap::new();
        for row in answers.rows() {
            if row.get("trial_type") != "trial" || row.get("stimulus").is_empty() {
                continue;
            }
            let key = (row.get("participant_id"), row.get("trial_id"));
            let place = *places.entry(key).or_insert_with(|| {
                let (participant, step) = (key.0.to_owned(), key.1.to_owned());
                let drawn = plays.get(&participant).and_then(|steps| steps.get(&step));
                trials.push(Trial {
                    plays: drawn.map_or(0, |plays| plays.count().0),
                    participant,
                    step,
                    order: row.get("trial_order").to_owned(),
                    stimulus: row.get("stimulus").to_owned(),
                    beside: row.get("beside").to_owned(),
                    answers: Vec::new(),
                    late: row.get("frames_late").to_owned(),
                });
                trials.len() - 1
            });
            let (question, answer) = (row.get("response_id"), row.get("answer"));
            if !question.is_empty() {
                trials[place].answers.push((question.to_owned(), answer.to_owned()));
            }
        }
        let mut participants: Vec<String> = Vec::new();
        for trial in &trials {
            if participants.last() != Some(&trial.participant) {
                participants.push(trial.participant.clone());
            }
        }
        let clips = trials.iter().map(|trial| trial.stimulus.clone()).collect();
        Self { participants, clips, trials }
    }

    /// How many there are, and how many can be drawn again.
    pub fn count(&self) -> (usize, usize) {
        (self.trials.len(), self.trials.iter().filter(|trial| trial.plays > 0).count())
    }
}
