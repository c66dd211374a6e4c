//! The packs that a clip is played from, each decoded by the module that encodes it.

mod operators;
mod take;
mod tracks;

pub use operators::{decode_inflated_operators, decode_operators, encode_operators};
pub use take::{
    SegmentMarkers, TakeContent, TakePack, decode_take, encode_take, encode_take_in_steps,
    stored_step,
};
