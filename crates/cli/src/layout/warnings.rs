//! What should be looked at in a layout.

use mimique_layout::{Chosen, Layout, MotionSource, Units, nearest_in_motion};

use super::args::Make;
use super::ground::Ground;

/// What should be looked at.
pub(super) fn warnings(
    args: &Make,
    ground: &Ground<'_>,
    units: &Units<'_>,
    chosen: &Chosen,
    layout: &Layout,
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
    // Choosing looks at the frames that tell most; what is chosen is held against every frame.
    let nearest = nearest_in_motion(face, motion, &chosen.vertices());
    if let Some((pair, apart)) =
        nearest.filter(|(_, apart)| *apart < 0.98 * units.spacing.minimum())
    {
        let label = |v: usize| {
            let found = layout.markers.iter().find(|marker| marker.vertex == v);
            found.map_or_else(|| v.to_string(), |marker| marker.label.clone())
        };
        warnings.push(format!(
            "{} and {} come as near as {:.1} mm in the motion that is given",
            label(pair[0]),
            label(pair[1]),
            1e3 * apart
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
