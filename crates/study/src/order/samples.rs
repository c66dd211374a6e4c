//! Samples under constraints: every participant's sample must have an order.
//!
//! The samples of the first cycle are proved by the check ([`super::prove`]). A later cycle is walked
//! only if each of its samples has an order that a short search finds; otherwise its circle is drawn
//! anew, some times, and then the first cycle is walked again. So each part is still shown equally
//! often within every cycle; which parts are shown together is balanced less where that happens, of
//! which the check warns.

use super::constrained::quickly_arranged;
use super::rotation::later_turn;
use super::{Context, OrderedItem, latin_square, subset};
use crate::study_file::{OrderRule, Sequence, SequenceItem};

/// Circles drawn for a cycle before the first cycle is walked again.
const CIRCLES: usize = 8;

/// How the samples of a cycle were come by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Drawn {
    /// As they fell.
    AtOnce,
    /// Others before had a sample without an order.
    Anew,
    /// They are those of the first cycle.
    FirstCycle,
}

impl Context<'_> {
    /// `samples` of the parts, each part equally often over participants, and each pair too.
    pub(super) fn sample(
        &self,
        sequence: &Sequence,
        parts: Vec<Vec<OrderedItem>>,
        samples: usize,
        pointer: &str,
    ) -> Vec<Vec<OrderedItem>> {
        if samples >= parts.len() {
            return parts;
        }
        let length = subset::cycle(parts.len(), samples);
        let squares = self.squares / self.own_square(sequence, samples);
        let place = later_turn(self.draw.participant, squares, length);
        let cycle = self.draw.participant / length.saturating_mul(squares);
        let (walk, _) = self.walk(sequence, &parts, samples, pointer, cycle);
        let mut parts: Vec<Option<Vec<OrderedItem>>> = parts.into_iter().map(Some).collect();
        let chosen = subset::window(&walk, samples, place);
        chosen.into_iter().filter_map(|index| parts[index].take()).collect()
    }

    /// Rows of a sequence's own square; 1 without.
    fn own_square(&self, sequence: &Sequence, parts: usize) -> u64 {
        if sequence.order == OrderRule::LatinSquare { latin_square::rows(parts) } else { 1 }
    }

    /// After how many participants every combination of the rows of all squares has come up.
    pub(super) fn all_squares(&self, sequence: &Sequence) -> u64 {
        let (mut parts, mut period) = (0, 1_u64);
        for item in &sequence.components {
            parts += match item {
                SequenceItem::Component(name) => {
                    self.component(name, "", None).map_or(0, |each| each.len())
                }
                SequenceItem::Sequence(nested) if !nested.is_shown_in(self.draw.condition) => 0,
                SequenceItem::Sequence(nested) => {
                    period = period.saturating_mul(self.all_squares(nested));
                    1
                }
            };
        }
        let shown = sequence.num_samples.map_or(parts, |samples| samples.min(parts));
        period.saturating_mul(self.own_square(sequence, shown))
    }

    /// The parts in the order in which the participants of a cycle take them.
    pub(super) fn walk(
        &self,
        sequence: &Sequence,
        parts: &[Vec<OrderedItem>],
        samples: usize,
        pointer: &str,
        cycle: u64,
    ) -> (Vec<usize>, Drawn) {
        let walk = |name: &str, stride| {
            let mut circle: Vec<usize> = (0..parts.len()).collect();
            self.draw.shared_stream(name).shuffle(&mut circle);
            subset::walk(&circle, stride)
        };
        let first = format!("sample{pointer}");
        let (number, stride) = subset::circle_and_stride(parts.len(), cycle);
        let mut drawn = match number {
            0 => walk(&first, stride),
            _ => walk(&format!("{first}/{number}"), stride),
        };
        if cycle == 0 || sequence.constraints.is_empty() {
            return (drawn, Drawn::AtOnce);
        }
        for again in 1..=CIRCLES {
            if self.each_has_an_order(sequence, parts, samples, &drawn) {
                return (drawn, if again == 1 { Drawn::AtOnce } else { Drawn::Anew });
            }
            drawn = walk(&format!("{first}/{cycle}/{again}"), 1);
        }
        (walk(&first, 1), Drawn::FirstCycle)
    }

    fn each_has_an_order(
        &self,
        sequence: &Sequence,
        parts: &[Vec<OrderedItem>],
        samples: usize,
        walk: &[usize],
    ) -> bool {
        (0..subset::cycle(parts.len(), samples)).all(|place| {
            let window = subset::window(walk, samples, place);
            let rules = self.rules(sequence, window.iter().map(|&index| &parts[index]));
            quickly_arranged(samples, &rules)
        })
    }
}
