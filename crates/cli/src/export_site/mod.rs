//! `mimique export-site`: a study as plain files that any web host can serve, without the server.
//!
//! ```text
//! DIR/index.html            the participant's page
//! DIR/site.json             the study, its clips, its codes
//! DIR/assets/{hash}/...     modules, scripts, styles
//! DIR/packs/{sha256}        stimuli
//! ```
//!
//! With `--jatos` the same files become the archive of a study that JATOS imports.
//!
//! Answers stay in the participant's browser, are posted to the study's own address at the end, or
//! downloaded (`staticHosting` of the study file); `mimique import` turns the files into an export.
//! What no server keeps secret is no secret: the completion codes lie in `site.json`.

mod files;
mod jatos;

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use mimique_server::{Assets, EmbeddedFile, HostedStudy, Stage};
use mimique_session::{SiteFile, Standing};
use mimique_storage::durable_file;
use mimique_study::{CheckedStudy, Multilingual as _, Severity, StaticHosting, Study};
use serde_json::json;

use crate::check::check_file;
use crate::export_site::files::{Archive, Files, Folder, Written};
use crate::serve::prepare_study;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Study file
    study: PathBuf,
    /// Folder to write; it must not be there, or be empty. With --jatos, the archive to write, NAME.jzip
    #[arg(long)]
    out: PathBuf,
    /// Write the archive of a study that JATOS imports
    #[arg(long)]
    jatos: bool,
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
pub fn run(args: Args, pages: &[EmbeddedFile], json: bool) -> anyhow::Result<()> {
    let assets = crate::pages::assets(args.web_dir.as_deref(), pages)?;
    let place = || args.out.display().to_string();
    is_free(&args)?;
    let checked = checked_study(&args.study)?;
    anyhow::ensure!(
        checked.study().mimicry.is_none(),
        "{}: /mimicry: pages hosted as files do not measure participants' faces; serve the study by `mimique serve`, or remove mimicry",
        args.study.display()
    );
    let prepared = prepare_study(&args.study, checked.study(), &args.packs)
        .map_err(|faults| anyhow::anyhow!(faults.join("\nerror: ")))?;
    let stage = if args.pilot { Stage::Pilot } else { Stage::Live };
    let hosted = HostedStudy::new(checked.value().clone(), prepared.clips, stage)?;

    // Written beside and moved into place: a site is whole or absent.
    let site = Exported {
        assets: &assets,
        study: checked.study(),
        hosted: &hosted,
        stage,
        packs: &args.packs,
    };
    let parent = args.out.parent().filter(|folder| !folder.as_os_str().is_empty());
    let parent = parent.unwrap_or(Path::new("."));
    std::fs::create_dir_all(parent).with_context(|| parent.display().to_string())?;
    let Written { files, bytes } = match args.jatos {
        true => site.write_archive(&args.out, checked.config_hash()),
        false => site.write_folder(&args.out),
    }
    .with_context(place)?;

    let study = checked.study();
    let hosting = hosting(study, args.jatos);
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
    if args.jatos {
        let study = args.study.display();
        writeln!(out, "  import it in JATOS: Studies, Import study")?;
        writeln!(out, "  every answer is appended to the result of its run as it comes")?;
        writeln!(
            out,
            "  read what JATOS exports (data only, or the archive) with: mimique import {study} FILES"
        )?;
        return Ok(());
    }
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

/// Whether nothing stands where the site is to be written.
fn is_free(args: &Args) -> anyhow::Result<()> {
    let place = args.out.display();
    if args.jatos {
        let is_archive = args.out.extension().is_some_and(|end| end == "jzip");
        anyhow::ensure!(is_archive, "{place}: JATOS imports archives; write --out NAME.jzip");
        anyhow::ensure!(
            !args.out.exists(),
            "{place}: there is such a file; choose another by --out"
        );
        return Ok(());
    }
    let taken = std::fs::read_dir(&args.out).is_ok_and(|mut entries| entries.next().is_some());
    anyhow::ensure!(!taken, "{place}: there is something in this folder; choose another by --out");
    Ok(())
}

/// Where the answers go.
fn hosting(study: &Study, jatos: bool) -> StaticHosting {
    match jatos {
        true => jatos::hosting(),
        false => study.static_hosting.clone().unwrap_or_default(),
    }
}

/// What a site is made of.
struct Exported<'a> {
    assets: &'a Assets,
    study: &'a Study,
    hosted: &'a HostedStudy,
    stage: Stage,
    packs: &'a Path,
}

impl Exported<'_> {
    /// Writes the folder that any web host can serve.
    fn write_folder(&self, out: &Path) -> anyhow::Result<Written> {
        durable_file::write_folder(out, |folder| {
            let mut folder = Folder::new(folder);
            write(&mut folder, self, false)?;
            Ok(folder.written)
        })
    }

    /// Writes the archive that JATOS imports.
    fn write_archive(&self, out: &Path, config_hash: &str) -> anyhow::Result<Written> {
        let mut draft = durable_file::Draft::begin(out)?;
        let name = jatos::folder(self.study);
        let mut archive = Archive::begin(&mut draft, &name);
        write(&mut archive, self, true)?;
        archive.beside();
        let description = jatos::description(self.study, config_hash);
        archive.put(&format!("{name}.jas"), description.to_string().as_bytes())?;
        let written = archive.finish()?;
        draft.finish()?;
        Ok(written)
    }
}

/// Writes the files of the site.
fn write(folder: &mut impl Files, site: &Exported<'_>, jatos: bool) -> anyhow::Result<()> {
    let Exported { assets, study, hosted, stage, packs } = *site;
    let prefix = format!("assets/{}", assets.hash());
    write_assets(folder, assets, &prefix)?;
    write_packs(folder, hosted, packs)?;
    let site = site_file(study, hosted, stage, hosting(study, jatos));
    folder.put("site.json", serde_json::to_string(&site)?.as_bytes())?;
    let language = study.default_language();
    let post = site.hosting.post.as_deref().map_or_else(String::new, origin);
    let (boot, inline) = match jatos {
        true => (jatos::BOOT, jatos::INLINE),
        false => ("participant/boot.js", ""),
    };
    let triggers = study.triggers.map(|triggers| triggers.origin()).unwrap_or_default();
    let values = [
        ("assets", prefix.as_str()),
        ("boot", &format!("{prefix}/{boot}")),
        ("inline", inline),
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
    folder.put("index.html", page.as_bytes())
}

/// Modules, scripts and styles of the participant's page.
fn write_assets(folder: &mut impl Files, assets: &Assets, prefix: &str) -> anyhow::Result<()> {
    for (name, bytes) in assets.files().filter(|(name, _)| is_of_participants(name)) {
        folder.put(&format!("{prefix}/{name}"), bytes)?;
    }
    Ok(())
}

/// Whether a file of the pages is one that participants' pages need: none of the pages (templates), and nothing of what
/// only researchers, the studio or a capsule loads.
pub fn is_of_participants(name: &str) -> bool {
    let others =
        ["capsule/", "report.", "report_bg.", "researcher/", "studio/", "studio.", "studio_bg."];
    !name.ends_with(".html") && !others.iter().any(|start| name.starts_with(start))
}

/// The packs of all clips, each once.
pub fn packs_of(hosted: &HostedStudy) -> Vec<&str> {
    let clips = hosted.bundle().clips.values();
    let mut hashes: Vec<&str> = clips.flat_map(|clip| clip.packs()).collect();
    hashes.sort_unstable();
    hashes.dedup();
    hashes
}

fn write_packs(folder: &mut impl Files, hosted: &HostedStudy, packs: &Path) -> anyhow::Result<()> {
    for hash in packs_of(hosted) {
        let path = packs.join(hash);
        let bytes = std::fs::read(&path).with_context(|| path.display().to_string())?;
        folder.put(&format!("packs/{hash}"), &bytes)?;
    }
    Ok(())
}

/// What `site.json` says: the study, its clips, its codes, and where the answers go.
pub fn site_file(
    study: &Study,
    hosted: &HostedStudy,
    stage: Stage,
    hosting: StaticHosting,
) -> SiteFile {
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
        hosting,
        email: contact.map_or_else(String::new, |contact| contact.investigator.email.clone()),
    }
}

/// Scheme and host of an address, as a content security policy wants them; nothing for a place beside the page.
fn origin(address: &str) -> String {
    let Some((scheme, rest)) = address.split_once("://") else { return String::new() };
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
