//! Paired comparisons: who was shown which two items, in which order, and which one was chosen.

use crate::procedure::arguments::{Arguments, ProcedureOption};
use crate::refusal::{Refusal, Unfit};
use crate::table::Table;
use crate::table::factor::Factor;
use crate::table::sample::complete_rows;

/// What was chosen of two items.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Chosen {
    /// The item on the left, or the first one.
    Left,
    /// Neither: both are the same.
    Same,
    /// The item on the right, or the second one.
    Right,
}

impl Chosen {
    /// All answers, in the order of the counts.
    pub const ALL: [Self; 3] = [Self::Left, Self::Same, Self::Right];

    /// The word of a table.
    pub fn word(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Same => "same",
            Self::Right => "right",
        }
    }
}

/// One answer about two items.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Compared {
    /// Place of the participant.
    pub participant: usize,
    /// Place of the item on the left.
    pub left: usize,
    /// Place of the item on the right.
    pub right: usize,
    /// The answer.
    pub chosen: Chosen,
}

/// Answers about pairs of items.
#[derive(Debug, Clone, PartialEq)]
pub struct PairedComparisons {
    /// Names of the items, in the order of all results.
    pub items: Vec<String>,
    /// Names of the participants.
    pub participants: Vec<String>,
    /// The answers, in the order of the rows.
    pub answers: Vec<Compared>,
    /// Rows left out because of a missing value or an item that is not compared.
    pub dropped: usize,
}

/// The options that name the columns of paired comparisons.
pub(crate) const COMPARISON_OPTIONS: [ProcedureOption; 5] = [
    ProcedureOption::text(
        "participant",
        "Column of the participants, or several with commas between",
    )
    .required(),
    ProcedureOption::text("left", "Column of the item on the left, or shown first").required(),
    ProcedureOption::text("right", "Column of the item on the right, or shown second").required(),
    ProcedureOption::text("answer", "Column of the answer: left, right, same, or an item's name")
        .required(),
    ProcedureOption::list("items", "Items to compare, in this order"),
];

impl PairedComparisons {
    /// The comparisons that the options of a procedure name.
    pub(crate) fn named(table: &Table, arguments: &Arguments) -> Result<Self, Refusal> {
        let participant = table.combined_factor(arguments.needed("participant")?)?;
        let factor = |option: &str| arguments.factor(table, option);
        Self::of(
            &participant,
            [&factor("left")?, &factor("right")?],
            &factor("answer")?,
            arguments.list("items"),
        )
    }

    /// From columns. Items are those named, else all that occur, as the levels of a factor are ordered. An
    /// answer is `left`, `right` or `same`; or the name of the item that was chosen.
    ///
    /// # Errors
    /// An item beside itself, an answer that is none, an item that is named twice or never occurs.
    pub fn of(
        participant: &Factor,
        [left, right]: [&Factor; 2],
        answer: &Factor,
        items: &[String],
    ) -> Result<Self, Refusal> {
        let items = ItemNames::of(left, right, items)?;
        let complete = complete_rows(&[], &[participant, left, right, answer])?;
        let words = Words::of(answer);
        let mut dropped = complete.dropped();
        let mut rows = Vec::with_capacity(complete.len());
        let mut answers = Vec::with_capacity(complete.len());
        for row in complete.to_vec() {
            let (one, other) = (left.codes[row] as usize, right.codes[row] as usize);
            let (Some(one), Some(other)) = (items.of_left[one], items.of_right[other]) else {
                dropped += 1;
                continue;
            };
            if one == other {
                let item = items.names[one].clone();
                return Err(Unfit::ItemBesideItself { item, row: row + 1 }.into());
            }
            let names = [&items.names[one], &items.names[other]];
            let chosen = words.chosen(answer.codes[row] as usize, names).ok_or_else(|| {
                let word = answer.level(row).unwrap_or_default().to_owned();
                let pair = names.map(String::clone);
                Unfit::NotAnAnswer { column: answer.name.clone(), row: row + 1, word, pair }
            })?;
            rows.push(row);
            answers.push(Compared { participant: 0, left: one, right: other, chosen });
        }
        if answers.is_empty() {
            return Err(Refusal::NoRows { column: left.name.clone(), dropped });
        }
        let participant = participant.rows(&rows);
        for (own, code) in answers.iter_mut().zip(&participant.codes) {
            own.participant = *code as usize;
        }
        Ok(Self { items: items.names, participants: participant.levels, answers, dropped })
    }

    /// Whether anybody answered that both are the same.
    pub fn has_ties(&self) -> bool {
        self.answers.iter().any(|answer| answer.chosen == Chosen::Same)
    }

    /// Counts of the answers left, same and right for each order of each pair that was shown, by left item,
    /// then right item.
    pub fn presentations(&self) -> Vec<Presentation> {
        let items = self.items.len();
        let mut counts = vec![[0; 3]; items * items];
        for answer in &self.answers {
            counts[answer.left * items + answer.right][answer.chosen as usize] += 1;
        }
        let shown = |(place, counts): (usize, [u64; 3])| {
            (counts != [0; 3]).then(|| Presentation {
                left: place / items,
                right: place % items,
                counts,
            })
        };
        counts.into_iter().enumerate().filter_map(shown).collect()
    }

    /// The items in parts, each of which was compared with no other part.
    pub fn parts(&self) -> Vec<Vec<usize>> {
        let joined = self.answers.iter().map(|answer| (answer.left, answer.right));
        parts(self.items.len(), joined)
    }
}

/// A pair in one order, and how it was answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Presentation {
    /// The item on the left.
    pub left: usize,
    /// The item on the right.
    pub right: usize,
    /// Answers left, same, right.
    pub counts: [u64; 3],
}

/// The vertices in parts that edges join; each part, and the parts, by their first vertex.
pub(crate) fn parts(
    vertices: usize,
    edges: impl Iterator<Item = (usize, usize)>,
) -> Vec<Vec<usize>> {
    let mut part: Vec<usize> = (0..vertices).collect();
    for (a, b) in edges {
        let (low, high) = (part[a].min(part[b]), part[a].max(part[b]));
        if low != high {
            part.iter_mut().filter(|own| **own == high).for_each(|own| *own = low);
        }
    }
    let mut parts: Vec<Vec<usize>> = Vec::new();
    let mut place = vec![usize::MAX; vertices];
    for vertex in 0..vertices {
        let own = &mut place[part[vertex]];
        if *own == usize::MAX {
            *own = parts.len();
            parts.push(Vec::new());
        }
        parts[*own].push(vertex);
    }
    parts
}

/// The items and where the levels of both columns are among them.
struct ItemNames {
    names: Vec<String>,
    of_left: Vec<Option<usize>>,
    of_right: Vec<Option<usize>>,
}

impl ItemNames {
    fn of(left: &Factor, right: &Factor, named: &[String]) -> Result<Self, Refusal> {
        let cells = left.levels.iter().chain(&right.levels).map(|level| Some(level.as_str()));
        let number = |cell: &str| cell.parse().ok().filter(|value: &f64| value.is_finite());
        let all = Factor::from_cells(&left.name, cells, number);
        let both = match named {
            [] => all,
            named => all.restricted(named)?,
        };
        both.require_levels(2)?;
        let codes: Vec<Option<usize>> = both
            .codes
            .iter()
            .map(|code| (*code != Factor::MISSING).then_some(*code as usize))
            .collect();
        let (of_left, of_right) = codes.split_at(left.levels.len());
        Ok(Self { names: both.levels, of_left: of_left.to_vec(), of_right: of_right.to_vec() })
    }
}

/// What the levels of a column of answers mean.
enum Words {
    /// `left`, `right` and `same`, by level.
    Sides(Vec<Option<Chosen>>),
    /// Names of items, and `same`.
    Items(Vec<String>),
}

impl Words {
    fn of(answer: &Factor) -> Self {
        let side = |level: &String| Chosen::ALL.into_iter().find(|c| c.word() == level);
        let sides: Vec<Option<Chosen>> = answer.levels.iter().map(side).collect();
        let known = sides.iter().any(|side| matches!(side, Some(Chosen::Left | Chosen::Right)));
        if known { Self::Sides(sides) } else { Self::Items(answer.levels.clone()) }
    }

    fn chosen(&self, level: usize, [left, right]: [&String; 2]) -> Option<Chosen> {
        match self {
            Self::Sides(sides) => sides[level],
            Self::Items(levels) if levels[level] == *left => Some(Chosen::Left),
            Self::Items(levels) if levels[level] == *right => Some(Chosen::Right),
            Self::Items(levels) => (levels[level] == Chosen::Same.word()).then_some(Chosen::Same),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, items: &[&str]) -> Result<PairedComparisons, Refusal> {
        let table = Table::parse(text.as_bytes()).unwrap();
        let items: Vec<String> = items.iter().map(|item| (*item).to_owned()).collect();
        let factor = |name: &str| table.factor(name).unwrap();
        PairedComparisons::of(&factor("p"), [&factor("l"), &factor("r")], &factor("a"), &items)
    }

    #[test]
    fn answers_are_sides_or_names_of_items() {
        let sides = read("p,l,r,a\n1,x,y,left\n2,y,z,same\n1,z,x,right\n", &[]).unwrap();
        let names = read("p,l,r,a\n1,x,y,x\n2,y,z,same\n1,z,x,x\n", &[]).unwrap();
        assert_eq!(sides, names);
        assert_eq!((sides.items.join(""), sides.participants.len()), ("xyz".to_owned(), 2));
        assert!(sides.has_ties());
        let counts: Vec<[u64; 3]> = sides.presentations().iter().map(|p| p.counts).collect();
        assert_eq!(counts, [[1, 0, 0], [0, 1, 0], [0, 0, 1]]);
    }

    #[test]
    fn rows_without_an_answer_or_with_other_items_are_counted() {
        let all = "p,l,r,a\n1,x,y,left\n2,y,z,NA\n1,z,x,right\n3,x,y,right\n";
        assert_eq!(read(all, &[]).unwrap().dropped, 1);
        let some = read(all, &["y", "x"]).unwrap();
        assert_eq!((some.dropped, some.answers.len(), some.items.join("")), (2, 2, "yx".into()));
        assert_eq!(some.participants, ["1", "3"]);
    }

    #[test]
    fn what_is_no_comparison_is_refused_with_its_row() {
        let said = |text: &str, items: &[&str]| read(text, items).unwrap_err().to_string();
        let beside = said("p,l,r,a\n1,x,y,left\n1,x,x,left\n", &[]);
        assert!(beside.contains("row 2") && beside.contains("\"x\""), "{beside}");
        let word = said("p,l,r,a\n1,x,y,left\n1,x,y,up\n", &[]);
        assert!(word.contains("row 2: \"up\"") && word.contains("left, right or same"), "{word}");
        let absent = said("p,l,r,a\n1,x,y,left\n", &["x", "q"]);
        assert!(absent.contains("\"q\""), "{absent}");
        let one = said("p,l,r,a\n1,x,y,left\n", &["x"]);
        assert!(one.contains("at least 2"), "{one}");
    }

    #[test]
    fn parts_are_named_by_their_first_item() {
        let found = parts(6, [(4, 1), (0, 5), (1, 4)].into_iter());
        assert_eq!(found, [vec![0, 5], vec![1, 4], vec![2], vec![3]]);
    }
}
