//! The columns of a mixed model: coded fixed effects, and random effects in an order in which their system is
//! solved quickly.

use std::collections::HashMap;
use std::ops::Range;

use crate::table::factor::Factor;

/// Most effects of a block that is eliminated: beyond it a block costs more than it saves.
const LARGEST_BLOCK: usize = 128;

/// A fixed effect: a factor, or the interaction of several, by their places among the factors.
pub(super) type FixedTerm = Vec<usize>;

/// Fixed effects coded against the first level of each factor.
#[derive(Clone)]
pub(super) struct Fixed {
    /// Names as R has them: `methodlsts`, `methodlsts:trainingother`.
    pub names: Vec<String>,
    /// Rows x columns, a row after the other.
    pub values: Vec<f64>,
}

impl Fixed {
    /// The columns of some terms.
    pub(super) fn of(factors: &[Factor], terms: &[FixedTerm], rows: usize) -> Self {
        // A column is 1 where each factor of its term has the level that it names.
        let mut columns: Vec<Vec<(usize, u32)>> = Vec::new();
        for term in terms {
            let mut own: Vec<Vec<(usize, u32)>> = vec![Vec::new()];
            for &factor in term {
                let mut more = Vec::new();
                // As in R the levels of the first factor change quickest.
                for level in 1..factors[factor].levels.len() as u32 {
                    more.extend(
                        own.iter().map(|own| [own.as_slice(), &[(factor, level)]].concat()),
                    );
                }
                own = more;
            }
            columns.extend(own);
        }
        let name = |column: &Vec<(usize, u32)>| {
            let part = |(factor, level): &(usize, u32)| {
                format!("{}{}", factors[*factor].name, factors[*factor].levels[*level as usize])
            };
            column.iter().map(part).collect::<Vec<_>>().join(":")
        };
        let mut values = Vec::with_capacity(rows * columns.len());
        for row in 0..rows {
            values.extend(columns.iter().map(|column| {
                let all =
                    column.iter().all(|(factor, level)| factors[*factor].codes[row] == *level);
                f64::from(u8::from(all))
            }));
        }
        Self { names: columns.iter().map(name).collect(), values }
    }

    pub(super) fn columns(&self) -> usize {
        self.names.len()
    }
}

/// Answers that share the effects of a block, and those effects.
#[derive(Clone)]
pub(super) struct Block {
    /// Answers, in the order of the layout.
    pub rows: Range<usize>,
    /// Its first effect.
    pub first: usize,
    /// How many there are.
    pub size: usize,
    /// How many blocks it represents (see [`Layout::merged`]).
    pub count: usize,
}

/// The random effects, ordered: first those that are eliminated, block by block (of each person, say, the person's
/// own effect and those of the person with each method), then the rest.
#[derive(Clone)]
pub(super) struct Layout {
    /// The answers in the order of the blocks, as places in the data.
    pub rows: Vec<usize>,
    pub blocks: Vec<Block>,
    /// The random terms by their places among the groupings: the eliminated ones first.
    pub terms: Vec<usize>,
    /// How many of the terms are eliminated.
    pub eliminated: usize,
    /// Effects in blocks, and in the rest.
    pub in_blocks: usize,
    pub in_rest: usize,
    /// The effect of each answer (in the order of `rows`) of each term (in the order of `terms`).
    pub effect: Vec<u32>,
}

impl Layout {
    /// Of groupings that have an entry for each of the answers.
    pub(super) fn of(groupings: &[&Factor], rows: usize) -> Self {
        Self::of_effects(groupings, &(0..groupings.len()).collect::<Vec<_>>(), rows)
    }

    /// Of groupings of which some have effects in common: `effects` has the same number for those, and they have the same
    /// levels. So an answer about two items has the effects of both.
    pub(super) fn of_effects(groupings: &[&Factor], effects: &[usize], rows: usize) -> Self {
        let mut family = family(groupings);
        // Groupings with effects in common stand on one side.
        let apart: Vec<usize> = (0..groupings.len()).filter(|own| !family.contains(own)).collect();
        family.retain(|own| !apart.iter().any(|other| effects[*other] == effects[*own]));
        let mut terms = family.clone();
        terms.extend((0..groupings.len()).filter(|term| !family.contains(term)));
        let eliminated = family.len();
        // The coarsest of the family stands last and says which block an answer is in.
        let block_of = |row: usize| family.last().map_or(0, |term| groupings[*term].codes[row]);
        let mut order: Vec<usize> = (0..rows).collect();
        // Within a block by the rest, so that answers to the same clips have the same places.
        let of_rest =
            |row: usize| terms[eliminated..].iter().map(move |t| groupings[*t].codes[row]);
        order.sort_by(|a, b| {
            block_of(*a).cmp(&block_of(*b)).then_with(|| of_rest(*a).cmp(of_rest(*b)))
        });
        let mut effect = vec![0; rows * terms.len()];
        let mut blocks: Vec<Block> = Vec::new();
        let mut known: HashMap<(usize, u32), u32> = HashMap::new();
        let mut next = 0;
        for (place, &row) in order.iter().enumerate() {
            let starts = place == 0 || block_of(order[place - 1]) != block_of(row);
            if starts {
                blocks.push(Block { rows: place..place, first: next, size: 0, count: 1 });
            }
            for (position, term) in family.iter().enumerate() {
                let of = (effects[*term], groupings[*term].codes[row]);
                let own = known.entry(of).or_insert_with(|| {
                    next += 1;
                    next as u32 - 1
                });
                effect[place * terms.len() + position] = *own;
            }
            if let Some(block) = blocks.last_mut() {
                block.rows.end = place + 1;
                block.size = next - block.first;
            }
        }
        let in_blocks = next;
        let mut begins: HashMap<usize, usize> = HashMap::new();
        for (position, term) in terms.iter().enumerate().skip(eliminated) {
            let first = *begins.entry(effects[*term]).or_insert_with(|| {
                let first = next;
                next += groupings[*term].levels.len();
                first
            });
            for (place, &row) in order.iter().enumerate() {
                effect[place * terms.len() + position] = first as u32 + groupings[*term].codes[row];
            }
        }
        Self {
            rows: order,
            blocks,
            terms,
            eliminated,
            in_blocks,
            in_rest: next - in_blocks,
            effect,
        }
    }

    /// The effects of an answer, one a term.
    #[inline(always)]
    pub(super) fn effects(&self, place: usize) -> &[u32] {
        &self.effect[place * self.terms.len()..][..self.terms.len()]
    }

    pub(super) fn size(&self) -> usize {
        self.in_blocks + self.in_rest
    }

    /// Blocks of the same design merged into one: those whose answers have the same effects, counted from the first of the
    /// block, and the same of the rest (where all people see all clips, all blocks). Returns also the numbers of the
    /// blocks that each merged block represents; the first of them gives it its answers.
    pub(super) fn merged(&self) -> (Self, Vec<Vec<usize>>) {
        let terms = self.terms.len();
        let mut known: HashMap<Vec<u32>, usize> = HashMap::new();
        let mut members: Vec<Vec<usize>> = Vec::new();
        for (number, block) in self.blocks.iter().enumerate() {
            let own = &self.effect[block.rows.start * terms..block.rows.end * terms];
            let relative = own.iter().enumerate().map(|(i, effect)| {
                let from = if i % terms < self.eliminated { block.first } else { 0 };
                effect - from as u32
            });
            let place = *known.entry(relative.collect()).or_insert(members.len());
            match members.get_mut(place) {
                Some(same) => same.push(number),
                None => members.push(vec![number]),
            }
        }
        let in_blocks: usize = members.iter().map(|same| self.blocks[same[0]].size).sum();
        let (mut blocks, mut rows, mut effect) = (Vec::new(), Vec::new(), Vec::new());
        let mut first = 0;
        for same in &members {
            let block = &self.blocks[same[0]];
            let start = rows.len();
            rows.extend_from_slice(&self.rows[block.rows.clone()]);
            for place in block.rows.clone() {
                let own = self.effects(place).iter().enumerate();
                effect.extend(own.map(|(term, effect)| match term < self.eliminated {
                    true => effect - block.first as u32 + first as u32,
                    false => effect - self.in_blocks as u32 + in_blocks as u32,
                }));
            }
            blocks.push(Block {
                rows: start..rows.len(),
                first,
                size: block.size,
                count: same.len(),
            });
            first += block.size;
        }
        let terms = self.terms.clone();
        let (eliminated, in_rest) = (self.eliminated, self.in_rest);
        (Self { rows, blocks, terms, eliminated, in_blocks, in_rest, effect }, members)
    }
}

/// The groupings that are eliminated: each is part of the last, the coarsest, and they hold the most effects.
fn family(groupings: &[&Factor]) -> Vec<usize> {
    let levels = |term: &usize| groupings[*term].levels.len();
    let mut best: Vec<usize> = Vec::new();
    for coarsest in 0..groupings.len() {
        let mut finer: Vec<usize> = (0..groupings.len()).filter(|term| *term != coarsest).collect();
        finer.retain(|term| is_part(groupings[*term], groupings[coarsest]));
        finer.sort_by_key(|term| std::cmp::Reverse(levels(term)));
        let mut own = vec![coarsest];
        for term in finer.into_iter().rev() {
            let mut joined = vec![term];
            joined.extend(&own);
            if largest_block(groupings, &joined) <= LARGEST_BLOCK {
                own = joined;
            }
        }
        let effects = |family: &[usize]| family.iter().map(levels).sum::<usize>();
        if effects(&own) > effects(&best) {
            best = own;
        }
    }
    best
}

/// Whether all answers of a level of the finer grouping have one level of the coarser one.
pub(super) fn is_part(finer: &Factor, coarser: &Factor) -> bool {
    let mut of = vec![Factor::MISSING; finer.levels.len()];
    finer.codes.iter().zip(&coarser.codes).all(|(fine, coarse)| {
        let known = &mut of[*fine as usize];
        let same = *known == Factor::MISSING || *known == *coarse;
        *known = *coarse;
        same
    })
}

/// The most effects that a level of the coarsest grouping of a family has.
fn largest_block(groupings: &[&Factor], family: &[usize]) -> usize {
    let Some(coarsest) = family.last() else { return 0 };
    let mut counts = vec![0; groupings[*coarsest].levels.len()];
    for term in family {
        let mut seen = vec![false; groupings[*term].levels.len()];
        for (own, block) in groupings[*term].codes.iter().zip(&groupings[*coarsest].codes) {
            if !std::mem::replace(&mut seen[*own as usize], true) {
                counts[*block as usize] += 1;
            }
        }
    }
    counts.into_iter().max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factor(name: &str, codes: Vec<u32>) -> Factor {
        let most = codes.iter().max().map_or(0, |most| *most + 1);
        Factor { name: name.to_owned(), levels: (0..most).map(|l| l.to_string()).collect(), codes }
    }

    #[test]
    fn people_with_their_methods_are_blocks_and_clips_the_rest() {
        // Three people, two segments, two methods, everybody everything.
        let (mut p, mut pm, mut s, mut c) = (vec![], vec![], vec![], vec![]);
        for (segment, method, person) in
            (0..2).flat_map(|s| (0..2).flat_map(move |m| (0..3).map(move |p| (s, m, p))))
        {
            p.push(person);
            pm.push(person * 2 + method);
            s.push(segment);
            c.push(segment * 2 + method);
        }
        let terms = [factor("p", p), factor("pm", pm), factor("s", s), factor("c", c)];
        let layout = Layout::of(&terms.each_ref(), 12);
        assert_eq!((&layout.terms[..], layout.eliminated), (&[1, 0, 2, 3][..], 2));
        let sizes: Vec<_> = layout.blocks.iter().map(|b| (b.size, b.rows.len())).collect();
        assert_eq!(sizes, [(3, 4); 3]);
        assert_eq!((layout.in_blocks, layout.in_rest), (9, 6));
        for (place, row) in layout.rows.iter().enumerate() {
            let own = layout.effects(place);
            let block = &layout.blocks[terms[0].codes[*row] as usize];
            assert!(block.rows.contains(&place));
            assert!((block.first..block.first + 3).contains(&(own[0] as usize)));
            assert_eq!(own[3], 9 + 2 + terms[3].codes[*row]);
        }
    }

    #[test]
    fn columns_are_coded_against_the_first_level_as_in_r() {
        let both = [factor("m", vec![0, 1, 2, 0, 1, 2]), factor("t", vec![0, 0, 0, 1, 1, 1])];
        let fixed = Fixed::of(&both, &[vec![0], vec![1], vec![0, 1]], 6);
        assert_eq!(fixed.names, ["m1", "m2", "t1", "m1:t1", "m2:t1"]);
        assert_eq!(fixed.values[5 * 5..], [0.0, 1.0, 1.0, 0.0, 1.0]);
    }
}
