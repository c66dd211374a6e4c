//! A staircase: down after some right answers in a row, up after a wrong one (Levitt 1971, J. Acoust. Soc.
//! Am. 49, 467; Wetherill and Levitt 1965).
//!
//! The first move against the direction of the last is a reversal, at the level of that trial, and is
//! already made with the next step. A level stays within bounds; a move that they stop keeps its
//! direction.

/// The rules of a staircase.
#[derive(Debug, Clone, PartialEq)]
pub struct StaircaseRules {
    /// Right answers in a row before a step down, from 1.
    pub down: u32,
    /// The first level.
    pub start: f64,
    /// Steps: the first until the first reversal, then the next, the last for good.
    pub steps: Vec<f64>,
    /// Lowest and highest level.
    pub bounds: [f64; 2],
}

/// Why rules cannot be followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum StaircaseError {
    /// No right answers before a step down.
    #[error("a step down is made after 1 right answer at least")]
    Down,
    /// No step, or one that is no length.
    #[error("steps must be finite numbers above 0, one at least")]
    Steps,
    /// Bounds that are none, or a start outside them.
    #[error("bounds must be two finite numbers, the lower one first, and the start between them")]
    Bounds,
}

/// Where the next level lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Direction {
    Down,
    Up,
}

/// A turn of a staircase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reversal {
    /// The trial whose answer turned it, from 1.
    pub trial: usize,
    /// The level of that trial.
    pub level: f64,
}

/// The state of one track.
#[derive(Debug, Clone, PartialEq)]
pub struct Staircase {
    rules: StaircaseRules,
    level: f64,
    trials: usize,
    right_in_a_row: u32,
    last: Option<Direction>,
    reversals: Vec<Reversal>,
}

/// The mean of the reversals that count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaircaseThreshold {
    /// The mean.
    pub level: f64,
    /// Reversals it is the mean of.
    pub reversals: usize,
}

impl StaircaseRules {
    /// The share of right answers that the levels go round: 0.5^(1 / down).
    pub fn target(&self) -> f64 {
        libm::pow(0.5, 1.0 / f64::from(self.down))
    }
}

impl Staircase {
    /// Before the first answer.
    pub fn new(rules: StaircaseRules) -> Result<Self, StaircaseError> {
        let [low, high] = rules.bounds;
        if rules.down == 0 {
            return Err(StaircaseError::Down);
        }
        if rules.steps.is_empty() || !rules.steps.iter().all(|step| step.is_finite() && *step > 0.0)
        {
            return Err(StaircaseError::Steps);
        }
        let finite = low.is_finite() && high.is_finite() && low < high;
        if !finite || !(low..=high).contains(&rules.start) {
            return Err(StaircaseError::Bounds);
        }
        let level = tidy(rules.start);
        Ok(Self { rules, level, trials: 0, right_in_a_row: 0, last: None, reversals: Vec::new() })
    }

    /// The rules.
    pub fn rules(&self) -> &StaircaseRules {
        &self.rules
    }

    /// The level of the next trial.
    pub fn level(&self) -> f64 {
        self.level
    }

    /// Takes in the answer at [`Staircase::level`].
    pub fn answer(&mut self, right: bool) {
        self.trials += 1;
        if !right {
            self.right_in_a_row = 0;
            self.step(Direction::Up);
            return;
        }
        self.right_in_a_row += 1;
        if self.right_in_a_row == self.rules.down {
            self.right_in_a_row = 0;
            self.step(Direction::Down);
        }
    }

    fn step(&mut self, direction: Direction) {
        if self.last.is_some_and(|last| last != direction) {
            self.reversals.push(Reversal { trial: self.trials, level: self.level });
        }
        self.last = Some(direction);
        let step = self.rules.steps[self.reversals.len().min(self.rules.steps.len() - 1)];
        let next = match direction {
            Direction::Down => self.level - step,
            Direction::Up => self.level + step,
        };
        let [low, high] = self.rules.bounds;
        self.level = tidy(next).clamp(low, high);
    }

    /// The reversals so far.
    pub fn reversals(&self) -> &[Reversal] {
        &self.reversals
    }

    /// The mean level of the reversals after the first `ignored`, the first of these dropped where their
    /// number is odd; none where fewer than two are left.
    pub fn threshold(&self, ignored: usize) -> Option<StaircaseThreshold> {
        let counted = self.reversals.get(ignored..)?;
        let counted = &counted[counted.len() % 2..];
        let sum: f64 = counted.iter().map(|reversal| reversal.level).sum();
        let reversals = counted.len();
        (reversals > 0).then(|| StaircaseThreshold { level: sum / reversals as f64, reversals })
    }
}

/// To 12 decimals, so that steps there and back give the same level again.
fn tidy(level: f64) -> f64 {
    let scaled = level * 1e12;
    if scaled.abs() < 9e15 { libm::round(scaled) / 1e12 } else { level }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rules() -> StaircaseRules {
        StaircaseRules { down: 2, start: 0.3, steps: vec![0.2, 0.1], bounds: [0.0, 1.0] }
    }

    fn levels(rules: StaircaseRules, answers: &str) -> (Vec<f64>, Staircase) {
        let mut track = Staircase::new(rules).unwrap();
        let mut levels = Vec::new();
        for answer in answers.chars() {
            levels.push(track.level());
            track.answer(answer == '1');
        }
        (levels, track)
    }

    #[test]
    fn steps_follow_the_answers_and_bounds_hold() {
        // Down, down into the bound, down against it (no reversal), up: a reversal with the smaller step.
        let (found, track) = levels(rules(), "111111001");
        assert_eq!(found, [0.3, 0.3, 0.1, 0.1, 0.0, 0.0, 0.0, 0.1, 0.2]);
        assert_eq!(track.reversals(), [Reversal { trial: 7, level: 0.0 }]);
        assert_eq!(track.level(), 0.2, "one right answer is no step");
    }

    #[test]
    fn the_first_move_is_no_reversal_and_three_tenths_stay_three_tenths() {
        let (found, track) = levels(rules(), "0110110");
        // Up by 0.2, down by 0.1 (turn), up by 0.1 (turn), down (turn), up (turn).
        assert_eq!(found, [0.3, 0.5, 0.5, 0.4, 0.5, 0.5, 0.4]);
        assert_eq!(track.reversals().len(), 4);
        assert_eq!(track.level(), 0.5);
    }

    #[test]
    fn the_threshold_leaves_out_an_odd_reversal() {
        let (_, track) = levels(rules(), "0110110");
        let of = |ignored| track.threshold(ignored).map(|found| (found.level, found.reversals));
        assert_eq!(of(0), Some(((0.5 + 0.4 + 0.5 + 0.4) / 4.0, 4)));
        assert_eq!(of(1), Some(((0.5 + 0.4) / 2.0, 2)), "the first of three is dropped");
        assert_eq!(of(3), None, "one is left, and dropped");
        assert_eq!((of(4), of(9)), (None, None));
    }

    #[test]
    fn the_target_is_where_steps_down_and_up_are_equally_likely() {
        for down in 1..=4 {
            let rules = StaircaseRules { down, ..rules() };
            let target = rules.target();
            assert!((target.powi(down as i32) - 0.5).abs() < 1e-15, "{target}");
        }
    }

    #[test]
    fn rules_that_cannot_be_followed_are_refused() {
        let with = |change: &dyn Fn(&mut StaircaseRules)| {
            let mut rules = rules();
            change(&mut rules);
            Staircase::new(rules).unwrap_err()
        };
        assert_eq!(with(&|r| r.down = 0), StaircaseError::Down);
        assert_eq!(with(&|r| r.steps.clear()), StaircaseError::Steps);
        assert_eq!(with(&|r| r.steps = vec![0.1, 0.0]), StaircaseError::Steps);
        assert_eq!(with(&|r| r.bounds = [1.0, 0.0]), StaircaseError::Bounds);
        assert_eq!(with(&|r| r.start = 1.5), StaircaseError::Bounds);
        assert_eq!(with(&|r| r.start = f64::NAN), StaircaseError::Bounds);
    }
}
