//! Built-in performances: posed emotions after published recipes, with human timing; and synthetic
//! motion capture of an actor who performs them, with the truth beside it.

mod envelope;
mod range_of_motion;
mod recipe;
mod take;
mod weights;

pub use range_of_motion::range_of_motion;
pub use recipe::Emotion;
pub use take::{NOISE_MM, Segment, SyntheticTake, range_of_motion_take, synthetic_take};
pub use weights::{Clip, HeadPose, Performance, Phases, performance_weights};
