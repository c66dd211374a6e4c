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
//! likely in each.

/// Participants after whom each of `count` parts was taken equally often.
pub(super) fn cycle(count: usize, samples: usize) -> u64 {
    (count / greatest_common_divisor(count, samples)) as u64
}

/// The parts of a participant, in ascending order. `circle` is asked for the shuffled parts of a
/// numbered circle. `samples` is less than `count`.
pub(super) fn subset(
    count: usize,
    samples: usize,
    participant: u64,
    circle: impl FnOnce(u64) -> Vec<usize>,
) -> Vec<usize> {
    let cycle_length = cycle(count, samples);
    let (cycle, place) = (participant / cycle_length, participant % cycle_length);
    let strides = if is_prime(count) { (count as u64 - 1) / 2 } else { 0 };
    let (number, stride) = match strides {
        0 => (cycle, 1),
        _ => (cycle / strides, 1 + (cycle % strides) as usize),
    };
    let circle = circle(number);
    // No product goes beyond count * count: place is below count.
    let start = place as usize * samples % count;
    let mut chosen = vec![false; count];
    (0..samples).for_each(|step| chosen[circle[(start + step) * stride % count]] = true);
    (0..count).filter(|index| chosen[*index]).collect()
}

fn greatest_common_divisor(left: usize, right: usize) -> usize {
    if right == 0 { left } else { greatest_common_divisor(right, left % right) }
}

fn is_prime(number: usize) -> bool {
    number > 1 && (2..).take_while(|d| d * d <= number).all(|d| !number.is_multiple_of(d))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How often each pair is shown together, over so many participants.
    fn pairs(count: usize, samples: usize, participants: u64) -> Vec<u64> {
        let mut together = vec![0; count * count];
        for participant in 0..participants {
            let chosen = subset(count, samples, participant, |_| (0..count).collect());
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
        let first = subset(2, 1, 0, |_| vec![0, 1]);
        let second = subset(2, 1, 1, |_| vec![0, 1]);
        assert_eq!((first, second), (vec![0], vec![1]));
        assert_eq!(subset(5, 0, 3, |_| (0..5).collect()), Vec::<usize>::new());
        assert_eq!(subset(6, 4, u64::MAX, |_| (0..6).collect()).len(), 4);
    }
}
