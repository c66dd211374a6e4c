//! The animation of a glTF file's morph targets: weights over time, at an even rate.

use std::path::Path;

use gltf_json::Animation;
use gltf_json::animation::{Interpolation, Property};
use gltf_json::validation::Checked;

use super::container::{self, Container};
use super::primitive::target_names;
use crate::ReadError;

/// Frames per second where the keys are not evenly spaced.
const USUAL_RATE_HZ: f64 = 60.0;
/// Keys whose spacing varies by less than this share are evenly spaced.
const EVEN: f64 = 0.02;
/// Longest animation, frames: an hour at 200 Hz.
const MOST_FRAMES: usize = 720_000;

/// Weights of morph targets over time.
#[derive(Debug, Clone, PartialEq)]
pub struct WeightAnimation {
    /// What is worth saying: which animation it is, where the file has several.
    pub notes: Vec<String>,
    /// The targets' names, in the order in which meshes name them.
    pub shape_names: Vec<String>,
    /// Frames per second.
    pub rate_hz: f64,
    /// Frames x names.
    pub weights: Vec<f64>,
}

/// The weights of one mesh over time.
struct Track {
    names: Vec<String>,
    times: Vec<f64>,
    /// Keys x names, or keys x 3 x names of in-tangents, values and out-tangents.
    values: Vec<f64>,
    interpolation: Interpolation,
}

/// Reads an animation of a glTF file: the one that is `wanted`, by its name or its number counted from 1, else the first
/// that moves morph targets; none where none does.
///
/// `folder` is where a `.gltf` file's buffers are looked for. Keys are sampled at their own rate where they are
/// evenly spaced, else at 60 Hz, as the file interpolates them (LINEAR, STEP, CUBICSPLINE).
///
/// # Errors
/// [`ReadError`] with the place in the file; weights that KHR_animation_pointer animates; a wanted animation that is not
/// there, or moves no morph target.
pub fn read_weight_animation(
    bytes: &[u8],
    folder: Option<&Path>,
    wanted: Option<&str>,
) -> Result<Option<WeightAnimation>, ReadError> {
    let container = container::open(bytes, folder)?;
    if let Some((place, pointer)) = container.weight_pointers.first() {
        return Err(ReadError::broken(
            place,
            format!(
                "weights by the extension KHR_animation_pointer ({pointer:?}), which is not read"
            ),
            "export the animation as channels of weights of a node",
        ));
    }
    let animations = &container.root.animations;
    let wanted = wanted.map(|wanted| chosen(animations, wanted)).transpose()?;
    let is_wanted = |number: usize| wanted.is_none_or(|wanted| wanted == number);
    for (number, animation) in animations.iter().enumerate().filter(|(k, _)| is_wanted(*k)) {
        let mut tracks = Vec::new();
        for (c, channel) in animation.channels.iter().enumerate() {
            if channel.target.path == Checked::Valid(Property::MorphTargetWeights) {
                let place = format!("animations[{number}].channels[{c}]");
                let sampler = animation.samplers.get(channel.sampler.value());
                let sampler = sampler.ok_or_else(|| {
                    let what = format!("sampler {} does not exist", channel.sampler.value());
                    ReadError::damaged(&place, what)
                })?;
                tracks.push(track(&container, channel.target.node.value(), sampler, &place)?);
            }
        }
        if !tracks.is_empty() {
            let mut read = sampled(&tracks, &format!("animations[{number}]"))?;
            if animations.len() > 1 && wanted.is_none() {
                read.notes.push(format!(
                    "animation {} is read, the first that moves shapes, of {}",
                    named(animations, number),
                    all_named(animations)
                ));
            }
            return Ok(Some(read));
        }
    }
    match wanted {
        None => Ok(None),
        Some(number) => Err(ReadError::broken(
            format!("animations[{number}]"),
            "it moves no morph target",
            "name another animation",
        )),
    }
}

/// An animation's number, counted from 1, and its name.
fn named(animations: &[Animation], place: usize) -> String {
    let name = animations[place].name.as_ref();
    name.map_or_else(|| (place + 1).to_string(), |name| format!("{} {name:?}", place + 1))
}

fn all_named(animations: &[Animation]) -> String {
    (0..animations.len()).map(|place| named(animations, place)).collect::<Vec<_>>().join(", ")
}

/// The place of the animation of that name, else of that number.
fn chosen(animations: &[Animation], wanted: &str) -> Result<usize, ReadError> {
    let by_name = animations.iter().position(|own| own.name.as_deref() == Some(wanted));
    let number = wanted.parse::<usize>().ok();
    let by_number = number.and_then(|number| number.checked_sub(1));
    by_name.or(by_number.filter(|place| *place < animations.len())).ok_or_else(|| {
        let remedy = match animations.len() {
            0 => "the file has no animation; leave the choice out".to_owned(),
            _ => format!("choose one of {}", all_named(animations)),
        };
        ReadError::broken("animations", format!("none is called {wanted:?}"), remedy)
    })
}

fn track(
    container: &Container,
    node: usize,
    sampler: &gltf_json::animation::Sampler,
    place: &str,
) -> Result<Track, ReadError> {
    let root = &container.root;
    let mesh = root.nodes.get(node).and_then(|node| node.mesh).map(|mesh| mesh.value());
    let mesh = mesh.and_then(|mesh| root.meshes.get(mesh).map(|found| (mesh, found)));
    let (index, mesh) =
        mesh.ok_or_else(|| ReadError::damaged(place, format!("node {node} has no mesh")))?;
    let targets = mesh.primitives.iter().map(|p| p.targets.as_ref().map_or(0, Vec::len));
    let names = target_names(mesh, targets.max().unwrap_or(0), &format!("meshes[{index}]"))?;
    let flat = |accessor, what: &str| -> Result<Vec<f64>, ReadError> {
        let numbers = container.floats::<1>(accessor, &format!("{place}, {what}"))?;
        Ok(numbers.into_iter().map(|[x]| f64::from(x)).collect())
    };
    let (times, values) = (flat(sampler.input, "input")?, flat(sampler.output, "output")?);
    let Checked::Valid(interpolation) = sampler.interpolation else {
        return Err(ReadError::damaged(place, "an interpolation that glTF does not know"));
    };
    let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let wanted = times.len() * names.len() * per_key;
    if times.is_empty() || values.len() != wanted {
        let what = format!(
            "{} weights for {} keys of {} targets, {wanted} expected",
            values.len(),
            times.len(),
            names.len()
        );
        return Err(ReadError::damaged(place, what));
    }
    if let Some(pair) = times.windows(2).find(|pair| pair[1] <= pair[0]) {
        let what = format!("a key at {} s after one at {} s", pair[1], pair[0]);
        return Err(ReadError::damaged(place, what));
    }
    Ok(Track { names, times, values, interpolation })
}

/// All tracks at one even rate, from the first key to the last.
fn sampled(tracks: &[Track], place: &str) -> Result<WeightAnimation, ReadError> {
    let first = tracks.iter().map(|t| t.times[0]).fold(f64::INFINITY, f64::min);
    let last = tracks.iter().map(|t| t.times[t.times.len() - 1]).fold(0.0, f64::max);
    let longest = tracks.iter().max_by_key(|t| t.times.len()).map_or(&[][..], |t| &t.times);
    let rate_hz = even_rate(longest).unwrap_or(USUAL_RATE_HZ);
    let steps = ((last - first) * rate_hz).round();
    if steps.is_nan() || steps >= MOST_FRAMES as f64 {
        let what = format!("{} s at {rate_hz} Hz", last - first);
        return Err(ReadError::broken(place, what, "export an hour at most"));
    }
    let frames = steps as usize + 1;
    let mut shape_names: Vec<String> = Vec::new();
    let mut from: Vec<(usize, usize)> = Vec::new();
    for (number, track) in tracks.iter().enumerate() {
        for (column, name) in track.names.iter().enumerate() {
            if !shape_names.contains(name) {
                shape_names.push(name.clone());
                from.push((number, column));
            }
        }
    }
    let mut weights = Vec::with_capacity(frames * shape_names.len());
    for frame in 0..frames {
        let time = first + frame as f64 / rate_hz;
        let rows: Vec<Vec<f64>> = tracks.iter().map(|track| track.at(time)).collect();
        weights.extend(from.iter().map(|&(track, column)| rows[track][column]));
    }
    Ok(WeightAnimation { notes: Vec::new(), shape_names, rate_hz, weights })
}

/// Keys per second where they are evenly spaced.
fn even_rate(times: &[f64]) -> Option<f64> {
    let (first, last) = (times.first()?, times.last()?);
    let step = (last - first) / (times.len().max(2) - 1) as f64;
    let even = times.windows(2).all(|pair| (pair[1] - pair[0] - step).abs() <= EVEN * step);
    (times.len() > 1 && even && step > 0.0).then(|| 1.0 / step)
}

impl Track {
    /// The weights at a time, seconds; those of the first or last key outside.
    fn at(&self, time: f64) -> Vec<f64> {
        let next = self.times.partition_point(|t| *t <= time);
        let n = self.names.len();
        let cubic = self.interpolation == Interpolation::CubicSpline;
        let per_key = if cubic { 3 * n } else { n };
        let part = |key: usize, of: usize| {
            let start = key * per_key + if cubic { of * n } else { 0 };
            &self.values[start..start + n]
        };
        // Of a cubic key the second part is the value.
        let value = |key: usize| part(key, 1);
        if next == 0 {
            return value(0).to_vec();
        }
        let before = next - 1;
        if next == self.times.len() || self.interpolation == Interpolation::Step {
            return value(before).to_vec();
        }
        let span = self.times[next] - self.times[before];
        let t = (time - self.times[before]) / span;
        if !cubic {
            let pairs = value(before).iter().zip(value(next));
            return pairs.map(|(a, b)| a + t * (b - a)).collect();
        }
        // The Hermite spline of the specification, appendix C.
        let (t2, t3) = (t * t, t * t * t);
        (0..n)
            .map(|k| {
                (2.0 * t3 - 3.0 * t2 + 1.0) * value(before)[k]
                    + (t3 - 2.0 * t2 + t) * span * part(before, 2)[k]
                    + (3.0 * t2 - 2.0 * t3) * value(next)[k]
                    + (t3 - t2) * span * part(next, 0)[k]
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write_glb;
    use mimique_actor::{Density, HeadSpec, build_head};

    #[test]
    fn what_is_written_is_read_back() {
        let head = build_head(&HeadSpec { density: Density::nearest(2000), ..HeadSpec::person(1) });
        let n = head.shape_names.len();
        let weights: Vec<f64> = (0..7 * n).map(|i| f64::from((i % 13) as u8) / 16.0).collect();
        let single: Vec<f32> = weights.iter().map(|w| *w as f32).collect();
        let bytes = write_glb(&head, &single, 50.0).unwrap();
        let read = read_weight_animation(&bytes, None, None).unwrap().unwrap();
        assert!((read.rate_hz - 50.0).abs() < 1e-3, "{}", read.rate_hz);
        assert_eq!(read.weights.len(), 7 * read.shape_names.len());
        for (frame, row) in read.weights.chunks_exact(read.shape_names.len()).enumerate() {
            for (name, w) in read.shape_names.iter().zip(row) {
                let k = head.shape_index(name).unwrap();
                assert!((w - weights[frame * n + k]).abs() < 1e-4, "{frame} {name}");
            }
        }
        let still = write_glb(&head, &[], 50.0).unwrap();
        assert_eq!(read_weight_animation(&still, None, None).unwrap(), None);
    }

    #[test]
    fn keys_are_interpolated_as_the_file_says() {
        let track = |interpolation, values: &[f64]| Track {
            names: vec!["a".to_owned()],
            times: vec![0.0, 1.0, 3.0],
            values: values.to_vec(),
            interpolation,
        };
        let linear = track(Interpolation::Linear, &[0.0, 1.0, 0.0]);
        assert_eq!([-1.0, 0.5, 2.0, 9.0].map(|t| linear.at(t)[0]), [0.0, 0.5, 0.5, 0.0]);
        let step = track(Interpolation::Step, &[0.0, 1.0, 0.5]);
        assert_eq!([0.9, 1.0, 2.9, 3.0].map(|t| step.at(t)[0]), [0.0, 1.0, 1.0, 0.5]);
        // The cubic with the slopes of t^2 is t^2.
        let cubic =
            track(Interpolation::CubicSpline, &[0.0, 0.0, 0.0, 2.0, 1.0, 2.0, 6.0, 9.0, 6.0]);
        for t in [0.25, 0.5, 1.5, 2.75] {
            assert!((cubic.at(t)[0] - t * t).abs() < 1e-12, "{t}");
        }
        assert_eq!(even_rate(&[0.0, 1.0, 3.0]), None);
        assert_eq!(even_rate(&[0.0, 0.02, 0.04]), Some(50.0));
    }

    /// A file of one triangle with two targets and an animation of them: three keys at 0, 0.5 and 1 s.
    fn document(interpolation: &str, outputs: &[f32], target: &str) -> String {
        use base64::Engine as _;
        let vertices: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let numbers = vertices.iter().chain(&[0.0, 0.5, 1.0]).chain(outputs);
        let bytes: Vec<u8> = numbers.flat_map(|x| x.to_le_bytes()).collect();
        let data = base64::engine::general_purpose::STANDARD.encode(&bytes);
        let (length, out) = (bytes.len(), outputs.len());
        format!(
            r#"{{"asset": {{"version": "2.0"}}, "extensionsUsed": ["KHR_animation_pointer"],
            "buffers": [{{"byteLength": {length}, "uri": "data:application/octet-stream;base64,{data}"}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 36, "byteLength": 12}},
              {{"buffer": 0, "byteOffset": 48, "byteLength": {}}}],
            "accessors": [
              {{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}},
              {{"bufferView": 1, "componentType": 5126, "count": 3, "type": "SCALAR", "min": [0], "max": [1]}},
              {{"bufferView": 2, "componentType": 5126, "count": {out}, "type": "SCALAR"}}],
            "meshes": [{{"extras": {{"targetNames": ["jawOpen", "smile"]}},
              "primitives": [{{"attributes": {{"POSITION": 0}}, "targets": [{{"POSITION": 0}}, {{"POSITION": 0}}]}}]}}],
            "nodes": [{{"mesh": 0}}], "scenes": [{{"nodes": [0]}}], "scene": 0,
            "animations": [{{"channels": [{{"sampler": 0, "target": {target}}}],
              "samplers": [{{"input": 1, "output": 2, "interpolation": "{interpolation}"}}]}}]}}"#,
            4 * out
        )
    }

    #[test]
    fn all_three_interpolations_are_read_from_a_file() {
        let node = r#"{"node": 0, "path": "weights"}"#;
        let keys = [0.0, 0.25, 0.5, 0.75, 1.0, 0.0];
        let read = |interpolation: &str, outputs: &[f32]| {
            let text = document(interpolation, outputs, node);
            read_weight_animation(text.as_bytes(), None, None).unwrap().unwrap()
        };
        for interpolation in ["LINEAR", "STEP"] {
            let read = read(interpolation, &keys);
            assert_eq!(
                (read.rate_hz, &read.shape_names[..]),
                (2.0, &["jawOpen", "smile"].map(str::to_owned)[..])
            );
            assert_eq!(read.weights, keys.map(f64::from), "{interpolation}");
            assert!(read.notes.is_empty());
        }
        // Tangents of 0 around each value.
        let cubic: Vec<f32> =
            keys.chunks(2).flat_map(|v| [0.0, 0.0, v[0], v[1], 0.0, 0.0]).collect();
        assert_eq!(read("CUBICSPLINE", &cubic).weights, keys.map(f64::from));
        let short = document("LINEAR", &keys[..4], node);
        let error = read_weight_animation(short.as_bytes(), None, None).unwrap_err().to_string();
        assert!(
            error.starts_with("animations[0].channels[0]: 4 weights for 3 keys of 2"),
            "{error}"
        );
    }

    #[test]
    fn one_of_several_animations_is_chosen_by_name_or_number() {
        let node = r#"{"node": 0, "path": "weights"}"#;
        let text = document("LINEAR", &[0.0, 0.25, 0.5, 0.75, 1.0, 0.0], node);
        let mut file: serde_json::Value = serde_json::from_str(&text).unwrap();
        let moves = file["animations"][0].clone();
        let named = |name: &str, channels: bool| {
            let mut own = moves.clone();
            own["name"] = name.into();
            if !channels {
                own["channels"] = serde_json::json!([]);
            }
            own
        };
        file["animations"] =
            serde_json::json!([named("walk", false), named("joy", true), named("fear", true)]);
        let bytes = file.to_string();
        let read = |wanted| read_weight_animation(bytes.as_bytes(), None, wanted);
        let first = read(None).unwrap().unwrap();
        assert_eq!(
            first.notes,
            [
                "animation 2 \"joy\" is read, the first that moves shapes, of 1 \"walk\", 2 \"joy\", 3 \"fear\""
            ]
        );
        for wanted in ["fear", "3"] {
            assert!(read(Some(wanted)).unwrap().unwrap().notes.is_empty(), "{wanted}");
        }
        let refused = |wanted| read(Some(wanted)).unwrap_err().to_string();
        assert_eq!(
            refused("anger"),
            "animations: none is called \"anger\"; choose one of 1 \"walk\", 2 \"joy\", 3 \"fear\""
        );
        assert_eq!(refused("1"), "animations[0]: it moves no morph target; name another animation");
        assert!(refused("0").starts_with("animations: none is called"));
    }

    #[test]
    fn weights_behind_a_pointer_are_refused_by_name_and_the_mesh_is_read() {
        let pointer = r#"{"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/meshes/0/weights/1"}}}"#;
        let text = document("LINEAR", &[0.0, 0.5, 1.0], pointer);
        let error = read_weight_animation(text.as_bytes(), None, None).unwrap_err().to_string();
        assert_eq!(
            error,
            "animations[0].channels[0]: weights by the extension KHR_animation_pointer \
             (\"/meshes/0/weights/1\"), which is not read; \
             export the animation as channels of weights of a node"
        );
        let other = text.replace("/meshes/0/weights/1", "/materials/0/alphaCutoff");
        assert_eq!(read_weight_animation(other.as_bytes(), None, None).unwrap(), None);
    }
}
