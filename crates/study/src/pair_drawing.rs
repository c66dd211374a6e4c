//! The pairs of an active schedule: batches of those whose answers are expected to tell most about the worths of the
//! items, under all answers so far (Lindley 1956; Li, Mantiuk et al. 2018).
//!
//! A batch is the spanning tree of greatest expected information over the items, so that every item is asked about in
//! it. The page draws it in a module of its own, from its own answers and, where a server is there, from those of all
//! people; cells and sides are drawn from the stream `active/COMPONENT/BATCH`.

use mimique_adaptive::{Comparison, Worths, all_pairs, information, spanning_tree};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::order::Draw;
use crate::study_file::DealtPairs;

/// Standard deviation of the worths before the first answer, log scale.
const PRIOR_SD: f64 = 1.0;

/// How often one of two items was chosen over the other.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
pub struct PairCount {
    /// Both levels, the lower name first.
    pub items: [String; 2],
    /// Answers that chose the first, that saw no difference, that chose the second.
    pub answers: [u64; 3],
}

/// How often each of two items was chosen over the other, in the order of the items.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct PairCounts(pub Vec<PairCount>);

impl PairCounts {
    /// Adds choices between the items of a pair.
    pub fn add(&mut self, PairCount { items, answers }: &PairCount) {
        let place = self.0.binary_search_by(|own| own.items.cmp(items));
        match place {
            Ok(at) => self.0[at].answers.iter_mut().zip(answers).for_each(|(own, new)| *own += new),
            Err(at) => self.0.insert(at, PairCount { items: items.clone(), answers: *answers }),
        }
    }

    /// Adds those of somebody else.
    pub fn add_all(&mut self, others: &Self) {
        others.0.iter().for_each(|count| self.add(count));
    }

    /// Adds a choice: which of left and right was chosen, or neither.
    pub fn chosen(&mut self, [left, right]: [&str; 2], chosen: Option<&str>) {
        let mut items = [left, right].map(str::to_owned);
        items.sort();
        let answers = match chosen {
            None => [0, 1, 0],
            Some(chosen) if *chosen == items[0] => [1, 0, 0],
            Some(_) => [0, 0, 1],
        };
        self.add(&PairCount { items, answers });
    }

    /// Adds a participant's answers to the pairs of a block with an active schedule.
    pub fn add_own(&mut self, pairs: &DealtPairs, own: &[OwnChoice]) {
        for OwnChoice { left, right, answer } in own {
            let (Some(answer), Some(left), Some(right)) =
                (answer.as_deref(), pairs.level(left), pairs.level(right))
            else {
                continue;
            };
            let chosen = match answer {
                "left" => Some(left),
                "right" => Some(right),
                _ => None,
            };
            self.chosen([left, right], chosen);
        }
    }
}

/// What a participant answered to a pair.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OwnChoice {
    /// The clip on the left (of clips in turn, the first).
    pub left: String,
    /// The other one.
    pub right: String,
    /// `left`, `right`, `same`; none without an answer.
    pub answer: Option<String>,
}

/// What a batch is drawn from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct PairRequest {
    /// Trial that waits for it.
    pub step: String,
    /// The block.
    pub component: String,
    /// What the block can show.
    pub pairs: DealtPairs,
    /// Seed of the study.
    pub seed: u64,
    /// Hash of the study file.
    pub config_hash: String,
    /// The participant's slot.
    pub slot: u64,
    /// Number of the batch, from 1.
    pub batch: u32,
    /// Trials that are left, at most so many pairs are drawn.
    pub left: usize,
    /// The participant's answers so far.
    pub own: Vec<OwnChoice>,
    /// Those of all others; none where no server tells them.
    #[serde(default)]
    pub others: PairCounts,
}

/// A batch of pairs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct DrawnPairs {
    /// The pairs: the left clip, the right clip.
    pub pairs: Vec<[String; 2]>,
    /// Answers that they were drawn under, of all people.
    pub answers: u64,
    /// SHA-256 of these answers, hexadecimal.
    pub hash: String,
}

impl PairRequest {
    /// The batch; empty where the block has fewer than two levels.
    pub fn draw(&self) -> DrawnPairs {
        let levels = &self.pairs.levels;
        let (items, place) = (levels.len(), |clip: &str| self.pairs.place(clip));
        let mut comparisons = Vec::new();
        let mut answers = 0;
        let item = |level: &str| levels.iter().position(|own| own == level);
        for PairCount { items: [one, other], answers: [first, same, second] } in &self.others.0 {
            let (Some(a), Some(b)) = (item(one), item(other)) else { continue };
            let count = first + same + second;
            answers += count;
            let wins = *first as f64 + 0.5 * *same as f64;
            comparisons.push(Comparison { a, b, wins, answers: count as f64 });
        }
        // How often each item stood left for this person, less how often right.
        let mut lean = vec![0_i64; items];
        for choice in &self.own {
            let (Some([a, _]), Some([b, _])) = (place(&choice.left), place(&choice.right)) else {
                continue;
            };
            lean[a] += 1;
            lean[b] -= 1;
            let share = match choice.answer.as_deref() {
                Some("left") => 1.0,
                Some("right") => 0.0,
                Some(_) => 0.5,
                None => continue,
            };
            answers += 1;
            comparisons.push(Comparison::one(a, b, share));
        }
        let told = serde_json::to_string(&(&self.others, &self.own)).unwrap_or_default();
        let hash = hex::encode(Sha256::digest(told));
        if items < 2 {
            return DrawnPairs { pairs: Vec::new(), answers, hash };
        }
        let worths = Worths::of(items, &comparisons, PRIOR_SD);
        let tree = spanning_tree(items, &information(&worths, &all_pairs(items)));
        let draw = Draw {
            seed: self.seed,
            config_hash: &self.config_hash,
            participant: self.slot,
            condition: None,
        };
        let mut stream = draw.stream(&format!("active/{}/{}", self.component, self.batch));
        let cells = self.pairs.clips.len() / items;
        let mut tree: Vec<[usize; 2]> = tree.iter().map(|pair| [pair.a, pair.b]).collect();
        tree.truncate(self.left);
        // The most informative pair would always come first.
        stream.shuffle(&mut tree);
        let pair = |[a, b]: [usize; 2]| {
            let cell = stream.below(cells);
            let coin = stream.below(2) == 1;
            let exchanged = match lean[a].cmp(&lean[b]) {
                std::cmp::Ordering::Equal => coin,
                unequal => unequal.is_gt(),
            };
            let [left, right] = if exchanged { [b, a] } else { [a, b] };
            lean[left] += 1;
            lean[right] -= 1;
            [left, right].map(|item| self.pairs.clips[cell * items + item].clone())
        };
        DrawnPairs { pairs: tree.into_iter().map(pair).collect(), answers, hash }
    }
}

impl DealtPairs {
    /// Of an active schedule: the level of a clip.
    fn level(&self, clip: &str) -> Option<&str> {
        self.levels.get(self.place(clip)?[0]).map(String::as_str)
    }

    /// Item and cell of a clip.
    fn place(&self, clip: &str) -> Option<[usize; 2]> {
        let items = self.levels.len().max(1);
        let place = self.clips.iter().position(|own| own == clip)?;
        Some([place % items, place / items])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(batch: u32, own: Vec<OwnChoice>, others: Vec<PairCount>) -> PairRequest {
        let levels: Vec<String> = ["a", "b", "c", "d"].map(str::to_owned).to_vec();
        let cells = ["joy", "fear"].into_iter();
        let clip = |cell| levels.iter().map(move |level| format!("{cell}.{level}"));
        let clips = cells.flat_map(clip).collect();
        let pairs =
            DealtPairs { clips, levels: levels.clone(), active: 9, ..DealtPairs::default() };
        PairRequest {
            step: "duels/active-1".to_owned(),
            component: "duels".to_owned(),
            pairs,
            seed: 1,
            config_hash: "c".to_owned(),
            slot: 3,
            batch,
            left: 9,
            own,
            others: PairCounts(others),
        }
    }

    fn count(items: [&str; 2], answers: [u64; 3]) -> PairCount {
        PairCount { items: items.map(str::to_owned), answers }
    }

    #[test]
    fn a_batch_joins_all_items_and_follows_from_seed_and_answers() {
        let first = request(1, Vec::new(), Vec::new()).draw();
        assert_eq!(first, request(1, Vec::new(), Vec::new()).draw());
        assert_eq!((first.pairs.len(), first.answers), (3, 0));
        let mut shown: Vec<&str> =
            first.pairs.iter().flatten().map(|clip| clip.rsplit('.').next().unwrap()).collect();
        shown.sort_unstable();
        shown.dedup();
        assert_eq!(shown, ["a", "b", "c", "d"]);
        for [left, right] in &first.pairs {
            let cell = |clip: &str| clip.split('.').next().unwrap().to_owned();
            assert_eq!(cell(left), cell(right), "a pair is of one cell");
        }
        assert_ne!(first.pairs, request(2, Vec::new(), Vec::new()).draw().pairs);
        let few = PairRequest { left: 1, ..request(1, Vec::new(), Vec::new()) };
        assert_eq!(few.draw().pairs.len(), 1);
    }

    #[test]
    fn what_is_known_is_not_asked_again() {
        // a and b are nearly alike; everybody prefers d to all others.
        let others = vec![
            count(["a", "d"], [0, 0, 200]),
            count(["b", "d"], [0, 0, 200]),
            count(["c", "d"], [0, 0, 200]),
            count(["a", "b"], [3, 0, 3]),
            count(["a", "c"], [40, 0, 40]),
            count(["b", "c"], [40, 0, 40]),
        ];
        let drawn = request(1, Vec::new(), others).draw();
        assert_eq!(drawn.answers, 766);
        let asks = |one: &str, other: &str| {
            drawn.pairs.iter().any(|pair| {
                pair.iter().any(|clip| clip.ends_with(one))
                    && pair.iter().any(|clip| clip.ends_with(other))
            })
        };
        assert!(asks(".a", ".b"), "{:?}", drawn.pairs);
        let with_d = drawn.pairs.iter().filter(|pair| pair.iter().any(|clip| clip.ends_with(".d")));
        assert_eq!(with_d.count(), 1, "d is joined by one pair alone: {:?}", drawn.pairs);
    }

    #[test]
    fn own_answers_count_and_sides_are_evened_out() {
        let own = |left: &str, right: &str| OwnChoice {
            left: format!("joy.{left}"),
            right: format!("joy.{right}"),
            answer: Some("left".to_owned()),
        };
        let told = vec![own("a", "b"), own("a", "c"), own("a", "d")];
        let drawn = request(1, told.clone(), Vec::new()).draw();
        assert_eq!(drawn.answers, 3);
        for [left, right] in &drawn.pairs {
            assert!(!left.ends_with(".a"), "a stood left three times: {left} {right}");
        }
        assert_ne!(drawn.hash, request(1, told[..2].to_vec(), Vec::new()).draw().hash);
    }
}
