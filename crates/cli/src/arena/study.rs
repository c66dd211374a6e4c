//! `mimique arena study`: the folder of the study in which people choose between the methods.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow, bail};
use mimique_arena::{ArenaStudy, arena_study};
use mimique_locale::counted;
use mimique_storage::durable_file;
use mimique_study::config_hash;
use serde_json::{Value, json};

use super::inputs::open;
use crate::new::fill;

/// Keys of a study file that are the arena's; what else a laboratory has written into its study stays.
const OF_THE_ARENA: [&str; 9] = [
    "$schema",
    "id",
    "seed",
    "questions",
    "components",
    "sequence",
    "hypotheses",
    "exclusions",
    "stimuli",
];

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Folder of the arena
    folder: PathBuf,
    /// Folder of the study. Where an earlier one of this arena is, it is brought up to date: contact, consent and the
    /// other pages stay as the laboratory has written them
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
}

/// Runs the command.
pub fn run(args: &Args, json: bool) -> anyhow::Result<()> {
    let folder = open(&args.folder)?;
    let mut made = arena_study(&folder).with_context(|| args.folder.display().to_string())?;
    let kept = keep(&mut made, &args.out)?;
    let place = args.out.display().to_string();
    let made_files = made.composed.files("`mimique arena study`", "arena", &made.wishes, &[], &[]);
    let copies: Vec<(PathBuf, String)> =
        made.files.iter().map(|file| (args.folder.join(file), file.clone())).collect();
    if let Some(parent) = args.out.parent().filter(|parent| !parent.as_os_str().is_empty()) {
        crate::output::make_folder(parent)?;
    }
    durable_file::write_folder(&args.out, |fresh| fill(fresh, &made_files, &copies, &place))?;
    let hash = config_hash(&made.composed.study);
    let methods = folder.submissions.len();
    let mut out = std::io::stdout().lock();
    if json {
        let told = json!({
            "study": args.out.join("study.json"), "configHash": hash, "methods": folder.submissions.keys().collect::<Vec<_>>(),
            "segments": folder.arena.segments.len(), "kept": kept,
        });
        writeln!(out, "{}", serde_json::to_string_pretty(&told)?)?;
        return Ok(());
    }
    writeln!(
        out,
        "{place}/study.json: {} on {}, {} of them for each participant; configuration {}",
        counted(methods, "method"),
        counted(folder.arena.segments.len(), "segment"),
        counted(made.pairs, "pair"),
        &hash[..12]
    )?;
    if kept {
        writeln!(out, "contact, consent and other pages are those that were there")?;
    } else {
        writeln!(out, "write your contact, ethics board and consent into it")?;
    }
    writeln!(out, "next: mimique serve {place}/study.json")?;
    Ok(())
}

/// Takes over what a laboratory has written into an earlier study of the arena; whether there was one.
fn keep(made: &mut ArenaStudy, out: &Path) -> anyhow::Result<bool> {
    if out.symlink_metadata().is_err() {
        return Ok(false);
    }
    let file = out.join("study.json");
    if !file.is_file() {
        let is_empty = out.is_dir() && std::fs::read_dir(out)?.next().is_none();
        if is_empty {
            return Ok(false);
        }
        bail!("{}: it holds something else; name an empty or a new folder", out.display());
    }
    let text = std::fs::read_to_string(&file).with_context(|| file.display().to_string())?;
    let earlier = mimique_study::parse(&text).map_err(|e| anyhow!("{}: {e}", file.display()))?;
    let id = &made.composed.study["id"];
    if earlier.get("id") != Some(id) {
        bail!(
            "{}: it is a study of {}, not of {id}; name another folder",
            file.display(),
            earlier["id"]
        );
    }
    let study = made.composed.study.as_object_mut().context("a study is an object")?;
    study.retain(|key, _| OF_THE_ARENA.contains(&key.as_str()));
    let own = earlier.as_object().into_iter().flatten();
    let own = own.filter(|(key, _)| !OF_THE_ARENA.contains(&key.as_str()));
    study.extend(own.map(|(key, value): (&String, &Value)| (key.clone(), value.clone())));
    let shown = &made.composed.study;
    made.composed
        .comments
        .retain(|pointer, _| pointer.is_empty() || shown.pointer(pointer).is_some());
    Ok(true)
}
