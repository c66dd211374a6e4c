//! `mimique inspect`: what an avatar, a capture, a weight file, a marker map, a study or a pack
//! holds, told from the file's content.

use mimique_study::Multilingual as _;
use std::borrow::Cow;
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};

use anyhow::anyhow;
use mimique_avatar::Avatar;
use mimique_avatar::pack::{decode_pack, pack_kind};
use mimique_clip::{TakeContent, decode_operators, decode_take, sha256_hex};
use mimique_mocap::{CaptureFacts, CaptureFile, ReadOptions, WeightOptions, WeightsTable};
use mimique_solver::Linking;
use mimique_stimulus::{AvatarSkin, BankDiagnosis, MarkerMap};
use serde_json::{Value, json};

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Avatar (a file, or a folder of OBJ poses), capture, weight file, marker map, study or pack
    file: PathBuf,
    /// Hold the avatar's bank of shapes against Kouadio's five rules
    #[arg(long)]
    bank: bool,
    /// With --bank: marker map of the avatar, for the rules about markers
    #[arg(long, value_name = "MAP", requires = "bank")]
    markers: Option<PathBuf>,
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let blame = |text: String| anyhow!("{}: {text}", args.file.display());
    if args.bank {
        return bank(&args, json);
    }
    let opened = Opened::new(&args.file)
        .map_err(|e| blame(format!("open: {e}; check the path and its permissions")))?;
    let mut facts = facts(&opened).map_err(|e| blame(e.to_string()))?;
    facts["file"] = json!(args.file);
    facts["bytes"] = json!(opened.length);
    let mut out = std::io::stdout().lock();
    if json {
        writeln!(out, "{}", serde_json::to_string_pretty(&facts)?)?;
    } else {
        let mut text = String::new();
        shorten_presence(&mut facts);
        tell(&facts, 0, &mut text);
        out.write_all(text.as_bytes())?;
    }
    Ok(())
}

/// `--bank`: the five rules.
fn bank(args: &Args, json: bool) -> anyhow::Result<()> {
    let blame = |file: &Path, error: &dyn std::fmt::Display| anyhow!("{}: {error}", file.display());
    let read = mimique_avatar_files::read_avatar(&args.file).map_err(|e| blame(&args.file, &e))?;
    let skin = AvatarSkin::of(&read.avatar).map_err(|e| blame(&args.file, &e))?;
    let sites = match &args.markers {
        None => None,
        Some(path) => {
            let text = std::fs::read_to_string(path)
                .map_err(|e| blame(path, &format!("open: {e}; check the path")))?;
            let map = MarkerMap::from_text(&text).map_err(|e| blame(path, &e))?;
            Some(map.resolve(&skin).map_err(|e| blame(path, &e))?)
        }
    };
    let diagnosis = BankDiagnosis::of(&skin, sites.as_deref());
    let mut out = std::io::stdout().lock();
    if json {
        let mut value = serde_json::to_value(&diagnosis)?;
        value["file"] = json!(args.file);
        value["clean"] = json!(diagnosis.is_clean());
        writeln!(out, "{}", serde_json::to_string_pretty(&value)?)?;
    } else {
        write!(out, "file: {}\n{}", args.file.display(), diagnosis.text())?;
    }
    Ok(())
}

/// The file to be inspected: what it begins with tells how much of it is read at a time.
struct Opened<'a> {
    file: &'a Path,
    /// The first 512 bytes.
    head: Vec<u8>,
    length: u64,
    /// All of it, where it is a pipe and can be read only once.
    piped: Option<Vec<u8>>,
}

impl<'a> Opened<'a> {
    fn new(file: &'a Path) -> std::io::Result<Self> {
        let metadata = std::fs::metadata(file)?;
        let piped = match metadata.is_file() || metadata.is_dir() {
            true => None,
            false => Some(std::fs::read(file)?),
        };
        let mut head = Vec::new();
        match &piped {
            Some(bytes) => head.extend(bytes.iter().take(512)),
            None if metadata.is_dir() => {}
            None => _ = std::fs::File::open(file)?.take(512).read_to_end(&mut head)?,
        }
        let length = match (&piped, metadata.is_dir()) {
            (Some(bytes), _) => bytes.len() as u64,
            (None, true) => 0,
            (None, false) => metadata.len(),
        };
        Ok(Self { file, head, length, piped })
    }

    /// As a capture, to be read as a stream.
    fn capture(&self) -> Result<CaptureFile<'_>, mimique_mocap::ReadError> {
        match &self.piped {
            Some(bytes) => CaptureFile::of_bytes(bytes),
            None => CaptureFile::open(self.file),
        }
    }

    /// All its bytes; none of a folder.
    fn bytes(&self) -> anyhow::Result<Cow<'_, [u8]>> {
        match &self.piped {
            Some(bytes) => Ok(Cow::Borrowed(bytes)),
            None if self.file.is_dir() => Ok(Cow::Borrowed(&[])),
            None => Ok(Cow::Owned(std::fs::read(self.file)?)),
        }
    }
}

fn facts(opened: &Opened<'_>) -> anyhow::Result<Value> {
    let (file, head) = (opened.file, &opened.head);
    if let Some(kind) = pack_kind(head) {
        let bytes = opened.bytes()?;
        return match kind {
            "MMAV" => Ok(avatar_facts("avatar pack", &decode_pack(&bytes)?, &bytes)),
            "MMOP" => operators_facts(&bytes),
            _ => take_facts(&bytes),
        };
    }
    let archives: [&[u8]; 3] = [b"PK\x03\x04", b"\x1f\x8b", b"\xfd7zXZ\0"];
    let is_tar = head.get(257..262) == Some(b"ustar");
    let is_archive = is_tar || archives.iter().any(|opening| head.starts_with(opening));
    if file.is_dir() || is_archive || head.starts_with(b"glTF") {
        return avatar_file(file, &opened.bytes()?);
    }
    let mut capture = opened.capture()?;
    match capture.format() {
        Some(format) if format.holds_weights() => {
            let table = capture.weights(&WeightOptions::default())?;
            return Ok(weights_facts(format.name, &table));
        }
        Some(_) => {
            let recording = capture.recording(&ReadOptions::default())?;
            let mut facts = serde_json::to_value(CaptureFacts::of(&recording))?;
            facts["kind"] = json!("capture");
            return Ok(facts);
        }
        None => {}
    }
    let bytes = opened.bytes()?;
    let text = String::from_utf8_lossy(&bytes);
    let text = text.trim_start_matches('\u{feff}').trim_start();
    if text.starts_with("marker,") {
        return map_facts(text);
    }
    match mimique_study::parse(text) {
        Ok(value) if value.get("meshes").is_some() && value.get("asset").is_some() => {
            avatar_file(file, &bytes)
        }
        Ok(value) if value.get("markers").is_some_and(Value::is_object) => map_facts(text),
        Ok(value) if value.get("stimuli").is_some() => study_facts(&value),
        // What is neither is best explained by the reader of captures, which names what it reads.
        _ => match capture.recording(&ReadOptions::default()) {
            Err(error) => Err(error.into()),
            Ok(_) => Err(anyhow!("byte 0: not a file that Mimique knows")),
        },
    }
}

fn avatar_file(file: &Path, bytes: &[u8]) -> anyhow::Result<Value> {
    let read = mimique_avatar_files::read_avatar(file)?;
    let mut facts = avatar_facts("avatar", &read.avatar, bytes);
    facts["unit m"] = json!(read.unit_metres);
    facts["notes"] = json!(read.notes);
    if !read.locked.is_empty() {
        facts["locked"] = json!(read.locked);
    }
    Ok(facts)
}

fn avatar_facts(kind: &str, avatar: &Avatar, bytes: &[u8]) -> Value {
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
    let still: Vec<&str> = (avatar.shape_names.iter().zip(&reach))
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

fn weights_facts(format: &str, table: &WeightsTable) -> Value {
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
    json!({
        "kind": "weights",
        "format": format,
        "frames": weights.len() / n,
        "rate_hz": rate.is_finite().then(|| (rate * 1e6).round() / 1e6),
        "column_count": names.len(),
        "columns": columns.join(", "),
        "outside_0_1": format!("{:.2} %", 100.0 * outside as f64 / weights.len().max(1) as f64),
        "first_frame": table.frames.first(),
        "interpolated": interpolated,
    })
}

fn map_facts(text: &str) -> anyhow::Result<Value> {
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

fn study_facts(value: &Value) -> anyhow::Result<Value> {
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

fn operators_facts(bytes: &[u8]) -> anyhow::Result<Value> {
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
        "association": parts.options.linking.map(|l| match l {
            Linking::Points => "points".to_owned(),
            Linking::Zones { sigma } => format!("zones of {:.1} mm", 1e3 * sigma),
            Linking::Triangles => "triangles".to_owned(),
        }),
        "l_mm": 1e3 * operators.data_scale().sqrt(),
        "tau_m2": operators.shell_scale(),
        "shapes_no_marker_sees": unseen.join(", "),
    }))
}

fn take_facts(bytes: &[u8]) -> anyhow::Result<Value> {
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

/// Of a capture's markers the labels on one line, and a line only for those with gaps.
fn shorten_presence(facts: &mut Value) {
    let Some(presence) = facts.get_mut("presence").and_then(Value::as_array_mut) else { return };
    let labels: Vec<&str> = presence.iter().filter_map(|m| m["label"].as_str()).collect();
    let labels = labels.join(", ");
    presence.retain(|m| m["gaps"] != 0);
    facts["labels"] = json!(labels);
}

/// Facts as indented text: what is empty or unknown is left out.
fn tell(value: &Value, depth: usize, out: &mut String) {
    let Value::Object(map) = value else { return };
    let pad = "  ".repeat(depth);
    // What it is and is called first, what is amiss last; the rest in alphabetical order.
    let rank = |key: &str| match key {
        "file" => 0,
        "kind" => 1,
        "name" | "label" => 2,
        "notes" => 4,
        "warnings" => 5,
        _ => 3,
    };
    let mut entries: Vec<_> = map.iter().collect();
    entries.sort_by_key(|(key, _)| rank(key));
    for (key, value) in entries {
        let label = key.replace('_', " ");
        match value {
            Value::Null => {}
            Value::String(text) if text.is_empty() => {}
            Value::String(text) => out.push_str(&format!("{pad}{label}: {text}\n")),
            Value::Array(items) if items.is_empty() => {}
            Value::Array(items) if items.iter().all(Value::is_object) => {
                out.push_str(&format!("{pad}{label}:\n"));
                for item in items {
                    out.push_str(&format!("{pad}  {}\n", line(item)));
                }
            }
            Value::Array(items) if items.iter().all(Value::is_string) => {
                out.push_str(&format!("{pad}{label}:\n"));
                for item in items {
                    out.push_str(&format!("{pad}  {}\n", scalar(item)));
                }
            }
            Value::Object(_) => {
                out.push_str(&format!("{pad}{label}:\n"));
                tell(value, depth + 1, out);
            }
            other => out.push_str(&format!("{pad}{label}: {}\n", scalar(other))),
        }
    }
}

/// An object on one line.
fn line(value: &Value) -> String {
    let Value::Object(map) = value else { return scalar(value) };
    let name = map.get("name").or_else(|| map.get("label"));
    let rest = map.iter().filter(|(key, value)| {
        !matches!(key.as_str(), "name" | "label") && !matches!(value, Value::Null)
    });
    let rest: Vec<String> =
        rest.map(|(key, value)| format!("{} {}", key.replace('_', " "), scalar(value))).collect();
    match name {
        Some(name) => format!("{}: {}", scalar(name), rest.join(", ")),
        None => rest.join(", "),
    }
}

fn scalar(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(items) => items.iter().map(scalar).collect::<Vec<_>>().join(" "),
        Value::Number(number) => match number.as_f64() {
            // Single-precision numbers and long fractions are for --json.
            Some(x) if number.is_f64() && x != 0.0 && x.abs() < 1e6 => {
                let digits = (6 - x.abs().log10().ceil() as i32).clamp(0, 12) as usize;
                let text = format!("{x:.digits$}");
                match text.contains('.') {
                    true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
                    false => text,
                }
            }
            _ => number.to_string(),
        },
        other => other.to_string(),
    }
}
