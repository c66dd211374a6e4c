//! `mimique inspect`: what an avatar, a capture, a weight file, an activity, a marker map, a study or a pack
//! holds, told from the file's content.

mod facts;
mod opened;
mod text;

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::anyhow;
use mimique_avatar::pack::{decode_pack, pack_kind};
use mimique_mocap::{
    CaptureFacts, ReadError, ReadOptions, WeightOptions, activity_formats, formats,
    read_activity_bytes, recognise, recognise_activity,
};
use mimique_server::ZIP_START;
use mimique_stimulus::{AvatarSkin, BankDiagnosis, MarkerMap};
use serde_json::{Value, json};

use self::facts::{
    activity_facts, avatar_facts, avatar_file, map_facts, operators_facts, study_facts, take_facts,
    weights_facts,
};
use self::opened::Opened;
use self::text::{shorten_presence, tell};

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Avatar (a file, or a folder of OBJ poses), capture, weight file, activity, marker map, study or pack
    file: PathBuf,
    /// Hold the avatar's bank of shapes against Kouadio's five rules
    #[arg(long)]
    bank: bool,
    /// Frames per second of a file that has none
    #[arg(long, value_name = "HZ")]
    mocap_rate: Option<f64>,
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
    let mut facts = facts(&opened, args.mocap_rate).map_err(|e| blame(e.to_string()))?;
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

/// The facts of a file, by what it holds.
fn facts(opened: &Opened<'_>, rate_hz: Option<f64>) -> anyhow::Result<Value> {
    let (file, head) = (opened.file, &opened.head);
    if let Some(kind) = pack_kind(head) {
        let bytes = opened.bytes()?;
        return match kind {
            "MMAV" => Ok(avatar_facts("avatar pack", &decode_pack(&bytes)?, &bytes)),
            "MMOP" => operators_facts(&bytes),
            _ => take_facts(&bytes),
        };
    }
    let archives: [&[u8]; 3] = [ZIP_START, b"\x1f\x8b", b"\xfd7zXZ\0"];
    let is_tar = head.get(257..262) == Some(b"ustar");
    // A zip archive may be NumPy's.
    let is_archive = (is_tar || archives.iter().any(|opening| head.starts_with(opening)))
        && recognise(head).is_none();
    if file.is_dir() || is_archive || head.starts_with(b"glTF") {
        return avatar_file(file, &opened.bytes()?);
    }
    if recognise_activity(head).is_some() {
        return Ok(activity_facts(&read_activity_bytes(&opened.bytes()?)?));
    }
    let mut capture = opened.capture()?;
    match capture.format() {
        Some(format) if format.holds_weights() => {
            let table = capture.weights(&WeightOptions { rate_hz, ..WeightOptions::default() })?;
            return Ok(weights_facts(format.name, &table));
        }
        Some(_) => {
            let recording =
                capture.recording(&ReadOptions { rate_hz, ..ReadOptions::default() })?;
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
        _ => Err(unknown(capture.recording(&ReadOptions::default()).err())),
    }
}

/// What to say of a file of no known kind: what it starts with, and everything that is told of.
fn unknown(error: Option<ReadError>) -> anyhow::Error {
    let found = match error {
        Some(ReadError::Unrecognised { found, .. }) => format!(", {found}"),
        Some(other) => return other.into(),
        None => String::new(),
    };
    let formats: Vec<&str> = formats().iter().map(|format| format.name).collect();
    let activities: Vec<&str> = activity_formats().iter().map(|format| format.name).collect();
    anyhow!(
        "byte 0: not a file that Mimique knows{found}; give an avatar (.glb, .gltf, a folder or an archive of OBJ \
         poses), a capture or weights ({}), an activity ({}), a marker map (CSV with a column marker, or JSON), a study file \
         or a pack",
        formats.join(", "),
        activities.join(", ")
    )
}
