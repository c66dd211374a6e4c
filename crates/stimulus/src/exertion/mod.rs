//! The face of a body that exerts itself: motions and recorded activities in, weights out.
//!
//! ```text
//! motion of a capture --+
//!                       +--> ExertionPart --> Plan --> ExertionTake: a series of seconds, a clip
//! recorded activity ----+
//! ```

mod built_in;
mod drawing;
mod part;
mod take;

pub use built_in::{built_in_bvh, built_in_motion};
pub use drawing::{Drawn, DrawnCourse, DrawnLine, ExertionDrawing};
pub use part::{ExertionPart, ExertionPartError, MotionOptions, PartFacts};
pub use take::ExertionTake;
