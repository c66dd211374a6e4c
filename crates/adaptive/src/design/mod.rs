//! Which pairs a participant compares: all of them, or a share of them so dealt that over people and within a
//! person everything is asked about equally often (a balanced incomplete design of pairs).
//!
//! A pair is of two of the items, in a cell (a segment, an avatar) that both were shown in; every cell has
//! every item. A participant's place in the balance is the slot; slots go round after a period.

mod dealer;

use self::dealer::dealt;
use crate::sides::{Orders, Side, sides};

/// Two items of a cell, shown together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Presentation {
    /// The item on the left, or the first one.
    pub left: usize,
    /// The item on the right, or the second one.
    pub right: usize,
    /// The cell.
    pub cell: usize,
}

/// Why pairs cannot be dealt.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum DesignError {
    /// Fewer than two items, or no cell.
    #[error("{items} items in {cells} cells make no pair")]
    NoPair {
        /// Items.
        items: usize,
        /// Cells.
        cells: usize,
    },
    /// More pairs for a participant than there are, or none.
    #[error("a participant can compare 1 to {all} pairs, not {asked}")]
    PairsOfParticipant {
        /// Asked for.
        asked: usize,
        /// Pairs x cells.
        all: usize,
    },
    /// The search for a balanced share was given up.
    #[error("no balanced share of {asked} pairs was found; ask for {near} pairs")]
    NotFound {
        /// Asked for.
        asked: usize,
        /// A number of pairs that is always balanced: whole rounds of all items.
        near: usize,
    },
}

/// The pairs of every slot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PairDesign {
    items: usize,
    cells: usize,
    /// A row for each slot of a period.
    rows: Vec<Vec<Presentation>>,
}

/// How evenly a design deals, over the slots of a period: least and most of each count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Balance {
    /// How often a pair is shown in a cell, over slots.
    pub pair_in_cell: [usize; 2],
    /// The largest difference between two items of how often one slot shows them.
    pub items_of_slot: usize,
    /// The largest difference, in one slot, between how often an item is left and right.
    pub sides_of_slot: usize,
}

/// Searches that are begun; each prefers other entries where several are as good.
const ATTEMPTS: usize = 64;
/// A pair and its cell, before sides are given.
type Entry = (usize, usize, usize);

impl PairDesign {
    /// Every pair in every cell, for every slot; the order of each pair changes from slot to slot.
    pub fn all(items: usize, cells: usize) -> Result<Self, DesignError> {
        let entries = entries(items, cells)?;
        Ok(Self::with_sides(items, cells, vec![entries]))
    }

    /// So many pairs for each slot: over the first slots, however many, a pair is shown in a cell at most once
    /// more than another, and within a slot an item at most once more than another.
    pub fn incomplete(
        items: usize,
        cells: usize,
        per_participant: usize,
    ) -> Result<Self, DesignError> {
        let entries = entries(items, cells)?;
        let (asked, all) = (per_participant, entries.len());
        if asked == 0 || asked > all {
            return Err(DesignError::PairsOfParticipant { asked, all });
        }
        // Whole rounds: an item each of an even number, all but one of an odd number.
        let round = items / 2;
        let near = (asked / round).max(1) * round;
        let rows = (0..ATTEMPTS).find_map(|attempt| dealt(items, cells, &entries, asked, attempt));
        let rows = rows.ok_or(DesignError::NotFound { asked, near })?;
        Ok(Self::with_sides(items, cells, rows))
    }

    fn with_sides(items: usize, cells: usize, rows: Vec<Vec<Entry>>) -> Self {
        let mut orders = Orders::new(items);
        let sided = |row: Vec<Entry>| {
            let pairs: Vec<(usize, usize)> = row.iter().map(|&(a, b, _)| (a, b)).collect();
            let given = sides(items, &pairs, &mut orders);
            let place = |(&(a, b, cell), side): (&Entry, Side)| match side {
                Side::First => Presentation { left: a, right: b, cell },
                Side::Second => Presentation { left: b, right: a, cell },
            };
            row.iter().zip(given).map(place).collect()
        };
        Self { items, cells, rows: rows.into_iter().map(sided).collect() }
    }

    /// Slots after which the pairs come again, left and right exchanged.
    pub fn period(&self) -> usize {
        self.rows.len()
    }

    /// The pairs of a slot. Over two periods every pair is shown in both orders equally often.
    pub fn of_slot(&self, slot: usize) -> Vec<Presentation> {
        let row = &self.rows[slot % self.rows.len()];
        let exchanged = slot / self.rows.len() % 2 == 1;
        let side = |&Presentation { left, right, cell }: &Presentation| match exchanged {
            true => Presentation { left: right, right: left, cell },
            false => Presentation { left, right, cell },
        };
        row.iter().map(side).collect()
    }

    /// How evenly it deals.
    pub fn balance(&self) -> Balance {
        let mut shown = vec![0; self.items * self.items * self.cells];
        let (mut items_of_slot, mut sides_of_slot) = (0, 0);
        for row in &self.rows {
            let mut sides = vec![[0_usize; 2]; self.items];
            for p in row {
                let (a, b) = (p.left.min(p.right), p.left.max(p.right));
                shown[(a * self.items + b) * self.cells + p.cell] += 1;
                sides[p.left][0] += 1;
                sides[p.right][1] += 1;
            }
            let counts = sides.iter().map(|[left, right]| left + right);
            let [least, most] = extremes(counts);
            items_of_slot = items_of_slot.max(most - least);
            let uneven = sides.iter().map(|[left, right]| left.abs_diff(*right)).max();
            sides_of_slot = sides_of_slot.max(uneven.unwrap_or(0));
        }
        let all = entries(self.items, self.cells).unwrap_or_default();
        let count = |&(a, b, cell): &Entry| shown[(a * self.items + b) * self.cells + cell];
        Balance { pair_in_cell: extremes(all.iter().map(count)), items_of_slot, sides_of_slot }
    }
}

fn extremes(counts: impl Iterator<Item = usize>) -> [usize; 2] {
    counts.fold([usize::MAX, 0], |[least, most], count| [least.min(count), most.max(count)])
}

fn common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

/// Every pair in every cell: round by round of a tournament in which each item meets another one (the
/// circle method), the cells in turn.
fn entries(items: usize, cells: usize) -> Result<Vec<Entry>, DesignError> {
    if items < 2 || cells == 0 {
        return Err(DesignError::NoPair { items, cells });
    }
    // With an odd number, whoever meets the last place has no pair in that round.
    let places = items.next_multiple_of(2);
    let mut all = Vec::with_capacity(items * (items - 1) / 2 * cells);
    for round in 0..places - 1 {
        for cell in 0..cells {
            for pair in 0..places / 2 {
                let at = |step: usize| (round + step) % (places - 1);
                let (a, b) = match pair {
                    0 => (at(0), places - 1),
                    _ => (at(pair), at(places - 1 - pair)),
                };
                if a < items && b < items {
                    all.push((a.min(b), a.max(b), cell));
                }
            }
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_pairs_of_all_cells_are_shown_to_everybody_in_both_orders() {
        for items in 2..=9 {
            for cells in 1..=3 {
                let design = PairDesign::all(items, cells).unwrap();
                let all = items * (items - 1) / 2 * cells;
                assert_eq!((design.period(), design.of_slot(0).len()), (1, all));
                let balance = design.balance();
                assert_eq!((balance.pair_in_cell, balance.items_of_slot), ([1, 1], 0));
                assert!(balance.sides_of_slot <= 1);
                let exchange =
                    |p: &Presentation| Presentation { left: p.right, right: p.left, cell: p.cell };
                let other: Vec<Presentation> = design.of_slot(0).iter().map(exchange).collect();
                assert_eq!(design.of_slot(1), other);
                assert_eq!(design.of_slot(2), design.of_slot(0));
            }
        }
    }

    #[test]
    fn shares_are_balanced_over_any_number_of_slots_and_within_each() {
        let mut found = 0;
        for (items, cells) in (3..=8).flat_map(|items| (1..=2).map(move |cells| (items, cells))) {
            let all = items * (items - 1) / 2 * cells;
            for share in 1..=all {
                let design = PairDesign::incomplete(items, cells, share)
                    .unwrap_or_else(|why| panic!("{items} {cells} {share}: {why}"));
                found += 1;
                let balance = design.balance();
                let [least, most] = balance.pair_in_cell;
                assert_eq!(least, most, "a period is whole: {items} {cells} {share}");
                assert!(balance.items_of_slot <= 1 && balance.sides_of_slot <= 1, "{balance:?}");
                let mut shown = std::collections::BTreeMap::new();
                for slot in 0..2 * design.period() {
                    let own = design.of_slot(slot);
                    assert_eq!(own.len(), share);
                    for p in own {
                        let pair = (p.left.min(p.right), p.left.max(p.right), p.cell);
                        *shown.entry(pair).or_insert(0) += 1;
                    }
                    let most = shown.values().max().unwrap_or(&0);
                    let least = if shown.len() < all { &0 } else { shown.values().min().unwrap() };
                    assert!(most - least <= 1, "{items} {cells} {share}, slot {slot}");
                }
            }
        }
        assert!(found > 200, "{found}");
    }

    #[test]
    fn designs_of_the_size_of_studies_are_found() {
        for items in 3..=8 {
            for (cells, share) in [(6, 12), (6, 15), (18, 20), (18, 36), (18, 40), (36, 50)] {
                let design = PairDesign::incomplete(items, cells, share).unwrap();
                let balance = design.balance();
                assert_eq!(balance.pair_in_cell[0], balance.pair_in_cell[1]);
                assert!(balance.items_of_slot <= 1 && balance.sides_of_slot <= 1, "{balance:?}");
            }
        }
    }

    #[test]
    fn what_is_not_found_names_a_number_that_is() {
        let mut lost = 0;
        for share in 1..=108 {
            if let Err(why) = PairDesign::incomplete(9, 3, share) {
                let DesignError::NotFound { asked, near } = why else { panic!("{why}") };
                assert_eq!(asked, share);
                assert!(PairDesign::incomplete(9, 3, near).is_ok(), "{near}");
                lost += 1;
            }
        }
        assert!(lost < 4, "{lost}");
    }

    #[test]
    fn a_slot_asks_about_a_pair_in_a_cell_once() {
        let design = PairDesign::incomplete(5, 3, 17).unwrap();
        for slot in 0..design.period() {
            let mut own = design.of_slot(slot);
            own.iter_mut().for_each(|p| {
                (p.left, p.right) = (p.left.min(p.right), p.left.max(p.right));
            });
            own.sort();
            own.dedup();
            assert_eq!(own.len(), 17);
        }
    }

    #[test]
    fn what_makes_no_pairs_is_refused() {
        assert_eq!(PairDesign::all(1, 4), Err(DesignError::NoPair { items: 1, cells: 4 }));
        assert_eq!(PairDesign::all(3, 0), Err(DesignError::NoPair { items: 3, cells: 0 }));
        for asked in [0, 7] {
            let refused = PairDesign::incomplete(4, 1, asked);
            assert_eq!(refused, Err(DesignError::PairsOfParticipant { asked, all: 6 }));
        }
    }
}
