//! `mimique capsule`: a study as one file that stays alive: study, stimuli, answers as far as they may be shared, report,
//! the program's pages, and the formats written down.
//!
//! ```text
//! capsule-STUDY/index.html           the reader
//! capsule-STUDY/take-part.html       the study's page, which keeps nothing
//! capsule-STUDY/FORMATS.md           what each file is
//! capsule-STUDY/study.json, data/, report/, formats/
//! capsule-STUDY/files/NAME.js        what the pages' scripts read, as scripts: pages on the disk may read nothing else
//! ```
//!
//! It opens from the disk and from any web host (`static/capsule/loader.js`). The same input gives the same bytes.

mod answers;
mod archive;
mod formats;
mod logs;
mod pages;
mod trials;
mod weights;
mod words;

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, ensure};
use mimique_analysis::{Report, ReportOptions, StudyVersions, analyze_with};
use mimique_locale::{Language, counted, counted_as};
use mimique_server::export::stimuli_of;
use mimique_server::{Assets, EmbeddedFile, HostedStudy, Hosting, Stage};
use mimique_session::flow::Plays;
use mimique_session::rows::TidyForm;
use mimique_stats::Table;
use mimique_study::{CheckedStudy, StaticHosting, Study, answer_hashes, published};
use serde_json::{Value, json};

use crate::analyze::language;
use crate::export_site::{checked_study, is_of_participants, packs_of, site_file};
use crate::output;
use crate::serve::prepare_study;
use answers::{Answers, LeftOut};
use archive::{Files, Part, Size};
use logs::Logs;
use trials::{PlaysOfPeople, Trials};

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Study file
    study: PathBuf,
    /// Tidy export, as `mimique export --format csv` writes it
    export: PathBuf,
    /// Events of the same moment, as `mimique export --format events` writes them: the frames that each person was shown
    #[arg(long, value_name = "EVENTS.jsonl")]
    events: PathBuf,
    /// Archive to write; its name ends in .zip
    #[arg(long, value_name = "FILE.zip")]
    out: PathBuf,
    /// Keep what people wrote in their own words; make sure that it names nobody
    #[arg(long)]
    keep_texts: bool,
    /// Language of reader and report: en or fr
    #[arg(long, default_value = "en", value_parser = language)]
    language: Language,
    /// Folder where prepared stimuli are kept between runs
    #[arg(long, default_value = "mimique-data/packs")]
    packs: PathBuf,
    /// Folder of the pages, instead of those inside the binary
    #[arg(long)]
    web_dir: Option<PathBuf>,
}

/// What a capsule is made of.
struct Capsule<'a> {
    args: &'a Args,
    checked: &'a CheckedStudy,
    hosted: HostedStudy,
    hosting: Hosting,
    answers: Answers,
    plays: PlaysOfPeople,
    other_versions: usize,
}

/// Runs the command.
pub fn run(args: &Args, pages: &[EmbeddedFile], json: bool) -> anyhow::Result<()> {
    let place = |path: &Path| path.display().to_string();
    ensure!(
        args.out.extension().is_some_and(|end| end.eq_ignore_ascii_case("zip")),
        "{}: a capsule is a ZIP archive; give --out a name that ends in .zip",
        place(&args.out)
    );
    let assets = crate::pages::assets(args.web_dir.as_deref(), pages)?;
    let checked = checked_study(&args.study)?;
    let logs = Logs::read(&args.events).with_context(|| place(&args.events))?;
    let answers = Answers::read(&args.export, checked.study(), &logs, args.keep_texts)
        .with_context(|| place(&args.export))?;
    let (plays, other_versions) =
        plays(&answers, &logs, &checked).with_context(|| place(&args.events))?;
    let hosting = prepare_study(&args.study, checked.study(), &args.packs)
        .map_err(|faults| anyhow::anyhow!(faults.join("\nerror: ")))?;
    let hosted = HostedStudy::new(checked.value().clone(), hosting.clips.clone(), Stage::Live)?;
    let checked = &checked;
    let capsule = Capsule { args, checked, hosted, hosting, answers, plays, other_versions };
    let (files, made) = capsule.files(&assets)?;
    let (bytes, sizes) = files.zipped(&format!("capsule-{}", checked.study().id))?;
    if let Some(parent) = args.out.parent().filter(|parent| !parent.as_os_str().is_empty()) {
        output::make_folder(parent)?;
    }
    output::write(&args.out, &bytes)?;
    capsule.tell(&made, &sizes, bytes.len(), json)
}

/// What each person was shown, of those whose session is of this version of the study; how many are of others.
fn plays(
    answers: &Answers,
    logs: &Logs,
    checked: &CheckedStudy,
) -> anyhow::Result<(PlaysOfPeople, usize)> {
    let (mut plays, mut others) = (BTreeMap::new(), 0);
    for (person, row) in answers.people() {
        let Some(session) = logs.people.get(person) else { continue };
        if !session.is_of(checked.config_hash()) {
            others += 1;
            continue;
        }
        let seen = session.plays(checked.study(), row).with_context(|| person.to_owned())?;
        plays.insert(person.to_owned(), seen);
    }
    Ok((plays, others))
}

/// What is told of a capsule.
struct Made {
    people: usize,
    trials: (usize, usize),
    plays: (usize, u64),
    left_out: Vec<String>,
}

impl Capsule<'_> {
    fn study(&self) -> &Study {
        self.checked.study()
    }

    /// Every file.
    fn files(&self, assets: &Assets) -> anyhow::Result<(Files, Made)> {
        let mut files = Files::default();
        let language = self.args.language;
        let prefix = format!("assets/{}", assets.hash());
        program(&mut files, assets, &prefix)?;
        self.stimuli(&mut files)?;
        let csv = self.answers.csv()?;
        let stimuli = stimuli_of(self.checked.value().clone(), &self.hosting)?;
        let report = self.report(&csv, &stimuli)?;
        for file in &report.files {
            files.plain(Part::Report, &format!("report/{}", file.path), file.text.as_bytes());
            if file.path == "report.html" {
                files.text(Part::Report, &file.path, "text/html", &file.text);
            }
        }
        let Report { people, trials, readings, .. } = &report;
        let summary =
            json!({ "people": [people.0, people.1], "trials": trials, "readings": readings });
        files.text(Part::Report, "summary.json", JSON, &summary.to_string());
        for (name, bytes) in [("responses.csv", &csv), ("stimuli.csv", &stimuli)] {
            files.plain(Part::Answers, &format!("data/{name}"), bytes.clone());
            files.text(Part::Answers, name, "text/csv", &String::from_utf8_lossy(bytes));
        }
        let trials = Trials::of(&self.answers, &self.plays);
        files.text(Part::Answers, "trials.json", JSON, &serde_json::to_string(&trials)?);
        for (person, pages) in &self.plays {
            let text = json!({ "pages": pages }).to_string();
            files.text(Part::Frames, &format!("plays/{person}.json"), JSON, &text);
        }
        let study = serde_json::to_string_pretty(&self.shared_study())? + "\n";
        files.plain(Part::Study, "study.json", study.as_bytes());
        files.text(Part::Study, "study.json", JSON, &study);
        files.text(Part::Study, "site.json", JSON, &self.site()?.to_string());
        let form = TidyForm::new(self.study(), &self.hosting.clips);
        let page = formats::page(&form, self.answers.names());
        files.plain(Part::Study, "FORMATS.md", page.as_bytes());
        for (name, source) in formats::SOURCES {
            files.plain(Part::Study, &format!("formats/{name}"), source);
        }
        let left_out = pages::sentences(&self.answers.left_out, self.other_versions, language);
        let made = Made {
            people: self.answers.people().len(),
            trials: trials.count(),
            plays: self.count(),
            left_out,
        };
        let about = pages::About {
            study: self.study(),
            config_hash: self.checked.config_hash(),
            people: made.people,
            trials: made.trials,
            left_out: &made.left_out,
            formats: &page,
        };
        files.plain(Part::Program, "index.html", pages::reader(&prefix, &about, language));
        files.plain(Part::Program, "take-part.html", pages::take_part(&prefix, self.study()));
        Ok((files, made))
    }

    /// Plays, and late frames in them.
    fn count(&self) -> (usize, u64) {
        let counts = self.plays.values().flat_map(|steps| steps.values().map(Plays::count));
        counts.fold((0, 0), |(plays, late), (own, own_late)| (plays + own, late + own_late))
    }

    /// Packs, and the weights of each clip as numbers.
    fn stimuli(&self, files: &mut Files) -> anyhow::Result<()> {
        for hash in packs_of(&self.hosted) {
            let path = self.args.packs.join(hash);
            let bytes = std::fs::read(&path).with_context(|| path.display().to_string())?;
            files.bytes(
                Part::Stimuli,
                &format!("packs/{hash}"),
                "application/octet-stream",
                &bytes,
            )?;
        }
        for (clip, source) in &self.hosting.clips {
            if let Some(csv) = weights::csv_of(clip, source, &self.args.packs)? {
                files.plain(Part::Stimuli, &format!("data/weights/{clip}.csv"), csv);
            }
        }
        Ok(())
    }

    /// The report on the answers that are shared; points of its figures lead to the reader.
    fn report(&self, csv: &[u8], stimuli: &[u8]) -> anyhow::Result<Report> {
        let table = Table::parse(csv)?;
        let shown = !self.study().clips().is_empty();
        let stimuli = shown.then(|| Table::parse(stimuli)).transpose()?;
        let hashes = answer_hashes(self.checked.value());
        let versions = StudyVersions { config_hashes: &hashes, served: &[] };
        // What was measured of faces says much of a person, and is not shared.
        let options = ReportOptions {
            stimuli: stimuli.as_ref(),
            preview: Some(READER),
            versions,
            ..ReportOptions::default()
        };
        analyze_with(&table, self.study(), self.args.language, options)
            .with_context(|| self.args.export.display().to_string())
    }

    /// The study file without codes and addresses of recruitment.
    fn shared_study(&self) -> Value {
        let mut file = self.checked.value().clone();
        if let Some(keys) = file.as_object_mut() {
            keys.remove("recruitment");
        }
        published(self.checked.value(), file)
    }

    /// What takes the server's place: nothing is posted, nothing is offered, and there are no codes.
    fn site(&self) -> anyhow::Result<Value> {
        let hosting = StaticHosting { post: None, post_progress: false, download: false };
        let mut site = site_file(self.study(), &self.hosted, Stage::Pilot, hosting);
        site.codes.clear();
        site.redirect = None;
        let mut site = serde_json::to_value(site)?;
        if let Some(study) = site.pointer_mut("/bundle/study").and_then(Value::as_object_mut) {
            study.remove("triggers");
            study.remove("mimicry");
        }
        Ok(site)
    }

    /// What was written.
    fn tell(
        &self,
        made: &Made,
        sizes: &BTreeMap<Part, Size>,
        bytes: usize,
        json: bool,
    ) -> anyhow::Result<()> {
        let mut out = std::io::stdout().lock();
        let place = self.args.out.display();
        let ((trials, drawn), (plays, late)) = (made.trials, made.plays);
        let LeftOut { withdrawn, declined, in_one_alone, identifiers, texts } =
            &self.answers.left_out;
        if json {
            let parts: BTreeMap<&str, Value> = (sizes.iter())
                .map(|(part, size)| {
                    (
                        part.word(),
                        json!({ "files": size.files, "bytes": size.bytes, "packed": size.packed }),
                    )
                })
                .collect();
            let line = json!({
                "study": self.study().id, "config_hash": self.checked.config_hash(), "out": place.to_string(),
                "bytes": bytes, "parts": parts, "people": made.people, "trials": trials, "trials_drawn": drawn,
                "plays": plays, "late_frames": late,
                "left_out": {
                    "withdrawn": withdrawn.len(), "declined": declined.len(), "in_one_export_alone": in_one_alone.len(),
                    "other_versions": self.other_versions, "texts": texts, "identifiers": identifiers,
                },
            });
            writeln!(out, "{line}")?;
            return Ok(());
        }
        let people = counted_as(made.people, "person", "people");
        writeln!(
            out,
            "{place}: {:.1} MB, {people}, {}",
            bytes as f64 / 1e6,
            counted(trials, "trial")
        )?;
        let frames = counted(late as usize, "late frame");
        writeln!(out, "  {drawn} trials can be drawn again: {}, {frames}", counted(plays, "play"))?;
        for (part, Size { files, bytes, packed }) in sizes {
            let (packed, bytes) = (*packed as f64 / 1e6, *bytes as f64 / 1e6);
            writeln!(
                out,
                "  {:8} {packed:6.2} MB ({bytes:.2} MB unpacked, {})",
                part.word(),
                counted(*files, "file")
            )?;
        }
        for sentence in
            pages::sentences(&self.answers.left_out, self.other_versions, Language::English)
        {
            writeln!(out, "  {sentence}")?;
        }
        writeln!(out, "  unpack it and open index.html, or put the folder on any web host")?;
        Ok(())
    }
}

const JSON: &str = "application/json";
/// The reader, as the report names it.
const READER: &str = "../index.html";
/// Files of the pages beside those of participants that the reader needs.
const READERS: [&str; 5] = [
    "researcher/preview.css",
    "researcher/replay.css",
    "researcher/replayed.js",
    "report.js",
    "report_bg.wasm",
];
/// What pages load as it is: the loader, and what runs before it.
const AS_THEY_ARE: [&str; 2] = ["capsule/loader.js", "capsule/nothing-kept.js"];

/// The pages' files: scripts and modules as scripts that hand them over, styles as they are.
fn program(files: &mut Files, assets: &Assets, prefix: &str) -> anyhow::Result<()> {
    let mut missing: BTreeSet<&str> = READERS.into_iter().chain(AS_THEY_ARE).collect();
    for (name, bytes) in assets.files() {
        missing.remove(name);
        let wanted =
            is_of_participants(name) || READERS.contains(&name) || name.starts_with("capsule/");
        let path = format!("{prefix}/{name}");
        match name.rsplit_once('.').map(|(_, ending)| ending) {
            _ if !wanted => {}
            Some("wasm") => files.bytes(Part::Program, &path, "application/wasm", bytes)?,
            Some("js") if !AS_THEY_ARE.contains(&name) => {
                let text = String::from_utf8_lossy(bytes);
                files.text(Part::Program, &path, "text/javascript", &text);
            }
            _ => files.plain(Part::Program, &path, bytes),
        }
    }
    ensure!(
        missing.is_empty(),
        "{} not among the pages; run `cargo xtask web` and build again",
        missing.into_iter().collect::<Vec<_>>().join(", ")
    );
    Ok(())
}
