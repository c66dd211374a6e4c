//! The avatar at rest of a block of reverse correlation: its pack, and how it shows the units that are drawn.

use mimique_avatar::ActionUnit;
use mimique_solver::{Method, MethodSpec};
use mimique_study::{Clip, ClipSource, ReverseCorrelationComponent, Study, UnitShapes};

use super::cache::Cache;
use super::sources::Sources;
use super::{PrepareError, avatar_pack, pointer};
use crate::provenance::Provenance;

/// Prepares the clip that a block's trials move.
///
/// # Errors
/// [`PrepareError`]: an avatar that is absent or damaged, a unit that it cannot show, two units that are the same
/// movement on it.
pub(super) fn clip_at_rest(
    study: &Study,
    clip: &Clip,
    block: &ReverseCorrelationComponent,
    sources: &Sources<'_>,
    cache: &Cache,
) -> Result<ClipSource, PrepareError> {
    let file = sources.avatar(&clip.avatar)?;
    let shape_names = &file.avatar.shape_names;
    let mut units: Vec<ActionUnit> = Vec::new();
    let component = study.reverse_correlations().find(|(_, own)| own.clip == clip.id);
    let component = component.map_or("", |(name, _)| name);
    for (index, name) in block.units.iter().enumerate() {
        let at = pointer(&["components", component, "units", &index.to_string()]);
        let Some(unit) = ActionUnit::of(name, shape_names) else {
            let all = ActionUnit::of_avatar(shape_names);
            let all: Vec<&str> = all.iter().map(|unit| unit.name.as_str()).collect();
            let message = format!(
                "the avatar {:?} cannot show {name:?}; it shows {}, of one side as in AU12_L",
                clip.avatar,
                all.join(", ")
            );
            return Err(PrepareError::new(at, message));
        };
        if let Some(same) = units.iter().find(|known| known.shapes == unit.shapes) {
            let message = format!(
                "{name:?} moves the same shapes of the avatar {:?} as {:?}; name one of them",
                clip.avatar, same.name
            );
            return Err(PrepareError::new(at, message));
        }
        units.push(unit);
    }
    let avatar = avatar_pack(&file, cache)?;
    let units = UnitShapes {
        shapes: shape_names.len(),
        units: units.into_iter().map(|unit| unit.shapes).collect(),
    };
    let provenance = Provenance::new()
        .json("avatar", avatar.hash.as_str())
        .json("units", serde_json::to_value(&units).unwrap_or_default())
        .hash();
    Ok(ClipSource {
        bytes: avatar.bytes.len() as u64,
        duration_ms: 1e3 * block.duration_seconds,
        avatar: avatar.hash,
        operators: String::new(),
        take: String::new(),
        method: MethodSpec::new(Method::Recorded),
        provenance,
        weights_hash: String::new(),
        look: study.stimuli.avatars[&clip.avatar].look.word().to_owned(),
        video: None,
        sound: None,
        units: Some(units),
    })
}
