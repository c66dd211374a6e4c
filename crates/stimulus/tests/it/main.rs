//! The integration tests of `mimique-stimulus`, in one binary.

mod bank_tools;
mod elan;
mod elan_twins;
mod exertion;
mod gaze;
mod head_motion;
mod known;
mod labels;
mod learnt;
mod lids;
mod prepare;
mod real_takes;
mod segments;
mod sound;
mod suggest_map;
mod support;
mod weights_packs;
