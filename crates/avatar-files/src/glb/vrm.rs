//! Expressions of VRM 1.0 (`VRMC_vrm`, *expressions*): names such as `happy` or `aa`, each some morph targets by shares.

use mimique_avatar::Expression;
use serde::Deserialize;
use std::collections::BTreeMap;

use super::container::Container;
use super::primitive::target_names;
use crate::ReadError;

const EXTENSION: &str = "VRMC_vrm";

#[derive(Deserialize)]
struct Vrm {
    #[serde(default)]
    expressions: Groups,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct Groups {
    preset: BTreeMap<String, Group>,
    custom: BTreeMap<String, Group>,
}

#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Group {
    morph_target_binds: Vec<Bind>,
}

/// A morph target of a node's mesh, and its weight where the expression is whole.
#[derive(Deserialize)]
struct Bind {
    node: usize,
    index: usize,
    weight: f64,
}

/// The expressions of a file, presets first, each by name. Those without morph targets are left out.
pub(super) fn expressions(container: &Container) -> Result<Vec<Expression>, ReadError> {
    let extensions = container.root.extensions.as_ref();
    let Some(vrm) = extensions.and_then(|own| own.others.get(EXTENSION)) else {
        return Ok(Vec::new());
    };
    let place = format!("extensions.{EXTENSION}");
    let vrm: Vrm = serde_json::from_value(vrm.clone())
        .map_err(|e| ReadError::damaged(&place, e.to_string()))?;
    let Groups { preset, custom } = vrm.expressions;
    let mut found: Vec<Expression> = Vec::new();
    for (kind, groups) in [("preset", preset), ("custom", custom)] {
        for (name, group) in groups {
            let place = format!("{place}.expressions.{kind}.{name}");
            let shares = group.morph_target_binds.iter().map(|bind| share(container, bind, &place));
            let shares: Vec<(String, f64)> = shares.collect::<Result<_, _>>()?;
            if !shares.is_empty() && !found.iter().any(|known| known.name == name) {
                found.push(Expression { name, shares });
            }
        }
    }
    Ok(found)
}

/// The name of the morph target that is bound, and its share.
fn share(container: &Container, bind: &Bind, place: &str) -> Result<(String, f64), ReadError> {
    let Bind { node, index, weight } = *bind;
    let root = &container.root;
    let mesh = root.nodes.get(node).and_then(|node| node.mesh).map(|mesh| mesh.value());
    let mesh = mesh.and_then(|mesh| Some((mesh, root.meshes.get(mesh)?)));
    let (number, mesh) =
        mesh.ok_or_else(|| ReadError::damaged(place, format!("node {node} has no mesh")))?;
    let count = mesh.primitives.iter().map(|p| p.targets.as_ref().map_or(0, Vec::len)).max();
    let names = target_names(mesh, count.unwrap_or(0), &format!("meshes[{number}]"))?;
    if !weight.is_finite() {
        return Err(ReadError::damaged(place, format!("a weight of {weight}")));
    }
    let name = names.get(index).cloned();
    let name = name.ok_or_else(|| {
        ReadError::damaged(place, format!("morph target {index} of {} in the mesh", names.len()))
    })?;
    Ok((name, weight))
}

#[cfg(test)]
mod tests {
    use crate::read_gltf;
    use crate::write_glb;
    use mimique_actor::{Density, HeadSpec, build_head};
    use serde_json::{Value, json};

    /// The JSON of a written head with expressions, as a file.
    fn with_expressions(expressions: Value) -> Vec<u8> {
        let head = build_head(&HeadSpec { density: Density::COARSE, ..HeadSpec::person(1) });
        let bytes = write_glb(&head, &[], 60.0).unwrap();
        let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
        let mut json: Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
        json["extensionsUsed"] = json!(["VRMC_vrm"]);
        json["extensions"] =
            json!({"VRMC_vrm": {"specVersion": "1.0", "expressions": expressions}});
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let rest = &bytes[20 + length..];
        let mut out = bytes[..8].to_vec();
        out.extend(((20 + text.len() + rest.len()) as u32).to_le_bytes());
        out.extend((text.len() as u32).to_le_bytes());
        out.extend(b"JSON");
        out.extend(text);
        out.extend(rest);
        out
    }

    #[test]
    fn expressions_are_shares_of_shapes() {
        let bind = |index: usize, weight: f64| json!({"node": 0, "index": index, "weight": weight});
        let bytes = with_expressions(json!({
            "preset": {"happy": {"morphTargetBinds": [bind(0, 1.0), bind(2, 0.5)]}, "aa": {}},
            "custom": {"smirk": {"morphTargetBinds": [bind(1, 0.25)]}},
        }));
        let avatar = read_gltf(&bytes, "head", None).unwrap().avatar;
        let found: Vec<(&str, usize)> =
            avatar.expressions.iter().map(|own| (&*own.name, own.shares.len())).collect();
        assert_eq!(found, [("happy", 2), ("smirk", 1)]);
        assert_eq!(avatar.expressions[0].shares[1].1, 0.5);
        assert!(avatar.shape_index(&avatar.expressions[0].shares[1].0).is_some());
        let wrong =
            with_expressions(json!({"preset": {"sad": {"morphTargetBinds": [bind(5000, 1.0)]}}}));
        let refused = read_gltf(&wrong, "head", None).unwrap_err().to_string();
        let place = "extensions.VRMC_vrm.expressions.preset.sad: morph target 5000 of ";
        assert!(refused.starts_with(place), "{refused}");
    }
}
