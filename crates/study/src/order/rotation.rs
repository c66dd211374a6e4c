//! Where a participant stands in everything that goes round with the participants.

use std::cell::Cell;

/// Hands each square of a study (nested ones first, then in document order) the participant's turn
/// in it, so that they are balanced against each other: over as many participants as the product of
/// their periods, every combination of their rows comes up once.
///
/// Samples are balanced against the squares of other sequences in the same way ([`later_turn`]), and
/// their circle stays until these have gone round with it. Against each other, and against the square
/// of their own sequence, they are balanced by chance: every cycle has another circle.
pub(super) struct Rotation {
    participant: u64,
    /// After how many participants all that was handed out comes round together.
    period: Cell<u64>,
}

impl Rotation {
    pub fn of(participant: u64) -> Self {
        Self { participant, period: Cell::new(1) }
    }

    /// The turn in the next square, which goes round after `period` (above 0) participants.
    pub fn next(&self, period: u64) -> u64 {
        let before = self.period.get();
        self.period.set(before.saturating_mul(period));
        later_turn(self.participant, before, period)
    }
}

/// The turn, below `period`, in what goes round beside something that comes round after `before`
/// participants.
///
/// A turn goes on by one with each participant. Two periods with a common divisor would meet in the
/// same combinations for ever; so each time they have come round together, the later one is put off
/// by one. Periods without a common divisor need no such step, and a single one has none.
pub(super) fn later_turn(participant: u64, before: u64, period: u64) -> u64 {
    let common = greatest_common_divisor(before, period);
    let together = (before / common).saturating_mul(period);
    (participant % period + participant / together % common) % period
}

pub(super) fn greatest_common_divisor(left: u64, right: u64) -> u64 {
    if right == 0 { left } else { greatest_common_divisor(right, left % right) }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    fn turns(participant: u64, periods: &[u64]) -> Vec<u64> {
        let turns = Rotation::of(participant);
        periods.iter().map(|&period| turns.next(period)).collect()
    }

    #[test]
    fn every_combination_comes_up_once() {
        let all: [&[u64]; 8] = [
            &[2, 2],
            &[4, 6],
            &[6, 4, 2],
            &[2, 2, 2, 2],
            &[3, 5],
            &[12, 18, 1, 4],
            &[9, 3, 6],
            &[10, 4, 25],
        ];
        for periods in all {
            let product = periods.iter().product();
            let seen: BTreeSet<Vec<u64>> = (0..product).map(|p| turns(p, periods)).collect();
            assert_eq!(seen.len() as u64, product, "{periods:?}");
            // Meanwhile each goes round as fast as it would alone.
            for (index, &period) in periods.iter().enumerate() {
                for round in 0..product / period {
                    let round = (round * period..(round + 1) * period).map(|p| turns(p, periods));
                    let here: BTreeSet<u64> = round.map(|each| each[index]).collect();
                    assert_eq!(here.len() as u64, period, "{periods:?}");
                }
            }
        }
    }

    #[test]
    fn a_single_one_and_those_without_common_divisor_follow_the_number() {
        for participant in [0, 1, 17, 1_000, u64::MAX] {
            assert_eq!(turns(participant, &[6]), [participant % 6]);
            assert_eq!(turns(participant, &[4, 9]), [participant % 4, participant % 9]);
        }
        assert_eq!(turns(u64::MAX, &[u64::MAX, 1 << 63, 6]).len(), 3, "no overflow");
    }
}
