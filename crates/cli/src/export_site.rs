//! `mimique export-site`: a study as plain files that any web host can serve, without the server.
//!
//! ```text
//! DIR/index.html            the participant's page
//! DIR/site.json             the study, its clips, its codes
//! DIR/assets/{hash}/...     modules, scripts, styles
//! DIR/packs/{sha256}        stimuli
//! ```
//!
//! Answers stay in the participant's browser, are posted to the study's own address at the end, or
//! downloaded (`staticHosting` of the study file); `mimique import` turns the files into an export.
//! What no server keeps secret is no secret: the completion codes lie in `site.json`.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use mimique_server::{Assets, HostedStudy, Stage};
use mimique_session::{SiteFile, Standing};
use mimique_storage::durable_file;
use mimique_study::{CheckedStudy, Multilingual as _, Severity, Study};
use serde_json::json;

use crate::check::check_file;
use crate::serve::prepare_study;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Study file
    study: PathBuf,
    /// Folder to write; it must not be there, or be empty
    #[arg(long)]
    out: PathBuf,
    /// Folder where prepared stimuli are kept between runs
    #[arg(long, default_value = "mimique-data/packs")]
    packs: PathBuf,
    /// Folder of the pages, instead of those inside the binary
    #[arg(long)]
    web_dir: Option<PathBuf>,
    /// Mark the answers as those of a pilot
    #[arg(long)]
    pilot: bool,
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let assets = match &args.web_dir {
        Some(folder) => Assets::from_folder(folder)?,
        None => Assets::embedded()?,
    };
    let place = || args.out.display().to_string();
    let taken = std::fs::read_dir(&args.out).is_ok_and(|mut entries| entries.next().is_some());
    anyhow::ensure!(
        !taken,
        "{}: there is something in this folder; choose another by --out",
        place()
    );
    let checked = checked_study(&args.study)?;
    let hosting = prepare_study(&args.study, checked.study(), &args.packs)
        .map_err(|faults| anyhow::anyhow!(faults.join("\nerror: ")))?;
    let stage = if args.pilot { Stage::Pilot } else { Stage::Live };
    let hosted = HostedStudy::new(checked.value().clone(), hosting.clips, stage)?;

    // Written beside and moved into place: a site is whole or absent.
    let parent = args.out.parent().filter(|folder| !folder.as_os_str().is_empty());
    let parent = parent.unwrap_or(Path::new("."));
    std::fs::create_dir_all(parent).with_context(|| parent.display().to_string())?;
    let (files, bytes) = durable_file::write_folder(&args.out, |folder| {
        write(folder, &assets, checked.study(), &hosted, stage, &args.packs)
    })
    .with_context(place)?;

    let study = checked.study();
    let hosting = study.static_hosting.clone().unwrap_or_default();
    let way = match (&hosting.post, hosting.download) {
        (Some(address), true) => format!("posted to {address}, and downloaded by the participant"),
        (Some(address), false) => format!("posted to {address}"),
        (None, _) => "downloaded by the participant, who must send you the file".to_owned(),
    };
    let mut out = std::io::stdout().lock();
    if json {
        let line = json!({
            "study": study.id, "config_hash": checked.config_hash(), "out": place(),
            "files": files, "bytes": bytes, "post": hosting.post, "download": hosting.download,
        });
        writeln!(out, "{line}")?;
        return Ok(());
    }
    writeln!(out, "{}: {files} files, {:.1} MB", place(), bytes as f64 / 1e6)?;
    writeln!(out, "  put the folder on any web host (https) and open its index.html there")?;
    writeln!(out, "  answers are kept in the browser, at the end {way}")?;
    writeln!(out, "  read them with: mimique import {} FILES", args.study.display())?;
    writeln!(
        out,
        "  without the server a completion code does not prove that answers were stored:"
    )?;
    writeln!(out, "  it lies in site.json, and nothing counts participants or stops repeats")?;
    Ok(())
}

/// The study of a file without errors; its warnings are printed.
pub(crate) fn checked_study(file: &Path) -> anyhow::Result<CheckedStudy> {
    let report = check_file(file)?;
    let mut problems = Vec::new();
    for issue in &report.issues {
        let at = issue.place();
        let text = format!("{}: {at}: {}; {}", file.display(), issue.message(), issue.remedy());
        match issue.severity {
            Severity::Error => problems.push(text),
            Severity::Warning => eprintln!("warning: {text}"),
        }
    }
    anyhow::ensure!(problems.is_empty(), "{}", problems.join("\nerror: "));
    report.study.ok_or_else(|| anyhow::anyhow!("{}: no study", file.display()))
}

/// Writes the site; returns the number of files and bytes.
fn write(
    folder: &Path,
    assets: &Assets,
    study: &Study,
    hosted: &HostedStudy,
    stage: Stage,
    packs: &Path,
) -> anyhow::Result<(usize, u64)> {
    let mut folder = Folder { path: folder, files: 0, bytes: 0 };
    let prefix = format!("assets/{}", assets.hash());
    write_assets(&mut folder, assets, &prefix)?;
    write_packs(&mut folder, hosted, packs)?;
    let site = site_file(study, hosted, stage);
    folder.put("site.json", serde_json::to_string(&site)?.as_bytes())?;
    let language = study.default_language();
    let post = site.hosting.post.as_deref().map_or_else(String::new, origin);
    let triggers = study.triggers.map(|triggers| triggers.origin()).unwrap_or_default();
    let values = [
        ("assets", prefix.as_str()),
        ("lang", language),
        ("title", study.study_metadata.title.in_language(language)),
        ("study", &study.id),
        ("post", &post),
        ("triggers", &triggers),
    ];
    let page = assets.participant_page("participant/site.html", &values, study, language);
    let page = page.context(
        "participant/site.html is not among the pages; run `cargo xtask web` and build again",
    )?;
    folder.put("index.html", page.as_bytes())?;
    Ok((folder.files, folder.bytes))
}

/// A folder that is being written, with what it holds so far.
struct Folder<'a> {
    path: &'a Path,
    files: usize,
    bytes: u64,
}

impl Folder<'_> {
    /// Writes a file, and makes its folder where it is not there.
    fn put(&mut self, name: &str, bytes: &[u8]) -> anyhow::Result<()> {
        let path = self.path.join(name);
        let place = || path.display().to_string();
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).with_context(place)?;
        }
        std::fs::write(&path, bytes).with_context(place)?;
        self.files += 1;
        self.bytes += bytes.len() as u64;
        Ok(())
    }
}

/// Modules, scripts and styles of the participant's page.
fn write_assets(folder: &mut Folder<'_>, assets: &Assets, prefix: &str) -> anyhow::Result<()> {
    for (name, bytes) in assets.files() {
        // Pages of the server, and what only they need.
        let servers = name.ends_with(".html")
            || ["researcher/", "studio/", "studio.", "studio_bg."]
                .iter()
                .any(|start| name.starts_with(start));
        if !servers {
            folder.put(&format!("{prefix}/{name}"), bytes)?;
        }
    }
    Ok(())
}

/// The packs of all clips, each once.
fn write_packs(folder: &mut Folder<'_>, hosted: &HostedStudy, packs: &Path) -> anyhow::Result<()> {
    let clips = hosted.bundle().clips.values();
    let mut hashes: Vec<&str> = clips.flat_map(|clip| clip.packs()).collect();
    hashes.sort_unstable();
    hashes.dedup();
    for hash in hashes {
        let path = packs.join(hash);
        let bytes = std::fs::read(&path).with_context(|| path.display().to_string())?;
        folder.put(&format!("packs/{hash}"), &bytes)?;
    }
    Ok(())
}

/// What `site.json` says: the study, its clips, its codes, and where the answers go.
fn site_file(study: &Study, hosted: &HostedStudy, stage: Stage) -> SiteFile {
    let recruitment = &study.recruitment;
    // By the stored word, which names one standing: those that one exported word joins may have codes of their own.
    let code = |standing: Standing| {
        let code = standing.completion_code(recruitment)?;
        Some((standing.stored_word().to_owned(), code.to_owned()))
    };
    let contact = study.contact.as_ref();
    SiteFile {
        bundle: hosted.bundle().clone(),
        stage: stage.word().to_owned(),
        seed: study.seed,
        codes: Standing::ALL.into_iter().filter_map(code).collect(),
        redirect: recruitment.redirect.clone(),
        hosting: study.static_hosting.clone().unwrap_or_default(),
        email: contact.map_or_else(String::new, |contact| contact.investigator.email.clone()),
    }
}

/// Scheme and host of an address, as a content security policy wants them.
fn origin(address: &str) -> String {
    let (scheme, rest) = address.split_once("://").unwrap_or(("https", address));
    let host = rest.split(['/', '?', '#', '{']).next().unwrap_or_default();
    format!("{scheme}://{host}")
}

#[cfg(test)]
mod tests {
    use super::origin;

    #[test]
    fn the_policy_names_scheme_and_host_alone() {
        assert_eq!(origin("https://example.org/a/{session}?x=1"), "https://example.org");
        assert_eq!(origin("http://127.0.0.1:99/"), "http://127.0.0.1:99");
        assert_eq!(origin("https://example.org"), "https://example.org");
    }
}
