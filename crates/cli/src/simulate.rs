//! `mimique simulate STUDY --participants N --out DIR`: an export of simulated participants, as the
//! server writes it, and the parameters it was made with.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use mimique_analysis::{Parameters, SimulatedSession, Simulation};
use mimique_locale::counted;
use mimique_server::export::{Exported, Format, Unstored};
use mimique_stats::Table;
use mimique_stimulus::{Places, prepare};
use mimique_study::{ClipSource, Study};

use crate::output;
use crate::study_file::{StudyFile, load};

/// Most participants of one simulation.
const MOST_PARTICIPANTS: u64 = 1_000_000;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Study file (JSON, comments allowed)
    study: PathBuf,
    /// How many people arrive; who declines or withdraws leaves no answers
    #[arg(long, short = 'n', value_parser = clap::value_parser!(u64).range(1..=MOST_PARTICIPANTS))]
    participants: u64,
    /// Seed of people and clips; the order of trials is the study's own
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    assumptions: Assumptions,
    /// Without the effects that the study's hypotheses look for
    #[arg(long)]
    no_effects: bool,
    /// csv: one row a participant x trial x response; wide: one row a participant; json: the rows of
    /// csv as JSON lines; events: all that the page would send; psych-ds: a Psych-DS data set
    #[arg(long, default_value = "csv", value_parser = format)]
    format: Format,
    /// Prepare the clips first, as serve does, so that the export says by hashes what was shown
    #[arg(long)]
    prepare: bool,
    /// Folder to write to: the export, and parameters.json
    #[arg(long)]
    out: PathBuf,
}

/// Where the parameters of a simulation come from.
#[derive(clap::Args)]
pub struct Assumptions {
    /// Parameters file (JSON, comments allowed); what it leaves out is the study's default, which
    /// `mimique simulate` writes into parameters.json
    #[arg(long)]
    parameters: Option<PathBuf>,
    /// Tidy export of this study to fit the parameters to; a parameters file goes over what is fitted
    #[arg(long)]
    fit: Option<PathBuf>,
}

impl Assumptions {
    /// Whether everything is the study's default.
    pub fn is_default(&self) -> bool {
        self.parameters.is_none() && self.fit.is_none()
    }

    /// The parameters for a study.
    pub fn read(&self, study: &Study) -> anyhow::Result<Parameters> {
        let mut parameters = match &self.fit {
            None => Parameters::for_study(study),
            Some(path) => std::fs::read(path)
                .map_err(|error| anyhow::anyhow!("cannot be read ({error}); check the path"))
                .and_then(|bytes| Ok(Table::parse(bytes)?))
                .and_then(|table| Ok(Parameters::fit(&table, study)?))
                .with_context(|| path.display().to_string())?,
        };
        if let Some(path) = &self.parameters {
            let place = || path.display().to_string();
            let text = std::fs::read_to_string(path)
                .map_err(|error| anyhow::anyhow!("cannot be read ({error}); check the path"))
                .with_context(place)?;
            parameters = Parameters::read_over(&parameters, &text, study).with_context(place)?;
        }
        Ok(parameters)
    }
}

fn format(word: &str) -> Result<Format, String> {
    Format::from_word(word).ok_or_else(|| {
        let known = Format::ALL.map(Format::word).join(", ");
        format!("there are {known}")
    })
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let (file, study) = load(&args.study)?;
    let place = || args.study.display().to_string();
    let mut parameters = args.assumptions.read(&study)?;
    if args.no_effects {
        parameters = parameters.without_effects(&study);
    }
    let clips = if args.prepare { prepared(&args.study, &study)? } else { BTreeMap::new() };
    let writer = Unstored::new(file, clips, args.format).with_context(place)?;
    let simulation = Simulation::new(&study, writer.config_hash(), &parameters, args.seed)
        .with_context(|| match &args.assumptions.parameters {
            Some(path) => path.display().to_string(),
            None => place(),
        })?;
    let written = |session: SimulatedSession| writer.write(&session.started, &session.events);
    let sessions = simulation.sessions(args.participants, written).with_context(place)?;
    let sessions: Vec<_> = sessions.into_iter().collect::<Result<_, _>>().with_context(place)?;
    let exported = writer.join(sessions)?;
    let (participants, rows) = (exported.participants, exported.rows);
    let written = write(&args.out, exported, &parameters)?;
    let mut out = std::io::stdout().lock();
    if json {
        let files: Vec<String> = written.iter().map(|path| path.display().to_string()).collect();
        let line = serde_json::json!({
            "study": study.id,
            "seed": args.seed,
            "arrived": args.participants,
            "participants": participants,
            "rows": rows,
            "files": files,
        });
        writeln!(out, "{line}")?;
        return Ok(());
    }
    writeln!(
        out,
        "{}: {participants} of {} left answers, {}, seed {}",
        study.id,
        counted(args.participants as usize, "simulated participant"),
        counted(rows, "row"),
        args.seed
    )?;
    for path in &written {
        writeln!(out, "  {}", path.display())?;
    }
    Ok(())
}

/// The clips of a study as a server prepares them.
fn prepared(file: &Path, study: &Study) -> anyhow::Result<BTreeMap<String, ClipSource>> {
    let opened = StudyFile::open(file)?;
    let packs = tempfile::tempdir().context("a folder for the packs")?;
    let found = prepare(study, &Places::of(opened.path(), packs.path()), &mut |_| ());
    let found = found.map_err(|faults| {
        let said = faults
            .iter()
            .map(|fault| format!("{}: {}", file.display(), opened.said(&fault.to_string())));
        anyhow::anyhow!("{}", said.collect::<Vec<_>>().join("\nerror: "))
    })?;
    Ok(found.clips)
}

/// Writes the export and `parameters.json` into a folder; returns the files.
fn write(
    folder: &Path,
    exported: Exported,
    parameters: &Parameters,
) -> anyhow::Result<Vec<PathBuf>> {
    std::fs::create_dir_all(folder)
        .map_err(|error| {
            anyhow::anyhow!("no folder can be made ({error}); choose another by --out")
        })
        .with_context(|| folder.display().to_string())?;
    // One file goes under its own name, several are a folder of their own.
    let target = match exported.files.as_slice() {
        [(name, _)] => folder.join(name),
        _ => folder.to_owned(),
    };
    let mut written = exported.write(&target)?;
    let path = folder.join("parameters.json");
    let mut text = serde_json::to_string_pretty(parameters)?;
    text.push('\n');
    output::write(&path, text.as_bytes())?;
    written.push(path);
    Ok(written)
}
