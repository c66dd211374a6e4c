//! The order of trials: `(seed, configuration hash, slot)` -> the exact order. The slot is the
//! participant's place in the balance of conditions; who replaces a drop-out has the drop-out's.
//!
//! Every draw comes from a stream named by its purpose, so the order is the same natively and in
//! the browser, today and later, and a new kind of draw never shifts an old one.
//!
//! A constrained random order is first sought by shuffling until an order fits, which makes every
//! order that fits equally likely; where few orders fit, it is built step by step with backtracking,
//! within a budget; where that fails too, the order falls back on the one that `mimique check` found
//! to prove that the constraints can be met. So a study that passed the check never hangs and never
//! breaks a constraint.
//!
//! Squares and samples go round with the participants. Several of them in one study are balanced
//! against each other: see [`Rotation`].

mod constrained;
mod latin_square;
mod proof;
mod rotation;
mod samples;
mod scaling_sets;
mod sides;
mod stream;
mod subset;

use std::collections::BTreeMap;

use crate::projection::StudyProjection;
use crate::study_file::{Clip, Component, OrderRule, PanelPage, Sequence, SequenceItem};
use constrained::{Search, arrange};
pub(crate) use proof::{CYCLES, Flaw, prove};
use rotation::Rotation;
pub use sides::Sides;
pub use stream::Stream;

/// One item of a participant's order.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
#[serde(untagged)]
pub enum OrderedItem {
    /// A trial.
    Trial {
        /// Identifier of the trial: `faces/joy2.lsts30`, with `#2` at a second showing.
        trial: String,
        /// Name of its component.
        component: String,
        /// Its clip; empty where it follows from answers. Of a pair it stands left.
        clip: String,
        /// Of a pair: the clip on the right.
        #[serde(skip_serializing_if = "Option::is_none")]
        beside: Option<String>,
        /// Of a panel: its clips at their places; `clip` is the first of them.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        panel: Vec<String>,
        /// Identifier of the nearest sequence that has one, else the component's name.
        condition: String,
    },
    /// Any other component.
    Component {
        /// Name of the component.
        component: String,
    },
}

impl OrderedItem {
    fn is_trial(&self) -> bool {
        matches!(self, Self::Trial { .. })
    }
}

/// A sequence has no order.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{pointer}: {why}; {}", why.remedy())]
pub struct OrderError {
    /// JSON pointer of what is wrong.
    pub pointer: String,
    /// What is wrong there.
    pub why: NoOrder,
}

/// Why a sequence has no order.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoOrder {
    /// The constraints cannot be met.
    #[error("no order of its {parts} parts meets them")]
    Unsatisfiable {
        /// Number of parts.
        parts: usize,
    },
    /// Whether the constraints can be met was not found out in the time given.
    #[error("no order of its {parts} parts was found within the search's budget")]
    NotFound {
        /// Number of parts.
        parts: usize,
    },
    /// A sequence names what is not there.
    #[error("there is no component {name:?}")]
    UnknownComponent {
        /// The name.
        name: String,
    },
}

impl NoOrder {
    /// What to do about it.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::Unsatisfiable { .. } => "loosen or drop one of them",
            Self::NotFound { .. } => "loosen one of them",
            Self::UnknownComponent { .. } => "name one of `components`",
        }
    }
}

/// Whose order is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Draw<'a> {
    /// Seed of the study.
    pub seed: u64,
    /// Hash of the canonical study file.
    pub config_hash: &'a str,
    /// The participant's slot (`SessionStarted::slot` of the session).
    pub participant: u64,
    /// The participant's condition ([`Sequence::conditions`]). It decides what is shown and names no
    /// stream: a nested sequence of random order outside of conditions comes in the same order for the
    /// same slot of each.
    pub condition: Option<&'a str>,
}

impl<'a> Draw<'a> {
    /// The participant's own stream for a purpose.
    pub fn stream(&self, purpose: &str) -> Stream {
        Stream::new(self.seed, self.config_hash, Some(self.participant), purpose)
    }

    /// The stream for a purpose that all participants share.
    pub fn shared_stream(&self, purpose: &str) -> Stream {
        Stream::new(self.seed, self.config_hash, None, purpose)
    }
}

/// The order that a participant gets.
pub fn order(study: &StudyProjection, draw: Draw<'_>) -> Result<Vec<OrderedItem>, OrderError> {
    let mut context = Context::new(study, draw);
    context.squares = context.all_squares(&study.sequence);
    context.sequence(&study.sequence, "/sequence", None)
}

/// The order in which the options of a question are shown, as indices into the file's list.
pub fn option_order(draw: Draw<'_>, question: &str, options: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..options).collect();
    draw.stream(&format!("options/{question}")).shuffle(&mut order);
    order
}

/// One of these conditions, each equally likely: where nobody counts who has finished, or where some
/// have as few. `draw` has the participant's number; its condition is not looked at.
pub fn drawn_condition<'c>(draw: Draw<'_>, conditions: &[&'c str]) -> Option<&'c str> {
    conditions.get(draw.stream("condition").below(conditions.len())).copied()
}

struct Context<'a> {
    study: &'a StudyProjection,
    by_id: BTreeMap<&'a str, &'a Clip>,
    draw: Draw<'a>,
    rotation: Rotation,
    /// The product of the periods of all squares.
    squares: u64,
}

impl<'a> Context<'a> {
    fn new(study: &'a StudyProjection, draw: Draw<'a>) -> Self {
        let by_id = study.clips.iter().map(|clip| (clip.id.as_str(), clip)).collect();
        Self { study, by_id, draw, rotation: Rotation::of(draw.participant), squares: 1 }
    }

    fn sequence(
        &self,
        sequence: &Sequence,
        pointer: &str,
        enclosing: Option<&str>,
    ) -> Result<Vec<OrderedItem>, OrderError> {
        let condition = sequence.id.as_deref().or(enclosing);
        let mut parts = Vec::new();
        for (index, item) in sequence.components.iter().enumerate() {
            let place = format!("{pointer}/components/{index}");
            match item {
                SequenceItem::Component(name) => {
                    parts.extend(self.component(name, &place, condition)?);
                }
                SequenceItem::Sequence(nested) if nested.is_shown_in(self.draw.condition) => {
                    parts.push(self.sequence(nested, &place, condition)?);
                }
                SequenceItem::Sequence(_) => {}
            }
        }
        if let Some(samples) = sequence.num_samples {
            parts = self.sample(sequence, parts, samples, pointer);
        }
        let order = self.arrangement(sequence, &parts, pointer)?;
        let mut slots: Vec<Option<Vec<OrderedItem>>> = parts.into_iter().map(Some).collect();
        let arranged =
            order.into_iter().filter_map(|index| slots[index].take()).flatten().collect();
        Ok(with_interruptions(sequence, arranged))
    }

    /// The parts that a component's name stands for: its trials, or itself.
    fn component(
        &self,
        name: &str,
        pointer: &str,
        condition: Option<&str>,
    ) -> Result<Vec<Vec<OrderedItem>>, OrderError> {
        let Some(component) = self.study.components.get(name) else {
            let why = NoOrder::UnknownComponent { name: name.to_owned() };
            return Err(OrderError { pointer: pointer.to_owned(), why });
        };
        // Trials whose clips follow from answers or are drawn: they stay together, with room for interruptions between
        // them.
        let numbered = match component {
            Component::Adaptive(block) => Some((block.steps(), "")),
            Component::ReverseCorrelation(block) => Some((block.trials(), block.clip())),
            _ => None,
        };
        if let Some((count, clip)) = numbered {
            let trial = |number| OrderedItem::Trial {
                trial: format!("{name}/{number}"),
                component: name.to_owned(),
                clip: clip.to_owned(),
                beside: None,
                panel: Vec::new(),
                condition: condition.unwrap_or(name).to_owned(),
            };
            return Ok(vec![(1..=count).map(trial).collect()]);
        }
        if let Component::Scaling(block) = component {
            let trial = |(place, clips): (usize, Vec<String>)| OrderedItem::Trial {
                trial: format!("{name}/{}", place + 1),
                component: name.to_owned(),
                clip: clips.first().cloned().unwrap_or_default(),
                beside: None,
                panel: clips,
                condition: condition.unwrap_or(name).to_owned(),
            };
            let shown = scaling_sets::scaling_sets(&block.0, name, self.draw);
            return Ok(vec![shown.into_iter().enumerate().map(trial).collect()]);
        }
        let Component::Trials(trials) = component else {
            return Ok(vec![vec![OrderedItem::Component { component: name.to_owned() }]]);
        };
        if let Some(pairs) = &trials.pairs {
            let trial = |[left, right]: [&str; 2]| {
                // The trial has one name, whatever its sides.
                let [one, other] = if left < right { [left, right] } else { [right, left] };
                vec![OrderedItem::Trial {
                    trial: format!("{name}/{one}+{other}"),
                    component: name.to_owned(),
                    clip: left.to_owned(),
                    beside: Some(right.to_owned()),
                    panel: Vec::new(),
                    condition: condition.unwrap_or(name).to_owned(),
                }]
            };
            let mut dealt: Vec<_> = pairs.of_slot(self.draw.participant).map(trial).collect();
            if pairs.active == 0 {
                return Ok(dealt);
            }
            // What follows from answers comes after them: the block stays together.
            self.draw.stream(&["pairs/", name].concat()).shuffle(&mut dealt);
            let active = |number| OrderedItem::Trial {
                trial: format!("{name}/active-{number}"),
                component: name.to_owned(),
                clip: String::new(),
                beside: None,
                panel: Vec::new(),
                condition: condition.unwrap_or(name).to_owned(),
            };
            let dealt = dealt.into_iter().flatten();
            return Ok(vec![dealt.chain((1..=pairs.active).map(active)).collect()]);
        }
        if let Some(panel) = &trials.panel {
            let trial = |page: &PanelPage| {
                let trial = [name, "/", &page.cell].concat();
                let mut clips = page.clips.clone();
                self.draw.stream(&format!("panel/{trial}")).shuffle(&mut clips);
                vec![OrderedItem::Trial {
                    trial,
                    component: name.to_owned(),
                    clip: clips.first().cloned().unwrap_or_default(),
                    beside: None,
                    panel: clips,
                    condition: condition.unwrap_or(name).to_owned(),
                }]
            };
            return Ok(panel.pages.iter().map(trial).collect());
        }
        let mut parts = Vec::new();
        for showing in 1..=trials.repetitions {
            for clip in self.study.clips.iter().filter(|clip| trials.clips.takes(clip)) {
                let mut trial = format!("{name}/{}", clip.id);
                if showing > 1 {
                    trial = format!("{trial}#{showing}");
                }
                parts.push(vec![OrderedItem::Trial {
                    trial,
                    component: name.to_owned(),
                    clip: clip.id.clone(),
                    beside: None,
                    panel: Vec::new(),
                    condition: condition.unwrap_or(name).to_owned(),
                }]);
            }
        }
        Ok(parts)
    }

    /// The parts' order as indices.
    fn arrangement(
        &self,
        sequence: &Sequence,
        parts: &[Vec<OrderedItem>],
        pointer: &str,
    ) -> Result<Vec<usize>, OrderError> {
        let count = parts.len();
        match sequence.order {
            OrderRule::Fixed => Ok((0..count).collect()),
            OrderRule::LatinSquare => {
                let mut labels: Vec<usize> = (0..count).collect();
                self.draw.shared_stream(&format!("latin square{pointer}")).shuffle(&mut labels);
                let turn = self.rotation.next(latin_square::rows(count));
                let row = latin_square::williams_row(count, turn);
                Ok(row.into_iter().map(|index| labels[index]).collect())
            }
            OrderRule::Random => {
                let mut stream = self.draw.stream(&format!("order{pointer}"));
                let rules = self.rules(sequence, parts.iter());
                arrange(count, &rules, &mut stream).map_err(|search| search.error(pointer, count))
            }
        }
    }

    /// The rules for these parts of a sequence; none where its order is not random.
    fn rules<'p>(
        &self,
        sequence: &Sequence,
        parts: impl Iterator<Item = &'p Vec<OrderedItem>> + Clone,
    ) -> Vec<constrained::Rule> {
        if sequence.order != OrderRule::Random {
            return Vec::new();
        }
        let of = |constraint| self.rule(constraint, parts.clone());
        sequence.constraints.iter().map(of).collect()
    }

    /// A constraint with each part's value as a number; only single trials have one, pairs and panels
    /// in what all of their clips are alike.
    fn rule<'p>(
        &self,
        constraint: &crate::study_file::Constraint,
        parts: impl Iterator<Item = &'p Vec<OrderedItem>>,
    ) -> constrained::Rule {
        let mut numbers: BTreeMap<String, u32> = BTreeMap::new();
        let values = parts
            .map(|part| {
                let [OrderedItem::Trial { clip, beside, panel, .. }] = part.as_slice() else {
                    return None;
                };
                let of = |clip: &str| self.by_id.get(clip)?.factor_text(&constraint.factor);
                let value = of(clip)?;
                let mut others = beside.iter().chain(panel);
                if others.any(|other| of(other).as_ref() != Some(&value)) {
                    return None;
                }
                let next = numbers.len() as u32;
                Some(*numbers.entry(value).or_insert(next))
            })
            .collect();
        constrained::Rule {
            values,
            at_most_alike: constraint.at_most_alike.unwrap_or(usize::MAX).max(1),
            minimum_distance: constraint.minimum_distance.unwrap_or(1).max(1),
        }
    }
}

impl Search {
    fn error(self, pointer: &str, parts: usize) -> OrderError {
        let why = match self {
            Self::Impossible => NoOrder::Unsatisfiable { parts },
            Self::OutOfBudget => NoOrder::NotFound { parts },
        };
        OrderError { pointer: format!("{pointer}/constraints"), why }
    }
}

/// Puts the interruptions in, counting trials; none stands after the last trial.
fn with_interruptions(sequence: &Sequence, items: Vec<OrderedItem>) -> Vec<OrderedItem> {
    if sequence.interruptions.is_empty() {
        return items;
    }
    let total = items.iter().filter(|item| item.is_trial()).count();
    let mut result = Vec::with_capacity(items.len());
    let mut done = 0;
    for item in items {
        let is_trial = item.is_trial();
        result.push(item);
        if !is_trial {
            continue;
        }
        done += 1;
        for interruption in &sequence.interruptions {
            let spacing = interruption.spacing.max(1);
            let first = interruption.first_location.unwrap_or(spacing).max(1);
            if done < total && done >= first && (done - first).is_multiple_of(spacing) {
                let component = interruption.component.clone();
                result.push(OrderedItem::Component { component });
            }
        }
    }
    result
}
