//! A track: levels one after the other by a rule, until it ends.
//!
//! The page asks a track for its next level; the fold of a log replays the answers and must find the same
//! levels. [`Track::after`] says what would come after either answer, so that both clips can be made
//! ready while one is still shown.

use crate::quest_plus::QuestPlus;
use crate::staircase::Staircase;

/// Fewest trials of a track that may end by its standard deviation.
pub const FEWEST_BEFORE_STOP: usize = 20;

/// What chooses the levels.
#[derive(Debug, Clone)]
pub enum Rule {
    /// The most informative level of a grid.
    QuestPlus(QuestPlus),
    /// Up and down.
    Staircase(Staircase),
}

/// When a track ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ends {
    /// After so many trials at the latest.
    pub trials: usize,
    /// QUEST+ alone: as soon as the location's standard deviation is below this, though not before
    /// [`FEWEST_BEFORE_STOP`] trials.
    pub stop_sd: Option<f64>,
}

/// A level that is to be shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NextLevel {
    /// The level.
    pub level: f64,
    /// QUEST+ alone: the entropy expected after the answer, in nats.
    pub entropy: Option<f64>,
}

/// A trial that was answered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answered {
    /// The level that was shown.
    pub level: f64,
    /// Whether the answer was right.
    pub right: bool,
}

/// The state of a track.
#[derive(Debug, Clone)]
pub struct Track {
    rule: Rule,
    ends: Ends,
    answered: Vec<Answered>,
    /// Place among the grid's levels, and what comes next; none at the end.
    next: Option<(usize, NextLevel)>,
    impossible: usize,
}

impl Track {
    /// Before the first answer.
    pub fn new(rule: Rule, ends: Ends) -> Self {
        let mut track = Self { rule, ends, answered: Vec::new(), next: None, impossible: 0 };
        track.look_ahead();
        track
    }

    fn look_ahead(&mut self) {
        self.next = (!self.is_over()).then(|| match &self.rule {
            Rule::QuestPlus(track) => {
                let choice = track.choice();
                let entropy = Some(choice.entropy);
                (choice.place, NextLevel { level: choice.level, entropy })
            }
            Rule::Staircase(track) => (0, NextLevel { level: track.level(), entropy: None }),
        });
    }

    fn is_over(&self) -> bool {
        let settled = || match (&self.rule, self.ends.stop_sd) {
            (Rule::QuestPlus(track), Some(stop)) => {
                self.answered.len() >= FEWEST_BEFORE_STOP && track.moments()[0][1] < stop
            }
            _ => false,
        };
        self.answered.len() >= self.ends.trials || settled()
    }

    /// What is shown next; none at the end.
    pub fn next(&self) -> Option<NextLevel> {
        self.next.map(|(_, next)| next)
    }

    /// Takes in the answer at [`Track::next`]; at the end nothing happens.
    pub fn answer(&mut self, right: bool) {
        let Some((place, NextLevel { level, .. })) = self.next else { return };
        match &mut self.rule {
            // What no cell of the grid allows is counted and leaves the posterior as it was: an answer is
            // never lost, and a track never stops by one.
            Rule::QuestPlus(track) => {
                self.impossible += usize::from(track.answer(place, right).is_err());
            }
            Rule::Staircase(track) => track.answer(right),
        }
        self.answered.push(Answered { level, right });
        self.look_ahead();
    }

    /// The track as it would be after an answer.
    pub fn after(&self, right: bool) -> Self {
        let mut after = self.clone();
        after.answer(right);
        after
    }

    /// The trials so far.
    pub fn answered(&self) -> &[Answered] {
        &self.answered
    }

    /// Answers that no cell of the grid allows.
    pub fn impossible(&self) -> usize {
        self.impossible
    }

    /// The rule and its state.
    pub fn rule(&self) -> &Rule {
        &self.rule
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::psychometric::Shape;
    use crate::quest_plus::Grid;
    use crate::staircase::StaircaseRules;

    fn quest(guess: f64) -> Rule {
        let grid = Grid {
            shape: Shape::Logistic,
            levels: (0..=10).map(f64::from).collect(),
            values: [(1..10).map(f64::from).collect(), vec![0.5, 1.0], vec![guess], vec![0.02]],
            prior: [const { None }; 4],
        };
        Rule::QuestPlus(QuestPlus::new(grid).unwrap())
    }

    fn staircase() -> Rule {
        let (steps, bounds) = (vec![2.0, 1.0], [0.0, 10.0]);
        Rule::Staircase(
            Staircase::new(StaircaseRules { down: 2, start: 8.0, steps, bounds }).unwrap(),
        )
    }

    #[test]
    fn what_would_come_after_an_answer_comes() {
        for rule in [quest(0.5), staircase()] {
            let mut track = Track::new(rule, Ends { trials: 12, stop_sd: None });
            for trial in 0..12 {
                let right = trial % 3 != 1;
                let expected = track.after(right).next();
                track.answer(right);
                assert_eq!(track.next(), expected);
            }
            assert_eq!((track.answered().len(), track.next()), (12, None));
            track.answer(true);
            assert_eq!(track.answered().len(), 12, "an answer after the end is none");
        }
    }

    #[test]
    fn a_track_ends_when_it_is_sure_but_not_before_twenty() {
        let ends = Ends { trials: 400, stop_sd: Some(1.0) };
        let mut track = Track::new(quest(0.0), ends);
        while let Some(next) = track.next() {
            track.answer(next.level > 4.5);
        }
        assert_eq!(track.answered().len(), FEWEST_BEFORE_STOP);
        let ends = Ends { trials: 10, ..ends };
        let mut track = Track::new(quest(0.0), ends);
        while track.next().is_some() {
            track.answer(true);
        }
        assert_eq!(track.answered().len(), 10);
    }

    #[test]
    fn an_impossible_answer_is_counted_and_the_track_goes_on() {
        let grid = Grid {
            shape: Shape::Weibull,
            levels: vec![0.0],
            values: [vec![1.0], vec![1.0], vec![0.0], vec![0.0]],
            prior: [const { None }; 4],
        };
        let rule = Rule::QuestPlus(QuestPlus::new(grid).unwrap());
        let mut track = Track::new(rule, Ends { trials: 2, stop_sd: None });
        track.answer(true);
        assert_eq!((track.impossible(), track.answered().len()), (1, 1));
        assert_eq!(track.next().map(|next| next.level), Some(0.0));
    }
}
