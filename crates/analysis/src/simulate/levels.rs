//! How simulated people answer adaptive blocks: a cumulative normal of the level (or of minus the level, where levels
//! fall) around each person's threshold. The
//! levels are chosen as the page has them chosen.

use std::collections::HashMap;

use mimique_adaptive::{Psychometric, Shape};
use mimique_session::LevelShown;
use mimique_session::flow::Input;
use mimique_study::{AdaptiveComponent, ClosedLoop, Draw, Study, component_of};
use serde::Deserialize as _;
use serde_json::{Value, json};

use super::parameters::{Discrimination, Parameters};
use super::random::Draws;

/// The thresholds of a study's adaptive blocks, if nothing else is said: in the middle of the levels.
pub(super) fn defaults(study: &Study) -> std::collections::BTreeMap<String, Discrimination> {
    let of = |(name, block): (&str, AdaptiveComponent)| {
        let width = (block.vary.to - block.vary.from).abs();
        let discrimination = Discrimination {
            threshold: (block.vary.from + block.vary.to) / 2.0,
            person_sd: 0.12 * width,
            spread: 0.15 * width,
            lapse: 0.02,
            false_alarm: 0.0,
        };
        (name.to_owned(), discrimination)
    };
    study.adaptive().map(of).collect()
}

/// The adaptive blocks of one session.
#[derive(Default)]
pub(super) struct Levels {
    /// Of each block: its state, and how many answers it has taken in.
    loops: HashMap<String, (ClosedLoop, usize)>,
}

impl Levels {
    /// Answers the effect `ChooseLevel` as the page's module does.
    pub(super) fn choose(&mut self, request: &Value) -> Option<Input> {
        let component = request["component"].as_str()?;
        let answers = request["answers"].as_array()?;
        if !self.loops.contains_key(component) {
            let block = AdaptiveComponent::deserialize(&request["block"]).ok()?;
            let draw = Draw {
                seed: request["seed"].as_u64()?,
                config_hash: request["configHash"].as_str()?,
                participant: request["slot"].as_u64()?,
                condition: None,
            };
            let closed_loop = ClosedLoop::new(block, component, draw).ok()?;
            self.loops.insert(component.to_owned(), (closed_loop, 0));
        }
        let (closed_loop, taken) = self.loops.get_mut(component)?;
        for answer in &answers[*taken..] {
            closed_loop.answer(answer.as_str());
        }
        *taken = answers.len();
        let step = &request["step"];
        let event = match closed_loop.next() {
            Some(chosen) => {
                let mut event = serde_json::to_value(chosen).ok()?;
                event["type"] = "level_chosen".into();
                event["step"] = step.clone();
                event
            }
            None => json!({ "type": "levels_over", "step": step }),
        };
        Some(Input::LevelChosen(event))
    }
}

/// The threshold of the person of a number in a block.
pub(crate) fn threshold(given: &Discrimination, block: &str, seed: u64, number: u64) -> f64 {
    let own = Draws::new(seed, Some(number), &format!("threshold/{block}")).normal();
    given.threshold + given.person_sd * own
}

/// How one person tells the levels of each block.
pub(super) struct Observer {
    /// The function of each block, of [`Varied::ease`].
    functions: HashMap<String, (AdaptiveComponent, Psychometric)>,
    draws: Draws,
}

impl Observer {
    /// The person of a number.
    pub(super) fn new(study: &Study, parameters: &Parameters, seed: u64, number: u64) -> Self {
        let of = |(name, block): (&str, AdaptiveComponent)| {
            let given: &Discrimination = parameters.discrimination.get(name)?;
            let threshold = threshold(given, name, seed, number);
            let function = Psychometric {
                shape: Shape::Normal,
                location: block.vary.ease(threshold),
                spread: given.spread,
                guess: block.guess().max(given.false_alarm),
                lapse: given.lapse,
            };
            Some((name.to_owned(), (block, function)))
        };
        let functions = study.adaptive().filter_map(of).collect();
        Self { functions, draws: Draws::new(seed, Some(number), "levels") }
    }

    /// Which of the answers that a question offers is given; none for a block that the parameters do not know.
    pub(super) fn answer<'q>(
        &mut self,
        shown: &LevelShown,
        offered: impl IntoIterator<Item = &'q str>,
        careless: bool,
    ) -> Option<&'q str> {
        let (block, function) = self.functions.get(component_of(&shown.step))?;
        let share = if careless { 0.5 } else { function.right(block.vary.ease(shown.level)) };
        let seen = self.draws.happens(share);
        offered.into_iter().find(|answer| block.seen(answer, shown.left) == Some(seen))
    }
}
