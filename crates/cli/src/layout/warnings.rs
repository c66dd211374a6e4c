//! What should be looked at in a layout.

use mimique_layout::{Chosen, MotionSource, Units};

use super::args::Make;
use super::ground::Ground;

/// What should be looked at.
pub(super) fn warnings(
    args: &Make,
    ground: &Ground<'_>,
    units: &Units<'_>,
    chosen: &Chosen,
) -> Vec<String> {
    let (face, motion) = (ground.face, &ground.motion);
    let mut warnings = Vec::new();
    if motion.source == MotionSource::IndependentShapes {
        warnings.push(
            "no motion is given: every shape counts by itself, standard deviation 0.25; give --rom or --take of the \
             people to be captured"
                .to_owned(),
        );
    }
    let unseen: Vec<&str> =
        motion.rested.iter().map(|&k| face.skin.shape_names[k].as_str()).collect();
    if !unseen.is_empty() && !args.as_thesis {
        warnings.push(format!(
            "{} shapes move no allowed place by 1 mm, or turn the eyes: no layout tells them, and they rest in the \
             simulated takes: {}",
            unseen.len(),
            unseen.join(", ")
        ));
    }
    if !chosen.without_room.is_empty() {
        let names: Vec<String> = chosen.without_room.iter().map(ToString::to_string).collect();
        warnings.push(format!(
            "clusters {} found no room at {:.1} mm: markers stand where others are farthest instead",
            names.join(", "),
            1e3 * units.spacing.minimum()
        ));
    }
    if let (Some(rate), Some(speed)) = (args.capture_rate, motion.top_speed(&chosen.vertices())) {
        let least = units.spacing.minimum() * rate;
        if speed > least {
            warnings.push(format!(
                "markers go up to {speed:.2} m/s and could jump to a neighbour's place between two frames: at {rate} \
                 Hz keep {:.1} mm, or capture at {:.0} Hz",
                1e3 * speed / rate,
                speed / units.spacing.minimum()
            ));
        }
    }
    warnings
}
