//! What a study's stimuli weigh as packs and as video. `docs/measured/pack-sizes.md` keeps what it says.
//!
//! `pack_sizes STUDY.json [CLIP ...]` prepares the study and adds up what a participant loads; with
//! `ict` for the study, 54 clips of ICT-FaceKit and the planted take of the real data (18 segments
//! of 4 s, three methods). The clips named are rendered at 1280 x 720 and 60 frames per second, whole,
//! and encoded with `ffmpeg` (libx264, CRF 18); their mean counts for all clips.

use std::collections::BTreeMap;
use std::error::Error;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use mimique_avatar::Avatar;
use mimique_avatar::pack::{decode_pack, pack_kind};
use mimique_clip::{SolvedTake, TakeContent, TakePack, encode_take_in_steps, solve_packs};
use mimique_stage::offscreen::Offscreen;
use mimique_stage::{Look, View};
use mimique_stimulus::{Places, prepare, weight_steps};
use mimique_study::Study;
use serde_json::{Value, json};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Frames per second of pictures and of weights at the playing rate.
const RATE_HZ: f64 = 60.0;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (study_file, videos) =
        arguments.split_first().ok_or("usage: pack_sizes STUDY.json|ict [CLIP ...]")?;
    let folder = tempfile::tempdir()?;
    let (study, places) = study(study_file, folder.path())?;
    let all =
        |faults: Vec<_>| faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    let prepared = prepare(&study, &places, &mut |_| {}).map_err(all)?;
    let out = &mut std::io::stdout().lock();

    let read = |hash: &str| std::fs::read(places.packs.join(hash));
    let mut sizes: BTreeMap<&str, (usize, usize, usize)> = BTreeMap::new();
    let mut seen = std::collections::BTreeSet::new();
    for clip in prepared.clips.values() {
        for hash in [&clip.avatar, &clip.operators, &clip.take] {
            if seen.insert(hash.clone()) {
                let bytes = read(hash)?;
                let entry = sizes.entry(pack_kind(&bytes).unwrap_or("?")).or_default();
                *entry = (entry.0 + 1, entry.1 + bytes.len(), entry.2.max(bytes.len()));
            }
        }
    }
    let total: usize = sizes.values().map(|s| s.1).sum();
    writeln!(out, "{study_file}: {} clips, {total} bytes of packs", prepared.clips.len())?;
    for (kind, (count, bytes, largest)) in &sizes {
        writeln!(out, "  {kind}: {count} packs, {bytes} bytes, {largest} the largest")?;
    }

    let mut clips = Vec::new();
    for (id, source) in &prepared.clips {
        let avatar = decode_pack(&read(&source.avatar)?)?;
        let solved = solve_packs(&read(&source.operators)?, &read(&source.take)?, &source.method)?;
        clips.push((id, avatar, played(&solved)));
    }
    let (mut largest, mut all_weights, mut error_m) = (0, 0, 0f64);
    for (_, avatar, weights) in &clips {
        let (bytes, error) = weights_pack(avatar, weights);
        largest = largest.max(bytes);
        all_weights += bytes;
        error_m = error_m.max(error);
    }
    let longest = clips.iter().map(|(_, _, w)| w.len()).max().unwrap_or(0);
    let avatars = sizes.get("MMAV").map_or(0, |s| s.1);
    writeln!(
        out,
        "as weights at {RATE_HZ} Hz: {all_weights} bytes, {largest} at most for {:.2} s, \
         {:.2} um off; with avatars {}",
        longest as f64 / RATE_HZ,
        1e6 * error_m,
        all_weights + avatars
    )?;

    if !videos.is_empty() {
        let mut bytes = 0.0;
        let mut seconds = 0.0;
        let chosen: Vec<_> = clips.iter().filter(|(id, ..)| videos.contains(id)).collect();
        if chosen.len() < videos.len() {
            return Err(format!("{videos:?}: not all of them are clips").into());
        }
        for (id, avatar, weights) in &chosen {
            let size = video(avatar, weights, &folder.path().join("clip.mp4"))?;
            writeln!(
                out,
                "  {id}: {size} bytes as video, {:.2} s",
                weights.len() as f64 / RATE_HZ
            )?;
            bytes += size as f64;
            seconds += weights.len() as f64 / RATE_HZ;
        }
        let all: f64 = clips.iter().map(|(_, _, w)| w.len() as f64 / RATE_HZ).sum();
        let estimate = bytes / seconds * all;
        writeln!(
            out,
            "video of all {} clips, {all:.0} s, at the {} clips' rate: {estimate:.0} bytes, \
             {:.1} times the packs, {:.1} times avatars and weights",
            clips.len(),
            chosen.len(),
            estimate / total as f64,
            estimate / (all_weights + avatars) as f64
        )?;
    }
    Ok(())
}

/// The study, and where its files are.
fn study(file: &str, folder: &Path) -> Result<(Study, Places)> {
    let repository = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    let data = std::env::var_os("MIMIQUE_DATA")
        .map_or_else(|| repository.join("../shared/data"), PathBuf::from);
    let packs = folder.join("packs");
    if file != "ict" {
        let value = mimique_study::parse(&std::fs::read_to_string(file)?)?;
        let study = Path::new(file).parent().unwrap_or(Path::new(".")).to_owned();
        return Ok((Study::from_value(&value)?, Places { study, data: Some(data), packs }));
    }
    // Markers by position: the vertices of the two files are numbered differently.
    let skin = mimique_avatar_files::read_avatar(&data.join("lsts/avatar_skin.glb"))?.avatar;
    let points = &skin.skin().ok_or("no skin")?.positions;
    let (mut markers, mut head) = (serde_json::Map::new(), Vec::new());
    for line in std::fs::read_to_string(data.join("lsts/mapping.csv"))?.lines().skip(1) {
        let [marker, role, vertex] = line.split(',').collect::<Vec<_>>()[..] else { continue };
        markers.insert(marker.to_owned(), json!({"position": points[vertex.parse::<usize>()?]}));
        if role == "head" {
            head.push(marker.to_owned());
        }
    }
    let map =
        json!({"avatar": "ict", "unit": "m", "markers": markers, "head": head, "neutral": [0, 60]});
    std::fs::write(folder.join("map.json"), map.to_string())?;
    let segments: Vec<Value> = (0..18)
        .map(|i| json!({"id": format!("s{i:02}"), "capture": "take", "first": 270 * i, "end": 270 * i + 800}))
        .collect();
    let lsts = |alpha: f64| json!({"method": "lsts-norm", "alpha": alpha});
    let study = Study::from_value(&json!({
        "id": "ict", "studyMetadata": {"title": "Sizes", "version": "1"}, "languages": ["en"],
        "components": {}, "sequence": {"order": "fixed", "components": []},
        "stimuli": {
            "avatars": {"ict": {"file": data.join("ict-facekit/ict-facekit.glb")}},
            "captures": {"take": {"file": data.join("lsts/take_n01.csv"), "markers": folder.join("map.json"), "rateHz": 60.0}},
            "segments": segments,
            "methods": {"lsts30": lsts(0.3), "lsts50": lsts(0.5), "lsts70": lsts(0.7)},
        },
    }))?;
    Ok((study, Places { study: folder.to_owned(), data: Some(data), packs }))
}

/// The weights at the frames of 60 Hz, between the two nearest of the capture.
fn played(solved: &SolvedTake) -> Vec<Vec<f64>> {
    let n = solved.shape_names.len();
    let last = solved.frames() - 1;
    let frames = (solved.frames() as f64 / solved.rate_hz * RATE_HZ).round() as usize;
    (0..frames)
        .map(|f| {
            let at = f as f64 / RATE_HZ * solved.rate_hz;
            let (low, part) = ((at as usize).min(last), at.fract());
            let high = (low + 1).min(last);
            let row = |f: usize| &solved.weights[f * n..(f + 1) * n];
            row(low).iter().zip(row(high)).map(|(a, b)| a + part * (b - a)).collect()
        })
        .collect()
}

/// Bytes of a clip's weights as a take pack of recorded weights, and how far its rounding moves the
/// vertex that it moves most, metres.
fn weights_pack(avatar: &Avatar, weights: &[Vec<f64>]) -> (usize, f64) {
    // Those of the shapes at the end are left out.
    let (frames, shapes) = (weights.len(), weights.first().map_or(0, Vec::len));
    let weights = weights.concat();
    let found = weight_steps(avatar, &weights, shapes);
    let take = TakePack {
        rate_hz: RATE_HZ,
        first_frame: 0,
        played: 0..frames,
        content: TakeContent::Weights {
            shape_names: avatar.shape_names[..shapes].to_vec(),
            weights,
        },
    };
    (encode_take_in_steps(&take, &found.steps).len(), found.error_m)
}

/// Renders a clip, encodes it, answers the file's bytes.
fn video(avatar: &Avatar, weights: &[Vec<f64>], file: &Path) -> Result<u64> {
    let stage = Offscreen::new(false)?;
    let renderer = stage.renderer([1280, 720], Look::STIMULUS);
    let head = renderer.load(avatar)?;
    let mut ffmpeg = Command::new("ffmpeg")
        .args(["-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgba", "-s", "1280x720"])
        .args(["-r", "60", "-i", "-", "-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p"])
        .arg(file)
        .stdin(Stdio::piped())
        .spawn()
        .map_err(|e| format!("ffmpeg: {e}; install it (apt install ffmpeg)"))?;
    let mut pipe = ffmpeg.stdin.take().ok_or("ffmpeg takes no frames")?;
    for frame in weights {
        let frame: Vec<f32> = frame.iter().map(|&w| w as f32).collect();
        pipe.write_all(&stage.picture(&renderer, &head, View::FRONT, &frame)?.rgba)?;
    }
    drop(pipe);
    if !ffmpeg.wait()?.success() {
        return Err("ffmpeg failed".into());
    }
    Ok(std::fs::metadata(file)?.len())
}
