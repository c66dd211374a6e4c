//! `mimique deposit`: a study and its export in; the folder out that a repository of research data takes. What is personal
//! is asked about first; with `--to` the folder is uploaded, or it is told what would be.

mod asked;
mod inputs;
mod source_files;
mod upload;
mod written;

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow, bail};
use mimique_analysis::{ReportOptions, analyze_with};
use mimique_deposit::{
    About, Answers, Author, CODE_LICENCES, DATA_LICENCES, DepositFile, Judged, Licence, Parts,
    Texts, deposit_files, is_day, licence_named, pack_hashes, personal, stimulus_rows,
};
use mimique_locale::{Language, counted};
use mimique_stats::Table;
use mimique_study::Study;

use self::inputs::Inputs;
use self::upload::Target;
use crate::analyze::language;
use crate::export_site::checked_study;
use crate::report_folder;
use crate::serve::prepare_study;
use crate::study_file::StudyFile;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Study file, or a ZIP archive of its folder
    study: PathBuf,
    /// Tidy export (CSV), or a Psych-DS folder, as `mimique export` writes them
    export: PathBuf,
    /// Folder of the deposit; an earlier deposit in it is replaced
    #[arg(long)]
    out: PathBuf,
    #[command(flatten)]
    said: Said,
    /// Deposit these columns, or the answers to these questions, though they may say who somebody is
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',')]
    keep: Vec<String>,
    /// Leave these columns, or the answers to these questions, out
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',')]
    drop: Vec<String>,
    /// What becomes of all texts that people wrote: keep or drop
    #[arg(long, value_parser = texts)]
    texts: Option<Texts>,
    /// Leave clips, avatars and captures out; their SHA-256 are listed
    #[arg(long)]
    no_stimuli: bool,
    /// Folder where prepared stimuli are kept between runs
    #[arg(long, default_value = "mimique-data/packs")]
    packs: PathBuf,
    /// Language of the report: en or fr
    #[arg(long, default_value = "en", value_parser = language)]
    language: Language,
    #[command(flatten)]
    target: Target,
}

/// What is said of the data set.
#[derive(clap::Args)]
struct Said {
    /// Title [default: the study's]
    #[arg(long)]
    title: Option<String>,
    /// What it is, in a sentence or two [default: the study's]
    #[arg(long)]
    description: Option<String>,
    /// Who made it, once for each: "Family, Given; ORCID; affiliation" [default: the study's authors]
    #[arg(long = "author", value_name = "AUTHOR")]
    authors: Vec<Author>,
    /// Day of the deposit, YYYY-MM-DD [default: today]
    #[arg(long, value_parser = day)]
    date: Option<String>,
    /// Licence of data, stimuli and report, by its SPDX identifier
    #[arg(long, value_name = "SPDX", default_value = "CC-BY-4.0", value_parser = data_licence)]
    data_licence: &'static Licence,
    /// Licence of the study file and of the report's scripts
    #[arg(long, value_name = "SPDX", default_value = "MIT", value_parser = code_licence)]
    code_licence: &'static Licence,
}

fn texts(word: &str) -> Result<Texts, String> {
    match word {
        "keep" => Ok(Texts::Keep),
        "drop" => Ok(Texts::Drop),
        _ => Err("there are keep and drop".to_owned()),
    }
}

fn day(text: &str) -> Result<String, String> {
    match is_day(text) {
        true => Ok(text.to_owned()),
        false => Err("give a day of the calendar as 2026-11-27".to_owned()),
    }
}

fn data_licence(spdx: &str) -> Result<&'static Licence, String> {
    licence_named(&DATA_LICENCES, spdx)
}

fn code_licence(spdx: &str) -> Result<&'static Licence, String> {
    licence_named(&CODE_LICENCES, spdx)
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let place = || args.out.display().to_string();
    written::check(&args.out).with_context(place)?;
    args.target.check()?;
    let opened = StudyFile::open(&args.study)?;
    let checked = checked_study(opened.path()).map_err(|e| anyhow!(opened.said(&e.to_string())))?;
    let authors = authors(&args.said, checked.study(), &args.study)?;
    let inputs = Inputs::read(&args.export, &checked)?;
    let (responses, judged, notes) = decided(&args, &inputs)?;
    let hosting = prepare_study(opened.path(), checked.study(), &args.packs)
        .map_err(|faults| anyhow!(opened.said(&faults.join("\nerror: "))))?;
    let stimuli = stimulus_rows(checked.study(), &hosting.clips);
    let packs = source_files::packs(&pack_hashes(&stimuli), &args.packs)?;
    let sources = source_files::of_study(opened.path())?;
    let report = report(&responses, checked.study(), args.language)
        .with_context(|| args.export.display().to_string())?;
    let date = args.said.date.clone().unwrap_or_else(today);
    let own = (args.said.title.clone(), args.said.description.clone());
    let licences = (args.said.data_licence, args.said.code_licence);
    let about = About {
        participants: responses.values("participant_id").len(),
        rows: responses.len(),
        ..About::of_study(checked.study(), own, authors, &date, licences)
    };
    let files = deposit_files(&Parts {
        about: &about,
        study: checked.study(),
        versions: &inputs.versions,
        sources: &sources,
        known: &inputs.known,
        responses: &responses,
        judged: &judged,
        stimuli: &stimuli,
        packs: (!args.no_stimuli).then_some(&packs),
        report: &report,
    })?;
    written::write(&files, &args.out).with_context(place)?;
    tell(&args, &about, &files, (&judged, &notes), json)?;
    args.target.run(&args.out, &about, &files, checked.study(), json)
}

/// The answers without what is left out, and what became of what is personal.
fn decided(
    args: &Args,
    inputs: &Inputs,
) -> anyhow::Result<(mimique_deposit::Responses, Judged, Vec<String>)> {
    let place = inputs.place.display().to_string();
    let versions: Vec<&Study> = inputs.studies.iter().collect();
    let find = |responses| personal(responses, &place, &versions, &inputs.known);
    let findings = find(&inputs.responses);
    let mut answers = Answers {
        keep: args.keep.iter().cloned().collect(),
        drop: args.drop.iter().cloned().collect(),
        texts: args.texts,
    };
    answers.check(&inputs.responses, &findings, &inputs.known)?;
    asked::ask_what_is_open(&mut answers, &findings)?;
    let judged = answers.judge(&findings);
    if !judged.unanswered.is_empty() {
        bail!("{}", asked::refusal(&place, &judged.unanswered));
    }
    let mut responses = inputs.responses.clone();
    judged.apply(&mut responses);
    // What is left was answered: nothing else may be in it.
    let left = answers.judge(&find(&responses));
    if !left.unanswered.is_empty() || !left.dropped.is_empty() {
        bail!("{}", asked::refusal(&place, &[left.unanswered, left.dropped].concat()));
    }
    let study = inputs.studies.last();
    let rare = study.and_then(|study| mimique_deposit::rare(&responses, study));
    let notes = rare.iter().map(asked::note_of_rare);
    let addresses = inputs.versions.last().map(|version| asked::notes_of_study(&version.file));
    Ok((responses, judged, notes.chain(addresses.into_iter().flatten()).collect()))
}

/// Those that options name, else the study's.
fn authors(said: &Said, study: &Study, file: &Path) -> anyhow::Result<Vec<Author>> {
    if !said.authors.is_empty() {
        return Ok(said.authors.clone());
    }
    let own = study.study_metadata.authors.iter();
    let authors: Vec<Author> = own
        .map(|name| name.parse().map_err(|error: String| anyhow!("{error}")))
        .collect::<anyhow::Result<_>>()
        .with_context(|| format!("{}: /studyMetadata/authors", file.display()))?;
    if authors.is_empty() {
        bail!(
            "{}: /studyMetadata/authors: nobody is named; name each author by --author \"Family, Given; ORCID; affiliation\"",
            file.display()
        );
    }
    Ok(authors)
}

/// The report of the answers as they are deposited.
fn report(
    responses: &mimique_deposit::Responses,
    study: &Study,
    language: Language,
) -> anyhow::Result<Vec<(String, Vec<u8>)>> {
    let table = Table::parse(responses.to_csv()?)?;
    let report = analyze_with(&table, study, language, ReportOptions::default())?;
    Ok(report_folder::with_pdfs(&report.files))
}

/// The day by this machine's clock, UTC.
fn today() -> String {
    let since = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    let now_ms = since.map_or(0.0, |since| since.as_secs_f64() * 1e3);
    mimique_study::iso_time(now_ms).chars().take(10).collect()
}

/// What was written, and what became of what is personal.
fn tell(
    args: &Args,
    about: &About,
    files: &[DepositFile],
    (judged, notes): (&Judged, &[String]),
    json: bool,
) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    let bytes: u64 = files.iter().map(|file| file.bytes).sum();
    let place = args.out.display();
    if json {
        let kept = judged.kept.iter().map(|finding| &finding.key);
        let value = serde_json::json!({
            "folder": place.to_string(), "study": about.study, "files": files.len(), "bytes": bytes,
            "participants": about.participants, "rows": about.rows, "left_out": judged.left_out,
            "kept": kept.collect::<std::collections::BTreeSet<_>>(), "notes": notes,
        });
        writeln!(out, "{value}")?;
        return Ok(());
    }
    for finding in &judged.dropped {
        writeln!(out, "left out: {}", asked::words(finding))?;
    }
    for finding in &judged.kept {
        writeln!(out, "kept: {}", asked::words(finding))?;
    }
    for note in notes {
        writeln!(out, "note: {note}")?;
    }
    let people = counted(about.participants, "participant");
    let rows = counted(about.rows, "row");
    let count = counted(files.len(), "file");
    writeln!(out, "{place}: {count}, {:.1} MB; {people}, {rows}", bytes as f64 / 1e6)?;
    writeln!(out, "  read {place}/README.md, or open {place}/ro-crate-preview.html")?;
    Ok(())
}
