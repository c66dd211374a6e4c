//! The integration tests of `mimique-analysis`, in one binary.

mod active_pairs;
mod agreement;
mod block_scripts;
mod choices;
mod conditions;
mod detection;
mod equivalence;
mod faces;
mod fit;
mod other_clips;
mod pair_blocks;
mod pairs;
mod panel_blocks;
mod power;
mod report;
mod roc;
mod scaling;
mod scripts;
mod simulate;
mod sound;
mod support;
mod templates;
mod test_names;
mod thresholds;
mod while_playing;
