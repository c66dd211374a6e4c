//! A decision tree: CART with Gini impurity, some columns drawn at each node (Breiman, Machine
//! Learning 2001), leaves of one label.

use std::hint::select_unpredictable;

use mimique_stats::Stream;
use serde::{Deserialize, Serialize};

use crate::Examples;

/// A node: a question, or a leaf.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
enum Node {
    /// Rows whose number in `column` is at most `threshold` go to the next node, others to `right`.
    Question { column: u32, threshold: f64, right: u32 },
    /// Share of each label that is there.
    Leaf { shares: Vec<(u32, f64)> },
}

/// A tree, its nodes in the order in which they were grown: depth first, left first.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Tree {
    nodes: Vec<Node>,
}

/// Fewer numbers between two rows than this are one number.
const SAME: f64 = 1e-7;

/// A cut of a node's rows, and how impure both sides are after it.
struct Cut {
    impurity: f64,
    column: usize,
    threshold: f64,
}

/// Rows that go down a tree side by side.
const SIDE: usize = 8;

/// A node on the way down.
struct Step {
    threshold: f64,
    column: u32,
    right: u32,
}

/// What is used again at every node.
struct Growth<'a> {
    examples: &'a Examples,
    /// Columns drawn at a node.
    drawn: usize,
    stream: Stream,
    columns: Vec<usize>,
    /// A column's numbers at a node, with their labels.
    sorted: Vec<(f64, usize)>,
    left: Vec<usize>,
    right: Vec<usize>,
}

impl Tree {
    /// Grow a tree on rows, which may stand there several times, drawing `drawn` columns a node.
    pub(crate) fn grow(
        examples: &Examples,
        mut rows: Vec<usize>,
        drawn: usize,
        stream: Stream,
    ) -> Self {
        let mut growth = Growth {
            examples,
            drawn,
            stream,
            columns: (0..examples.rows().width()).collect(),
            sorted: Vec::with_capacity(rows.len()),
            left: vec![0; examples.count()],
            right: vec![0; examples.count()],
        };
        let mut nodes = Vec::new();
        // Ranges of `rows` still to grow, and the question that they answer with no.
        let mut open = vec![(0..rows.len(), None)];
        while let Some((range, parent)) = open.pop() {
            let place = nodes.len();
            if let Some(parent) = parent
                && let Some(Node::Question { right, .. }) = nodes.get_mut::<usize>(parent)
            {
                *right = place as u32;
            }
            let own = &mut rows[range.clone()];
            let Some(cut) = growth.best_cut(own) else {
                nodes.push(growth.leaf(own));
                continue;
            };
            let middle = range.start + growth.part(own, &cut);
            let (column, threshold) = (cut.column as u32, cut.threshold);
            nodes.push(Node::Question { column, threshold, right: 0 });
            open.push((middle..range.end, Some(place)));
            open.push((range.start..middle, None));
        }
        Self { nodes }
    }

    /// Add the share of each label in the leaf of a row.
    pub(crate) fn add_shares(&self, row: &[f64], sum: &mut [f64]) {
        let mut place = 0;
        while let Node::Question { column, threshold, right } = &self.nodes[place] {
            let left = row[*column as usize] <= *threshold;
            place = if left { place + 1 } else { *right as usize };
        }
        self.add_leaf(place, sum);
    }

    fn add_leaf(&self, place: usize, sum: &mut [f64]) {
        if let Node::Leaf { shares } = &self.nodes[place] {
            shares.iter().for_each(|(label, share)| sum[*label as usize] += share);
        }
    }

    /// The same of many rows, one after the other in both tables. Rows go down side by side, so that a
    /// processor need not guess which way one of them turns.
    pub(crate) fn add_shares_of(
        &self,
        rows: &[f64],
        width: usize,
        sums: &mut [f64],
        labels: usize,
    ) {
        let steps = self.steps();
        let whole = rows.len() / (SIDE * width) * SIDE;
        let (rows, rows_rest) = rows.split_at(whole * width);
        let (sums, sums_rest) = sums.split_at_mut(whole * labels);
        let blocks = rows.chunks_exact(SIDE * width).zip(sums.chunks_exact_mut(SIDE * labels));
        for (rows, sums) in blocks {
            let mut places = [0u32; SIDE];
            let mut moved = 1;
            while moved != 0 {
                moved = 0;
                for (side, place) in places.iter_mut().enumerate() {
                    let step = &steps[*place as usize];
                    let left = rows[side * width + step.column as usize] <= step.threshold;
                    let next = select_unpredictable(left, place.wrapping_add(1), step.right);
                    moved |= next ^ *place;
                    *place = next;
                }
            }
            for (place, sum) in places.iter().zip(sums.chunks_exact_mut(labels)) {
                self.add_leaf(*place as usize, sum);
            }
        }
        let rest = rows_rest.chunks_exact(width).zip(sums_rest.chunks_exact_mut(labels));
        rest.for_each(|(row, sum)| self.add_shares(row, sum));
    }

    /// The nodes without their kinds: a leaf asks what is never so, and leads to itself.
    fn steps(&self) -> Vec<Step> {
        let step = |(place, node): (u32, &Node)| match node {
            Node::Question { column, threshold, right } => {
                Step { threshold: *threshold, column: *column, right: *right }
            }
            Node::Leaf { .. } => Step { threshold: f64::NEG_INFINITY, column: 0, right: place },
        };
        (0u32..).zip(&self.nodes).map(step).collect()
    }

    /// Nodes, leaves included.
    pub fn size(&self) -> usize {
        self.nodes.len()
    }

    /// Whether every question's sides are inside the tree and its columns and labels below these.
    pub(crate) fn fits(&self, width: usize, labels: usize) -> bool {
        self.nodes.iter().enumerate().all(|(place, node)| match node {
            Node::Question { column, threshold, right } => {
                let inside = (*right as usize) < self.nodes.len() && *right as usize > place + 1;
                inside && (*column as usize) < width && threshold.is_finite()
            }
            Node::Leaf { shares } => shares.iter().all(|(label, _)| (*label as usize) < labels),
        }) && matches!(self.nodes.last(), Some(Node::Leaf { .. }))
    }
}

impl Growth<'_> {
    /// The cut after which both sides are purest, of the columns drawn; more are drawn as long as
    /// none of them differs between rows. None when the rows have one label, or are all alike.
    fn best_cut(&mut self, rows: &[usize]) -> Option<Cut> {
        let labels = self.examples.labels();
        if rows.iter().all(|&row| labels[row] == labels[rows[0]]) {
            return None;
        }
        let mut best: Option<Cut> = None;
        let mut varied = 0;
        for place in 0..self.columns.len() {
            if varied == self.drawn {
                break;
            }
            self.stream.draw_first(&mut self.columns[place..], 1);
            let (differs, cut) = self.cut_of_column(rows, self.columns[place]);
            varied += usize::from(differs);
            let better = |cut: &Cut| best.as_ref().is_none_or(|b| cut.impurity < b.impurity);
            if let Some(cut) = cut.filter(better) {
                best = Some(cut);
            }
        }
        best
    }

    /// Whether the column differs between the rows, and its purest cut.
    fn cut_of_column(&mut self, rows: &[usize], column: usize) -> (bool, Option<Cut>) {
        let (table, labels) = (self.examples.rows(), self.examples.labels());
        self.sorted.clear();
        self.sorted.extend(rows.iter().map(|&row| (table.row(row)[column], labels[row])));
        self.sorted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let (Some(first), Some(last)) = (self.sorted.first(), self.sorted.last()) else {
            return (false, None);
        };
        if last.0 <= first.0 + SAME {
            return (false, None);
        }
        self.left.fill(0);
        self.right.fill(0);
        self.sorted.iter().for_each(|(_, label)| self.right[*label] += 1);
        // Sums of the squared counts: the impurity of a side of n rows is n - squares / n.
        let mut right_squares: f64 = self.right.iter().map(|&n| (n * n) as f64).sum();
        let mut left_squares = 0.0;
        let mut best: Option<Cut> = None;
        let n = self.sorted.len();
        for (taken, pair) in (1..n).zip(self.sorted.windows(2)) {
            let label = pair[0].1;
            left_squares += (2 * self.left[label] + 1) as f64;
            right_squares -= (2 * self.right[label] - 1) as f64;
            self.left[label] += 1;
            self.right[label] -= 1;
            if pair[1].0 <= pair[0].0 + SAME {
                continue;
            }
            let impurity =
                n as f64 - left_squares / taken as f64 - right_squares / (n - taken) as f64;
            if best.as_ref().is_none_or(|b| impurity < b.impurity) {
                let middle = pair[0].0 + (pair[1].0 - pair[0].0) / 2.0;
                // Between neighbours so close that their middle is the upper one, the lower one.
                let threshold = if middle < pair[1].0 { middle } else { pair[0].0 };
                best = Some(Cut { impurity, column, threshold });
            }
        }
        (true, best)
    }

    /// Rows on the left of a cut to the front, both sides in their order; how many those are.
    fn part(&self, rows: &mut [usize], cut: &Cut) -> usize {
        let left = |row: &usize| self.examples.rows().row(*row)[cut.column] <= cut.threshold;
        let (front, back): (Vec<usize>, Vec<usize>) = rows.iter().partition(|row| left(row));
        rows[..front.len()].copy_from_slice(&front);
        rows[front.len()..].copy_from_slice(&back);
        front.len()
    }

    fn leaf(&mut self, rows: &[usize]) -> Node {
        self.left.fill(0);
        rows.iter().for_each(|&row| self.left[self.examples.labels()[row]] += 1);
        let n = rows.len() as f64;
        let own = self.left.iter().zip(0u32..).filter(|(count, _)| **count > 0);
        Node::Leaf { shares: own.map(|(&count, label)| (label, count as f64 / n)).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rows;

    #[test]
    fn a_planted_corner_is_cut_out() {
        // Label 1 where both numbers are above 0.5.
        let grid: Vec<[f64; 2]> =
            (0..100).map(|i| [f64::from(i % 10) / 10.0, f64::from(i / 10) / 10.0]).collect();
        let label = |p: &[f64; 2]| usize::from(p[0] > 0.5 && p[1] > 0.5);
        let rows = Rows::new(grid.as_flattened().to_vec(), 2).unwrap();
        let examples = Examples::new(rows, grid.iter().map(label).collect(), 2).unwrap();
        let tree = Tree::grow(&examples, (0..100).collect(), 2, Stream::new(1, 0));
        assert_eq!(tree.size(), 5);
        assert!(tree.fits(2, 2) && !tree.fits(1, 2) && !tree.fits(2, 1));
        for point in &grid {
            let mut shares = [0.0; 2];
            tree.add_shares(point, &mut shares);
            assert_eq!(shares[label(point)], 1.0);
        }
        let mut all = vec![0.0; 200];
        tree.add_shares_of(grid.as_flattened(), 2, &mut all, 2);
        for (point, shares) in grid.iter().zip(all.chunks_exact(2)) {
            assert_eq!(shares[label(point)], 1.0);
        }
    }

    #[test]
    fn rows_alike_with_two_labels_end_in_a_leaf_of_both() {
        let rows = Rows::new(vec![1.0; 4], 1).unwrap();
        let examples = Examples::new(rows, vec![0, 1, 1, 1], 2).unwrap();
        let tree = Tree::grow(&examples, (0..4).collect(), 1, Stream::new(1, 0));
        let mut shares = [0.0; 2];
        tree.add_shares(&[1.0], &mut shares);
        assert_eq!((tree.size(), shares), (1, [0.25, 0.75]));
    }
}
