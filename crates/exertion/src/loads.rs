//! What a person carries.

use serde_json::Value;

use crate::error::ExertionError;
use crate::json::{Object, number};

/// What is carried, kg.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Loads {
    /// In the left hand.
    pub left_hand: f64,
    /// In the right hand.
    pub right_hand: f64,
    /// On the back.
    pub back: f64,
}

impl Loads {
    /// Names of the places, in JSON and on the command line.
    pub const NAMES: [&'static str; 3] = ["leftHand", "rightHand", "back"];

    /// The load of a name.
    pub fn by_name(&mut self, name: &str) -> Option<&mut f64> {
        Some(match name {
            "leftHand" => &mut self.left_hand,
            "rightHand" => &mut self.right_hand,
            "back" => &mut self.back,
            _ => return None,
        })
    }

    pub(crate) fn of_json(at: &str, value: &Value) -> Result<Self, ExertionError> {
        let mut loads = Self::default();
        for (place, key, value) in Object::of(at, value)?.members() {
            let Some(load) = loads.by_name(key) else {
                return Err(ExertionError::Unknown { place, known: Self::NAMES.to_vec() });
            };
            *load = number(&place, value)?;
        }
        Ok(loads)
    }
}
