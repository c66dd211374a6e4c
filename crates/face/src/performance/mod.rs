//! Built-in performances: posed emotions after published recipes, with human timing; and synthetic
//! motion capture of an actor who performs them, with the truth beside it.

mod envelope;
mod recipe;
mod take;
mod weights;

pub use recipe::Emotion;
pub use take::{Segment, SyntheticTake, synthetic_take};
pub use weights::{Clip, HeadPose, Performance, performance_weights};
