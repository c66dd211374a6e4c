//! Labels that change places: found, and put back where they belong.
//!
//! A marker's track is followed through every change of labels. The label that a track has had in
//! most of its frames is its own; where it had another one, that stretch is repaired, unless its
//! markers then lie worse among the others than they do as labelled.

use super::abrupt_steps::{AbruptStep, distance, each_abrupt_step};
use crate::Capture;
use mimique_geometry::Point;
use std::ops::Range;

/// Markers whose labels change places.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Swap {
    /// The labels, two or more: each marker takes the next one's label, the last the first's.
    pub labels: Vec<String>,
    /// First frame after the change, 0 = the first of the capture.
    pub frame: usize,
}

/// A stretch of frames in which labels stood on each other's markers.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct RepairedSwap {
    /// Labels whose positions were exchanged.
    pub labels: Vec<String>,
    /// First frame of the stretch, 0 = the first of the capture.
    pub first: usize,
    /// First frame after it.
    pub end: usize,
    /// Whether the labels were put back; if not, the markers lay better as they are labelled.
    pub repaired: bool,
}

/// One change: the marker under label `cycle[i]` goes on under label `cycle[i + 1]`.
pub(crate) struct Change {
    /// First frame after it.
    pub(crate) frame: usize,
    /// The markers.
    pub(crate) cycle: Vec<usize>,
}

/// Moves that are swaps, and those that are none, in order of time.
pub(crate) fn swaps_and_others(capture: &Capture) -> (Vec<Change>, Vec<(usize, AbruptStep)>) {
    let (mut swaps, mut others) = (Vec::new(), Vec::new());
    each_abrupt_step(capture, |frame, abrupt| {
        let cycles = cycles(abrupt);
        let swapped = |marker: usize| cycles.iter().any(|c| c.contains(&marker));
        others.extend(abrupt.iter().filter(|s| !swapped(s.marker)).map(|s| (frame, *s)));
        swaps.extend(cycles.into_iter().map(|cycle| Change { frame, cycle }));
    });
    (swaps, others)
}

/// Repair every swap in place. Returns the stretches that were found.
pub(crate) fn repair_swaps(capture: &mut Capture) -> Vec<RepairedSwap> {
    let (changes, _) = swaps_and_others(capture);
    if changes.is_empty() {
        return Vec::new();
    }
    let (frames, markers) = (capture.frames(), capture.labels.len());
    let pieces = pieces(&changes, markers, frames);
    let owner = owners(&pieces, markers);
    let still: Vec<usize> =
        (0..markers).filter(|&m| pieces.iter().all(|p| p.label_of_track[m] == m)).collect();
    let places = Places::of(capture, &pieces, &owner, &still);
    let mut found = Vec::new();
    for piece in &pieces {
        // Own label -> label in the file, for every track that has another one's.
        let moved: Vec<(usize, usize)> = (0..markers)
            .map(|track| (owner[track], piece.label_of_track[track]))
            .filter(|(own, label)| own != label)
            .collect();
        for group in groups(&moved) {
            let repaired = places.fit_better_moved(capture, piece.frames.clone(), &group);
            if repaired {
                for frame in piece.frames.clone() {
                    let row = &mut capture.positions[frame * markers..(frame + 1) * markers];
                    let old: Vec<Point> = group.iter().map(|(_, label)| row[*label]).collect();
                    for ((own, _), p) in group.iter().zip(old) {
                        row[*own] = p;
                    }
                }
            }
            let labels = group.iter().map(|(own, _)| capture.labels[*own].clone()).collect();
            let Range { start, end } = piece.frames;
            found.push(RepairedSwap { labels, first: start, end, repaired });
        }
    }
    joined(found)
}

/// Closed chains of markers that each take the place of the next.
fn cycles(abrupt: &[AbruptStep]) -> Vec<Vec<usize>> {
    let next: Vec<Option<usize>> = abrupt
        .iter()
        .map(|a| {
            let nearest = (0..abrupt.len()).min_by(|&i, &j| {
                distance(a.from, abrupt[i].to).total_cmp(&distance(a.from, abrupt[j].to))
            })?;
            (abrupt[nearest].marker != a.marker).then_some(nearest)
        })
        .collect();
    let mut taken = vec![false; abrupt.len()];
    let mut found = Vec::new();
    for start in 0..abrupt.len() {
        let mut chain = vec![start];
        let mut at = start;
        while let Some(to) = next[at].filter(|to| !taken[*to] && !chain[1..].contains(to)) {
            if to == start {
                break;
            }
            chain.push(to);
            at = to;
        }
        if chain.len() < 2 || next[at] != Some(start) || taken[start] {
            continue;
        }
        // Together they land on each other's places, much nearer than on their own.
        let steps: f64 = chain.iter().map(|&i| abrupt[i].step).sum();
        let crossed: f64 =
            chain.iter().filter_map(|&i| Some(distance(abrupt[i].from, abrupt[next[i]?].to))).sum();
        if crossed < 0.25 * steps {
            chain.iter().for_each(|&i| taken[i] = true);
            found.push(chain.iter().map(|&i| abrupt[i].marker).collect());
        }
    }
    found
}

/// Frames between two changes, and under which label each track is in them.
struct Piece {
    frames: Range<usize>,
    label_of_track: Vec<usize>,
}

fn pieces(changes: &[Change], markers: usize, frames: usize) -> Vec<Piece> {
    let mut label_of_track: Vec<usize> = (0..markers).collect();
    let mut found: Vec<Piece> = Vec::new();
    let mut start = 0;
    for change in changes {
        if change.frame > start {
            found.push(Piece {
                frames: start..change.frame,
                label_of_track: label_of_track.clone(),
            });
            start = change.frame;
        }
        let count = change.cycle.len();
        for label in &mut label_of_track {
            if let Some(place) = change.cycle.iter().position(|l| l == label) {
                *label = change.cycle[(place + 1) % count];
            }
        }
    }
    found.push(Piece { frames: start..frames, label_of_track });
    found
}

/// The label that each track has had longest; where two tracks claim one, all keep their first.
fn owners(pieces: &[Piece], markers: usize) -> Vec<usize> {
    let mut frames = vec![std::collections::BTreeMap::<usize, usize>::new(); markers];
    for piece in pieces {
        for (track, label) in piece.label_of_track.iter().enumerate() {
            *frames[track].entry(*label).or_default() += piece.frames.len();
        }
    }
    let owner: Vec<usize> = frames
        .iter()
        .enumerate()
        .map(|(track, labels)| {
            // Of equals the label that the track began with.
            let longest = labels.values().max().copied().unwrap_or(0);
            if labels.get(&track) == Some(&longest) {
                return track;
            }
            labels.iter().find(|(_, n)| **n == longest).map_or(track, |(label, _)| *label)
        })
        .collect();
    let mut claimed = vec![false; markers];
    let unique = owner.iter().all(|&label| !std::mem::replace(&mut claimed[label], true));
    if unique { owner } else { (0..markers).collect() }
}

/// The moved tracks in groups that exchange labels among themselves.
fn groups(moved: &[(usize, usize)]) -> Vec<Vec<(usize, usize)>> {
    let mut left = moved.to_vec();
    let mut found = Vec::new();
    while let Some(first) = left.pop() {
        let mut group = vec![first];
        // Follow file label -> the track that owns it, until it closes.
        while let Some(at) =
            group.last().and_then(|(_, label)| left.iter().position(|(own, _)| own == label))
        {
            group.push(left.swap_remove(at));
        }
        group.sort_unstable();
        found.push(group);
    }
    found.sort();
    found
}

/// Stretches that follow each other with the same labels become one.
fn joined(found: Vec<RepairedSwap>) -> Vec<RepairedSwap> {
    let mut all: Vec<RepairedSwap> = Vec::new();
    for swap in found {
        let before = all.iter_mut().rev().find(|b| {
            b.end == swap.first && b.labels == swap.labels && b.repaired == swap.repaired
        });
        match before {
            Some(before) => before.end = swap.end,
            None => all.push(swap),
        }
    }
    all
}

/// Mean distance of each label from the markers that never swap, over the frames in which the
/// label is its own marker's: what does not change when the head moves.
struct Places {
    still: Vec<usize>,
    /// labels x still; NaN where never seen together.
    mean: Vec<f64>,
}

/// Frames that are looked at in a stretch: enough for a mean to a tenth of a millimetre.
const SAMPLES: usize = 400;

impl Places {
    fn of(capture: &Capture, pieces: &[Piece], owner: &[usize], still: &[usize]) -> Self {
        let markers = capture.labels.len();
        let mut mean = Vec::with_capacity(markers * still.len());
        for label in 0..markers {
            let own = pieces.iter().filter(|p| {
                owner.iter().zip(&p.label_of_track).any(|(o, l)| *o == label && *l == label)
            });
            let frames: Vec<usize> = own.flat_map(|p| p.frames.clone()).collect();
            let step = (frames.len() / SAMPLES).max(1);
            mean.extend(still.iter().map(|&reference| {
                mean_distance(capture, frames.iter().copied().step_by(step), label, reference)
            }));
        }
        Self { still: still.to_vec(), mean }
    }

    /// Whether the labels of a group lie better on the markers that are moved to them than on
    /// those that they have in the file. Without a marker to compare with the tracks decide.
    fn fit_better_moved(
        &self,
        capture: &Capture,
        frames: Range<usize>,
        group: &[(usize, usize)],
    ) -> bool {
        let step = (frames.len() / SAMPLES).max(1);
        let (mut moved, mut stayed) = (0.0, 0.0);
        for &(own, label) in group {
            for (column, &reference) in self.still.iter().enumerate() {
                let want = self.mean[own * self.still.len() + column];
                let sampled = || frames.clone().step_by(step);
                let as_moved = (mean_distance(capture, sampled(), label, reference) - want).abs();
                let as_is = (mean_distance(capture, sampled(), own, reference) - want).abs();
                if as_moved.is_finite() && as_is.is_finite() {
                    moved += as_moved;
                    stayed += as_is;
                }
            }
        }
        moved <= stayed
    }
}

fn mean_distance(
    capture: &Capture,
    frames: impl Iterator<Item = usize>,
    a: usize,
    b: usize,
) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for frame in frames {
        let row = capture.frame(frame);
        let d = distance(row[a], row[b]);
        if d.is_finite() {
            sum += d;
            count += 1.0;
        }
    }
    sum / count
}
