//! The whole chain: from a plan to a series of seconds, and from a window of it to a face's weights.

use mimique_mocap::WeightsTable;

use crate::breathing::{Breathing, BreathingInput};
use crate::controls::Controls;
use crate::error::{ExertionError, within};
use crate::expression::Expression;
use crate::heart::{HeartModel, WORK_LIMIT, heart_with};
use crate::metabolism::Metabolism;
use crate::person::Person;
use crate::plan::Plan;
use crate::rules::{Curves, Features};
use crate::samples::between_seconds;
use crate::shapes::ShapeTable;

/// Frames per second of weights by default.
pub const FRAMES_PER_SECOND: f64 = 60.0;
/// Frames that a clip may have: nine hours at 60 Hz.
const MOST_FRAMES: usize = 2_000_000;
/// What of a frame the end of a window may lie before a whole one and count as it.
const ROUNDING: f64 = 1e-9;
/// rcn above which the law without a steady state is said to be one.
const NEAR_MAXIMUM: f64 = 0.9;

/// Where the heart comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Heart {
    /// A law, whatever was recorded.
    Law(HeartModel),
    /// What was recorded, in every second.
    Recorded,
    /// What was recorded where it was, else a law.
    RecordedElse(HeartModel),
}

impl Default for Heart {
    fn default() -> Self {
        Self::RecordedElse(HeartModel::Thesis)
    }
}

/// How a person begins: by default rested and on their feet, with a tenth of the heart's reserve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    /// The share of the heart's reserve.
    pub rcn: f64,
    /// EPOC, ml/kg.
    pub epoc: f64,
}

impl Default for Start {
    fn default() -> Self {
        Self { rcn: 0.1, epoc: 0.0 }
    }
}

/// What the body does, a value a second each, from 0 on.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Work of the last second, J/kg.
    pub w: Vec<f64>,
    /// Power, W/kg.
    pub p: Vec<f64>,
    /// The share of the heart's reserve.
    pub rcn: Vec<f64>,
    /// Beats per minute.
    pub heart_rate: Vec<f64>,
    /// What follows from the heart.
    pub metabolism: Metabolism,
    /// Seconds whose work is above 120 J/kg and counted as that for the heart.
    pub over_limit: Vec<usize>,
    /// The first second in which the law of the thesis takes the heart over nine tenths of its reserve: it
    /// has no steady state, and `steady` has.
    pub near_maximum: Option<usize>,
}

impl Series {
    /// Of a plan, from its beginning: the state of a body takes minutes.
    ///
    /// # Errors
    /// [`ExertionError`]: a start that is none; [`Heart::Recorded`] and a second without it; work below 0, of
    /// a convention that allows it (`w/j`).
    pub fn of(
        person: &Person,
        plan: &Plan,
        heart: Heart,
        start: Start,
    ) -> Result<Self, ExertionError> {
        let seconds = (plan.span_s() + ROUNDING).floor() as usize + 1;
        let times = || (0..seconds).map(|second| second as f64);
        let w: Vec<f64> = times().map(|t| plan.w(t)).collect();
        let recorded: Vec<Option<f64>> = match heart {
            Heart::Law(_) => Vec::new(),
            Heart::Recorded | Heart::RecordedElse(_) => {
                times().map(|t| plan.recorded_rcn(t)).collect()
            }
        };
        if heart == Heart::Recorded {
            all_recorded(&recorded)?;
        }
        let law = match heart {
            Heart::Law(law) | Heart::RecordedElse(law) => law,
            Heart::Recorded => HeartModel::default(),
        };
        let rcn = heart_with(person, law, &w, start.rcn, &recorded)?;
        let metabolism = Metabolism::of(person, &rcn, start.epoc)?;
        let by_law = |second: usize| recorded.get(second).is_none_or(Option::is_none);
        let near_maximum = (law == HeartModel::Thesis)
            .then(|| (0..seconds).find(|&second| by_law(second) && rcn[second] > NEAR_MAXIMUM));
        Ok(Self {
            p: times().map(|t| plan.p(t)).collect(),
            heart_rate: rcn.iter().map(|share| person.heart_rate(*share)).collect(),
            over_limit: (0..seconds).filter(|&second| w[second] > WORK_LIMIT).collect(),
            near_maximum: near_maximum.flatten(),
            w,
            rcn,
            metabolism,
        })
    }

    /// Seconds, the one at 0 included.
    pub fn seconds(&self) -> usize {
        self.rcn.len()
    }
}

/// Refuses seconds without a recorded heart.
fn all_recorded(recorded: &[Option<f64>]) -> Result<(), ExertionError> {
    let Some(first) = recorded.iter().position(Option::is_none) else { return Ok(()) };
    let length = recorded[first..].iter().position(Option::is_some);
    let last = length.map_or(recorded.len(), |length| first + length) - 1;
    let place = "heart".to_owned();
    Err(ExertionError::NoHeartRate { place, first: first as f64, last: last as f64 })
}

/// A window of a plan that becomes a clip of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Beginning and end, s of the plan; both are frames.
    pub seconds: [f64; 2],
    /// Frames per second.
    pub rate_hz: f64,
}

/// How the face follows.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Face {
    /// What makes the curves.
    pub expression: Expression,
    /// Which shapes the controls move.
    pub shapes: ShapeTable,
    /// Whether the mouth moves with the breath, and the chest: the weight `breath` is what is in the lungs,
    /// times how hard the heart works.
    pub breathing: bool,
    /// Whether the skin reddens and sweats: the weights `flush` and `sweat`, of the series' columns.
    pub skin: bool,
    /// A seed where breaths are to be irregular.
    pub seed: Option<u64>,
}

/// A clip of a face, a row a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Clip {
    /// Times of the frames, s of the plan.
    pub times: Vec<f64>,
    /// Frames per second.
    pub rate_hz: f64,
    /// What the curves follow from.
    pub features: Vec<Features>,
    /// The curves, per cent.
    pub curves: Vec<Curves>,
    /// The breath, where there is one.
    pub breathing: Option<Breathing>,
    /// The controls.
    pub controls: Controls,
    /// Names of the shapes.
    pub shape_names: Vec<String>,
    /// Weights, frame after frame.
    pub weights: Vec<f64>,
}

impl Clip {
    /// Of a window. Heart, EPOC, breaths and fatigue lie straight between seconds; the breath begins at the
    /// window's first frame.
    ///
    /// # Errors
    /// [`ExertionError`]: a window that is empty or outside the plan (`window`), a rate that is none.
    pub fn of(
        person: &Person,
        plan: &Plan,
        series: &Series,
        window: &Window,
        face: &Face,
    ) -> Result<Self, ExertionError> {
        let times = frame_times(plan, window)?;
        let features: Vec<Features> = times
            .iter()
            .map(|&t| Features {
                w: plan.w(t),
                p: plan.p(t),
                rcn: between_seconds(&series.rcn, t),
                epoc: between_seconds(&series.metabolism.epoc, t),
            })
            .collect();
        let curves = face.expression.curves(&features, person.spec().level);
        let rcn: Vec<f64> = features.iter().map(|own| own.rcn).collect();
        let of_seconds = |values: &[f64]| -> Vec<f64> {
            times.iter().map(|&t| between_seconds(values, t)).collect()
        };
        let breathing = if face.breathing {
            Some(Breathing::of(&BreathingInput {
                rate_hz: window.rate_hz,
                phase0: 0.0,
                breaths: &of_seconds(&series.metabolism.breaths),
                rcn: &rcn,
                fatigue: &of_seconds(&series.metabolism.fatigue),
                seed: face.seed,
            })?)
        } else {
            None
        };
        let breath = breathing.as_ref().map(|breathing| (breathing, &rcn[..]));
        let controls = Controls::of(&curves, &person.spec().expressivity, breath);
        let body = body_weights(breathing.as_ref(), &rcn, face.skin, |own| {
            of_seconds(own(&series.metabolism))
        });
        let (shape_names, weights) = face.shapes.weights_with(&controls, &body);
        Ok(Self {
            rate_hz: window.rate_hz,
            shape_names,
            times,
            features,
            curves,
            breathing,
            controls,
            weights,
        })
    }

    /// The weights as a take has them: frames numbered by the plan's time, times from 0 on.
    pub fn table(&self) -> WeightsTable {
        let first = self.times.first().map_or(0.0, |t| t * self.rate_hz).round() as u64;
        WeightsTable::at_rate(self.shape_names.clone(), self.weights.clone(), first, self.rate_hz)
    }
}

/// Least that a chest moves with the breath, at rest; at the heart's maximum it moves by all.
const CHEST_AT_REST: f64 = 0.3;

/// Weights of the shapes that show the body, by their names, a value a frame each.
fn body_weights(
    breathing: Option<&Breathing>,
    rcn: &[f64],
    skin: bool,
    of_seconds: impl Fn(fn(&Metabolism) -> &[f64]) -> Vec<f64>,
) -> Vec<(&'static str, Vec<f64>)> {
    let mut body = Vec::new();
    if let Some(breathing) = breathing {
        let depth = |rcn: &f64| CHEST_AT_REST + (1.0 - CHEST_AT_REST) * rcn;
        let breath = breathing.volume.iter().zip(rcn).map(|(volume, rcn)| volume * depth(rcn));
        body.push(("breath", breath.collect()));
    }
    if skin {
        body.push(("flush", of_seconds(|all| &all.flush)));
        body.push(("sweat", of_seconds(|all| &all.sweat)));
    }
    body
}

/// The times of a window's frames, s.
fn frame_times(plan: &Plan, window: &Window) -> Result<Vec<f64>, ExertionError> {
    let rate_hz = within("rateHz", window.rate_hz, [1.0, 1000.0], Some("frames per second"))?;
    let ([first, last], span) = (window.seconds, plan.span_s());
    if !(first >= 0.0 && first < last && last <= span + ROUNDING) {
        let place = "window".to_owned();
        return Err(ExertionError::Window { place, first, last, span });
    }
    let frames = ((last - first) * rate_hz + ROUNDING).floor() as usize + 1;
    if frames > MOST_FRAMES {
        let place = "window".to_owned();
        return Err(ExertionError::Many { place, found: frames, most: MOST_FRAMES });
    }
    Ok((0..frames).map(|frame| first + frame as f64 / rate_hz).collect())
}
