//! The likelihood of a psychometric function, and its maximum within bounds.
//!
//! | coordinate | logistic, normal | Weibull |
//! |---|---|---|
//! | 0 | h, the level where F = 1/2 | ln h |
//! | 1 | ln s | ln s |
//! | 2 | lapse λ | λ |
//!
//! p = γ + (1 - γ - λ) F. With h as a coordinate its profile is the likelihood with coordinate 0 held.

use mimique_adaptive::{Psychometric, Shape, normal_below};

use super::{Lapse, LevelCount};

/// A place among the coordinates.
pub(super) type Place = [f64; 3];

/// What is maximised, and where it is looked for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Likelihood<'a> {
    pub counts: &'a [LevelCount],
    pub shape: Shape,
    pub guess: f64,
    pub lapse: Lapse,
    pub bounds: [[f64; 2]; 3],
}

/// Half-widths of the region of h beyond the levels, in widths of the levels: further out the answers say
/// nothing of h but its side.
const BEYOND: f64 = 20.0;
/// Least and largest spread, in widths of the levels; slopes of Weibull.
const SPREADS: [f64; 2] = [1e-3, 1e3];
const SLOPES: [f64; 2] = [1e-2, 1e3];
/// Most that lapse may be.
const MOST_LAPSE: f64 = 0.2;
/// Scoring steps, at most: near the maximum each takes off a share of the distance.
const STEPS: usize = 400;
/// Where the step's length in standard errors, squared, is below this, the place is a maximum.
const SETTLED: f64 = 1e-22;

/// Damping takes the information of a coordinate to be this at least: where answers say nothing of threshold and spread
/// any more, the lapse still goes on to its maximum.
const NO_INFORMATION: f64 = 1e-9;

/// Height, score and Fisher information at a place.
struct Terrain {
    height: f64,
    score: [f64; 3],
    information: [[f64; 3]; 3],
}

/// Where a search ended.
#[derive(Debug, Clone, Copy)]
pub(super) struct Summit {
    pub at: Place,
    /// The log likelihood, with the prior of a free lapse.
    pub height: f64,
}

impl<'a> Likelihood<'a> {
    pub(super) fn new(counts: &'a [LevelCount], shape: Shape, guess: f64, lapse: Lapse) -> Self {
        let [low, high] = ends(counts, shape);
        let width = high - low;
        let bounds = match shape {
            Shape::Weibull => {
                // As many times below and above as the levels reach.
                let reach = 3.0 * libm::log(high / low).max(1.0);
                let [shallow, steep] = SLOPES.map(libm::log);
                [[libm::log(low) - reach, libm::log(high) + reach], [shallow, steep], [0.0; 2]]
            }
            Shape::Logistic | Shape::Normal => [
                [low - BEYOND * width, high + BEYOND * width],
                SPREADS.map(|share| libm::log(share * width)),
                [0.0; 2],
            ],
        };
        let lapses = match lapse {
            Lapse::Fixed(lapse) => [lapse; 2],
            Lapse::Free => [0.0, MOST_LAPSE.min(1.0 - guess - 1e-6)],
        };
        Self { counts, shape, guess, lapse, bounds: [bounds[0], bounds[1], lapses] }
    }

    /// The function at a place.
    pub(super) fn function(&self, at: Place) -> Psychometric {
        let spread = libm::exp(at[1]);
        let location = self.shape.location_of_half(self.half(at), spread);
        Psychometric { shape: self.shape, location, spread, guess: self.guess, lapse: at[2] }
    }

    /// The level where F = 1/2.
    pub(super) fn half(&self, at: Place) -> f64 {
        if self.shape == Shape::Weibull { libm::exp(at[0]) } else { at[0] }
    }

    /// Coordinate 0 of a level.
    pub(super) fn coordinate(&self, half: f64) -> f64 {
        if self.shape == Shape::Weibull { libm::log(half) } else { half }
    }

    /// F with its slopes by coordinates 0 and 1.
    fn seen(&self, at: Place, level: f64) -> [f64; 3] {
        let spread = libm::exp(at[1]);
        match self.shape {
            Shape::Weibull if level <= 0.0 => [0.0; 3],
            Shape::Weibull => {
                let ln_ratio = spread * (libm::log(level) - at[0]);
                let u = libm::exp(ln_ratio + libm::log(core::f64::consts::LN_2));
                let left = u * libm::exp(-u);
                [-libm::expm1(-u), -spread * left, left * ln_ratio]
            }
            shape => {
                let z = (level - at[0]) / spread;
                let (seen, density) = if shape == Shape::Logistic {
                    let seen = mimique_adaptive::logistic(z);
                    (seen, seen * mimique_adaptive::logistic(-z))
                } else {
                    let root = (2.0 * core::f64::consts::PI).sqrt();
                    (normal_below(z), libm::exp(-0.5 * z * z) / root)
                };
                [seen, -density / spread, -density * z]
            }
        }
    }

    /// Log likelihood, with the prior of a free lapse.
    pub(super) fn height(&self, at: Place) -> f64 {
        self.counts.iter().map(|own| own.log_likelihood(self.right(at, own.level))).sum::<f64>()
            + self.ln_prior(at[2])
    }

    fn right(&self, at: Place, level: f64) -> f64 {
        self.guess + (1.0 - self.guess - at[2]) * self.seen(at, level)[0]
    }

    /// Log density of Beta(1, 10) but for its constant, of a free lapse.
    pub(super) fn ln_prior(&self, lapse: f64) -> f64 {
        if self.lapse == Lapse::Free { 9.0 * libm::log1p(-lapse) } else { 0.0 }
    }

    fn terrain(&self, at: Place) -> Terrain {
        let mut found =
            Terrain { height: self.ln_prior(at[2]), score: [0.0; 3], information: [[0.0; 3]; 3] };
        if self.lapse == Lapse::Free {
            let rest = 1.0 - at[2];
            found.score[2] = -9.0 / rest;
            found.information[2][2] = 9.0 / (rest * rest);
        }
        for own in self.counts {
            let [seen, by_half, by_spread] = self.seen(at, own.level);
            let room = 1.0 - self.guess - at[2];
            let p = self.guess + room * seen;
            found.height += own.log_likelihood(p);
            let slopes = [room * by_half, room * by_spread, -seen];
            let spread = p * (1.0 - p);
            // Where an answer is certain it says nothing of the place.
            if spread <= 0.0 {
                continue;
            }
            let surprise = (own.correct as f64 - own.n as f64 * p) / spread;
            let weight = own.n as f64 / spread;
            for i in 0..3 {
                found.score[i] += surprise * slopes[i];
                for j in 0..3 {
                    found.information[i][j] += weight * slopes[i] * slopes[j];
                }
            }
        }
        found
    }

    /// Goes up from a place by Fisher's scoring with Levenberg and Marquardt's damping, within the bounds;
    /// coordinate 0 may be held.
    pub(super) fn climb(&self, start: Place, hold_half: bool) -> Summit {
        let mut at = [0, 1, 2].map(|i| start[i].clamp(self.bounds[i][0], self.bounds[i][1]));
        let mut damping = 1e-3;
        let mut terrain = self.terrain(at);
        for _ in 0..STEPS {
            let free = [0, 1, 2].map(|i| {
                let [low, high] = self.bounds[i];
                let at_bound = (at[i] <= low && terrain.score[i] <= 0.0)
                    || (at[i] >= high && terrain.score[i] >= 0.0);
                !(at_bound || low == high || (i == 0 && hold_half))
            });
            let Some(plain) = step(&terrain, free, 0.0).or_else(|| step(&terrain, free, 1e-6))
            else {
                break;
            };
            let gain: f64 = (0..3).map(|i| plain[i] * terrain.score[i]).sum();
            if gain <= SETTLED * (1.0 + terrain.height.abs()) {
                break;
            }
            let mut moved = false;
            while damping < 1e12 {
                let Some(way) = step(&terrain, free, damping) else { break };
                let next =
                    [0, 1, 2].map(|i| (at[i] + way[i]).clamp(self.bounds[i][0], self.bounds[i][1]));
                let found = self.terrain(next);
                if found.height > terrain.height {
                    (at, terrain, moved) = (next, found, true);
                    damping = (damping / 10.0).max(1e-12);
                    break;
                }
                damping *= 10.0;
            }
            if !moved {
                break;
            }
        }
        Summit { at, height: terrain.height }
    }

    /// The highest of the summits that the best places of a grid lead to.
    pub(super) fn highest(&self) -> Summit {
        let [from, to] = ends(self.counts, self.shape).map(|level| self.coordinate(level));
        let width = to - from;
        let mut starts: Vec<Summit> = Vec::new();
        for place in 0..=16 {
            let half = from - 0.25 * width + 1.5 * width * f64::from(place) / 16.0;
            for power in 0..8 {
                // Spreads from a hundredth of the width to the width and beyond; slopes from 0.5 on.
                let spread = match self.shape {
                    Shape::Weibull => 0.5 * libm::pow(2.0, f64::from(power)),
                    _ => width / 80.0 * libm::pow(2.2, f64::from(power)),
                };
                let [least, most] = self.bounds[2];
                for lapse in [least, (2.0 * least + most) / 3.0, (least + 2.0 * most) / 3.0] {
                    let at = [half, libm::log(spread), lapse];
                    starts.push(Summit { at, height: self.height(at) });
                    if least == most {
                        break;
                    }
                }
            }
        }
        starts.sort_by(|one, other| other.height.total_cmp(&one.height));
        let mut tried: Vec<Summit> = Vec::new();
        for start in &starts {
            // Another hill, not the next place of the same one.
            let near = |own: &Summit| {
                let apart = [(start.at[0] - own.at[0]) / width, start.at[1] - own.at[1]];
                apart[0].abs() < 0.3 && apart[1].abs() < 1.2
            };
            if tried.len() < 6 && !tried.iter().any(near) {
                tried.push(*start);
            }
        }
        let climbed = tried.iter().map(|start| self.climb(start.at, false));
        climbed.fold(Summit { at: starts[0].at, height: f64::NEG_INFINITY }, |best, own| {
            if own.height > best.height { own } else { best }
        })
    }

    /// The inverse of the information at a place, coordinate 0 with itself: the variance of h, or of ln h; none
    /// where the answers do not determine it.
    pub(super) fn variance_of_half(&self, at: Place) -> Option<f64> {
        let terrain = self.terrain(at);
        let inside = |i: usize| self.bounds[i][0] < at[i] && at[i] < self.bounds[i][1];
        let free = [0, 1, 2].map(inside);
        let unit = Terrain { score: [1.0, 0.0, 0.0], ..terrain };
        Some(step(&unit, free, 0.0)?[0]).filter(|variance| *variance > 0.0)
    }
}

/// Lowest and highest level; of Weibull's the lowest above 0, where its logarithm begins.
fn ends(counts: &[LevelCount], shape: Shape) -> [f64; 2] {
    let levels = || counts.iter().map(|own| own.level);
    let mut used = levels().filter(|level| shape != Shape::Weibull || *level > 0.0);
    let low = used.next().unwrap_or(1.0);
    [low, levels().next_back().unwrap_or(low)]
}

/// (I + damping max(diag I, [`NO_INFORMATION`]))^-1 score over the free coordinates; none where that is singular.
fn step(terrain: &Terrain, free: [bool; 3], damping: f64) -> Option<[f64; 3]> {
    let places: Vec<usize> = (0..3).filter(|i| free[*i]).collect();
    let size = places.len();
    let mut matrix = nalgebra::DMatrix::zeros(size, size);
    let mut right = nalgebra::DVector::zeros(size);
    for (i, &a) in places.iter().enumerate() {
        right[i] = terrain.score[a];
        for (j, &b) in places.iter().enumerate() {
            matrix[(i, j)] = terrain.information[a][b];
        }
        matrix[(i, i)] += damping * matrix[(i, i)].max(NO_INFORMATION);
    }
    let solved = nalgebra::Cholesky::new(matrix)?.solve(&right);
    let mut step = [0.0; 3];
    for (i, &a) in places.iter().enumerate() {
        step[a] = solved[i];
    }
    step.iter().all(|x| x.is_finite()).then_some(step)
}
