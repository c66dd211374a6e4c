//! What a participant sees next, chosen from the answers so far, and who compares what: numbers in, levels
//! and pairs out.
//!
//! It runs in the participant's browser while a clip plays, and again in the fold of the log, where the
//! same seed and answers must give the same levels: mathematics is `libm`, sums have a fixed order, there is
//! neither clock nor randomness nor thread, and the bits are the same natively and in WebAssembly.
//!
//! | what | by |
//! |---|---|
//! | [`Track`] | levels of one parameter, by [`QuestPlus`] or a [`Staircase`], until it ends |
//! | [`Psychometric`] | how often an answer is right at a level |
//! | [`Worths`], [`information`], [`spanning_tree`] | the pairs whose answers are expected to tell most |
//! | [`PairDesign`], [`sides`] | pairs dealt evenly over people, items evenly left and right |
//! | [`TrajectoryDesign`], [`Trajectory`] | courses of action units drawn at random, for reverse correlation |
//!
//! ```
//! use mimique_adaptive::{Ends, Grid, QuestPlus, Rule, Shape, Track};
//!
//! // Where between 0 and 1 is a difference seen? Two alternatives: half of the answers are right by chance.
//! let grid = Grid {
//!     shape: Shape::Normal,
//!     levels: (0..=20).map(|step| f64::from(step) / 20.0).collect(),
//!     values: [vec![0.2, 0.4, 0.6, 0.8], vec![0.1, 0.2], vec![0.5], vec![0.02]],
//!     prior: [None, None, None, None],
//! };
//! let rule = Rule::QuestPlus(QuestPlus::new(grid)?);
//! let mut track = Track::new(rule, Ends { trials: 30, stop_sd: None });
//! while let Some(next) = track.next() {
//!     // This person sees every difference from 0.55 on.
//!     track.answer(next.level >= 0.55);
//! }
//! // Where nearly all answers are right is well above where half of the differences are seen.
//! let Rule::QuestPlus(found) = track.rule() else { unreachable!() };
//! assert_eq!(found.mode().location, 0.4);
//! # Ok::<(), mimique_adaptive::GridError>(())
//! ```

mod active_pairs;
mod design;
mod psychometric;
mod quadrature;
mod quest_plus;
mod sides;
mod staircase;
mod track;
mod trajectory;
mod trajectory_design;
mod worths;

pub use active_pairs::{PairInformation, all_pairs, information, spanning_tree};
pub use design::{Balance, DesignError, PairDesign, Presentation};
pub use psychometric::{Psychometric, Shape, logistic, normal_below};
pub use quadrature::GaussHermite;
pub use quest_plus::{
    Choice, Grid, GridError, ImpossibleAnswer, MOST_CELLS, PARAMETERS, QuestPlus,
};
pub use sides::{Orders, Side, sides};
pub use staircase::{Reversal, Staircase, StaircaseError, StaircaseRules, StaircaseThreshold};
pub use track::{Answered, Ends, FEWEST_BEFORE_STOP, NextLevel, Rule, Track};
pub use trajectory::Trajectory;
pub use trajectory_design::{TrajectoryDesign, TrajectoryError, weights_of_units};
pub use worths::{Comparison, Worths};
