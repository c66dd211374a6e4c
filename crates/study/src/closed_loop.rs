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

/// Share of right answers by chance: one of two clips.
const GUESS: f64 = 0.5;

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

/// The grid of QUEST+ of a block.
pub fn grid(rule: &QuestPlusRule, vary: &Varied) -> Grid {
    let [low, high, count] = rule.threshold;
    let count = count.clamp(0.0, 1e5) as u32;
    let threshold = Varied { parameter: String::new(), from: low, to: high, levels: count };
    let shape = match rule.function {
        PsychometricFunction::Normal => Shape::Normal,
        PsychometricFunction::Logistic => Shape::Logistic,
        PsychometricFunction::Weibull => Shape::Weibull,
    };
    Grid {
        shape,
        levels: vary.all(),
        values: [threshold.all(), rule.spread.clone(), vec![GUESS], rule.lapse.clone()],
        prior: [const { None }; 4],
    }
}

/// The rules of the staircase of a block.
pub fn staircase(rule: &StaircaseRule, vary: &Varied) -> StaircaseRules {
    StaircaseRules {
        down: rule.down,
        start: rule.start.unwrap_or(vary.to),
        steps: rule.steps.clone(),
        bounds: [vary.from, vary.to],
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
            (Some(rule), None) => Rule::QuestPlus(QuestPlus::new(grid(rule, &block.vary))?),
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
            true => (self.block.vary.to, None),
            // A level of a staircase is one of the list, whatever its sums round to.
            false => (self.nearest(next.level), next.entropy),
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

    /// Takes in the side that was chosen as the varied clip's (`left`, `right`). Another answer moves no track.
    pub fn answer(&mut self, side: Option<&str>) {
        let Some(at) = self.upcoming() else { return };
        let Planned { track, catch, left, .. } = self.planned[at];
        self.at = at + 1;
        let chose_left = match side {
            Some("left") => true,
            Some("right") => false,
            _ => return,
        };
        if !catch {
            self.tracks[track].answer(chose_left != left);
        }
    }

    /// The block as it would be after an answer.
    pub fn after(&self, side: &str) -> Self {
        let mut after = self.clone();
        after.answer(Some(side));
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
            Rule::QuestPlus(track) => Some(track.moments()[0]),
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
