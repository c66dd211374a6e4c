//! The readers on the public files of `tests/records/corpus.md`, which are in no repository of ours: those
//! that lie in the folder given, as `owner+name/path`, must read as the record says.
//! `MIMIQUE_UPDATE_GOLDEN=1` writes anew what it says of them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use mimique_avatar::{Avatar, Part};
use mimique_avatar_files::read_avatar;
use mimique_mocap::{
    CaptureFacts, CaptureFile, ReadError, ReadOptions, Recording, WeightOptions, WeightsTable,
};
use mimique_stimulus::EafDocument;
use mimique_test_support::repository;

const RECORD: &str = "tests/records/corpus.md";

fn main() -> ExitCode {
    let Some(corpus) = std::env::args_os().nth(1).map(PathBuf::from) else {
        eprintln!("give the folder of the files, laid out as owner+name/path");
        return ExitCode::from(2);
    };
    let record = repository().join(RECORD);
    let text = std::fs::read_to_string(&record).unwrap();
    let (mut wrong, mut absent, mut repository) = (Vec::new(), 0, String::new());
    let mut renewed = String::new();
    for line in text.lines() {
        if let Some(heading) = line.strip_prefix("### ") {
            let name = heading.split_whitespace().next().unwrap_or_default();
            repository = name.replace('/', "+");
        }
        let told = row(line).and_then(|(path, expected)| {
            let file = corpus.join(&repository).join(path);
            if !file.exists() {
                eprintln!("absent: {}", file.display());
                absent += 1;
                return None;
            }
            let found = told(&file);
            if found != expected {
                wrong.push(format!("{repository}/{path}\n  is: {found}\n  was: {expected}"));
            }
            Some(format!("| `{path}` | {found} |"))
        });
        renewed.push_str(told.as_deref().unwrap_or(line));
        renewed.push('\n');
    }
    if std::env::var_os("MIMIQUE_UPDATE_GOLDEN").is_some() {
        std::fs::write(&record, renewed).unwrap();
        return ExitCode::SUCCESS;
    }
    eprintln!("{} files read otherwise, {absent} absent\n{}", wrong.len(), wrong.join("\n"));
    ExitCode::from(u8::from(!wrong.is_empty() || absent > 0))
}

/// Path and expectation of a row of a table of the record.
fn row(line: &str) -> Option<(&str, &str)> {
    let (path, expected) = line.strip_prefix("| `")?.split_once("` |")?;
    Some((path, expected.trim().strip_suffix('|')?.trim()))
}

/// What the readers say of a file, in a line of a table.
fn told(file: &Path) -> String {
    let extension = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let told = match extension.as_str() {
        "eaf" => elan(&std::fs::read(file).unwrap()),
        "" | "glb" | "gltf" | "vrm" | "zip" => avatar(file),
        _ => capture(file),
    };
    told.replace('|', "/").replace('\n', " ")
}

fn refused(error: impl std::fmt::Display) -> String {
    format!("refused: {error}")
}

fn capture(file: &Path) -> String {
    let read = || -> Result<String, ReadError> {
        let mut opened = CaptureFile::open(file)?;
        if opened.format().is_some_and(|format| format.holds_weights()) {
            let format = opened.format().map_or("", |format| format.name);
            return opened.weights(&WeightOptions::default()).map(|table| weights(format, &table));
        }
        opened.recording(&ReadOptions::default()).map(|recording| recorded(&recording))
    };
    read().unwrap_or_else(refused)
}

/// Numbers of a capture, among them how far its markers are apart and where the farthest is.
fn recorded(recording: &Recording) -> String {
    let capture = &recording.capture;
    let facts = CaptureFacts::of(recording);
    let metres = capture.unit.metres();
    let farthest =
        capture.positions.iter().filter(|p| p.is_seen()).map(|p| p.0.length()).fold(0.0, f64::max);
    let missing = capture.positions.iter().filter(|p| !p.is_seen()).count();
    format!(
        "{}: {} markers, {} frames from {} at {:.3} Hz ({:.2} s), {}, spanning {:.2} m, at most {:.2} m off; \
         {missing} missing, {} jumps, {} analog, {} events{}",
        recording.format.name,
        facts.markers,
        facts.frames,
        facts.first_frame,
        facts.rate_hz,
        facts.duration_s,
        facts.unit.symbol(),
        facts.extent_m.unwrap_or(f64::NAN),
        farthest * metres,
        facts.jumps.len(),
        facts.analog_channels,
        facts.events.len(),
        noted(&facts.notes),
    )
}

/// Notes that a line can hold.
const MOST_NOTES: usize = 5;

fn noted(notes: &[String]) -> String {
    if notes.is_empty() {
        return String::new();
    }
    let more = match notes.len().saturating_sub(MOST_NOTES) {
        0 => String::new(),
        more => format!("; and {more} more"),
    };
    format!("; notes: {}{more}", notes[..notes.len().min(MOST_NOTES)].join("; "))
}

fn weights(format: &str, table: &WeightsTable) -> String {
    let range = |low: f64, w: f64| if w < low { w } else { low };
    let lowest = table.weights.iter().copied().fold(f64::INFINITY, range);
    let highest = table.weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let filled: usize = table.filled.iter().map(|(from, to)| to - from).sum();
    format!(
        "{format}: {} columns, {} frames at {:.3} Hz, weights {lowest:.3} to {highest:.3}, {filled} filled",
        table.shape_names.len(),
        table.frames.len(),
        table.rate_hz().unwrap_or(f64::NAN),
    )
}

fn avatar(file: &Path) -> String {
    let read = match read_avatar(file) {
        Ok(read) => read,
        Err(error) => return refused(error),
    };
    let avatar = &read.avatar;
    let mut parts: BTreeMap<String, usize> = BTreeMap::new();
    for mesh in &avatar.meshes {
        *parts.entry(format!("{:?}", mesh.part)).or_default() += 1;
    }
    let parts: Vec<String> = parts.iter().map(|(part, n)| format!("{n} {part}")).collect();
    format!(
        "avatar: {} shapes moving up to {:.1} mm, unit {} m, skin {:.3} m high of {} vertices, {}; {} eyeballs{}",
        avatar.shape_names.len(),
        1e3 * farthest_move(avatar),
        read.unit_metres,
        height(avatar),
        skins(avatar).map(|m| m.positions.len()).sum::<usize>(),
        parts.join(", "),
        avatar.eyeballs.len(),
        noted(&read.notes),
    )
}

fn skins(avatar: &Avatar) -> impl Iterator<Item = &mimique_avatar::Mesh> {
    avatar.meshes.iter().filter(|mesh| mesh.part == Part::Skin)
}

fn farthest_move(avatar: &Avatar) -> f64 {
    let deltas = skins(avatar).flat_map(|m| &m.shapes).flat_map(|s| &s.deltas);
    deltas.map(|d| d.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>().sqrt()).fold(0.0, f64::max)
}

fn height(avatar: &Avatar) -> f32 {
    let heights = || skins(avatar).flat_map(|m| &m.positions).map(|p| p[1]);
    heights().fold(f32::NEG_INFINITY, f32::max) - heights().fold(f32::INFINITY, f32::min)
}

fn elan(bytes: &[u8]) -> String {
    let document = match EafDocument::parse(&String::from_utf8_lossy(bytes)) {
        Ok(document) => document,
        Err(error) => return refused(error),
    };
    let tiers = document.tiers();
    let told = || tiers.iter().flat_map(|tier| &tier.annotations);
    let first = told().map(|a| a.start_ms).min().unwrap_or(0);
    let last = told().map(|a| a.end_ms).max().unwrap_or(0);
    let most = tiers.iter().max_by_key(|tier| tier.annotations.len());
    format!(
        "ELAN: {} tiers, {} annotations from {first} to {last} ms, {} without times; most in {:?} ({})",
        tiers.len(),
        told().count(),
        tiers.iter().map(|tier| tier.without_times).sum::<usize>(),
        most.map_or("", |tier| tier.id.as_str()),
        most.map_or(0, |tier| tier.annotations.len()),
    )
}
