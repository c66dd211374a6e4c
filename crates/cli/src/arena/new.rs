//! `mimique arena new`: the folder of an arena.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::PathBuf;

use anyhow::{anyhow, bail};
use mimique_arena::{
    ARENA_FILE, Given, MadeArena, NewArena, SubmissionDetails, arena_schema_text, new_arena,
};
use mimique_locale::counted;
use mimique_new_study::study_id;
use serde_json::json;

use super::inputs::{all_of, each, today, write_folder};
use super::submit::weights_of;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Folder of the arena; it must not be there yet
    folder: PathBuf,
    /// The head that all methods move (GLB)
    #[arg(long, value_name = "FILE")]
    avatar: PathBuf,
    /// The capture that methods are applied to
    #[arg(long, value_name = "FILE")]
    capture: PathBuf,
    /// Where its markers sit on the head
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// The segments that are compared, as `mimique segment` writes them (CSV)
    #[arg(long, value_name = "FILE")]
    segments: PathBuf,
    /// Sound of a segment, which all methods are heard with; may be given several times
    #[arg(long = "sound", value_name = "SEGMENT=FILE")]
    sounds: Vec<String>,
    /// Weights that were recorded, or are known: they take part as `recorded`, named as the reference
    #[arg(long, value_name = "FILE")]
    reference: Option<String>,
    /// Title that participants see
    #[arg(long, default_value = "Which face is more natural?")]
    title: String,
    /// Frames per second that are shown, of all methods alike [default: the capture's]
    #[arg(long, value_name = "HZ")]
    shown: Option<f64>,
    /// Pairs that each participant is shown
    #[arg(long, value_name = "NUMBER", default_value_t = 20)]
    per_participant: usize,
    /// The day it is opened, YYYY-MM-DD [default: today]
    #[arg(long, value_name = "DAY")]
    date: Option<String>,
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let place = args.folder.display().to_string();
    if args.folder.symlink_metadata().is_ok() {
        bail!("{place}: it is there already, and nothing is written over it; name another folder");
    }
    let name = args.folder.file_name().unwrap_or_default().to_string_lossy();
    let id = study_id(&name)
        .ok_or_else(|| anyhow!("{place}: no name for an arena; use letters and digits"))?;
    let sounds: BTreeMap<String, PathBuf> = (args.sounds.iter())
        .map(|text| match text.split_once('=') {
            Some((segment, path)) => Ok((segment.to_owned(), PathBuf::from(path))),
            None => bail!("--sound: {text:?}; write SEGMENT=FILE, as in joy=joy.wav"),
        })
        .collect::<anyhow::Result<_>>()?;
    let date = args.date.unwrap_or_else(today);
    let wanted = NewArena {
        id,
        title: args.title,
        opened: date.clone(),
        avatar: args.avatar.clone(),
        capture: args.capture,
        map: args.map,
        segments: args.segments,
        sounds,
        shown_hz: args.shown,
        per_participant: args.per_participant,
    };
    let MadeArena { arena, copies } =
        new_arena(&wanted).map_err(|e| anyhow!("{}", each(&e.to_string())))?;
    let mut files = vec![
        (ARENA_FILE.to_owned(), arena.to_text().into_bytes()),
        ("schema/arena.schema.json".to_owned(), arena_schema_text().into_bytes()),
    ];
    if let Some(reference) = &args.reference {
        let details = SubmissionDetails {
            name: "recorded".to_owned(),
            authors: vec![format!("the arena {}", arena.id)],
            licence: "as the capture".to_owned(),
            submitted: date,
            reference: true,
            ..SubmissionDetails::default()
        };
        let given = [Given::of(reference)];
        let made = weights_of(&arena, &args.avatar, &given, details)
            .map_err(|problems| all_of(&problems, &format!("{place}: nothing was written")))?;
        let under = |(name, bytes)| (format!("submissions/recorded/{name}"), bytes);
        files.extend(made.files.into_iter().map(under));
    }
    write_folder(&args.folder, "", &files, &copies)?;
    let mut out = std::io::stdout().lock();
    if json {
        let names = files.iter().map(|(name, _)| name).chain(copies.iter().map(|(_, name)| name));
        let told = json!({ "folder": place, "arena": arena, "files": names.collect::<Vec<_>>() });
        writeln!(out, "{}", serde_json::to_string_pretty(&told)?)?;
        return Ok(());
    }
    let frames: usize = arena.segments.iter().map(|own| own.frames()).sum();
    writeln!(
        out,
        "{place}: {}, {} in all{}",
        counted(arena.segments.len(), "segment"),
        counted(frames, "frame"),
        if args.reference.is_some() { ", with what was recorded" } else { "" }
    )?;
    writeln!(
        out,
        "next: mimique arena submit {place} --method NAME --weights FILE --author NAME --licence LICENCE"
    )?;
    Ok(())
}
