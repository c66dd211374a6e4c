//! Answers that choose between two clips, told of the levels of a factor: which levels stood beside each other,
//! on which side, and which was chosen; what tests say of them, and in words.

pub(crate) mod answers;
pub(crate) mod preference;
pub(crate) mod reading;
pub(crate) mod tested;
