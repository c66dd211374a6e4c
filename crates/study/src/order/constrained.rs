//! Random orders under constraints: no more than k alike in a row, a minimum distance of repeats.

use std::collections::BTreeMap;

use super::Stream;

/// One constraint over the parts.
pub(super) struct Rule {
    /// Value of each part; a part without one ends a run.
    pub values: Vec<Option<u32>>,
    /// Most parts in a row with the same value.
    pub at_most_alike: usize,
    /// Fewest places from one part with a value to the next (1 = neighbours allowed).
    pub minimum_distance: usize,
}

/// Why there is no order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Search {
    /// There is none: every possibility was tried, or counting shows it.
    Impossible,
    /// None was found with the steps allowed.
    OutOfBudget,
}

/// Shuffles tried before an order is built step by step. While one of them fits, every order that
/// fits is equally likely.
const SHUFFLES: usize = 200;
/// Times an order is begun anew from the participant's stream.
const STARTS: usize = 20;
/// Times an order is begun anew for the order that proves a study feasible.
const PROOF_STARTS: usize = 200;
/// Times an order is begun anew to see whether a sample has one: the first of those of the proof.
const QUICK_STARTS: usize = 4;
/// Steps of one start, for each part.
const STEPS_A_PART: usize = 200;

/// An order of `count` parts (as indices) that keeps to the rules.
pub(super) fn arrange(
    count: usize,
    rules: &[Rule],
    stream: &mut Stream,
) -> Result<Vec<usize>, Search> {
    let mut order: Vec<usize> = (0..count).collect();
    if rules.is_empty() {
        stream.shuffle(&mut order);
        return Ok(order);
    }
    for _ in 0..SHUFFLES {
        stream.shuffle(&mut order);
        if rules.iter().all(|rule| rule.holds(&order)) {
            return Ok(order);
        }
    }
    let builder = Builder::new(count, rules);
    let classes = match builder.search(stream, STARTS) {
        // The same search for every participant and at the check: what it found once, it finds again.
        Err(Search::OutOfBudget) => builder.proof(),
        other => other,
    }?;
    Ok(builder.parts_of(&classes, stream))
}

/// The order on which [`arrange`] falls back; the same whoever asks.
pub(super) fn prove_arrangement(count: usize, rules: &[Rule]) -> Result<Vec<usize>, Search> {
    if rules.is_empty() {
        return Ok((0..count).collect());
    }
    let builder = Builder::new(count, rules);
    let classes = builder.proof()?;
    Ok(builder.parts_of(&classes, &mut proof_stream()))
}

/// Whether a short search finds an order; [`arrange`] then finds one for whoever asks.
pub(super) fn quickly_arranged(count: usize, rules: &[Rule]) -> bool {
    Builder::new(count, rules).search(&mut proof_stream(), QUICK_STARTS).is_ok()
}

/// The stream of the proof: [`Builder::proof`] begins as [`quickly_arranged`] does.
fn proof_stream() -> Stream {
    Stream::new(0, "", None, "proof")
}

impl Rule {
    fn holds(&self, order: &[usize]) -> bool {
        let mut run = 0;
        let mut previous = None;
        let mut last_place: BTreeMap<u32, usize> = BTreeMap::new();
        for (place, &part) in order.iter().enumerate() {
            let value = self.values[part];
            run = if value.is_some() && value == previous { run + 1 } else { 1 };
            previous = value;
            let Some(value) = value else { continue };
            if run > self.at_most_alike {
                return false;
            }
            if last_place
                .insert(value, place)
                .is_some_and(|before| place - before < self.minimum_distance)
            {
                return false;
            }
        }
        true
    }
}

/// Builds an order of classes: parts with the same values everywhere can stand for one another.
struct Builder<'a> {
    count: usize,
    rules: &'a [Rule],
    /// Values of each class, one a rule.
    class_values: Vec<Vec<Option<u32>>>,
    /// Parts of each class.
    members: Vec<Vec<usize>>,
}

/// How far an order has come.
struct Partial {
    classes: Vec<usize>,
    left: Vec<usize>,
    /// Per rule and value: how many parts are left.
    values_left: Vec<Vec<usize>>,
}

impl<'a> Builder<'a> {
    fn new(count: usize, rules: &'a [Rule]) -> Self {
        let mut classes: BTreeMap<Vec<Option<u32>>, Vec<usize>> = BTreeMap::new();
        for part in 0..count {
            let values = rules.iter().map(|rule| rule.values[part]).collect();
            classes.entry(values).or_default().push(part);
        }
        let (class_values, members) = classes.into_iter().unzip();
        Self { count, rules, class_values, members }
    }

    fn search(&self, stream: &mut Stream, starts: usize) -> Result<Vec<usize>, Search> {
        for _ in 0..starts {
            match self.start(stream) {
                Err(Search::OutOfBudget) => {}
                settled => return settled,
            }
        }
        Err(Search::OutOfBudget)
    }

    fn proof(&self) -> Result<Vec<usize>, Search> {
        self.search(&mut proof_stream(), PROOF_STARTS)
    }

    /// One depth-first search with a budget; without recursion, so that no input is too long.
    fn start(&self, stream: &mut Stream) -> Result<Vec<usize>, Search> {
        let mut partial = self.nothing_placed();
        if !self.can_be_completed(&partial) {
            return Err(Search::Impossible);
        }
        let mut steps = STEPS_A_PART * self.count;
        let mut choices: Vec<Vec<usize>> = vec![self.choices(&partial, stream)];
        loop {
            if partial.classes.len() == self.count {
                return Ok(partial.classes);
            }
            let Some(open) = choices.last_mut() else { return Err(Search::Impossible) };
            match open.pop() {
                None => {
                    choices.pop();
                    self.take_back(&mut partial);
                }
                Some(class) => {
                    if steps == 0 {
                        return Err(Search::OutOfBudget);
                    }
                    steps -= 1;
                    self.place(&mut partial, class);
                    if self.can_be_completed(&partial) {
                        choices.push(self.choices(&partial, stream));
                    } else {
                        self.take_back(&mut partial);
                    }
                }
            }
        }
    }

    fn nothing_placed(&self) -> Partial {
        let values_left = self
            .rules
            .iter()
            .map(|rule| {
                let kinds = rule.values.iter().flatten().max().map_or(0, |&most| most as usize + 1);
                let mut left = vec![0; kinds];
                for &value in rule.values.iter().flatten() {
                    left[value as usize] += 1;
                }
                left
            })
            .collect();
        Partial {
            classes: Vec::with_capacity(self.count),
            left: self.members.iter().map(Vec::len).collect(),
            values_left,
        }
    }

    fn place(&self, partial: &mut Partial, class: usize) {
        partial.classes.push(class);
        partial.left[class] -= 1;
        for (rule, value) in self.class_values[class].iter().enumerate() {
            if let Some(value) = value {
                partial.values_left[rule][*value as usize] -= 1;
            }
        }
    }

    fn take_back(&self, partial: &mut Partial) {
        let Some(class) = partial.classes.pop() else { return };
        partial.left[class] += 1;
        for (rule, value) in self.class_values[class].iter().enumerate() {
            if let Some(value) = value {
                partial.values_left[rule][*value as usize] += 1;
            }
        }
    }

    /// The classes that may stand next, drawn without replacement in proportion to the parts left;
    /// the last one is tried first.
    fn choices(&self, partial: &Partial, stream: &mut Stream) -> Vec<usize> {
        let mut open: Vec<(usize, usize)> = (0..self.members.len())
            .filter(|&class| partial.left[class] > 0 && self.may_follow(partial, class))
            .map(|class| (class, partial.left[class]))
            .collect();
        let mut drawn = Vec::with_capacity(open.len());
        while !open.is_empty() {
            let total = open.iter().map(|(_, weight)| weight).sum();
            let mut ticket = stream.below(total);
            let index = open
                .iter()
                .position(|&(_, weight)| {
                    let here = ticket < weight;
                    ticket = ticket.saturating_sub(weight);
                    here
                })
                .unwrap_or(0);
            drawn.push(open.remove(index).0);
        }
        drawn.reverse();
        drawn
    }

    fn may_follow(&self, partial: &Partial, class: usize) -> bool {
        self.rules.iter().enumerate().all(|(number, rule)| {
            let Some(value) = self.class_values[class][number] else { return true };
            let placed = partial.classes.iter().rev().map(|&each| self.class_values[each][number]);
            let run = placed.clone().take_while(|each| *each == Some(value)).count();
            let near = rule.minimum_distance.saturating_sub(1);
            run < rule.at_most_alike && !placed.take(near).any(|each| each == Some(value))
        })
    }

    /// Whether counting leaves room for the parts that are left: exact for one rule of one kind,
    /// necessary for several.
    fn can_be_completed(&self, partial: &Partial) -> bool {
        let places = self.count - partial.classes.len();
        self.rules.iter().enumerate().all(|(number, rule)| {
            let mut placed = vec![None; partial.values_left[number].len()];
            if rule.minimum_distance > 1 {
                let window = partial.classes.len().saturating_sub(rule.minimum_distance);
                for (place, &class) in partial.classes.iter().enumerate().skip(window) {
                    if let Some(value) = self.class_values[class][number] {
                        placed[value as usize] = Some(place);
                    }
                }
            }
            let run_of = |value: u32| {
                let alike = |class: &&usize| self.class_values[**class][number] == Some(value);
                partial.classes.iter().rev().take_while(alike).count()
            };
            let last = partial.classes.last().and_then(|&class| self.class_values[class][number]);
            partial.values_left[number].iter().enumerate().all(|(value, &left)| {
                if left == 0 {
                    return true;
                }
                let run = if last == Some(value as u32) { run_of(value as u32) } else { 0 };
                // Each other part opens room for one more run.
                let room = (places - left)
                    .saturating_mul(rule.at_most_alike)
                    .saturating_add(rule.at_most_alike.saturating_sub(run));
                let soonest = placed[value]
                    .map_or(0, |place| place + rule.minimum_distance)
                    .max(partial.classes.len());
                let latest =
                    soonest.saturating_add((left - 1).saturating_mul(rule.minimum_distance));
                left <= room && latest < self.count
            })
        })
    }

    /// The parts for an order of classes: within a class, every assignment equally likely.
    fn parts_of(&self, classes: &[usize], stream: &mut Stream) -> Vec<usize> {
        let mut members = self.members.clone();
        for parts in &mut members {
            stream.shuffle(parts);
        }
        classes.iter().filter_map(|&class| members[class].pop()).collect()
    }
}
