//! `mimique sample`: files to try every command on, made from the built-in head, actor and body.

mod corpus;

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::anyhow;
use mimique_actor::{
    Clip, Emotion, Gait, HeadSpec, NOISE_MM, SyntheticTake, build_head, marker_sites,
    synthetic_take,
};
use mimique_avatar::Avatar;
use mimique_mocap::C3dOptions;
use mimique_stimulus::{MarkerMap, built_in_bvh, built_in_capture, built_in_map, built_in_weights};

use crate::output;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Folder that the files go to; made if it is not there
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
    /// Which built-in person the avatar is
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    avatar: u64,
    /// Which built-in actor performs
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    actor: u64,
    /// How strong each emotion is, from 1 (slight) to 3 (strong)
    #[arg(long, value_name = "LEVEL", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=3))]
    intensity: u8,
    /// Write takes of four actors with their known labels, to try annotate on, instead
    #[arg(long, conflicts_with = "intensity")]
    annotated: bool,
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let person = HeadSpec::person(args.avatar);
    if args.annotated {
        return annotated(&args, &person, json);
    }
    let take = performance(args.actor, args.intensity);
    let map = marker_map(&person, &take);
    let head = build_head(&person);
    output::make_folder(&args.out)?;
    let mut files = vec![
        ("head.glb".to_owned(), glb(&head)?, "the avatar: the built-in head with its blendshapes"),
        (
            "take.c3d".to_owned(),
            c3d(&take)?,
            "the capture: another person performs the six emotions",
        ),
        (
            "markers.json".to_owned(),
            map.to_json().into_bytes(),
            "the marker map from the one to the other",
        ),
        (
            "weights.csv".to_owned(),
            built_in_weights(&take).to_csv().into_bytes(),
            "the weights that the actor played",
        ),
    ];
    for (gait, what) in Gait::ALL.into_iter().zip([
        "the motion of a walk, whole strides",
        "the motion of a run, whole strides",
        "the motion of a sprint, whole strides",
    ]) {
        files.push((format!("{}.bvh", gait.name), built_in_bvh(&gait).into_bytes(), what));
    }
    output::write_all(&args.out, &files, json)?;
    if json {
        let text = serde_json::json!({
            "files": files.iter().map(|(name, ..)| args.out.join(name)).collect::<Vec<_>>(),
            "rate_hz": take.rate_hz,
            "frames": take.frames(),
            "neutral": take.neutral,
            "segments": take.segments.iter().map(|segment| serde_json::json!({
                "name": segment.name, "first_frame": segment.first, "end_frame": segment.end,
            })).collect::<Vec<_>>(),
        });
        writeln!(std::io::stdout(), "{}", serde_json::to_string_pretty(&text)?)?;
    }
    Ok(())
}

/// `--annotated`: takes with labels.
fn annotated(args: &Args, person: &HeadSpec, json: bool) -> anyhow::Result<()> {
    let files = corpus::files(person, args.actor)?;
    output::make_folder(&args.out)?;
    output::write_all(&args.out, &files, json)?;
    if json {
        let names: Vec<PathBuf> = files.iter().map(|(name, ..)| args.out.join(name)).collect();
        let text = serde_json::json!({ "files": names });
        writeln!(std::io::stdout(), "{}", serde_json::to_string_pretty(&text)?)?;
    }
    Ok(())
}

/// The six emotions one after the other, after a neutral start.
fn performance(actor: u64, intensity: u8) -> SyntheticTake {
    let spec = HeadSpec::actor(actor);
    let clips = Emotion::ALL.map(|emotion| Clip { emotion, intensity, seed: actor });
    synthetic_take(&build_head(&spec), &marker_sites(&spec), &clips, actor, NOISE_MM)
}

/// Where the actor's face markers belong on another person, which markers are the head's, and which
/// frames are neutral.
fn marker_map(person: &HeadSpec, take: &SyntheticTake) -> MarkerMap {
    let [first, end] = take.neutral;
    MarkerMap {
        avatar: Some("head".to_owned()),
        head: take.head_labels.clone(),
        neutral: Some(first..end),
        ..built_in_map(&marker_sites(person))
    }
}

fn glb(head: &Avatar) -> anyhow::Result<Vec<u8>> {
    // The head alone: without weights there is no animation, whatever its rate would be.
    mimique_avatar_files::write_glb(head, &[], 1.0).map_err(|error| anyhow!("head.glb: {error}"))
}

fn c3d(take: &SyntheticTake) -> anyhow::Result<Vec<u8>> {
    mimique_mocap::write_c3d(&built_in_capture(take), &C3dOptions::default())
        .map_err(|error| anyhow!("take.c3d: {error}"))
}
