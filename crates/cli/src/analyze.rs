//! `mimique analyze EXPORT.csv --study STUDY.json --out DIR`: every table and figure of a study.
//!
//! `DIR` holds a whole report or is left as it was.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::Context;
use mimique_analysis::{
    ExportError, MeasuredFaces, ReportOptions, ServedVersion, StudyVersions, analyze_with,
};
use mimique_locale::{Language, counted, counted_as};
use mimique_stats::Table;

use crate::report_folder;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Tidy export, as `mimique export --format csv` writes it
    export: PathBuf,
    /// Study file that the answers belong to
    #[arg(long)]
    study: PathBuf,
    /// Table of stimuli, as `mimique export --stimuli` writes it, or with a laboratory's own measures in further columns:
    /// answers are held against them
    #[arg(long, value_name = "FILE.csv")]
    stimuli: Option<PathBuf>,
    /// Participants' faces, as `mimique export --format tracks` writes them, in studies that measure them
    #[arg(long, value_name = "FILE.csv", requires = "courses")]
    tracks: Option<PathBuf>,
    /// The courses of the clips that faces are held against, as `mimique export --courses` writes them
    #[arg(long, value_name = "FILE.csv", requires = "tracks")]
    courses: Option<PathBuf>,
    /// Address of the study's preview, such as http://127.0.0.1:8080/preview/demo: in the figures what stands for one clip
    /// leads to that clip there
    #[arg(long, value_name = "URL", value_parser = preview_address)]
    preview_url: Option<String>,
    /// Folder with the study files of all versions that were served [default: the folder materials next to the folder of
    /// the export, as in the form Psych-DS]
    #[arg(long, value_name = "DIR")]
    versions: Option<PathBuf>,
    /// Repeat every verdict over the rules of exclusion and the tests, and without each segment and each participant; the
    /// report then has the section "Sensitivity". Takes time: one analysis per participant, segment and set of rules
    #[arg(long)]
    multiverse: bool,
    /// Folder for the report; an earlier report in it is replaced
    #[arg(long)]
    out: PathBuf,
    /// Language of the report: en or fr
    #[arg(long, default_value = "en", value_parser = language)]
    language: Language,
}

fn read_table(path: &Path) -> anyhow::Result<Table> {
    let bytes = std::fs::read(path)
        .map_err(|error| anyhow::anyhow!("cannot be read ({error}); check the path"))?;
    Ok(Table::parse(bytes)?)
}

/// The study files of the versions that were served.
fn served_versions(args: &Args) -> anyhow::Result<Vec<ServedVersion>> {
    let next_to_export = || Some(args.export.parent()?.parent()?.join("materials"));
    let folder = match &args.versions {
        Some(folder) => folder.clone(),
        None => match next_to_export().filter(|folder| folder.is_dir()) {
            Some(folder) => folder,
            None => return Ok(Vec::new()),
        },
    };
    let unread = |error: std::io::Error| {
        anyhow::anyhow!("cannot be read ({error}); check the path")
            .context(folder.display().to_string())
    };
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(&folder).map_err(unread)? {
        let path = entry.map_err(unread)?.path();
        // Other files of the folder are no study files.
        let is_version = path.extension().is_some_and(|extension| extension == "json")
            && (args.versions.is_some()
                || path
                    .file_stem()
                    .is_some_and(|name| name.to_string_lossy().contains("_version-")));
        paths.extend(is_version.then_some(path));
    }
    paths.sort();
    let read = |path: &PathBuf| -> anyhow::Result<ServedVersion> {
        let place = || path.display().to_string();
        let text = std::fs::read_to_string(path)
            .map_err(|error| anyhow::anyhow!("cannot be read ({error}); check the path"))
            .with_context(place)?;
        ServedVersion::from_text(&text).with_context(place)
    };
    paths.iter().map(read).collect()
}

/// A language that reports are written in.
pub fn language(code: &str) -> Result<Language, String> {
    Language::from_code(code).ok_or_else(|| "reports are written in en or fr".to_owned())
}

/// An address that `?clip=ID` can follow.
fn preview_address(text: &str) -> Result<String, String> {
    let known = text.starts_with("http://") || text.starts_with("https://");
    if !known || text.contains(['?', '#']) || text.contains(char::is_whitespace) {
        return Err("give the whole address of the study's preview, such as \
             http://127.0.0.1:8080/preview/demo, without ? and #"
            .to_owned());
    }
    Ok(text.trim_end_matches('/').to_owned())
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let place = |path: &Path| path.display().to_string();
    let text = std::fs::read_to_string(&args.study)
        .map_err(|error| anyhow::anyhow!("cannot be read ({error}); check the path"))
        .with_context(|| place(&args.study))?;
    let ServedVersion { config_hashes, study } =
        ServedVersion::from_text(&text).with_context(|| place(&args.study))?;
    let served = served_versions(&args)?;
    let table = read_table(&args.export).with_context(|| place(&args.export))?;
    let stimuli = match &args.stimuli {
        Some(path) => Some(read_table(path).with_context(|| place(path))?),
        None => None,
    };
    let read = |path: &PathBuf| read_table(path).with_context(|| place(path));
    let tracks = args.tracks.as_ref().map(read).transpose()?;
    let courses = args.courses.as_ref().map(read).transpose()?;
    let faces = tracks.as_ref().zip(courses.as_ref());
    let faces = faces.map(|(tracks, courses)| MeasuredFaces { tracks, courses });
    let preview = args.preview_url.as_deref();
    let multiverse = args.multiverse;
    let versions = StudyVersions { config_hashes: &config_hashes, served: &served };
    let options = ReportOptions { stimuli: stimuli.as_ref(), faces, preview, versions, multiverse };
    let report = analyze_with(&table, &study, args.language, options).map_err(|error| {
        let file = match &error {
            ExportError::Stimuli(_) => args.stimuli.as_ref(),
            ExportError::Mimicry(fault) if fault.table() == "tracks" => args.tracks.as_ref(),
            ExportError::Mimicry(_) => args.courses.as_ref(),
            _ => None,
        };
        let file = file.unwrap_or(&args.export);
        anyhow::Error::from(error).context(place(file))
    })?;
    let written =
        report_folder::write(&report.files, &args.out).with_context(|| place(&args.out))?;

    let mut out = std::io::stdout().lock();
    let page = args.out.join("report.html");
    if json {
        let summary = serde_json::json!({
            "status": "ok",
            "report": page,
            "people_used": report.people.0,
            "people": report.people.1,
            "trials_used": report.trials,
            "files": written,
            "readings": report.readings.iter().map(|(id, reading)| {
                serde_json::json!({"hypothesis": id, "reading": reading})
            }).collect::<Vec<_>>(),
            "sensitivity": report.sensitivity.iter().map(|(id, words)| {
                serde_json::json!({"hypothesis": id, "reading": words})
            }).collect::<Vec<_>>(),
        });
        writeln!(out, "{summary:#}")?;
        return Ok(());
    }
    let (used, all) = report.people;
    let all = counted_as(all, "person", "people");
    writeln!(out, "{used} of {all}, {}", counted(report.trials, "trial"))?;
    for (id, reading) in &report.readings {
        writeln!(out, "{id}. {reading}")?;
    }
    for (id, words) in &report.sensitivity {
        writeln!(out, "Sensitivity of {id}: {words}")?;
    }
    if multiverse && report.sensitivity.is_empty() {
        writeln!(
            out,
            "Sensitivity: the study file states no hypothesis, so there is no verdict to repeat."
        )?;
    }
    let files = counted(written.len(), "file");
    writeln!(out, "{files}, report: {}", page.display())?;
    Ok(())
}
