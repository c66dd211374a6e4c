//! Whether the worths have finite estimates, decided exactly.
//!
//! Without side and ties they have if and only if from every item every other one is reached along wins, a tie
//! being a win both ways (Ford 1957). With them the whole cone of directions is looked at
//! ([`crate::numerics::recession`]), of which Ford's condition is the part without side and tie.

use serde::Serialize;

use super::model::{Model, Place};
use crate::numerics::recession::{Recession, rank, recession};
use crate::table::comparisons::Presentation;

/// Why the likelihood has no maximum.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Separation {
    /// Items that never lost; with ties never tied either.
    pub items_without_defeat: Vec<String>,
    /// Items that never won; with ties never tied either.
    pub items_without_win: Vec<String>,
    /// The items of the best group that never lost to an item outside; empty where each item is reached.
    pub group: Vec<String>,
    /// Whether it needs the side bias to be told: the side rises or falls without bound.
    pub side: bool,
    /// Whether it needs the ties to be told: they become certain, or impossible.
    pub tie: bool,
    /// Whether ties are among the answers, so that "never lost" means "never lost nor tied".
    pub with_ties: bool,
}

/// Places of the items behind [`Separation`], by the answers alone.
struct Places {
    undefeated: Vec<usize>,
    winless: Vec<usize>,
    group: Vec<usize>,
}

impl Model {
    /// Why there is no finite maximum; none where there is one.
    pub(crate) fn separation(self, shown: &[Presentation], names: &[String]) -> Option<Separation> {
        let graph = self.wins(shown);
        let top = undominated(&graph);
        let named = |places: Vec<usize>| places.into_iter().map(|i| names[i].clone()).collect();
        if top.len() < self.items {
            let Places { undefeated, winless, group } = self.places_of(&graph, top);
            return Some(Separation {
                items_without_defeat: named(undefeated),
                items_without_win: named(winless),
                group: named(group),
                side: false,
                tie: false,
                with_ties: self.ties,
            });
        }
        if !(self.side || self.ties) || self.is_pinned(shown) {
            return None;
        }
        let Recession::Along(direction) = recession(&self.rows(shown), self.parameters()) else {
            return None;
        };
        let worths = self.items - 1;
        Some(Separation {
            items_without_defeat: Vec::new(),
            items_without_win: Vec::new(),
            group: Vec::new(),
            side: self.side && direction[worths] != 0,
            tie: self.ties && direction[self.parameters() - 1] != 0,
            with_ties: self.ties,
        })
    }

    /// Whether separated at all; quicker than saying why.
    pub(super) fn is_separated(self, shown: &[Presentation]) -> bool {
        if undominated(&self.wins(shown)).len() < self.items {
            return true;
        }
        (self.side || self.ties)
            && !self.is_pinned(shown)
            && matches!(recession(&self.rows(shown), self.parameters()), Recession::Along(_))
    }

    /// For each item those that it won against or tied with.
    fn wins(self, shown: &[Presentation]) -> Vec<Vec<bool>> {
        let mut wins = vec![vec![false; self.items]; self.items];
        for Presentation { left, right, counts: [over, same, under] } in shown {
            wins[*left][*right] |= over + same > 0;
            wins[*right][*left] |= under + same > 0;
        }
        wins
    }

    fn places_of(self, wins: &[Vec<bool>], group: Vec<usize>) -> Places {
        let all = 0..self.items;
        let lost = |item: usize| all.clone().any(|other| wins[other][item]);
        let won = |item: usize| all.clone().any(|other| wins[item][other]);
        Places {
            undefeated: all.clone().filter(|item| !lost(*item)).collect(),
            winless: all.clone().filter(|item| !won(*item)).collect(),
            group,
        }
    }

    /// Whether side and tie cannot move alone, seen at a glance: some order of a pair was answered left and
    /// right (so that a direction keeps both items apart by minus the side, and no tie gains on it), and where
    /// a side is fitted the other order was, too.
    fn is_pinned(self, shown: &[Presentation]) -> bool {
        let both = |p: &&Presentation| p.counts[0] > 0 && p.counts[2] > 0;
        let mut seen = vec![false; self.items * self.items];
        shown.iter().filter(both).any(|p| {
            seen[p.left * self.items + p.right] = true;
            !self.side || seen[p.right * self.items + p.left]
        })
    }

    /// For each answer that was given, by how much it rises against each other one along the parameters; times 2,
    /// so that the numbers are whole.
    pub(super) fn rows(self, shown: &[Presentation]) -> Vec<Vec<i64>> {
        const DOUBLED: [[i64; 4]; 3] = [[2, 0, 1, 0], [1, 1, 0, 2], [0, 2, -1, 0]];
        let mut rows = Vec::new();
        for p in shown {
            let places = self.places(p.left, p.right);
            let answers = [0, 1, 2].into_iter().filter(|answer| self.ties || *answer != 1);
            for given in answers.clone().filter(|answer| p.counts[*answer] > 0) {
                for other in answers.clone().filter(|answer| *answer != given) {
                    let mut row = vec![0; self.parameters()];
                    for (c, place) in places.iter().enumerate() {
                        let rise = DOUBLED[given][c] - DOUBLED[other][c];
                        match place {
                            Place::None => {}
                            Place::One(at) => row[*at] += rise,
                            Place::MinusAllWorths => {
                                row[..self.items - 1].iter_mut().for_each(|x| *x -= rise);
                            }
                        }
                    }
                    rows.push(row);
                }
            }
        }
        rows
    }

    /// Whether the side bias can be told from the worths: not where every pair that was shown has an order that a
    /// scale of the items gives it.
    pub(super) fn side_is_told(self, shown: &[Presentation]) -> bool {
        let with = Self { side: true, ties: false, worths: true, ..self };
        let without = Self { side: false, ..with };
        let all: Vec<Presentation> =
            shown.iter().map(|p| Presentation { counts: [1, 0, 1], ..*p }).collect();
        let of = |model: Self| rank(&model.rows(&all), model.parameters());
        of(with) > of(without)
    }
}

/// The group of items that nobody outside won against or tied with: of the sets "an item and all that are above
/// it in any number of wins" the smallest one; all items if each is above each other.
fn undominated(wins: &[Vec<bool>]) -> Vec<usize> {
    let items = wins.len();
    let above = |start: usize| {
        let mut seen = vec![false; items];
        let mut open = vec![start];
        seen[start] = true;
        while let Some(item) = open.pop() {
            for other in 0..items {
                if !seen[other] && wins[other][item] {
                    seen[other] = true;
                    open.push(other);
                }
            }
        }
        (0..items).filter(|item| seen[*item]).collect::<Vec<usize>>()
    };
    (0..items).map(above).min_by_key(Vec::len).unwrap_or_default()
}
