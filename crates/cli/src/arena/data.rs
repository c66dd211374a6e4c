//! `mimique arena export`: votes and stimuli for learning a measure of what people see.

use std::io::Write as _;
use std::path::PathBuf;

use mimique_arena::{DataSetFile, data_set};
use mimique_locale::counted;
use serde_json::json;

use super::inputs::{open, pooled, stimuli, write_folder};

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Folder of the arena
    folder: PathBuf,
    /// Folder of the pooled votes, as `arena merge` wrote it
    #[arg(long, value_name = "FOLDER")]
    votes: PathBuf,
    /// Folder of the data set, in the place of an earlier one
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
}

/// Runs the command.
pub fn run(args: &Args, json: bool) -> anyhow::Result<()> {
    let folder = open(&args.folder)?;
    let (votes, _) = pooled(&args.votes)?;
    let stimuli = stimuli(&folder)?;
    let (mut made, mut copies) = (Vec::new(), Vec::new());
    for file in data_set(&folder, &stimuli, &votes)? {
        match file {
            DataSetFile::Made(name, bytes) => made.push((name, bytes)),
            DataSetFile::Copied(name) => copies.push((args.folder.join(&name), name)),
        }
    }
    write_folder(&args.out, "clips.csv", &made, &copies)?;
    let mut out = std::io::stdout().lock();
    let clips = stimuli.clips().count();
    if json {
        let names = made.iter().map(|(name, _)| name).chain(copies.iter().map(|(_, name)| name));
        let told = json!({ "folder": args.out, "votes": votes.len(), "clips": clips, "files": names.collect::<Vec<_>>() });
        writeln!(out, "{}", serde_json::to_string_pretty(&told)?)?;
        return Ok(());
    }
    writeln!(
        out,
        "{}: {}, {}, the weights of each, README.md with the columns",
        args.out.display(),
        counted(votes.len(), "vote"),
        counted(clips, "clip")
    )?;
    Ok(())
}
