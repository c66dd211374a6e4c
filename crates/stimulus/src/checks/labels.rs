//! Labels that are swapped or stand twice at one place, found by the residual of the fit (Kouadio
//! 4.2.3: markers that come too near one another are mixed up when they part).
//!
//! - For the whole take: after the rigid alignment of the neutral each pair of labels is asked
//!   whether exchanging them brings the markers nearer to their places on the avatar.
//! - For a stretch: two labels that jump to one another's places from one sighting to the next, and
//!   whose markers the weights then explain better exchanged.
//! - At one place: two labels less than a millimetre apart, which no two markers can be.
//!
//! Each swap is tried by solving again with the labels exchanged; it is reported with the residual
//! before and after, and only if the residual falls.

use std::ops::Range;

use mimique_geometry::{Displacement, Point};
use mimique_solver::{Fit, FrontEnd, Operators};
use serde::Serialize;

/// What is wrong with two labels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LabelFault {
    /// Each carries the other's marker.
    Swapped,
    /// Both are at one place.
    OnePlace,
}

/// Two labels that are not what they say.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LabelProblem {
    /// What is wrong.
    pub fault: LabelFault,
    /// The two labels; of two at one place the second is the one that does not belong there.
    pub labels: [String; 2],
    /// First frame and the one after the last, as the capture numbers them; none = throughout.
    pub frames: Option<[u64; 2]>,
    /// Residual over those frames, millimetres rms: of all markers, as labelled.
    pub residual_mm: f64,
    /// The same with the labels exchanged, or without the marker that does not belong there.
    pub residual_if_mended_mm: f64,
}

/// Two markers cannot be nearer: their own size is more. Metres.
const MARKER_SIZE_M: f64 = 1e-3;
/// A jump below this is no jump: skin moves as far from frame to frame. Metres.
const JUMP_M: f64 = 3e-3;
/// Exchanged, the pair must be at less than this share of its squared distance.
const SHARE: f64 = 0.5;
/// Frames that a trial solve looks at, evenly spread.
const TRIAL_FRAMES: usize = 60;
/// Swaps that are looked for in a neutral, one after the other.
const MOST_SWAPS: usize = 4;

/// A solved take as the search sees it.
pub(crate) struct LabelCheck<'a> {
    pub operators: &'a Operators,
    pub fit: &'a Fit,
    pub front_end: &'a FrontEnd,
    /// Frames x 3P displacements, metres, not scaled.
    pub displacements: &'a [f64],
    /// Frames x N.
    pub weights: &'a [f64],
    /// Number of the first frame.
    pub first_frame: u64,
    /// Displacements of some frames with two face markers' columns exchanged throughout.
    pub exchanged: &'a Exchanged<'a>,
}

/// Two markers and some frames to 3P displacements per frame; none where the front end has no answer.
type Exchanged<'a> = dyn Fn(usize, usize, &[usize]) -> Option<Vec<f64>> + 'a;

impl LabelCheck<'_> {
    /// Every problem, whole takes first.
    pub fn problems(&self) -> Vec<LabelProblem> {
        let mut found = self.whole_take();
        found.extend(self.stretches());
        found.extend(self.one_place());
        found
    }

    fn markers(&self) -> usize {
        self.operators.marker_count()
    }

    fn frames(&self) -> usize {
        self.displacements.len() / (3 * self.markers())
    }

    /// Where the front end puts a marker on the avatar: x = its place at rest + d.
    fn observed(&self, frame: usize, m: usize) -> Point {
        let at = 3 * (frame * self.markers() + m);
        let rest = self.operators.parts().marker_positions[m];
        let d = &self.displacements[at..at + 3];
        rest + Displacement::new(d[0], d[1], d[2])
    }

    /// Where the weights put it.
    fn predicted(&self, frame: usize, m: usize) -> Point {
        let n = self.operators.shape_count();
        let c = &self.weights[frame * n..(frame + 1) * n];
        let rest = self.operators.parts().marker_positions[m];
        let deltas = &self.operators.parts().marker_deltas;
        let along = |axis: usize| {
            let row = &deltas[(3 * m + axis) * n..(3 * m + axis + 1) * n];
            row.iter().zip(c).map(|(d, c)| d * c).sum::<f64>()
        };
        rest + Displacement::new(along(0), along(1), along(2))
    }

    /// Swaps that the neutral has too.
    fn whole_take(&self) -> Vec<LabelProblem> {
        let avatar = &self.operators.parts().marker_positions;
        let motion = self.front_end.avatar_from_actor();
        let flat = self.front_end.depth().is_some();
        let mut at: Vec<Point> = (self.front_end.neutral().iter().zip(avatar))
            .map(|(p, avatar)| {
                let p = motion.apply(*p);
                if flat { Point::new(p.x, p.y, avatar.z) } else { p }
            })
            .collect();
        let mut found = Vec::new();
        for _ in 0..MOST_SWAPS {
            let mut best: Option<(f64, usize, usize)> = None;
            for a in 0..at.len() {
                for b in a + 1..at.len() {
                    let now = square(at[a], avatar[a]) + square(at[b], avatar[b]);
                    let then = square(at[b], avatar[a]) + square(at[a], avatar[b]);
                    let gain = now - then;
                    if then < SHARE * now
                        && now > JUMP_M * JUMP_M
                        && best.is_none_or(|(most, ..)| gain > most)
                    {
                        best = Some((gain, a, b));
                    }
                }
            }
            let Some((_, a, b)) = best else { break };
            at.swap(a, b);
            let frames = self.some_frames(0..self.frames());
            let Some(repaired) = (self.exchanged)(a, b, &frames) else { continue };
            let before = self.residual(&self.rows(&frames));
            let after = self.residual(&repaired);
            if after < 0.95 * before {
                found.push(self.problem(LabelFault::Swapped, [a, b], None, [before, after]));
            }
        }
        found
    }

    /// Swaps that come and go.
    fn stretches(&self) -> Vec<LabelProblem> {
        let mut found = Vec::new();
        for (pair, events) in self.jumps() {
            let [a, b] = pair;
            let mut ends = events;
            ends.insert(0, 0);
            ends.push(self.frames());
            // The pieces between the jumps, alternately as labelled and exchanged: which ones?
            let costs: Vec<[f64; 2]> =
                ends.windows(2).map(|w| self.pair_costs(a, b, w[0]..w[1])).collect();
            let total = |exchanged: fn(usize) -> bool| -> f64 {
                costs.iter().enumerate().map(|(i, c)| c[usize::from(exchanged(i))]).sum()
            };
            let odd = total(|i| i % 2 == 1);
            let even = total(|i| i % 2 == 0);
            let parity = usize::from(odd <= even);
            for (i, piece) in ends.windows(2).enumerate().filter(|(i, _)| i % 2 == parity) {
                let [now, then] = costs[i];
                if then >= SHARE * now || piece[0] >= piece[1] {
                    continue;
                }
                let frames = self.some_frames(piece[0]..piece[1]);
                let rows = self.rows(&frames);
                let before = self.residual(&rows);
                let after = self.residual(&self.exchange_rows(rows, a, b));
                if after < before {
                    let span = Some(piece[0]..piece[1]);
                    found.push(self.problem(LabelFault::Swapped, pair, span, [before, after]));
                }
            }
        }
        found.sort_by_key(|p| p.frames.map(|f| f[0]));
        found
    }

    /// Pairs of labels that jump to one another's last places, with the frames in which they do.
    fn jumps(&self) -> Vec<([usize; 2], Vec<usize>)> {
        let p = self.markers();
        let mut out: Vec<([usize; 2], Vec<usize>)> = Vec::new();
        let mut last: Vec<Option<Point>> = vec![None; p];
        let mut moved = Vec::new();
        for frame in 0..self.frames() {
            let here: Vec<Option<Point>> =
                (0..p).map(|m| Some(self.observed(frame, m)).filter(|x| x.is_finite())).collect();
            moved.clear();
            for m in 0..p {
                if let (Some(x), Some(before)) = (here[m], last[m])
                    && square(x, before) > JUMP_M * JUMP_M
                {
                    moved.push((m, x, before));
                }
            }
            for (i, &(a, xa, la)) in moved.iter().enumerate() {
                for &(b, xb, lb) in &moved[i + 1..] {
                    let stay = square(xa, la) + square(xb, lb);
                    let exchange = square(xa, lb) + square(xb, la);
                    // A quarter: half as far each.
                    if exchange < 0.25 * stay {
                        match out.iter_mut().find(|(pair, _)| *pair == [a, b]) {
                            Some((_, frames)) => frames.push(frame),
                            None => out.push(([a, b], vec![frame])),
                        }
                    }
                }
            }
            for (last, here) in last.iter_mut().zip(here) {
                *last = here.or(*last);
            }
        }
        out
    }

    /// Squared distance of two markers to where the weights put them, as labelled and exchanged.
    fn pair_costs(&self, a: usize, b: usize, frames: Range<usize>) -> [f64; 2] {
        let mut costs = [0.0; 2];
        for frame in frames {
            let (xa, xb) = (self.observed(frame, a), self.observed(frame, b));
            let (pa, pb) = (self.predicted(frame, a), self.predicted(frame, b));
            let [now, then] = [square(xa, pa) + square(xb, pb), square(xb, pa) + square(xa, pb)];
            if now.is_finite() && then.is_finite() {
                costs[0] += now;
                costs[1] += then;
            }
        }
        costs
    }

    /// Labels at one place.
    fn one_place(&self) -> Vec<LabelProblem> {
        let p = self.markers();
        let mut open: Vec<([usize; 2], usize)> = Vec::new();
        let mut spans: Vec<([usize; 2], Range<usize>)> = Vec::new();
        for frame in 0..self.frames() {
            let here: Vec<Point> = (0..p).map(|m| self.observed(frame, m)).collect();
            let mut now = Vec::new();
            for a in 0..p {
                for b in a + 1..p {
                    if (here[a][0] - here[b][0]).abs() < MARKER_SIZE_M
                        && square(here[a], here[b]) < MARKER_SIZE_M * MARKER_SIZE_M
                    {
                        now.push([a, b]);
                    }
                }
            }
            let (on, off): (Vec<_>, Vec<_>) =
                open.into_iter().partition(|(pair, _)| now.contains(pair));
            spans.extend(off.into_iter().map(|(pair, first)| (pair, first..frame)));
            open = on;
            for pair in now {
                if !open.iter().any(|(other, _)| *other == pair) {
                    open.push((pair, frame));
                }
            }
        }
        let end = self.frames();
        spans.extend(open.into_iter().map(|(pair, first)| (pair, first..end)));
        spans.sort_by_key(|(pair, span)| (span.start, *pair));
        spans.into_iter().map(|(pair, span)| self.misplaced(pair, span)).collect()
    }

    /// Of two labels at one place the one whose loss leaves the others better explained.
    fn misplaced(&self, [a, b]: [usize; 2], span: Range<usize>) -> LabelProblem {
        let frames = self.some_frames(span.clone());
        let rows = self.rows(&frames);
        let before = self.residual(&rows);
        let without = |m: usize| {
            let mut rows = rows.clone();
            for frame in rows.chunks_exact_mut(3 * self.markers()) {
                frame[3 * m..3 * m + 3].fill(f64::NAN);
            }
            self.residual(&rows)
        };
        let (no_a, no_b) = (without(a), without(b));
        let (pair, after) = if no_a < no_b { ([b, a], no_a) } else { ([a, b], no_b) };
        let span = Some(span).filter(|s| s.len() < self.frames());
        self.problem(LabelFault::OnePlace, pair, span, [before, after])
    }

    fn problem(
        &self,
        fault: LabelFault,
        pair: [usize; 2],
        span: Option<Range<usize>>,
        [before, after]: [f64; 2],
    ) -> LabelProblem {
        let labels = &self.operators.parts().marker_labels;
        let number = |frame: usize| self.first_frame + frame as u64;
        LabelProblem {
            fault,
            labels: pair.map(|m| labels[m].clone()),
            frames: span.map(|s| [number(s.start), number(s.end)]),
            residual_mm: 1e3 * before,
            residual_if_mended_mm: 1e3 * after,
        }
    }

    /// At most [`TRIAL_FRAMES`] of some frames, evenly spread.
    fn some_frames(&self, frames: Range<usize>) -> Vec<usize> {
        let step = frames.len().div_ceil(TRIAL_FRAMES).max(1);
        frames.step_by(step).collect()
    }

    fn rows(&self, frames: &[usize]) -> Vec<f64> {
        let width = 3 * self.markers();
        let row = |&f: &usize| self.displacements[f * width..(f + 1) * width].iter().copied();
        frames.iter().flat_map(row).collect()
    }

    /// Displacements with two labels exchanged: a displacement is the marker's point less the place
    /// at rest of whose it is taken to be.
    fn exchange_rows(&self, mut rows: Vec<f64>, a: usize, b: usize) -> Vec<f64> {
        let rest = &self.operators.parts().marker_positions;
        for frame in rows.chunks_exact_mut(3 * self.markers()) {
            for k in 0..3 {
                let (xa, xb) = (frame[3 * a + k] + rest[a][k], frame[3 * b + k] + rest[b][k]);
                frame[3 * a + k] = xb - rest[a][k];
                frame[3 * b + k] = xa - rest[b][k];
            }
        }
        rows
    }

    /// Residual of displacements solved anew, metres rms over the frames.
    fn residual(&self, rows: &[f64]) -> f64 {
        let Ok(solved) = self.fit.solve_take(rows) else { return f64::INFINITY };
        let squares: f64 = solved.reports.iter().map(|r| r.residual * r.residual).sum();
        (squares / solved.reports.len().max(1) as f64).sqrt()
    }
}

impl LabelProblem {
    /// In words.
    pub fn sentence(&self) -> String {
        let when = match self.frames {
            None => "throughout".to_owned(),
            Some([first, end]) => format!("in frames {first}:{end}"),
        };
        let [a, b] = &self.labels;
        let (before, after) = (self.residual_mm, self.residual_if_mended_mm);
        match self.fault {
            LabelFault::Swapped => format!(
                "labels {a} and {b} look swapped {when}: exchanged, the residual falls from \
                 {before:.2} to {after:.2} mm; exchange them in the capture"
            ),
            LabelFault::OnePlace => format!(
                "labels {a} and {b} are at one place {when}, {b} does not belong there: without it \
                 the residual is {after:.2} instead of {before:.2} mm; correct it in the capture"
            ),
        }
    }
}

fn square(a: Point, b: Point) -> f64 {
    (a - b).length_squared()
}
