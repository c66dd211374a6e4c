//! The facts of each kind of file, as JSON.

use std::path::Path;

use mimique_avatar::Avatar;
use mimique_clip::{TakeContent, decode_operators, decode_take, sha256_hex};
use mimique_mocap::{Activity, ActivityColumn, Sport, WeightsTable};
use mimique_solver::VertexAssociation;

use mimique_stimulus::{AvatarSkin, GazeStatistics, MarkerMap};
use mimique_study::Multilingual as _;
use serde_json::{Value, json};

/// Facts of an avatar file.
pub(super) fn avatar_file(file: &Path, bytes: &[u8]) -> anyhow::Result<Value> {
    let read = mimique_avatar_files::read_avatar(file)?;
    let mut facts = avatar_facts("avatar", &read.avatar, bytes);
    facts["unit m"] = json!(read.unit_metres);
    facts["notes"] = json!(read.notes);
    // Of a folder or an archive there are no animations.
    if bytes.starts_with(b"glTF") || bytes.trim_ascii_start().starts_with(b"{") {
        match mimique_avatar_files::read_weight_animation(bytes, file.parent(), None) {
            Ok(None) => {}
            Ok(Some(animation)) => {
                let shapes = animation.shape_names.len();
                facts["animation"] = json!({
                    "frames": animation.weights.len() / shapes.max(1),
                    "rate_hz": (animation.rate_hz * 1e3).round() / 1e3,
                    "shapes": animation.shape_names.join(", "),
                    "notes": animation.notes,
                });
            }
            Err(error) => facts["animation"] = json!({ "warnings": [error.to_string()] }),
        }
    }
    if !read.locked.is_empty() {
        facts["locked"] = json!(read.locked);
    }
    Ok(facts)
}

/// Facts of an avatar, and of the bytes that it was read from.
pub(super) fn avatar_facts(kind: &str, avatar: &Avatar, bytes: &[u8]) -> Value {
    let meshes: Vec<Value> = avatar
        .meshes
        .iter()
        .map(|mesh| {
            json!({
                "name": mesh.name,
                "part": format!("{:?}", mesh.part),
                "vertices": mesh.positions.len(),
                "triangles": mesh.triangles.len(),
                "shapes": mesh.shapes.iter().filter(|s| !s.vertices.is_empty()).count(),
            })
        })
        .collect();
    let reach = reach(avatar);
    let shapes: Vec<String> = avatar
        .shape_names
        .iter()
        .zip(&reach)
        .map(|(name, reach)| format!("{name} ({:.1} mm)", reach * 1e3))
        .collect();
    let mut warnings = Vec::new();
    let welded = match AvatarSkin::of(avatar) {
        Ok(skin) => json!(skin.mesh.positions.len()),
        Err(error) => {
            warnings.push(error.to_string());
            Value::Null
        }
    };
    let still: Vec<&str> = (avatar.face_shapes().iter().zip(&reach))
        .filter(|(_, reach)| **reach < 1e-4)
        .map(|(name, _)| name.as_str())
        .collect();
    if !still.is_empty() {
        warnings.push(format!("shapes that do not move the skin: {}", still.join(", ")));
    }
    json!({
        "kind": kind,
        "name": avatar.name,
        "sha256": sha256_hex(bytes),
        "meshes": meshes,
        "skin_vertices_welded": welded,
        "eyeballs": eyeball_facts(avatar),
        "shape_count": avatar.shape_names.len(),
        "shapes": shapes.join(", "),
        "warnings": warnings,
    })
}

/// Largest displacement of the skin by each shape at weight 1, metres.
fn reach(avatar: &Avatar) -> Vec<f64> {
    let of_shape = |k: usize| {
        let skins = avatar.meshes.iter().filter(|m| m.part == mimique_avatar::Part::Skin);
        skins
            .flat_map(|m| &m.shapes[k].deltas)
            .map(|d| d.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>().sqrt())
            .fold(0.0, f64::max)
    };
    (0..avatar.shape_names.len()).map(of_shape).collect()
}

fn eyeball_facts(avatar: &Avatar) -> Vec<Value> {
    let facts = |eye: &mimique_avatar::Eyeball| {
        let looks = eye.looks.iter().map(|l| avatar.shape_names[l.shape].as_str());
        json!({
            "mesh": avatar.meshes[eye.mesh].name,
            "centre_m": eye.centre,
            "turned_by": looks.collect::<Vec<_>>().join(", "),
        })
    };
    avatar.eyeballs.iter().map(facts).collect()
}

/// Facts of a file of weights.
pub(super) fn weights_facts(format: &str, table: &WeightsTable) -> Value {
    let (names, weights) = (&table.shape_names, &table.weights);
    let rate = table.rate_hz().unwrap_or(f64::NAN);
    let n = names.len().max(1);
    let range = |k: usize| {
        let column = || weights.iter().skip(k).step_by(n).copied();
        (column().fold(f64::INFINITY, f64::min), column().fold(f64::NEG_INFINITY, f64::max))
    };
    let outside = weights.iter().filter(|w| !(0.0..=1.0).contains(*w)).count();
    let columns: Vec<String> = (0..names.len())
        .map(|k| (range(k), &names[k]))
        .map(|((low, high), name)| format!("{name} ({low:.3} to {high:.3})"))
        .collect();
    let interpolated: usize = table.filled.iter().map(|(first, end)| end - first).sum();
    let gaze = GazeStatistics::of(names, weights);
    let first = table.frames.first().copied().unwrap_or_default();
    json!({
        "gaze": gaze.as_ref().map(GazeStatistics::words),
        "gaze_warning": gaze.and_then(|gaze| gaze.warning(first)),
        "kind": "weights",
        "format": format,
        "frames": weights.len() / n,
        "rate_hz": rate.is_finite().then(|| (rate * 1e6).round() / 1e6),
        "column_count": names.len(),
        "columns": columns.join(", "),
        "outside_0_1": format!("{:.2} %", 100.0 * outside as f64 / weights.len().max(1) as f64),
        "first_frame": table.frames.first(),
        "interpolated": interpolated,
        "notes": table.notes,
    })
}

/// Facts of a recorded activity.
pub(super) fn activity_facts(activity: &Activity) -> Value {
    let columns: Vec<String> = ActivityColumn::ALL
        .into_iter()
        .filter_map(|column| Some((column, activity.column(column)?)))
        .map(|(column, values)| {
            let seen = || values.iter().copied().filter(|value| !value.is_nan());
            let (low, high) =
                (seen().fold(f64::INFINITY, f64::min), seen().fold(f64::NEG_INFINITY, f64::max));
            format!(
                "{} ({low:.3} to {high:.3}, {} missing)",
                column.name(),
                values.len() - seen().count()
            )
        })
        .collect();
    let gaps = activity.time_s.windows(2).map(|pair| pair[1] - pair[0]);
    json!({
        "kind": "activity",
        "format": activity.format.name,
        "samples": activity.time_s.len(),
        "seconds": activity.time_s.last(),
        "longest_gap_s": gaps.fold(0.0, f64::max),
        "sport": activity.sport.map(|sport| match sport {
            Sport::Cycling => "cycling",
            Sport::OnFoot => "on foot",
        }),
        "columns": columns.join(", "),
        "notes": activity.notes,
    })
}

/// Facts of a marker map.
pub(super) fn map_facts(text: &str) -> anyhow::Result<Value> {
    let map = MarkerMap::from_text(text)?;
    Ok(json!({
        "kind": "marker map",
        "avatar": map.avatar,
        "face_count": map.face.len(),
        "face": map.face_labels().collect::<Vec<_>>().join(", "),
        "head": map.head.join(", "),
        "neutral": map.neutral.map(|n| format!("{}:{}", n.start, n.end)),
    }))
}

/// Facts of a study file.
pub(super) fn study_facts(value: &Value) -> anyhow::Result<Value> {
    let study = mimique_study::Study::from_value(value)?;
    let clips: Vec<String> = study.clips().into_iter().map(|clip| clip.id).collect();
    let list =
        |names: Vec<&String>| names.into_iter().map(String::as_str).collect::<Vec<_>>().join(", ");
    Ok(json!({
        "kind": "study",
        "id": study.id,
        "title": study.study_metadata.title.in_language(study.default_language()),
        "version": study.study_metadata.version,
        "languages": study.languages.join(", "),
        "config_hash": mimique_study::config_hash(value),
        "avatars": list(study.stimuli.avatars.keys().collect()),
        "captures": list(study.stimuli.captures.keys().collect()),
        "methods": list(study.stimuli.methods.keys().collect()),
        "factors": list(study.factor_names().iter().collect()),
        "clip_count": clips.len(),
        "clips": clips.join(", "),
    }))
}

/// Facts of an operators pack.
pub(super) fn operators_facts(bytes: &[u8]) -> anyhow::Result<Value> {
    let operators = decode_operators(bytes)?;
    let parts = operators.parts();
    let unseen: Vec<&str> = (parts.shape_names.iter().zip(operators.marker_reach()))
        .filter(|(_, reach)| *reach < 1e-3)
        .map(|(name, _)| name.as_str())
        .collect();
    Ok(json!({
        "kind": "operators pack",
        "sha256": sha256_hex(bytes),
        "vertices": parts.vertex_count,
        "shape_count": parts.shape_names.len(),
        "marker_count": parts.marker_labels.len(),
        "markers": parts.marker_labels.join(", "),
        "laplacian": parts.options.laplacian,
        "k_s": parts.options.k_s,
        "k_b": parts.options.k_b,
        "association": parts.options.association.map(|l| match l {
            VertexAssociation::Points => "points".to_owned(),
            VertexAssociation::Zones { sigma } => format!("zones of {:.1} mm", 1e3 * sigma),
            VertexAssociation::Triangles => "triangles".to_owned(),
        }),
        "l_mm": 1e3 * operators.data_scale().sqrt(),
        "tau_m2": operators.shell_scale(),
        "shapes_no_marker_sees": unseen.join(", "),
    }))
}

/// Facts of a take pack.
pub(super) fn take_facts(bytes: &[u8]) -> anyhow::Result<Value> {
    let take = decode_take(bytes)?;
    let mut facts = json!({
        "kind": "take pack",
        "sha256": sha256_hex(bytes),
        "rate_hz": take.rate_hz,
        "first_frame": take.first_frame,
        "frames_played": take.played.len(),
        "duration_s": take.played.len() as f64 / take.rate_hz,
    });
    let labels = |columns: &[usize], all: &[String]| {
        columns.iter().map(|&c| all[c].as_str()).collect::<Vec<_>>().join(", ")
    };
    match &take.content {
        TakeContent::Markers(m) => {
            facts["holds"] = json!("markers");
            facts["face"] = json!(labels(&m.face, &m.labels));
            facts["head"] = json!(labels(m.head.as_deref().unwrap_or_default(), &m.labels));
            let missing = m.positions.iter().filter(|x| x.is_nan()).count() / 3;
            facts["missing_markers"] = json!(missing);
        }
        TakeContent::Weights { shape_names, .. } => {
            facts["holds"] = json!("recorded weights");
            facts["shapes"] = json!(shape_names.join(", "));
        }
    }
    Ok(facts)
}
