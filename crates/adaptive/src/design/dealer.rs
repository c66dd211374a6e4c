//! Deals pairs slot by slot: a search that backtracks, in an order that is the same everywhere.

use super::{Entry, common_divisor};

/// The entries of each slot of a period; none where the search came to a dead end.
pub(super) fn dealt(
    items: usize,
    cells: usize,
    entries: &[Entry],
    asked: usize,
    attempt: usize,
) -> Option<Vec<Vec<Entry>>> {
    let all = entries.len();
    // What a slot does not show is dealt as evenly as what it shows: the smaller part is dealt.
    let hidden = asked > all / 2;
    let mut dealer = Dealer::new(items, cells, entries.to_vec(), attempt);
    let slots = all / common_divisor(all, asked);
    let slot = |_| {
        let row = dealer.deal(if hidden { all - asked } else { asked })?;
        let others = || entries.iter().filter(|entry| !row.contains(entry)).copied();
        Some(if hidden { others().collect() } else { row })
    };
    (0..slots).map(slot).collect()
}

/// Deals entries slot by slot; each is dealt once before any is dealt again.
struct Dealer {
    items: usize,
    cells: usize,
    entries: Vec<Entry>,
    /// Entries that have not been dealt in this pass.
    left: Vec<bool>,
    /// How often each item was dealt.
    dealt: Vec<usize>,
    attempt: usize,
    /// The places of each item's entries.
    of_item: Vec<Vec<usize>>,
}

/// Entries that a search for one slot looks at before it gives up.
const LOOKED_AT: usize = 5000;

/// The search for the pairs of one slot.
struct Search {
    chosen: Vec<usize>,
    /// How often each item and each cell is in what was chosen.
    items: Vec<usize>,
    cells: Vec<usize>,
    /// How often each item must be in it, and may be; and how many items may be there as often as they may.
    least: Vec<usize>,
    most: Vec<usize>,
    above: usize,
    /// Entries that may be chosen.
    allowed: Vec<bool>,
    wanted: usize,
    looked_at: usize,
}

impl Dealer {
    fn new(items: usize, cells: usize, entries: Vec<Entry>, attempt: usize) -> Self {
        let mut of_item = vec![Vec::new(); items];
        for (place, &(a, b, _)) in entries.iter().enumerate() {
            of_item[a].push(place);
            of_item[b].push(place);
        }
        let (left, dealt) = (vec![true; entries.len()], vec![0; items]);
        Self { items, cells, entries, left, dealt, attempt, of_item }
    }

    /// The pairs of the next slot; none where no balanced ones were found.
    fn deal(&mut self, wanted: usize) -> Option<Vec<Entry>> {
        let left = self.left.iter().filter(|left| **left).count();
        let mut search = self.search(wanted);
        if left <= wanted {
            // What is left of the pass goes to this slot, the rest is of the next one.
            for entry in (0..self.entries.len()).filter(|entry| self.left[*entry]) {
                search.choose(entry, &self.entries);
            }
            search.allowed = self.left.iter().map(|left| !left).collect();
            self.left.fill(true);
            if !self.complete(&mut search) {
                return None;
            }
            for &entry in &search.chosen[left..] {
                self.left[entry] = false;
            }
        } else {
            if !self.complete(&mut search) {
                return None;
            }
            for &entry in &search.chosen {
                self.left[entry] = false;
            }
        }
        for (dealt, own) in self.dealt.iter_mut().zip(&search.items) {
            *dealt += own;
        }
        Some(search.chosen.iter().map(|&entry| self.entries[entry]).collect())
    }

    /// An empty search. Of 2 wanted = items x each + more, so many items are there once more than `each`. In
    /// every other attempt these are the ones that were dealt least so far: what is left of a pass is then
    /// as balanced, and can more often be dealt.
    fn search(&self, wanted: usize) -> Search {
        let (each, more) = (2 * wanted / self.items, 2 * wanted % self.items);
        if self.attempt % 2 == 1 {
            let bound = |extra: usize| vec![each + extra; self.items];
            return self.search_within(wanted, bound(0), bound(1), more);
        }
        let fewest = self.dealt.iter().min().copied().unwrap_or(0);
        let behind = self.dealt.iter().filter(|dealt| **dealt == fewest).count();
        let bound = |once_more: &dyn Fn(bool) -> bool| {
            let of = |dealt: &usize| each + usize::from(once_more(*dealt == fewest));
            self.dealt.iter().map(of).collect()
        };
        let least = bound(&|is_behind| is_behind && more >= behind);
        let most = bound(&|is_behind| if is_behind { more > 0 } else { more > behind });
        let above = if more >= behind { more - behind } else { more };
        self.search_within(wanted, least, most, above)
    }

    fn search_within(
        &self,
        wanted: usize,
        least: Vec<usize>,
        most: Vec<usize>,
        above: usize,
    ) -> Search {
        Search {
            chosen: Vec::with_capacity(wanted),
            items: vec![0; self.items],
            cells: vec![0; self.cells],
            least,
            most,
            above,
            allowed: self.left.clone(),
            wanted,
            looked_at: 0,
        }
    }

    /// Chooses until there are enough; false where that cannot be, or was not found.
    fn complete(&self, search: &mut Search) -> bool {
        let bounds = || search.items.iter().zip(search.least.iter().zip(&search.most));
        let above = bounds().filter(|(count, (least, _))| count > least).count();
        let missing: usize = bounds().map(|(count, (least, _))| least.saturating_sub(*count)).sum();
        let open = search.wanted - search.chosen.len();
        let too_many = bounds().any(|(count, (_, most))| count > most);
        if too_many || above > search.above || missing > 2 * open {
            return false;
        }
        if open == 0 {
            return true;
        }
        // The item that is asked about least, here and so far, is next.
        let below = |item: &usize| search.items[*item] < search.most[*item];
        let rank = |item: &usize| {
            (search.items[*item], self.dealt[*item], (*item + self.attempt) % self.items)
        };
        let Some(item) = (0..self.items).filter(below).min_by_key(rank) else { return false };
        for entry in self.ranked(search, item) {
            search.looked_at += 1;
            if search.looked_at > LOOKED_AT {
                return false;
            }
            search.choose(entry, &self.entries);
            if self.complete(search) {
                return true;
            }
            search.give_back(entry, &self.entries);
        }
        // Nothing with this item can be: where it may stay below the others, they go on without it.
        if search.items[item] < search.least[item] || search.looked_at > LOOKED_AT {
            return false;
        }
        let without = self.ranked(search, item);
        without.iter().for_each(|entry| search.allowed[*entry] = false);
        let found = !without.is_empty() && self.complete(search);
        without.iter().for_each(|entry| search.allowed[*entry] = true);
        found
    }

    /// The order of entries that are as good as each other: another one in each attempt.
    fn preference(&self, entry: usize) -> usize {
        (entry + 1) * (2 * self.attempt + 1) * 7919 % (self.entries.len() + 1)
    }

    /// The entries of an item that may be chosen, the most wanted first: those with another item that is
    /// asked about least, in the cell that was shown least.
    fn ranked(&self, search: &Search, item: usize) -> Vec<usize> {
        let allowed = |entry: &usize| search.allowed[*entry];
        let mut own: Vec<usize> = self.of_item[item].iter().copied().filter(allowed).collect();
        own.sort_by_key(|&entry| {
            let (a, b, cell) = self.entries[entry];
            let other = if a == item { b } else { a };
            (search.items[other], search.cells[cell], self.dealt[other], self.preference(entry))
        });
        own
    }
}

impl Search {
    fn choose(&mut self, entry: usize, entries: &[Entry]) {
        let (a, b, cell) = entries[entry];
        self.chosen.push(entry);
        self.items[a] += 1;
        self.items[b] += 1;
        self.cells[cell] += 1;
        self.allowed[entry] = false;
    }

    fn give_back(&mut self, entry: usize, entries: &[Entry]) {
        let (a, b, cell) = entries[entry];
        self.chosen.pop();
        self.items[a] -= 1;
        self.items[b] -= 1;
        self.cells[cell] -= 1;
        self.allowed[entry] = true;
    }
}
