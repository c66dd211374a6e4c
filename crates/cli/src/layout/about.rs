//! What a layout's own file tells of it.

use mimique_stimulus::Provenance;
use serde_json::{Value, json};

use super::args::Make;
use super::{CountReason, Made};

/// The member `layout` of the map.
pub(super) fn about(args: &Make, made: &Made<'_, '_>) -> Value {
    let people: Vec<Value> = (made.ground.motion.people.iter())
        .map(|person| {
            let frames = person.frames.len() / made.ground.motion.basis.width;
            json!({"name": person.name, "frames": frames, "rateHz": person.rate_hz})
        })
        .collect();
    let parts: Vec<&str> = made.ground.place.exclude.iter().map(|part| part.word()).collect();
    let mm = |metres: f64| (1e7 * metres).round() / 1e4;
    let mut value = json!({
        "method": made.ground.method,
        "asThesis": args.as_thesis,
        "seed": args.seed,
        "symmetric": !args.free && !args.as_thesis,
        "motion": {"source": made.ground.motion.source, "people": people},
        "solve": args.solve,
        "noiseMm": mm(made.ground.conditions.noise),
        "slipMm": mm(made.ground.conditions.slip),
        "smoothing": args.smoothing,
        "minimumDistanceMm": mm(made.ground.distance),
        "exclude": parts,
        "candidates": made.ground.candidates.counts,
        "rehearsedErrorMm": made.rehearsed_mm,
        "order": made.layout.markers.iter().zip(made.worth.iter().map(Some).chain(std::iter::repeat(None)))
            .map(|(marker, worth)| json!({"label": marker.label, "worth": worth}))
            .collect::<Vec<_>>(),
        "provenance": provenance(args, made),
    });
    if let Some(heads) = &made.heads {
        value["headErrorMm"] = json!(1e3 * heads.error);
    }
    if made.count != CountReason::Asked
        && let Some(comparison) = &made.comparison
    {
        let curve = comparison.main_curve(made.ground.method.word());
        value["curve"] = json!(curve);
    }
    value
}

/// The hash of everything that a layout is made of, and of the layout.
fn provenance(args: &Make, made: &Made<'_, '_>) -> String {
    let frames: Vec<f64> = made.ground.motion.frames().flatten().copied().collect();
    let vertices: Vec<f64> = made.layout.vertices().iter().map(|&v| v as f64).collect();
    let heads: Vec<f64> = made.layout.head.iter().map(|marker| marker.vertex as f64).collect();
    Provenance::new()
        .json("avatar", made.ground.key.as_str())
        .numbers("motion", &frames)
        .json("method", made.ground.method.word())
        .json("asThesis", args.as_thesis)
        .json("seed", args.seed)
        .json("conditions", json!([made.ground.conditions.noise, made.ground.conditions.slip]))
        .json("smoothing", args.smoothing)
        .json("solve", json!(args.solve))
        .json("distance", made.ground.distance)
        .json("where", json!(made.ground.place))
        .numbers("vertices", &vertices)
        .numbers("heads", &heads)
        .hash()
}
