//! Williams squares (E. J. Williams 1949): Latin squares balanced for first-order carry-over.

/// Rows of the square of `count` parts.
pub(super) fn rows(count: usize) -> u64 {
    let rows = if count.is_multiple_of(2) { count } else { 2 * count };
    rows.max(1) as u64
}

/// Row of a participant in a Williams square of `count` parts: over the square's rows (`count` of
/// them, twice as many when `count` is odd) each part stands at each place equally often and follows
/// each other part equally often.
pub(super) fn williams_row(count: usize, participant: u64) -> Vec<usize> {
    if count == 0 {
        return Vec::new();
    }
    let row = (participant % rows(count)) as usize;
    // 0, 1, n-1, 2, n-2, ...: neighbouring differences are all different modulo n.
    let zigzag = (0..count).map(|place| {
        let half = place.div_ceil(2);
        if place % 2 == 1 { half } else { (count - half) % count }
    });
    let mut parts: Vec<usize> = zigzag.map(|part| (part + row) % count).collect();
    if row >= count {
        parts.reverse();
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn williams_square_balances_places_and_successions() {
        for count in 1..=13 {
            let rows = rows(count) as usize;
            let mut places = vec![vec![0; count]; count];
            let mut successions = vec![vec![0; count]; count];
            for participant in 0..rows {
                let row = williams_row(count, participant as u64);
                for (place, &part) in row.iter().enumerate() {
                    places[place][part] += 1;
                }
                for pair in row.windows(2) {
                    successions[pair[0]][pair[1]] += 1;
                }
            }
            let each = rows / count;
            assert!(places.iter().flatten().all(|&times| times == each), "{count}: {places:?}");
            for (before, row) in successions.iter().enumerate() {
                for (after, &times) in row.iter().enumerate() {
                    assert_eq!(times, if before == after { 0 } else { each }, "{count}");
                }
            }
        }
    }
}
