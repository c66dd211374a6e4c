//! How a participant is named.

/// The public name of a participant: `p0007`.
pub fn participant_id(number: u64) -> String {
    format!("p{number:04}")
}
