//! What participants of simulated studies go through: clips, orders, pages, and what must be drawn.

use std::collections::BTreeMap;

use mimique_study::{
    Clip, Component, Draw, Measure, OrderError, OrderedItem, Sides, Study, StudyProjection, order,
};

use super::clips::{ScaledClips, scaled};
use crate::simulate::{Companion, Draws, Model, Parameters, condition_and_slot};
use crate::trials::straight_lining;

/// What participants go through, the same in every run.
pub(crate) struct Design<'s> {
    pub study: &'s Study,
    /// Hash of the study's file: with the seed it decides what is drawn.
    pub config_hash: String,
    pub clips: ScaledClips,
    /// The components as pages carry them: blocks of pairs as the trials that they make.
    pub components: BTreeMap<String, Component>,
    /// A participant each, from number 1.
    pub walks: Vec<Vec<Step>>,
    conditions: Vec<&'s str>,
    pub needs: Needs,
}

/// A step with answers.
pub(crate) enum Step {
    /// A trial: its clip, what is played beside it, its block's name.
    Trial { clip: usize, beside: Option<Companion>, block: String },
    /// A pair that follows from the answers so far: its block.
    DrawnPair(String),
    /// A page of questions.
    Page(String),
}

/// What must be drawn beside the answers.
pub(crate) struct Needs {
    pub times: bool,
    pub display: bool,
    pub pages: bool,
    /// Responses in which runs of equal answers are counted.
    pub runs: Vec<String>,
    /// Questions that hypotheses are about.
    pub responses: Vec<String>,
}

impl<'s> Design<'s> {
    /// The walks of so many participants; `clips` of them instead of the study's own, if given.
    pub(crate) fn new(
        study: &'s Study,
        config_hash: &str,
        participants: usize,
        clips: Option<usize>,
    ) -> Result<Self, OrderError> {
        let own = study.clips().len();
        let clips = scaled(study, clips.unwrap_or(own));
        let conditions = study.conditions();
        let projection = study.projection();
        let own_clips = study.clips();
        let mut walks = Vec::with_capacity(participants);
        for number in 1..=participants as u64 {
            let (condition, slot) = condition_and_slot(&conditions, number);
            let draw = Draw { seed: study.seed, config_hash, participant: slot, condition };
            let mut walk = Vec::new();
            let items = order(&projection, draw)?;
            let mut sides = Sides::new(&projection, draw, &items);
            for item in items {
                match item {
                    OrderedItem::Trial { component, clip, .. }
                        if clip.is_empty() && draws_pairs(&projection, &component) =>
                    {
                        walk.push(Step::DrawnPair(component));
                    }
                    OrderedItem::Trial { component, clip, beside, panel, .. } => {
                        let beside = beside.map(|clip| (clip, false)).or_else(|| {
                            companion((&projection, &own_clips), &component, &clip, &mut sides)
                        });
                        let copies = |clip: &str| clips.stand_ins.get(clip).into_iter().flatten();
                        // The clips of a panel are rated one by one.
                        let shown = if panel.is_empty() { vec![clip] } else { panel };
                        for (copy, &clip) in shown.iter().flat_map(|it| copies(it).enumerate()) {
                            // A copy of a clip stands beside the same copy of its companion.
                            let beside = beside.as_ref().and_then(|(id, left)| {
                                Some(Companion { clip: *copies(id).nth(copy)?, left: *left })
                            });
                            walk.push(Step::Trial { clip, beside, block: component.clone() });
                        }
                    }
                    OrderedItem::Component { component } => walk.push(Step::Page(component)),
                }
            }
            if clips.clips.len() > own {
                mix(&mut walk, number);
            }
            walks.push(walk);
        }
        let rules = study.exclusions.clone().unwrap_or_default();
        let measures = |what: Measure| study.hypotheses.iter().any(|each| each.measure == what);
        let needs = Needs {
            times: measures(Measure::Rt) || rules.shortest_rt_ms.is_some(),
            display: measures(Measure::Rt)
                || rules.shortest_rt_ms.is_some()
                || rules.late_frame_share.is_some()
                || rules.longest_frame_ms.is_some(),
            pages: rules.failed_attention_checks.is_some() || has_conditions(study),
            runs: straight_lining::responses(study),
            responses: study.hypotheses.iter().map(|each| each.response.clone()).collect(),
        };
        let (components, config_hash) = (projection.components, config_hash.to_owned());
        Ok(Self { study, config_hash, clips, components, walks, conditions, needs })
    }

    /// The condition of a participant, numbered from 1, and the slot in it.
    pub(crate) fn condition_and_slot(&self, number: usize) -> (Option<&'s str>, u64) {
        condition_and_slot(&self.conditions, number as u64)
    }

    /// The clips that stand for one of the study's.
    pub(crate) fn copies(&self, clip: &str) -> &[usize] {
        self.clips.stand_ins.get(clip).map_or(&[], Vec::as_slice)
    }

    /// The model of these parameters on the design's clips.
    pub(crate) fn model(&self, parameters: &'s Parameters) -> Model<'s> {
        Model::new(self.study, parameters, self.clips.clips.clone())
    }
}

/// Whether pairs of a block follow from the answers so far.
fn draws_pairs(study: &StudyProjection, block: &str) -> bool {
    let Some(Component::Trials(trials)) = study.components.get(block) else { return false };
    trials.pairs.as_ref().is_some_and(|pairs| pairs.active > 0)
}

/// The clip that a block plays beside another, and whether it stands on the left.
fn companion(
    (study, clips): (&StudyProjection, &[Clip]),
    block: &str,
    clip: &str,
    sides: &mut Sides,
) -> Option<(String, bool)> {
    let Some(Component::Trials(trials)) = study.components.get(block) else { return None };
    let beside = trials.beside.as_ref()?;
    let left = sides.is_left(block, beside);
    let own = clips.iter().find(|own| own.id == clip)?;
    Some((beside.of(own, clips)?.id.clone(), left))
}

/// Mixes the trials of a study with more clips than its own: copies of a clip must not follow it.
fn mix(walk: &mut [Step], number: u64) {
    let mut draws = Draws::new(0, Some(number), "order of more clips");
    let places: Vec<usize> =
        (0..walk.len()).filter(|&place| matches!(walk[place], Step::Trial { .. })).collect();
    for last in (1..places.len()).rev() {
        let other = draws.below(last + 1);
        walk.swap(places[last], places[other]);
    }
}

/// Whether some question is asked only after some answers.
pub(crate) fn has_conditions(study: &Study) -> bool {
    study.questions.iter().any(|question| question.show_if.is_some())
}
