//! `mimique arena rank`: the ranking as a page, tables and JSON.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::bail;
use mimique_arena::{RankOptions, Ranking, Submission, rank, ranking_document, ranking_rows};
use mimique_locale::Language;
use mimique_report::{ReportFile, document_files};
use serde_json::json;

use super::inputs::{open, pooled};
use crate::report_folder;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Folder of the arena
    folder: PathBuf,
    /// Folder of the pooled votes, as `arena merge` wrote it
    #[arg(long, value_name = "FOLDER")]
    votes: PathBuf,
    /// Folder of the ranking, in the place of an earlier one: report.html, tables, figures, results.json
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
    /// Draws of participants for the intervals of worths
    #[arg(long, value_name = "NUMBER", default_value_t = RankOptions::default().rounds)]
    rounds: usize,
    /// Seed of the draws
    #[arg(long, default_value_t = RankOptions::default().seed)]
    seed: u64,
}

/// Runs the command.
pub fn run(args: &Args, json: bool) -> anyhow::Result<()> {
    let folder = open(&args.folder)?;
    let (votes, pooled) = pooled(&args.votes)?;
    if pooled.arena != folder.arena.id {
        bail!(
            "{}: these are votes of the arena {:?}, not of {:?}; pool those of this one by `mimique arena merge`",
            args.votes.display(),
            pooled.arena,
            folder.arena.id
        );
    }
    let methods: Vec<String> = folder.submissions.keys().cloned().collect();
    let options = RankOptions { rounds: args.rounds, seed: args.seed, ..RankOptions::default() };
    let ranking = rank(&votes, &methods, &options);
    let submissions: Vec<&Submission> = folder.submissions.values().collect();
    let document = ranking_document(&folder.arena, &submissions, &ranking, &pooled.laboratories);
    let mut files = document_files(&document, Language::English);
    let results = json!({
        "arena": folder.arena.id,
        "rows": ranking_rows(&ranking, &submissions),
        "ranking": ranking,
        "submissions": submissions,
        "laboratories": pooled.laboratories,
    });
    let text = serde_json::to_string_pretty(&results)? + "\n";
    files.push(ReportFile { path: "results.json".to_owned(), text: text.clone() });
    report_folder::write(&files, &args.out)
        .map_err(|error| anyhow::anyhow!("{}: {error:#}", args.out.display()))?;
    let mut out = std::io::stdout().lock();
    if json {
        out.write_all(text.as_bytes())?;
        return Ok(());
    }
    tell(&mut out, &ranking)?;
    writeln!(out, "{}", args.out.join("report.html").display())?;
    Ok(())
}

fn tell(out: &mut impl std::io::Write, ranking: &Ranking) -> anyhow::Result<()> {
    for band in &ranking.bands {
        let [first, last] = band.ranks;
        let ranks = if first == last { first.to_string() } else { format!("{first} to {last}") };
        writeln!(out, "{ranks:>8}  {}", band.methods.join(", "))?;
    }
    if ranking.not_ranked.is_some() {
        writeln!(out, "nothing is ranked; the page says why")?;
    }
    for own in &ranking.waiting {
        writeln!(out, "       -  {} ({} votes of {} people)", own.method, own.votes, own.people)?;
    }
    Ok(())
}
