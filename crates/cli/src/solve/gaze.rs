//! The gaze that `mimique solve` is given.

use mimique_mocap::WeightOptions;
use mimique_stimulus::{GazeTrack, GivenGaze, read_performance};

use super::args::Args;
use super::blame;

/// The gaze of the options; none where the eyes rest.
pub(super) fn given(args: &Args) -> anyhow::Result<Option<GivenGaze>> {
    if let Some(path) = &args.gaze_track {
        let options = WeightOptions { rate_hz: args.mocap_rate, ..WeightOptions::default() };
        let table = read_performance(path, &options).map_err(|e| blame(path, e))?.table;
        let later = args.gaze_later.unwrap_or_default();
        return Ok(Some(GivenGaze::Track(
            GazeTrack::of(&table, later).map_err(|e| blame(path, e))?,
        )));
    }
    let held = args.gaze_held.map(|angles| GivenGaze::Held(angles.0));
    Ok(held.or_else(|| args.gaze_target.clone().map(GivenGaze::Target)))
}
