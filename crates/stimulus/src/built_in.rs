//! The built-in head and its actors as a study and the studio use them: marker map, capture, and the
//! range of motion that a regression learns from.

use mimique_actor::{
    HeadSpec, MarkerSites, SyntheticTake, build_head, marker_sites, range_of_motion_take,
};
use mimique_mocap::{Capture, LengthUnit, WeightsTable};

use crate::{MappedMarker, MarkerMap, MarkerPlace, Training};

/// A range of motion has sensor noise of its own.
const TRAINING: u64 = 0x726f_6d00_0000_0000;

/// Where the built-in markers belong on a built-in head: a vertex each.
pub fn built_in_map(sites: &MarkerSites) -> MarkerMap {
    let face = sites.face_labels().iter().zip(&sites.vertices).map(|(label, &vertex)| {
        MappedMarker { label: label.clone(), place: MarkerPlace::Vertex(vertex) }
    });
    MarkerMap { face: face.collect(), ..MarkerMap::default() }
}

/// What the markers of a built-in actor did, in millimetres.
pub fn built_in_capture(take: &SyntheticTake) -> Capture {
    let (labels, positions) = (take.labels.clone(), take.positions.clone());
    Capture::new(labels, take.rate_hz, LengthUnit::Millimetre, positions)
}

/// The weights that a built-in actor played, without unit.
pub fn built_in_weights(take: &SyntheticTake) -> WeightsTable {
    WeightsTable::at_rate(take.shape_names.clone(), take.truth.clone(), 0, take.rate_hz)
}

/// The range of motion of the built-in actor of that number with its weights: what a regression learns
/// from. `noise_mm` is the sensors' standard deviation in millimetres.
pub fn built_in_training(actor: u64, noise_mm: f64) -> Training {
    let spec = HeadSpec::actor(actor);
    let (head, sites) = (build_head(&spec), marker_sites(&spec));
    let take = range_of_motion_take(&head, &sites, actor ^ TRAINING, noise_mm);
    let [first, end] = take.neutral;
    Training {
        weights: built_in_weights(&take),
        capture: built_in_capture(&take),
        neutral: Some(first..end),
        head: Some(take.head_labels),
    }
}
