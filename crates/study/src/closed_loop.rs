//! The levels of an adaptive block: from its definition, the participant's draw and the answers so far.
//!
//! The page asks for the next level while it runs, in a module of its own; the export and the report replay a
//! session and must find the same. Which track a trial belongs to, which segment it shows, on which side, and which
//! trials are catch trials is drawn before the first answer, from the stream `levels/COMPONENT`.

use mimique_adaptive::{
    Ends, Grid, GridError, QuestPlus, Rule, Shape, Staircase, StaircaseError, StaircaseRules, Track,
};
use serde::Serialize;

use crate::order::Draw;
use crate::study_file::{
    AdaptiveComponent, PsychometricFunction, QuestPlusRule, StaircaseRule, Varied,
};

/// A block has no levels.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoLevels {
    /// Both rules or none.
    #[error("a rule is either questPlus or staircase")]
    Rule,
    /// The grid of QUEST+ cannot be used.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The staircase cannot be followed.
    #[error(transparent)]
    Staircase(#[from] StaircaseError),
    /// No segment has both clips.
    #[error("no segment has both clips")]
    NothingShown,
}

/// A level that is to be shown, and how.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChosenLevel {
    /// Track, from 1.
    pub track: usize,
    /// The level.
    pub level: f64,
    /// QUEST+ alone: the entropy expected after the answer, in nats.
    pub entropy: Option<f64>,
    /// Whether it is a catch trial, which no track counts.
    pub catch: bool,
    /// Clip of the level.
    pub clip: String,
    /// Clip that it is held against.
    pub against: String,
    /// Whether that one stands left.
    pub left: bool,
}

/// What is drawn of a trial beforehand.
#[derive(Debug, Clone)]
struct Planned {
    track: usize,
    catch: bool,
    /// Place among the segments.
    segment: usize,
    /// Whether the clip that stays the same stands left.
    left: bool,
}

/// The state of an adaptive block.
#[derive(Debug, Clone)]
pub struct ClosedLoop {
    block: AdaptiveComponent,
    planned: Vec<Planned>,
    /// Place of the next trial in the plan.
    at: usize,
    tracks: Vec<Track>,
    levels: Vec<f64>,
}

/// The grid of QUEST+ of a block, its levels and thresholds by [`Varied::ease`].
pub fn grid(rule: &QuestPlusRule, block: &AdaptiveComponent) -> Grid {
    let vary = &block.vary;
    let [low, high, count] = rule.threshold;
    let count = count.clamp(0.0, 1e5) as u32;
    let threshold = Varied { parameter: String::new(), from: low, to: high, levels: count };
    let shape = match rule.function {
        PsychometricFunction::Normal => Shape::Normal,
        PsychometricFunction::Logistic => Shape::Logistic,
        PsychometricFunction::Weibull => Shape::Weibull,
    };
    let mut thresholds: Vec<f64> = threshold.all().iter().map(|own| vary.ease(*own)).collect();
    thresholds.sort_by(f64::total_cmp);
    Grid {
        shape,
        levels: vary.all().iter().map(|level| vary.ease(*level)).collect(),
        values: [thresholds, rule.spread.clone(), vec![block.guess()], rule.lapse.clone()],
        prior: [const { None }; 4],
    }
}

/// The rules of the staircase of a block, by [`Varied::ease`].
pub fn staircase(rule: &StaircaseRule, vary: &Varied) -> StaircaseRules {
    StaircaseRules {
        down: rule.down,
        start: vary.ease(rule.start.unwrap_or(vary.to)),
        steps: rule.steps.clone(),
        bounds: [vary.ease(vary.from), vary.ease(vary.to)],
    }
}

impl ClosedLoop {
    /// A block before the first answer. `block` is one of a projection (or [`crate::Study::adaptive`]), `component`
    /// its name.
    ///
    /// # Errors
    /// [`NoLevels`]: what the check of a study refuses.
    pub fn new(
        block: AdaptiveComponent,
        component: &str,
        draw: Draw<'_>,
    ) -> Result<Self, NoLevels> {
        if block.shown.is_empty() {
            return Err(NoLevels::NothingShown);
        }
        let rule = match (&block.rule.quest_plus, &block.rule.staircase) {
            (Some(rule), None) => Rule::QuestPlus(QuestPlus::new(grid(rule, &block))?),
            (None, Some(rule)) => Rule::Staircase(Staircase::new(staircase(rule, &block.vary))?),
            _ => return Err(NoLevels::Rule),
        };
        let ends = Ends { trials: block.trials as usize, stop_sd: block.stop_sd };
        let track = Track::new(rule, ends);
        let tracks = vec![track; block.tracks as usize];
        let planned = plan(&block, component, draw);
        let levels = block.vary.all();
        Ok(Self { block, planned, at: 0, tracks, levels })
    }

    /// What comes next; none once every track has ended.
    pub fn next(&self) -> Option<ChosenLevel> {
        let planned = &self.planned[self.upcoming()?];
        let next = self.tracks[planned.track].next()?;
        let shown = &self.block.shown[planned.segment];
        let (level, entropy) = match planned.catch {
            true => (self.block.catch_level(), None),
            // A level of a staircase is one of the list, whatever its sums round to.
            false => (self.nearest(self.block.vary.ease(next.level)), next.entropy),
        };
        Some(ChosenLevel {
            track: planned.track + 1,
            level,
            entropy,
            catch: planned.catch,
            clip: format!("{}{level}", shown.levels),
            against: shown.against.clone(),
            left: planned.left,
        })
    }

    fn nearest(&self, level: f64) -> f64 {
        let off = |each: &f64| (each - level).abs();
        self.levels.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(level)
    }

    /// Place of the next trial whose track has not ended.
    fn upcoming(&self) -> Option<usize> {
        let left = self.at..self.planned.len();
        left.into_iter().find(|&at| self.tracks[self.planned[at].track].next().is_some())
    }

    /// Whether an answer to the next trial says that the difference is seen.
    pub fn seen(&self, answer: &str) -> Option<bool> {
        self.block.seen(answer, self.planned[self.upcoming()?].left)
    }

    /// Takes in the answer to the next trial: the side of the varied clip (`left`, `right`), or whether the clips
    /// differ. Another answer moves no track.
    pub fn answer(&mut self, answer: Option<&str>) {
        self.take(answer.and_then(|answer| self.seen(answer)));
    }

    fn take(&mut self, seen: Option<bool>) {
        let Some(at) = self.upcoming() else { return };
        let Planned { track, catch, .. } = self.planned[at];
        self.at = at + 1;
        if let Some(seen) = seen.filter(|_| !catch) {
            self.tracks[track].answer(seen);
        }
    }

    /// The block as it would be after an answer that says whether the difference is seen.
    pub fn after(&self, seen: bool) -> Self {
        let mut after = self.clone();
        after.take(Some(seen));
        after
    }

    /// The clips that are shown next: both of a pair.
    pub fn clips(&self) -> Vec<String> {
        self.next().map_or_else(Vec::new, |next| vec![next.clip, next.against])
    }

    /// The tracks, in their state.
    pub fn tracks(&self) -> &[Track] {
        &self.tracks
    }

    /// Mean and standard deviation of a track's threshold (from 1) under the answers so far; none of a staircase.
    pub fn threshold(&self, track: usize) -> Option<[f64; 2]> {
        match self.tracks.get(track.checked_sub(1)?)?.rule() {
            Rule::QuestPlus(track) => {
                let [mean, sd] = track.moments()[0];
                Some([self.block.vary.ease(mean), sd])
            }
            Rule::Staircase(_) => None,
        }
    }
}

/// Draws what does not depend on answers: tracks in rounds, each once; catch trials anywhere; segments in rounds;
/// each side in half of the trials.
fn plan(block: &AdaptiveComponent, component: &str, draw: Draw<'_>) -> Vec<Planned> {
    let mut stream = draw.stream(&format!("levels/{component}"));
    let tracks = block.tracks as usize;
    let mut order: Vec<(usize, bool)> = Vec::new();
    for _ in 0..block.trials {
        let mut round: Vec<usize> = (0..tracks).collect();
        stream.shuffle(&mut round);
        order.extend(round.into_iter().map(|track| (track, false)));
    }
    for _ in 0..block.catches() {
        let place = stream.below(order.len() + 1);
        let track = stream.below(tracks);
        order.insert(place, (track, true));
    }
    let mut left: Vec<bool> = (0..order.len()).map(|trial| trial % 2 == 0).collect();
    stream.shuffle(&mut left);
    let mut segments = Vec::new();
    while segments.len() < order.len() {
        let mut round: Vec<usize> = (0..block.shown.len()).collect();
        stream.shuffle(&mut round);
        segments.extend(round);
    }
    let parts = order.into_iter().zip(left).zip(segments);
    parts.map(|(((track, catch), left), segment)| Planned { track, catch, segment, left }).collect()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// A block whose levels rise from 0 to 1, or fall from 1 to 0.
    fn block(falls: bool, rule: &serde_json::Value) -> AdaptiveComponent {
        let (from, to) = if falls { (1.0, 0.0) } else { (0.0, 1.0) };
        serde_json::from_value(json!({
            "vary": { "parameter": "alpha", "from": from, "to": to, "levels": 11 },
            "method": "lsts", "against": "none", "question": "which", "trials": 60, "rule": rule,
            "shown": [{ "levels": "joy.lsts@alpha=", "against": "joy.none" }]
        }))
        .unwrap()
    }

    #[test]
    fn levels_that_fall_go_as_those_that_rise() {
        for rule in [
            json!({ "questPlus": { "threshold": [0.1, 0.9, 9], "spread": [0.05, 0.2] } }),
            json!({ "staircase": { "down": 2, "steps": [0.2, 0.1] } }),
        ] {
            let draw = Draw { seed: 1, config_hash: "c", participant: 1, condition: None };
            let of = |falls| ClosedLoop::new(block(falls, &rule), "limit", draw).unwrap();
            let (mut rises, mut falls) = (of(false), of(true));
            while let Some(up) = rises.next() {
                let down = falls.next().unwrap();
                assert!((up.level + down.level - 1.0).abs() < 1e-12, "{up:?} {down:?}");
                assert_eq!((up.left, up.track), (down.left, down.track));
                // This person tells levels above 0.4, and those below 0.6.
                let is_told = up.level > 0.4;
                let side = if is_told == up.left { "right" } else { "left" };
                rises.answer(Some(side));
                falls.answer(Some(side));
            }
            assert_eq!(falls.next(), None);
            if let (Some([up, sd]), Some([down, same])) = (rises.threshold(1), falls.threshold(1)) {
                assert!((up + down - 1.0).abs() < 1e-9 && (sd - same).abs() < 1e-9, "{up} {down}");
            }
        }
    }
}
