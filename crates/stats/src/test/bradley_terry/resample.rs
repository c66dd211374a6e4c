//! Standard deviations by drawing participants with replacement, and p of the lack of fit by drawing answers from the
//! model. Each draw has a random stream of its own, so that neither threads nor their number matter.

use nalgebra::DVector;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde::Serialize;

use super::fit_of_model::{Deviance, deviance};
use super::model::{Model, Parameters};
use crate::numerics::random::Stream;
use crate::table::comparisons::{PairedComparisons, Presentation, parts};

/// How the participants were drawn again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Resampling {
    /// Draws.
    pub rounds: usize,
    /// The seed of the random streams.
    pub seed: u64,
    /// Draws whose answers were separated: the penalised estimates count.
    pub separated: usize,
    /// Draws in which no answer joined some items: left out.
    pub disconnected: usize,
}

/// The parameters of every draw that counts.
pub(super) struct Resampled {
    pub how: Resampling,
    /// All worths, then side, then tie, a draw each.
    draws: Vec<Vec<f64>>,
}

/// What a draw gave.
enum Draw {
    Found { values: Vec<f64>, separated: bool },
    Disconnected,
}

/// The participants' answers as counts of presentations and answers.
struct Counts {
    /// Left and right items of every presentation that anybody was shown.
    shown: Vec<(usize, usize)>,
    /// For each participant, place of a presentation, answer, how often.
    own: Vec<Vec<(u32, u8, u32)>>,
}

impl Counts {
    fn of(data: &PairedComparisons) -> Self {
        let items = data.items.len();
        let presentations = data.presentations();
        let mut place = vec![u32::MAX; items * items];
        for (at, p) in presentations.iter().enumerate() {
            place[p.left * items + p.right] = at as u32;
        }
        let mut own = vec![Vec::new(); data.participants.len()];
        for answer in &data.answers {
            let at = place[answer.left * items + answer.right];
            own[answer.participant].push((at, answer.chosen as u8, 1));
        }
        for list in &mut own {
            list.sort_unstable();
            list.dedup_by(|next, kept| {
                let same = (next.0, next.1) == (kept.0, kept.1);
                kept.2 += if same { next.2 } else { 0 };
                same
            });
        }
        Self { shown: presentations.iter().map(|p| (p.left, p.right)).collect(), own }
    }

    /// The answers of participants drawn with replacement.
    fn drawn(&self, stream: &mut Stream) -> Vec<Presentation> {
        let of = |&(left, right): &(usize, usize)| Presentation { left, right, counts: [0; 3] };
        let mut drawn: Vec<Presentation> = self.shown.iter().map(of).collect();
        for _ in 0..self.own.len() {
            for &(place, answer, times) in &self.own[stream.below(self.own.len())] {
                drawn[place as usize].counts[answer as usize] += u64::from(times);
            }
        }
        drawn.retain(|p| p.counts != [0; 3]);
        drawn
    }
}

/// Draws participants and fits again, from the estimates of all.
pub(super) fn resampled(
    model: Model,
    at: &Parameters,
    data: &PairedComparisons,
    rounds: usize,
    seed: u64,
) -> Resampled {
    let counts = Counts::of(data);
    let draws: Vec<Draw> = (0..rounds)
        .into_par_iter()
        .map(|round| {
            let drawn = counts.drawn(&mut Stream::new(seed, round as u64));
            one_draw(model, at, &drawn)
        })
        .collect();
    let mut how = Resampling { rounds, seed, separated: 0, disconnected: 0 };
    let mut kept = Vec::with_capacity(rounds);
    for draw in draws {
        match draw {
            Draw::Disconnected => how.disconnected += 1,
            Draw::Found { values, separated } => {
                how.separated += usize::from(separated);
                kept.push(values);
            }
        }
    }
    Resampled { how, draws: kept }
}

fn one_draw(model: Model, at: &Parameters, drawn: &[Presentation]) -> Draw {
    let joined = parts(model.items, drawn.iter().map(|p| (p.left, p.right))).len() == 1;
    if !joined || (model.side && !model.side_is_told(drawn)) {
        return Draw::Disconnected;
    }
    let separated = model.is_separated(drawn);
    let found = if separated {
        model.maximise_penalised(drawn).map(|found| found.at)
    } else {
        Some(model.maximise(at, drawn).at)
    };
    match found {
        None => Draw::Disconnected,
        Some(at) => {
            let mut values = model.worth(&at);
            values.extend([model.side_bias(&at), model.tie(&at)]);
            Draw::Found { values, separated }
        }
    }
}

impl Resampled {
    /// The standard deviation over the draws of one of the worths; none with fewer than two draws.
    pub fn sd(&self, of: impl Fn(&[f64]) -> f64) -> Option<f64> {
        let values: Vec<f64> = self.draws.iter().map(|draw| of(draw)).collect();
        crate::summary::describe::moments(&values).1.map(f64::sqrt)
    }
}

/// Of `rounds` draws of all answers from the model, the share with at least as large a G2, and X2, the data
/// being one draw more (Davison and Hinkley 1997, equation 4.11).
pub(super) fn parametric_p(
    model: Model,
    at: &Parameters,
    shown: &[Presentation],
    observed: Deviance,
    rounds: usize,
    seed: u64,
) -> [f64; 2] {
    let worth = model.worth(at);
    let p: Vec<[f64; 3]> =
        shown.iter().map(|p| model.ln_p(at, &worth, (p.left, p.right)).map(libm::exp)).collect();
    let draws: Vec<[bool; 2]> = (0..rounds)
        .into_par_iter()
        .map(|round| {
            let mut stream = Stream::new(seed, PARAMETRIC + round as u64);
            let drawn: Vec<Presentation> =
                shown.iter().zip(&p).map(|(own, p)| drawn_from(own, p, &mut stream)).collect();
            let found = model.maximise(at, &drawn);
            let own = deviance(model, &found.at, &drawn);
            // A draw like the data may differ from it by rounding.
            let at_least = |own: f64, observed: f64| own >= observed - 1e-9 * observed.abs();
            [at_least(own.g2, observed.g2), at_least(own.x2, observed.x2)]
        })
        .collect();
    [0, 1].map(|which| {
        let count = draws.iter().filter(|draw| draw[which]).count();
        (count + 1) as f64 / (rounds + 1) as f64
    })
}

/// The first stream of [`parametric_p`], beyond those of [`resampled`].
const PARAMETRIC: u64 = 1 << 32;

fn drawn_from(own: &Presentation, p: &[f64; 3], stream: &mut Stream) -> Presentation {
    let mut counts = [0; 3];
    for _ in 0..own.counts.iter().sum::<u64>() {
        let unit = stream.unit();
        let answer = if unit < p[0] {
            0
        } else if unit < p[0] + p[1] {
            1
        } else {
            2
        };
        counts[answer] += 1;
    }
    Presentation { counts, ..*own }
}

/// The start of a fit: all parameters 0.
pub(super) fn origin(model: Model) -> Parameters {
    DVector::zeros(model.parameters())
}
