//! Simulated participants: raters with a confusion matrix, ordinal thresholds, effects of people, clips
//! and people x method, dropout and careless answers, who go through the study as the page lets them.
//!
//! The events are made by `study::flow` and the order by `study::order`, so that what the server's export
//! makes of them cannot drift from real sessions. Every person has ChaCha streams of their own, by seed,
//! number and purpose: the same seed gives the same events in any order and on any number of threads.

mod answering;
mod defaults;
mod draws;
mod faces;
mod fit;
mod latent;
mod levels;
mod model;
mod null;
mod panels;
mod parameters;
mod person;
mod random;
mod read;
mod scales;
mod scaling;
mod session;
mod template;
mod values;

use std::collections::BTreeMap;

use mimique_session::wire::{Event, SessionStarted};
use mimique_study::{OrderError, PairCounts, Study};
use rayon::prelude::*;

pub use faces::{FacePart, FaceTemplates};
pub(crate) use latent::ClipEffects;
pub(crate) use levels::threshold;
pub(crate) use model::{Asked, Model, Way};
pub use parameters::{
    ByLevel, Careless, Compared, Discrimination, Display, Dropout, Interaction, NumberAnswer,
    Parameters, Rating, Recognition, Times,
};
pub(crate) use person::{BEFORE_REPLAY_MS, Companion, Person, Raw, as_json};
pub(crate) use random::Draws;
pub use read::ParametersError;
pub(crate) use scales::{factor_levels, traits};
pub use scaling::PerceivedScale;
pub(crate) use session::eighths;
pub use template::{Template, TemplatePart, TemplatePeople};

/// A study with simulated participants.
#[derive(Debug, Clone)]
pub struct Simulation<'s> {
    model: Model<'s>,
    clips: ClipEffects,
    config_hash: String,
    conditions: Vec<&'s str>,
    seed: u64,
}

/// One simulated session, as the server keeps it.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedSession {
    /// As at its start.
    pub started: SessionStarted,
    /// Its events; none of a session that was taken back.
    pub events: Vec<Event>,
    /// What was chosen between two levels in blocks whose pairs follow from answers.
    pub choices: PairChoices,
}

/// What people have chosen between two levels, by block of pairs that follow from answers.
pub type PairChoices = BTreeMap<String, PairCounts>;

impl<'s> Simulation<'s> {
    /// Refuses parameters that do not fit the study. `config_hash` is that of the study's file; with
    /// the study's own seed it decides the order of trials, `seed` decides everything else.
    pub fn new(
        study: &'s Study,
        config_hash: &str,
        parameters: &'s Parameters,
        seed: u64,
    ) -> Result<Self, ParametersError> {
        parameters.check(study)?;
        let model = Model::new(study, parameters, study.clips());
        let clips = model.clip_effects(seed);
        let conditions = study.conditions();
        Ok(Self { model, clips, config_hash: config_hash.to_owned(), conditions, seed })
    }

    /// The session of a participant, numbered from 1 as the server does, as if nobody had answered before. Conditions
    /// between participants go round with the number.
    pub fn session(&self, participant: u64) -> Result<SimulatedSession, OrderError> {
        self.session_after(participant, &PairChoices::new())
    }

    /// The sessions of participants 1 to `participants`, each handed to `made`. They are simulated beside each other,
    /// unless pairs follow from the answers of all before.
    ///
    /// # Errors
    /// [`OrderError`] where an order of trials cannot be made.
    pub fn sessions<T: Send>(
        &self,
        participants: u64,
        made: impl Fn(SimulatedSession) -> T + Sync,
    ) -> Result<Vec<T>, OrderError> {
        let study = self.model.study;
        if study.pair_blocks().all(|(_, block)| block.schedule.active() == 0) {
            let all = (1..=participants).into_par_iter();
            return all.map(|participant| Ok(made(self.session(participant)?))).collect();
        }
        let mut others = PairChoices::new();
        let in_turn = (1..=participants).map(|participant| {
            let session = self.session_after(participant, &others)?;
            for (block, own) in &session.choices {
                others.entry(block.clone()).or_default().add_all(own);
            }
            Ok(made(session))
        });
        in_turn.collect()
    }

    fn session_after(
        &self,
        participant: u64,
        others: &PairChoices,
    ) -> Result<SimulatedSession, OrderError> {
        let (condition, slot) = condition_and_slot(&self.conditions, participant);
        let started = SessionStarted {
            session: String::new(),
            participant_id: format!("p{participant:04}"),
            participant,
            slot,
            condition: condition.map(str::to_owned),
            seed: self.model.study.seed,
            stage: "live".to_owned(),
            config_hash: self.config_hash.clone(),
            withdrawal_code: String::new(),
        };
        session::session(&self.model, &self.clips, self.seed, started, others)
    }
}

/// The condition and the slot in it of a participant, numbered from 1, where all finish.
pub(crate) fn condition_and_slot<'c>(
    conditions: &[&'c str],
    participant: u64,
) -> (Option<&'c str>, u64) {
    let before = participant.saturating_sub(1);
    match conditions.len() as u64 {
        0 => (None, participant),
        count => (Some(conditions[(before % count) as usize]), before / count + 1),
    }
}
