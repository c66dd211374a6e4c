//! Pairs of active schedules in simulated answers: drawn as the page draws them, under all answers before.

use std::collections::{BTreeMap, VecDeque};

use mimique_study::{Component, DealtPairs, OwnChoice, PairRequest};

use super::design::Design;
use crate::simulate::PairChoices;

/// One person's answers to pairs, and the pairs that are still to be shown.
pub(super) struct OwnPairs<'d> {
    design: &'d Design<'d>,
    slot: u64,
    blocks: BTreeMap<String, Block<'d>>,
}

struct Block<'d> {
    pairs: &'d DealtPairs,
    own: Vec<OwnChoice>,
    drawn: VecDeque<[String; 2]>,
    batch: u32,
    /// Pairs that are not drawn yet.
    left: usize,
}

impl<'d> OwnPairs<'d> {
    /// Nothing answered yet.
    pub fn new(design: &'d Design<'d>, slot: u64) -> Self {
        let blocks = design.components.iter().filter_map(|(name, component)| {
            let Component::Trials(trials) = component else { return None };
            let pairs = trials.pairs.as_deref().filter(|pairs| pairs.active > 0)?;
            let (own, drawn, left) = (Vec::new(), VecDeque::new(), pairs.active);
            Some((name.clone(), Block { pairs, own, drawn, batch: 0, left }))
        });
        Self { design, slot, blocks: blocks.collect() }
    }

    /// The next pair of a block, under what `others` chose; none once all have been shown.
    pub fn next(&mut self, name: &str, others: &PairChoices) -> Option<[String; 2]> {
        let block = self.blocks.get_mut(name)?;
        if block.drawn.is_empty() {
            block.batch += 1;
            let request = PairRequest {
                step: String::new(),
                component: name.to_owned(),
                pairs: block.pairs.clone(),
                seed: self.design.study.seed,
                config_hash: self.design.config_hash.clone(),
                slot: self.slot,
                batch: block.batch,
                left: block.left,
                own: block.own.clone(),
                others: others.get(name).cloned().unwrap_or_default(),
            };
            block.drawn = request.draw().pairs.into();
            block.left -= block.drawn.len();
        }
        block.drawn.pop_front()
    }

    /// Takes in the answer to a pair; of other blocks nothing is kept.
    pub fn answered(&mut self, name: &str, [left, right]: [&str; 2], answer: Option<&str>) {
        if let Some(block) = self.blocks.get_mut(name) {
            let [left, right] = [left, right].map(str::to_owned);
            block.own.push(OwnChoice { left, right, answer: answer.map(str::to_owned) });
        }
    }

    /// Adds this person's answers to those of all.
    pub fn count(self, all: &mut PairChoices) {
        for (name, Block { pairs, own, .. }) in self.blocks {
            all.entry(name).or_default().add_own(pairs, &own);
        }
    }
}
