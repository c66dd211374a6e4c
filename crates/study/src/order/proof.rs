//! Proofs that every participant has an order: of the check alone, never of the page.

use super::constrained::prove_arrangement;
use super::samples::Drawn;
use super::{Context, Draw, OrderError, OrderedItem, subset};
use crate::projection::StudyProjection;
use crate::study_file::{OrderRule, Sequence, SequenceItem};

/// Most parts of all samples of one cycle together: each is ordered before a session starts.
pub(crate) const MOST_PARTS: usize = 50_000;
/// Cycles of samples after the first that are looked at for their balance.
pub(crate) const CYCLES: u64 = 20;

/// What is wrong with the order of a sequence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Flaw {
    /// Somebody would have no order.
    NoOrder(OrderError),
    /// There are too many samples to try them all.
    TooManySamples { pointer: String, parts: usize, samples: usize },
    /// Of the first [`CYCLES`] cycles, so many were drawn anew, or show the samples of the first.
    Unbalanced { pointer: String, anew: u64, first: u64 },
}

/// Finds, for every sequence with constraints and each sample of its first cycle, the order on which
/// [`super::order`] falls back when its own search fails. Nothing else can leave a participant without
/// one: a sequence's constraints depend on its own parts alone.
pub(crate) fn prove(study: &StudyProjection, draw: Draw<'_>) -> Vec<Flaw> {
    let context = Context::new(study, draw);
    let mut flaws = Vec::new();
    context.prove(&study.sequence, "/sequence", &mut flaws);
    flaws
}

impl Context<'_> {
    fn prove(&self, sequence: &Sequence, pointer: &str, flaws: &mut Vec<Flaw>) {
        let mut parts: Vec<Vec<OrderedItem>> = Vec::new();
        for (index, item) in sequence.components.iter().enumerate() {
            let place = format!("{pointer}/components/{index}");
            match item {
                // A name that is not there is said elsewhere.
                SequenceItem::Component(name) => {
                    parts.extend(self.component(name, &place, None).unwrap_or_default());
                }
                // To the constraints a nested sequence is a part without values. One of a condition is
                // proved as the others are: no constraint and no sample reaches across its border.
                SequenceItem::Sequence(nested) => {
                    self.prove(nested, &place, flaws);
                    parts.push(Vec::new());
                }
            }
        }
        if sequence.order == OrderRule::Random && !sequence.constraints.is_empty() {
            flaws.extend(self.flaw(sequence, &parts, pointer));
        }
    }

    fn flaw(&self, sequence: &Sequence, parts: &[Vec<OrderedItem>], pointer: &str) -> Option<Flaw> {
        let proved = |chosen: &[usize]| {
            let rules = self.rules(sequence, chosen.iter().map(|&index| &parts[index]));
            let count = chosen.len();
            let arranged = prove_arrangement(count, &rules).map(drop);
            arranged.map_err(|search| Flaw::NoOrder(search.error(pointer, count)))
        };
        let all: Vec<usize> = (0..parts.len()).collect();
        let Some(samples) = sequence.num_samples.filter(|samples| *samples < parts.len()) else {
            return proved(&all).err();
        };
        let length = subset::cycle(parts.len(), samples);
        if length.saturating_mul(samples as u64) > MOST_PARTS as u64 {
            let pointer = pointer.to_owned();
            return Some(Flaw::TooManySamples { pointer, parts: parts.len(), samples });
        }
        let (walk, _) = self.walk(sequence, parts, samples, pointer, 0);
        for place in 0..length {
            if let Err(flaw) = proved(&subset::window(&walk, samples, place)) {
                return Some(flaw);
            }
        }
        let (mut anew, mut first) = (0, 0);
        for cycle in 1..=CYCLES {
            match self.walk(sequence, parts, samples, pointer, cycle).1 {
                Drawn::AtOnce => {}
                Drawn::Anew => anew += 1,
                Drawn::FirstCycle => first += 1,
            }
        }
        let pointer = pointer.to_owned();
        (anew + first > 0).then_some(Flaw::Unbalanced { pointer, anew, first })
    }
}
