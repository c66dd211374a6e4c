//! A block of paired comparisons: every two levels of a factor side by side, in each segment.

use mimique_adaptive::{Balance, DesignError, PairDesign};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::adaptive::is_none_at_all;
use super::compared::{Compared, NoCells, method, segment_and_avatar};
use super::json_block::JsonBlock;
use super::{
    Clip, ClipSelection, ClipShowing, Component, LocalText, Study, TimeLimit, TrialsComponent,
};

/// A block of paired comparisons. Its items are the levels of a factor of the clips; two clips make a pair where they
/// differ in it and are alike in what `within` names (a cell). Each trial shows one pair and asks which of the two.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct PairsComponent {
    /// The factor whose levels are compared; `segment` and `avatar` can be named too.
    #[serde(default = "method")]
    pub compare: String,
    /// Its levels; all that clips have if not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub levels: Vec<String>,
    /// Factors in which the two clips of a pair are alike.
    #[serde(default = "segment_and_avatar")]
    pub within: Vec<String>,
    /// Which clips; all of them if not given.
    #[serde(default, skip_serializing_if = "ClipSelection::is_everything")]
    pub clips: ClipSelection,
    /// Which pairs each participant is shown.
    #[serde(default)]
    pub schedule: PairSchedule,
    /// How the two clips are shown.
    #[serde(default)]
    pub show: ClipShowing,
    /// Identifier of one of the study's `questions`, of type `comparison`.
    pub question: String,
    /// Identifier of one of the study's `questions` that is asked after the choice: why.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reasons: Option<String>,
    /// A line above the clips.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instruction: Option<LocalText>,
    /// Most replays after the first whole play; without limit if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum_replays: Option<u32>,
    /// How long its answers may take, from the end of the first whole play.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_limit: Option<TimeLimit>,
}

/// Which pairs each participant is shown.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct PairSchedule {
    /// All, or a share.
    pub rule: PairRule,
    /// Of a share, and of an active schedule: how many pairs each participant is shown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub per_participant: Option<usize>,
}

/// How pairs are dealt.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum PairRule {
    /// Every pair in every cell, to everybody.
    #[default]
    All,
    /// A share of them: over participants every pair is shown in every cell equally often, and each
    /// participant is shown every level equally often, both to within one.
    Incomplete,
    /// The first half as `incomplete`, then batches of pairs whose answers are expected to tell most, under all
    /// answers so far.
    Active,
}

/// The pairs that a block's trials show, derived from [`PairsComponent`].
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct DealtPairs {
    /// Identifiers of the clips.
    pub clips: Vec<String>,
    /// For each slot of a period its pairs, the left clip first, as places in `clips`. In every other period
    /// left and right are exchanged.
    pub slots: Vec<Vec<[usize; 2]>>,
    /// Whether the two clips are shown one after the other.
    pub in_turn: bool,
    /// Of an active schedule: the pairs that follow from answers, after those of the slot.
    #[serde(skip_serializing_if = "is_none_at_all")]
    pub active: usize,
    /// Of an active schedule: the levels; `clips` has those of each cell in this order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub levels: Vec<String>,
}

/// Why a block has no pairs.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoPairs {
    /// The clips make no cells.
    #[error(transparent)]
    Cells(#[from] NoCells),
    /// The pairs cannot be dealt.
    #[error(transparent)]
    Design(#[from] DesignError),
}

/// The block as pages carry it.
pub type PairsBlock = JsonBlock<PairsComponent>;

impl PairsComponent {
    /// Identifiers of the questions of each trial, in the order they are asked.
    pub fn questions(&self) -> Vec<String> {
        [&self.question].into_iter().chain(&self.reasons).cloned().collect()
    }

    pub(crate) fn compares(&self) -> Compared<'_> {
        let Self { compare, levels, within, clips, .. } = self;
        Compared { compare, levels, within, clips }
    }

    /// The levels that are compared: those of the file, or those of the clips in their order.
    pub fn compared(&self, clips: &[Clip]) -> Vec<String> {
        self.compares().levels(clips)
    }

    /// The block as the trials that it makes.
    ///
    /// # Errors
    /// [`NoPairs`]: what the check of a study refuses.
    pub fn trials(&self, clips: &[Clip]) -> Result<TrialsComponent, NoPairs> {
        let levels = self.compared(clips);
        let cells = self.compares().cells(clips, &levels)?;
        let design = self.design(levels.len(), cells.len())?;
        let shown: Vec<&Clip> = cells.iter().flat_map(|cell| &cell.clips).copied().collect();
        let ids = || shown.iter().map(|clip| clip.id.clone()).collect();
        let place = |item: usize, cell: usize| cell * levels.len() + item;
        let slots = (0..design.period()).map(|slot| {
            let row = design.of_slot(slot);
            row.iter().map(|p| [place(p.left, p.cell), place(p.right, p.cell)]).collect()
        });
        let in_turn = self.show == ClipShowing::InTurn;
        Ok(TrialsComponent {
            clips: ClipSelection { ids: ids(), ..ClipSelection::default() },
            instruction: self.instruction.clone(),
            questions: self.questions(),
            maximum_replays: self.maximum_replays,
            repetitions: 1,
            beside: None,
            time_limit: self.time_limit.clone(),
            pairs: Some(Box::new(DealtPairs {
                clips: ids(),
                slots: slots.collect(),
                in_turn,
                active: self.schedule.active(),
                levels: if self.schedule.active() > 0 { levels } else { Vec::new() },
            })),
            panel: None,
        })
    }

    /// How evenly the block deals its pairs.
    ///
    /// # Errors
    /// [`NoPairs`].
    pub fn balance(&self, clips: &[Clip]) -> Result<Balance, NoPairs> {
        let levels = self.compared(clips);
        let cells = self.compares().cells(clips, &levels)?;
        Ok(self.design(levels.len(), cells.len())?.balance())
    }

    fn design(&self, items: usize, cells: usize) -> Result<PairDesign, DesignError> {
        match self.schedule.per_participant {
            None => PairDesign::all(items, cells),
            Some(pairs) => PairDesign::incomplete(items, cells, pairs - self.schedule.active()),
        }
    }
}

impl PairSchedule {
    /// Pairs that follow from answers: the second half of an active schedule.
    pub fn active(self) -> usize {
        match (self.rule, self.per_participant) {
            (PairRule::Active, Some(pairs)) => pairs / 2,
            _ => 0,
        }
    }
}

impl DealtPairs {
    /// The pairs of a slot: the left clip, the right clip.
    pub fn of_slot(&self, slot: u64) -> impl Iterator<Item = [&str; 2]> {
        let period = self.slots.len().max(1) as u64;
        let exchanged = slot / period % 2 == 1;
        let row = self.slots.get((slot % period) as usize).map_or(&[][..], Vec::as_slice);
        let clip = |place: usize| self.clips.get(place).map_or("", String::as_str);
        row.iter().map(move |&[left, right]| match exchanged {
            true => [clip(right), clip(left)],
            false => [clip(left), clip(right)],
        })
    }

    /// Pairs that each participant is shown.
    pub fn each(&self) -> usize {
        self.slots.first().map_or(0, Vec::len) + self.active
    }
}

impl Study {
    /// The blocks of pairs, by name. What cannot be read is left out: the check reports it.
    pub fn pair_blocks(&self) -> impl Iterator<Item = (&str, PairsComponent)> {
        self.components.iter().filter_map(|(name, component)| match component {
            Component::Pairs(block) => Some((name.as_str(), block.read().ok()?)),
            _ => None,
        })
    }
}
