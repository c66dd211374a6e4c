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

use mimique_session::wire::{Event, SessionStarted};
use mimique_study::{OrderError, Study};

pub use faces::{FacePart, FaceTemplates};
pub(crate) use latent::ClipEffects;
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
}

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

    /// The session of a participant, numbered from 1 as the server does. Conditions between
    /// participants go round with the number.
    pub fn session(&self, participant: u64) -> Result<SimulatedSession, OrderError> {
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
        let events = session::events(&self.model, &self.clips, self.seed, &started)?;
        Ok(SimulatedSession { started, events })
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
