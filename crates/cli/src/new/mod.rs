//! `mimique new`: a design, instruments, an avatar and a capture in; the folder of a study that can be checked, served,
//! simulated and analysed out. What no option says is asked; nothing is written over, and nothing half.

mod ask;
mod stimuli;

use std::io::Write as _;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Context as _, anyhow, bail};
use mimique_new_study::{
    Design, Instrument, NotComposed, compose, designs, elsewhere, instruments, study_id,
};
use mimique_stimulus::TakeSegment;
use mimique_storage::durable_file;
use mimique_study::Severity;
use serde_json::{Value, json};

use self::stimuli::StimulusFiles;
use crate::check::check_opened_file;
use crate::solve::Span;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Folder of the study; it must not be there yet
    #[arg(required_unless_present = "list")]
    folder: Option<PathBuf>,
    /// Print the designs and the instruments instead
    #[arg(long, conflicts_with = "folder")]
    list: bool,
    /// Design of the study, as --list has them; without it everything is asked
    #[arg(long, value_name = "NAME")]
    design: Option<String>,
    /// Title that participants see
    #[arg(long)]
    title: Option<String>,
    /// Languages of the pages, the first being the default [default: en]
    #[arg(long, value_name = "CODE,CODE", value_delimiter = ',')]
    languages: Vec<String>,
    /// Instruments, as --list has them, or files of your own in the same form
    #[arg(long = "instrument", value_name = "NAME,NAME", value_delimiter = ',')]
    instruments: Vec<String>,
    /// Methods that are compared, by their names [default: the design's]
    #[arg(long = "method", value_name = "NAME,NAME", value_delimiter = ',')]
    methods: Vec<String>,
    /// File of the avatar; without it the built-in head and its actor
    #[arg(long, value_name = "FILE")]
    avatar: Option<PathBuf>,
    /// File of the capture
    #[arg(long, value_name = "FILE")]
    capture: Option<PathBuf>,
    /// Marker map of the capture on the avatar; without it one is suggested
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Labels of the markers that move with the head alone [default: the map's]
    #[arg(long, value_name = "LABEL,LABEL", value_delimiter = ',')]
    head: Vec<String>,
    /// Frames of the neutral face, counted from 0 [default: the map's]
    #[arg(long, value_name = "FIRST:END")]
    neutral: Option<Span>,
    /// Clips of the capture: a CSV or an ELAN document, as `mimique segment` writes them
    #[arg(long, value_name = "FILE")]
    segments: Option<PathBuf>,
    /// Tier of an ELAN document
    #[arg(long, value_name = "NAME", default_value = "expressions")]
    tier: String,
    /// A clip of the capture; may be given several times
    #[arg(long = "cut", value_name = "FIRST:END:NAME")]
    cuts: Vec<Cut>,
    /// Leave avatar, capture and map where they are, instead of copying them
    #[arg(long)]
    reference: bool,
}

/// `FIRST:END:NAME`.
#[derive(Debug, Clone)]
struct Cut(TakeSegment);

impl FromStr for Cut {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.rsplit_once(':').filter(|(_, name)| !name.trim().is_empty());
        let read = parts.and_then(|(frames, name)| Some((Span::from_str(frames).ok()?, name)));
        let (Span(frames), name) = read.ok_or_else(|| {
            "give the first frame, the one after the last, and a name, as 330:570:jaw-open"
                .to_owned()
        })?;
        Ok(Self(TakeSegment::new(name.trim(), frames)))
    }
}

/// What is wished, with nothing left open.
struct Wishes {
    id: String,
    design: String,
    title: Option<String>,
    languages: Vec<String>,
    instruments: Vec<String>,
    methods: Vec<String>,
    avatar: Option<PathBuf>,
    capture: Option<PathBuf>,
    map: Option<PathBuf>,
    head: Vec<String>,
    neutral: Option<Range<usize>>,
    segments: Option<PathBuf>,
    tier: String,
    cuts: Vec<TakeSegment>,
    reference: bool,
}

impl Wishes {
    /// What the study itself is told of them.
    fn of_study(&self) -> mimique_new_study::Wishes {
        let method = |name: &String| (name.clone(), json!({ "method": name }));
        mimique_new_study::Wishes {
            id: self.id.clone(),
            title: self.title.clone(),
            languages: self.languages.clone(),
            methods: self.methods.iter().map(method).collect(),
        }
    }
}

/// Runs the command.
pub fn run(mut args: Args, json: bool) -> anyhow::Result<()> {
    if args.list {
        return list(json);
    }
    let folder = args.folder.clone().unwrap_or_default();
    let place = folder.display().to_string();
    // A link that leads nowhere is there, too.
    if folder.symlink_metadata().is_ok() {
        bail!("{place}: it is there already, and nothing is written over it; name another folder");
    }
    if args.design.is_none() {
        ask::ask(&mut args, &mut std::io::stdin().lock(), &mut std::io::stderr().lock())?;
    }
    let wishes = wishes(args, &folder)?;
    let design = Design::named(&wishes.design).map_err(|e| anyhow!("--design: {e}"))?;
    let instruments: Vec<Instrument> =
        wishes.instruments.iter().map(|name| instrument(name)).collect::<anyhow::Result<_>>()?;
    let stimuli = match &design {
        Design::Parts(_) => Some(StimulusFiles::of(&wishes)?),
        Design::Whole(_) => no_stimuli(&wishes)?,
    };
    let composed =
        compose(&wishes.of_study(), &design, &instruments, stimuli.as_ref().map(|own| &own.shown))
            .map_err(|error| match &error {
                NotComposed::NoSingleClips { instrument } => {
                    anyhow!("--instrument: {instrument}: {error}")
                }
                NotComposed::OneExpression { .. } | NotComposed::NoStimuli => {
                    anyhow!("--design: {}: {error}", wishes.design)
                }
                NotComposed::Library(_) => error.into(),
            })?;
    let notes = stimuli.as_ref().map_or(&[][..], |own| &own.notes);
    let mut made =
        composed.files("`mimique new`", &wishes.design, &wishes.of_study(), &instruments, notes);
    made.extend(stimuli.iter().flat_map(|own| own.made.iter().cloned()));
    let copied = stimuli.as_ref().map_or(&[][..], |own| &own.copied);
    if let Some(parent) = folder.parent().filter(|parent| !parent.as_os_str().is_empty()) {
        crate::output::make_folder(parent)?;
    }
    durable_file::write_folder(&folder, |fresh| fill(fresh, &made, copied, &place))?;
    let files: Vec<&String> =
        made.iter().map(|(name, _)| name).chain(copied.iter().map(|(_, name)| name)).collect();
    tell(&place, &files, notes, json)
}

/// Writes and copies the files of a study's folder, and checks what is there as `mimique check` does.
pub(crate) fn fill(
    fresh: &Path,
    made: &[(String, String)],
    copied: &[(PathBuf, String)],
    place: &str,
) -> anyhow::Result<()> {
    let there = |name: &str| -> anyhow::Result<PathBuf> {
        let path = fresh.join(name);
        crate::output::make_folder(path.parent().unwrap_or(fresh))?;
        Ok(path)
    };
    for (name, text) in made {
        std::fs::write(there(name)?, text).with_context(|| format!("{place}/{name}"))?;
    }
    for (from, name) in copied {
        std::fs::copy(from, there(name)?)
            .map_err(|e| anyhow!("{}: cannot be copied ({e}); check the file", from.display()))?;
    }
    let report = check_opened_file(&fresh.join("study.json"))?;
    let errors = report.issues.iter().filter(|issue| issue.severity == Severity::Error);
    let said: Vec<String> = errors
        .map(|issue| {
            // The folder that goes away is no place that anybody knows.
            let message = issue.message().replace(&fresh.display().to_string(), place);
            format!("{place}/study.json: {}: {message}; {}", issue.place(), issue.remedy())
        })
        .collect();
    if !said.is_empty() {
        bail!("{}\nerror: {place}: nothing was written", said.join("\nerror: "));
    }
    Ok(())
}

/// The instrument of that name, or of that file.
fn instrument(name: &str) -> anyhow::Result<Instrument> {
    let path = Path::new(name);
    let found = if path.extension().is_some_and(|end| end == "json") {
        let text = std::fs::read_to_string(path)
            .map_err(|e| anyhow!("--instrument: {name}: open: {e}; check the path"))?;
        let id = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Instrument::read(&id, &text)
    } else {
        Instrument::named(name)
    };
    found.map_err(|e| anyhow!("--instrument: {e}"))
}

/// A study of the thesis shows what it shows.
fn no_stimuli(wishes: &Wishes) -> anyhow::Result<Option<StimulusFiles>> {
    if wishes.avatar.is_some() || wishes.capture.is_some() || !wishes.methods.is_empty() {
        bail!(
            "--design: {}: a study of the thesis has its own performances and methods; leave --avatar, --capture and \
             --method out, and change /stimuli in its study.json",
            wishes.design
        );
    }
    Ok(None)
}

fn wishes(args: Args, folder: &Path) -> anyhow::Result<Wishes> {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let id = study_id(&name).ok_or_else(|| {
        anyhow!("{}: no name for a study; use letters and digits", folder.display())
    })?;
    let languages = if args.languages.is_empty() { vec!["en".to_owned()] } else { args.languages };
    Ok(Wishes {
        id,
        design: args.design.unwrap_or_default(),
        title: args.title,
        languages,
        instruments: args.instruments,
        methods: args.methods,
        avatar: args.avatar,
        capture: args.capture,
        map: args.map,
        head: args.head,
        neutral: args.neutral.map(|Span(frames)| frames),
        segments: args.segments,
        tier: args.tier,
        cuts: args.cuts.into_iter().map(|Cut(segment)| segment).collect(),
        reference: args.reference,
    })
}

/// What was written, and what to do next.
fn tell(place: &str, files: &[&String], notes: &[String], json: bool) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    if json {
        let value = json!({ "folder": place, "files": files, "notes": notes });
        writeln!(out, "{}", serde_json::to_string_pretty(&value)?)?;
        return Ok(());
    }
    for name in files {
        writeln!(out, "{place}/{name}")?;
    }
    for note in notes {
        writeln!(out, "note: {note}")?;
    }
    writeln!(out, "next: mimique check {place}/study.json, then mimique serve {place}/study.json")?;
    Ok(())
}

/// `--list`: what there is to choose from.
fn list(json: bool) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    let (designs, instruments, elsewhere) = (designs()?, instruments()?, elsewhere()?);
    if json {
        let value = json!({
            "designs": designs.iter().map(|(name, about)| json!({ "name": name, "about": about })).collect::<Vec<Value>>(),
            "instruments": instruments.iter().map(|own| json!({
                "name": own.id, "about": own.name, "citation": own.citation, "licence": own.licence,
                "scoring": own.scoring,
            })).collect::<Vec<Value>>(),
            "elsewhere": elsewhere.iter().map(|own| json!({
                "name": own.id, "about": own.name, "citation": own.citation, "where": own.place, "why": own.why,
            })).collect::<Vec<Value>>(),
        });
        writeln!(out, "{}", serde_json::to_string_pretty(&value)?)?;
        return Ok(());
    }
    writeln!(out, "designs (--design):")?;
    for (name, about) in designs {
        writeln!(out, "  {name}: {about}")?;
    }
    writeln!(out, "instruments (--instrument):")?;
    for own in instruments {
        writeln!(out, "  {}: {}", own.id, own.name)?;
    }
    writeln!(out, "not in the library; write them into a file of your own:")?;
    for own in elsewhere {
        writeln!(out, "  {}: {}: {}; {}", own.id, own.name, own.why, own.place)?;
    }
    Ok(())
}
