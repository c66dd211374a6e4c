//! Which parts a participant is shown where a sequence shows some of them only: a balanced incomplete
//! block design over participants.
//!
//! The parts lie on a circle, and each participant takes `samples` of them from where the participant
//! before ended, so that after [`cycle`] participants every part was taken equally often. Pairs are
//! balanced over the cycles: where the number of parts `v` is prime, cycle `c` walks round the circle
//! with stride `1 + c mod (v - 1) / 2`; the blocks of all strides are an orbit of the affine group of
//! the integers modulo `v`, which is 2-transitive, so that every pair is shown together equally often
//! after `(v - 1) / 2` cycles (C. Colbourn & J. Dinitz, "Handbook of Combinatorial Designs", II.1).
//! Where `v` is not prime each cycle has a circle of its own, shuffled anew: every pair is then equally
//! likely in each. Where constraints must be met, `samples` says which of these circles are walked.

use super::rotation::greatest_common_divisor;

/// Participants after whom each of `count` parts was taken equally often.
pub(super) fn cycle(count: usize, samples: usize) -> u64 {
    count as u64 / greatest_common_divisor(count as u64, samples as u64).max(1)
}

/// Which circle a cycle walks round, and with which stride.
pub(super) fn circle_and_stride(count: usize, cycle: u64) -> (u64, usize) {
    let strides = if is_prime(count) { (count as u64 - 1) / 2 } else { 0 };
    match strides {
        0 => (cycle, 1),
        _ => (cycle / strides, 1 + (cycle % strides) as usize),
    }
}

/// The parts in the order in which a cycle walks round their circle.
pub(super) fn walk(circle: &[usize], stride: usize) -> Vec<usize> {
    (0..circle.len()).map(|step| circle[step * stride % circle.len()]).collect()
}

/// What the participant at this place of a cycle is shown: indices in ascending order. `samples` is
/// less than the number of parts.
pub(super) fn window(walk: &[usize], samples: usize, place: u64) -> Vec<usize> {
    let count = walk.len();
    // No product goes beyond count * count: place is below count.
    let start = place as usize * samples % count;
    let mut chosen = vec![false; count];
    (0..samples).for_each(|step| chosen[walk[(start + step) % count]] = true);
    (0..count).filter(|index| chosen[*index]).collect()
}

fn is_prime(number: usize) -> bool {
    number > 1 && (2..).take_while(|d| d * d <= number).all(|d| !number.is_multiple_of(d))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The parts of a participant, where every circle has the parts in the order of the file.
    fn subset(count: usize, samples: usize, participant: u64) -> Vec<usize> {
        let length = cycle(count, samples);
        let (_, stride) = circle_and_stride(count, participant / length);
        let circle: Vec<usize> = (0..count).collect();
        window(&walk(&circle, stride), samples, participant % length)
    }

    /// How often each pair is shown together, over so many participants.
    fn pairs(count: usize, samples: usize, participants: u64) -> Vec<u64> {
        let mut together = vec![0; count * count];
        for participant in 0..participants {
            let chosen = subset(count, samples, participant);
            assert_eq!(chosen.len(), samples);
            assert!(chosen.windows(2).all(|pair| pair[0] < pair[1]), "{chosen:?}");
            for (at, &left) in chosen.iter().enumerate() {
                for &right in &chosen[at + 1..] {
                    together[left * count + right] += 1;
                }
            }
        }
        let upper = (0..count).flat_map(|left| (left + 1..count).map(move |r| left * count + r));
        upper.map(|index| together[index]).collect()
    }

    #[test]
    fn pairs_are_exactly_balanced_where_the_number_of_parts_is_prime() {
        for (count, samples) in [(3, 2), (5, 2), (7, 3), (11, 5), (13, 4), (17, 9)] {
            let participants = cycle(count, samples) * (count as u64 - 1) / 2;
            let each = pairs(count, samples, participants);
            // lambda = b k (k - 1) / (v (v - 1))
            let lambda = participants as usize * samples * (samples - 1) / (count * (count - 1));
            assert!(each.iter().all(|&times| times == lambda as u64), "{count} {samples} {each:?}");
        }
    }

    #[test]
    fn two_parts_take_turns() {
        let first = subset(2, 1, 0);
        let second = subset(2, 1, 1);
        assert_eq!((first, second), (vec![0], vec![1]));
        assert_eq!(subset(5, 0, 3), Vec::<usize>::new());
        assert_eq!(subset(6, 4, u64::MAX).len(), 4);
    }
}
