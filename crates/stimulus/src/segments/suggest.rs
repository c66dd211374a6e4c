//! Where the expressions of a take are: a suggestion, to be corrected by hand.
//!
//! Borders are the frames where the energy of velocity and acceleration peaks, as far as the peak
//! stands out (thesis 4.4.2). The thesis labels what lies between borders by learning; here a
//! stretch is an expression when its weights are away from those of the neutral face, which is
//! named or is the face that the take comes back to most.

use std::ops::Range;

use mimique_mocap::FilterError;
use serde::Serialize;

use super::peaks::nearest_quantile;
use super::{Activity, ActivityOptions, BorderRule, Channels, TakeSegment};

/// What the user decides.
#[derive(Debug, Clone, PartialEq)]
pub struct SuggestOptions {
    /// How activity is measured.
    pub activity: ActivityOptions,
    /// Which of its peaks are borders.
    pub rule: BorderRule,
    /// Frames in which the face is neutral; found where not given.
    pub neutral: Option<Range<usize>>,
    /// Names of the expressions, in order of time; `expression 1`... where there are none left.
    pub labels: Vec<String>,
    /// How weak an expression may be: the level above rest at which one begins is divided by it. 1 as it is found.
    pub sensitivity: f64,
}

impl Default for SuggestOptions {
    fn default() -> Self {
        Self {
            activity: ActivityOptions::default(),
            rule: BorderRule::default(),
            neutral: None,
            labels: Vec::new(),
            sensitivity: 1.0,
        }
    }
}

/// Why nothing can be suggested.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SuggestError {
    /// The low-pass does not fit the rate.
    #[error(transparent)]
    Filter(#[from] FilterError),
    /// Too little to look at.
    #[error("take: {frames} frames of {channels} channels; give a take of a second or more")]
    TooShort {
        /// Frames.
        frames: usize,
        /// Channels.
        channels: usize,
    },
    /// The neutral is not in the take.
    #[error("neutral frames {start}:{end} of {frames}; give a range inside the take")]
    Neutral {
        /// First frame.
        start: usize,
        /// One past the last.
        end: usize,
        /// Frames of the take.
        frames: usize,
    },
}

/// Expressions found, and what they were found by.
#[derive(Debug, Clone, PartialEq)]
pub struct Suggestion {
    /// The expressions, in order of time, without lead-in and lead-out.
    pub segments: Vec<TakeSegment>,
    /// Frames where one state of the face gives way to another.
    pub borders: Vec<usize>,
    /// Energy of every frame.
    pub energy: Vec<f64>,
    /// Distance of every frame's face from the neutral: sum over the channels.
    pub level: Vec<f64>,
    /// Level above which a face is an expression.
    pub threshold: f64,
    /// Frames per second.
    pub rate_hz: f64,
}

/// What a timeline draws: energy and level thinned, borders and segments in seconds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Timeline {
    /// Seconds of the take.
    pub duration_s: f64,
    /// Frames per second.
    pub rate_hz: f64,
    /// Frames.
    pub frames: usize,
    /// Seconds between two points of the curves.
    pub step_s: f64,
    /// Square root of the energy, the highest of each step.
    pub energy: Vec<f64>,
    /// Distance from the neutral, the highest of each step.
    pub level: Vec<f64>,
    /// Level above which a face is an expression.
    pub threshold: f64,
    /// Borders, seconds.
    pub borders_s: Vec<f64>,
    /// Segments.
    pub segments: Vec<TimelineSegment>,
}

/// A segment on a timeline.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TimelineSegment {
    /// Its name.
    pub label: String,
    /// First frame of the clip and the one after its last.
    pub clip: [usize; 2],
    /// The same of the expression.
    pub expression: [usize; 2],
    /// The clip in seconds.
    pub clip_s: [f64; 2],
    /// The expression in seconds.
    pub expression_s: [f64; 2],
}

/// Share of the strongest expressions' level that a weak one reaches: a weak smile is a fifth of
/// an exaggerated fear.
const WEAKEST: f64 = 0.12;
/// An expression ends where its level has fallen to this share of its own highest.
const EDGE: f64 = 0.03;
/// How far above the noise at rest a level stands out.
const OVER_NOISE: f64 = 4.0;
/// Shortest expression, seconds: micro-expressions last 1/25 to 1/2 s; shorter is a twitch.
const SHORTEST_S: f64 = 0.2;
/// Shortest plateau between two expressions that follow each other without neutral, seconds.
const PLATEAU_S: f64 = 0.15;
/// Points of a timeline's curves.
const POINTS: usize = 2000;

/// Suggest the expressions of a take.
///
/// # Errors
/// [`SuggestError`]: a take too short, a neutral outside it, a cut-off that does not fit.
pub fn suggest(take: Channels<'_>, options: &SuggestOptions) -> Result<Suggestion, SuggestError> {
    let frames = take.values.len() / take.count.max(1);
    if take.count == 0 || (frames as f64) < take.rate_hz || frames < 16 {
        return Err(SuggestError::TooShort { frames, channels: take.count });
    }
    if let Some(Range { start, end }) = options.neutral
        && (start >= end || end > frames)
    {
        return Err(SuggestError::Neutral { start, end, frames });
    }
    let activity = Activity::of(take, &options.activity)?;
    let root = activity.root();
    let borders = options.rule.borders(&activity, take.rate_hz);
    let neutral = neutral_face(&activity.smooth, frames, &root, options.neutral.clone());
    let level: Vec<f64> = (0..frames)
        .map(|f| {
            let channels = activity.smooth.chunks_exact(frames).zip(&neutral);
            channels.map(|(track, rest)| (track[f] - rest).abs()).sum()
        })
        .collect();
    let (rest, threshold) = rest_and_threshold(&level, options.neutral.as_ref());
    let threshold = rest + (threshold - rest) / options.sensitivity.max(f64::EPSILON);
    let shortest = (SHORTEST_S * take.rate_hz).ceil() as usize;
    let found = expressions_above(&level, rest, threshold, shortest);
    let tracks: Vec<&[f64]> = activity.smooth.chunks_exact(frames).collect();
    let found: Vec<Range<usize>> = found
        .into_iter()
        .flat_map(|whole| split(&whole, &borders, &root, &tracks, &level, threshold, take.rate_hz))
        .collect();
    let segments = found
        .into_iter()
        .enumerate()
        .map(|(i, frames)| {
            let label = options.labels.get(i).cloned();
            TakeSegment::new(label.unwrap_or_else(|| format!("expression {}", i + 1)), frames)
        })
        .collect();
    Ok(Suggestion {
        segments,
        borders,
        energy: activity.energy,
        level,
        threshold,
        rate_hz: take.rate_hz,
    })
}

impl Suggestion {
    /// What a timeline draws of it.
    pub fn timeline(&self) -> Timeline {
        let frames = self.energy.len();
        let step = frames.div_ceil(POINTS).max(1);
        let highest = |of: &[f64]| -> Vec<f64> {
            of.chunks(step).map(|c| c.iter().copied().fold(0.0, f64::max)).collect()
        };
        let root: Vec<f64> = self.energy.iter().map(|e| e.sqrt()).collect();
        let seconds = |frame: usize| frame as f64 / self.rate_hz;
        let segments = self.segments.iter().map(|s| TimelineSegment {
            label: s.label.clone(),
            clip: [s.clip.start, s.clip.end],
            expression: [s.expression.start, s.expression.end],
            clip_s: [seconds(s.clip.start), seconds(s.clip.end)],
            expression_s: [seconds(s.expression.start), seconds(s.expression.end)],
        });
        Timeline {
            duration_s: seconds(frames),
            rate_hz: self.rate_hz,
            frames,
            step_s: seconds(step),
            energy: highest(&root),
            level: highest(&self.level),
            threshold: self.threshold,
            borders_s: self.borders.iter().map(|&b| seconds(b)).collect(),
            segments: segments.collect(),
        }
    }
}

/// The neutral face: the mean of the named frames, else the face that the take comes back to.
fn neutral_face(
    smooth: &[f64],
    frames: usize,
    root: &[f64],
    named: Option<Range<usize>>,
) -> Vec<f64> {
    let tracks: Vec<&[f64]> = smooth.chunks_exact(frames).collect();
    if let Some(named) = named {
        let count = named.len() as f64;
        return tracks.iter().map(|t| t[named.clone()].iter().sum::<f64>() / count).collect();
    }
    // Of the calmer half, spread evenly; of each the distance to a quarter of the others.
    const SAMPLES: usize = 300;
    let mut sorted = root.to_vec();
    sorted.sort_by(f64::total_cmp);
    let calm = nearest_quantile(&sorted, 0.5);
    let calmer: Vec<usize> = (0..frames).filter(|&f| root[f] <= calm).collect();
    let samples: Vec<usize> =
        calmer.iter().copied().step_by((calmer.len() / SAMPLES).max(1)).collect();
    let distance = |f: usize, g: usize| -> f64 { tracks.iter().map(|t| (t[f] - t[g]).abs()).sum() };
    let spread = |f: usize| {
        let mut all: Vec<f64> = samples.iter().map(|&g| distance(f, g)).collect();
        all.sort_by(f64::total_cmp);
        nearest_quantile(&all, 0.25)
    };
    let best = samples
        .iter()
        .map(|&f| (spread(f), f))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map_or(0, |(_, f)| f);
    // The mean of the samples that are as near, so that one frame's noise is not the reference.
    let reach = spread(best);
    let near: Vec<usize> =
        samples.iter().copied().filter(|&g| distance(best, g) <= reach).collect();
    tracks
        .iter()
        .map(|t| near.iter().map(|&g| t[g]).sum::<f64>() / near.len().max(1) as f64)
        .collect()
}

/// The level at rest (of the named frames, else of the lower part of the take), and the level above
/// which a face is an expression.
fn rest_and_threshold(level: &[f64], neutral: Option<&Range<usize>>) -> (f64, f64) {
    let mut sorted = level.to_vec();
    sorted.sort_by(f64::total_cmp);
    let strong = nearest_quantile(&sorted, 0.95);
    let rest = match neutral {
        Some(named) => {
            let mut own = level[named.clone()].to_vec();
            own.sort_by(f64::total_cmp);
            nearest_quantile(&own, 0.9)
        }
        None => nearest_quantile(&sorted, 0.2),
    };
    (rest, (OVER_NOISE * rest).max(rest + WEAKEST * (strong - rest)))
}

/// Expressions whose level is above the threshold for `shortest` frames at least.
fn expressions_above(
    level: &[f64],
    rest: f64,
    threshold: f64,
    shortest: usize,
) -> Vec<Range<usize>> {
    let frames = level.len();
    let mut found = Vec::new();
    let mut frame = 0;
    while frame < frames {
        if level[frame] <= threshold {
            frame += 1;
            continue;
        }
        let end = (frame..frames).find(|&f| level[f] <= threshold).unwrap_or(frames);
        if end - frame >= shortest {
            let last = found.last().map_or(0, |r: &Range<usize>| r.end);
            found.push(whole_expression(level, frame..end, rest, last));
        }
        frame = end;
    }
    found
}

/// From where the level is above the threshold outwards to where the expression began and ended:
/// to the edge level or the lowest point on the way.
fn whole_expression(
    level: &[f64],
    above: Range<usize>,
    rest: f64,
    not_before: usize,
) -> Range<usize> {
    let highest = above.clone().map(|f| level[f]).fold(0.0, f64::max);
    let edge = rest + EDGE * (highest - rest);
    let mut start = above.start;
    while start > not_before && level[start - 1] > edge && level[start - 1] <= level[start] {
        start -= 1;
    }
    let mut end = above.end;
    while end < level.len() && level[end] > edge && level[end] <= level[end - 1] {
        end += 1;
    }
    start..end
}

/// Expressions that follow each other without neutral between them are parted at the border: a
/// face held, a change, another face held.
fn split(
    whole: &Range<usize>,
    borders: &[usize],
    root: &[f64],
    tracks: &[&[f64]],
    level: &[f64],
    threshold: f64,
    rate_hz: f64,
) -> Vec<Range<usize>> {
    let plateau = ((PLATEAU_S * rate_hz).ceil() as usize).max(2);
    // The calmest frame of a stretch, when the face is held there.
    let held = |part: Range<usize>| -> Option<usize> {
        let calmest = part
            .clone()
            .filter(|&f| level[f] > threshold)
            .min_by(|&a, &b| root[a].total_cmp(&root[b]))?;
        (part.len() >= plateau).then_some(calmest)
    };
    let inside: Vec<usize> = borders.iter().copied().filter(|b| whole.contains(b)).collect();
    let mut parts = Vec::new();
    let mut start = whole.start;
    for (i, &border) in inside.iter().enumerate() {
        let before = if i == 0 { start } else { inside[i - 1].max(start) };
        let after = inside.get(i + 1).copied().unwrap_or(whole.end);
        let (Some(a), Some(b)) = (held(before..border), held(border + 1..after)) else { continue };
        // Both are held, and neither is the other's last trace.
        let calm = 0.25 * root[border];
        let (less, more) = (level[a].min(level[b]), level[a].max(level[b]));
        let change: f64 = tracks.iter().map(|t| (t[a] - t[b]).abs()).sum();
        // A face that only fades changes by the difference of the levels, another face by up to
        // their sum: 0 and 1 on this scale.
        let otherness = (change - (more - less)) / (2.0 * less);
        if root[a] < calm && root[b] < calm && less > 0.3 * more && otherness > 0.5 {
            parts.push(start..border);
            start = border;
        }
    }
    parts.push(start..whole.end);
    parts
}
