//! `mimique check`: every problem of a study file at once, each with its place and a remedy.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use mimique_comparison::{ClipDifference, StudyComparison, compare_clips};
use mimique_locale::counted;
use mimique_stimulus::{
    ADVISED_SMOOTHING, AdvisedMethod, Places, PrepareError, Prepared, SoundError, StudySound,
    advised_methods, prepare, source_faults, study_sounds,
};
use mimique_study::text::template;
use mimique_study::{
    Issue, Problem, Report, Severity, Study, check, check_opened, json_schema, resolve_path,
};

use crate::study_file::StudyFile;

/// Options.
#[derive(clap::Args)]
#[command(group(clap::ArgGroup::new("what").required(true).args(["study", "schema", "words"])))]
pub struct Args {
    /// Study file (JSON, comments allowed), or a ZIP archive of its folder
    study: Option<PathBuf>,
    /// Print the JSON Schema of study files instead, for editors
    #[arg(long)]
    schema: bool,
    /// Print the buttons and messages of the pages by their names instead, to be translated into
    /// `translations` of a study file
    #[arg(long, value_name = "LANGUAGE", value_parser = language)]
    words: Option<String>,
    /// Leave the clips alone: they are not prepared, nor held against each other
    #[arg(long, requires = "study")]
    without_clips: bool,
}

/// The code of a language.
fn language(code: &str) -> Result<String, String> {
    match code.trim() {
        "" => Err("no language is named; write its code, as in --words de".to_owned()),
        code => Ok(code.to_owned()),
    }
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    if let Some(language) = &args.words {
        // In the order of the pages, not of the alphabet.
        let lines: Vec<String> = template(language)
            .iter()
            .map(|(name, text)| format!("    \"{name}\": {}", serde_json::Value::from(*text)))
            .collect();
        let language = serde_json::Value::from(language.as_str());
        let lines = lines.join(",\n");
        writeln!(out, "{{ \"translations\": {{\n  {language}: {{\n{lines}\n  }}\n}} }}")?;
        return Ok(());
    }
    let Some(file) = args.study else {
        writeln!(out, "{}", serde_json::to_string_pretty(&json_schema())?)?;
        return Ok(());
    };
    let opened = StudyFile::open(&file)?;
    let mut report = check_opened_file(opened.path())?;
    let mut comparison = None;
    let mut sounds = Vec::new();
    if let Some(checked) = &report.study {
        let mut advised = advised(checked.study(), opened.path());
        sounds = study_sounds(checked.study(), &Places::of(opened.path(), PathBuf::new()));
        let at_fault: Vec<Issue> = sounds.iter().filter_map(fault_of_sound).collect();
        // What is wrong with a file is said once: the clips are not made of it.
        let without_clips = args.without_clips || !at_fault.is_empty();
        advised.extend(at_fault);
        let clips = if without_clips { None } else { Some(clips(checked.study(), opened.path())?) };
        report.issues.extend(advised);
        if let Some(clips) = clips {
            report.issues.extend(clips.issues);
            comparison = clips.comparison;
        }
        if report.errors() > 0 {
            report.study = None;
        }
    }
    if json {
        let text = serde_json::json!({
            "file": file.display().to_string(),
            "ok": report.study.is_some(),
            "errors": report.errors(),
            "warnings": report.warnings(),
            "config_hash": report.study.as_ref().map(|study| study.config_hash()),
            "issues": report.issues,
            "sounds": sounds.iter().map(sound_facts).collect::<Vec<_>>(),
            "comparison": comparison,
        });
        writeln!(out, "{}", opened.said(&serde_json::to_string_pretty(&text)?))?;
    } else {
        print(&mut out, &file, &opened, &report)?;
        tell_sounds(&mut out, &sounds)?;
        if let Some(comparison) = &comparison {
            differences(&mut out, comparison)?;
        }
    }
    // Everything was said above.
    anyhow::ensure!(report.study.is_some(), "");
    Ok(())
}

/// What the captures of a study gain by a smoothed adaptation of shape.
fn advised(study: &Study, file: &Path) -> Vec<Issue> {
    // Nothing is packed.
    let places = Places::of(file, PathBuf::new());
    let issue = |AdvisedMethod { pointer, capture, advice }| Issue {
        pointer,
        severity: Severity::Warning,
        problem: Problem::SmoothingAdvised {
            capture,
            why: advice.reason.to_string(),
            residual_mm: advice.residual_mm,
            smoothed_mm: advice.smoothed_mm,
            smoothing: ADVISED_SMOOTHING,
        },
    };
    advised_methods(study, &places).into_iter().map(issue).collect()
}

/// What is wrong with a file of sound.
fn fault_of_sound(sound: &StudySound) -> Option<Issue> {
    let StudySound { pointer, file: path, from_s, facts } = sound;
    let (path, from_s) = (path.clone(), *from_s);
    let problem = match facts {
        Err(SoundError::Unknown) => Problem::SoundUnknown { path },
        Err(SoundError::Damaged { what }) => Problem::SoundDamaged { path, what: what.clone() },
        Ok(facts) if from_s >= facts.duration_s => {
            Problem::SoundBeginsLate { path, from_s, duration_s: facts.duration_s }
        }
        Ok(_) => return None,
    };
    Some(Issue::error(pointer, problem))
}

/// The clips whose sound ends before they do.
fn short_sounds(study: &Study, prepared: &Prepared) -> Vec<Issue> {
    let short = study.clips().into_iter().filter_map(|clip| {
        let source = prepared.clips.get(&clip.id)?;
        let sound = source.sound.as_ref()?;
        let (audible_s, clip_s) = (sound.audible_s(), source.duration_ms / 1e3);
        // Of a video the duration is known to browsers alone (0 here).
        (audible_s < clip_s - SHORT_SOUND_S).then(|| Issue {
            pointer: study.heard(&clip).map_or_else(String::new, |heard| heard.place.pointer()),
            severity: Severity::Warning,
            problem: Problem::SoundEndsEarly { clip: clip.id.clone(), audible_s, clip_s },
        })
    });
    short.collect()
}

/// So much earlier than its clip a sound may end, seconds: three frames of a display.
const SHORT_SOUND_S: f64 = 0.05;

fn sound_facts(sound: &StudySound) -> serde_json::Value {
    let facts = sound.facts.as_ref().ok();
    serde_json::json!({
        "file": sound.file,
        "format": facts.map(|facts| facts.format.name()),
        "duration_s": facts.map(|facts| facts.duration_s),
        "sample_rate_hz": facts.map(|facts| facts.sample_rate_hz),
        "channels": facts.map(|facts| facts.channels),
    })
}

/// What the files of sound hold.
fn tell_sounds(out: &mut impl std::io::Write, sounds: &[StudySound]) -> std::io::Result<()> {
    for StudySound { file, facts, .. } in sounds {
        let Ok(facts) = facts else { continue };
        let (name, seconds) = (facts.format.name(), facts.duration_s);
        let rate = facts.sample_rate_hz;
        let channels = counted(usize::from(facts.channels), "channel");
        writeln!(out, "sound {file}: {name}, {seconds:.3} s, {rate} Hz, {channels}")?;
    }
    Ok(())
}

/// What the clips of a study tell when they are prepared.
struct Clips {
    issues: Vec<Issue>,
    comparison: Option<StudyComparison>,
}

/// Prepares the clips, as `serve` does, in a folder that goes away, and holds those of one segment against each
/// other.
fn clips(study: &Study, file: &Path) -> anyhow::Result<Clips> {
    let folder = tempfile::tempdir().context("a folder for the clips")?;
    let issue = |pointer: String, severity, problem| Issue { pointer, severity, problem };
    let prepared = match prepare(study, &Places::of(file, folder.path()), &mut |_| ()) {
        Ok(prepared) => prepared,
        Err(faults) => {
            let issues = faults.into_iter().map(PrepareError::issue).collect();
            return Ok(Clips { issues, comparison: None });
        }
    };
    let read = |hash: &str| std::fs::read(folder.path().join(hash));
    let comparison = compare_clips(study, &prepared.clips, &read)?;
    let unlike = comparison.unlike.iter().map(|unlike| {
        let (what, remedy) = unlike.words();
        let at = study.stimuli.segments.iter().position(|s| s.id == unlike.segment);
        let pointer = format!("/stimuli/segments/{}", at.unwrap_or_default());
        issue(pointer, Severity::Warning, Problem::ClipsUnlike { what, remedy })
    });
    let mut issues: Vec<Issue> = unlike.collect();
    issues.extend(short_sounds(study, &prepared));
    Ok(Clips { issues, comparison: Some(comparison) })
}

/// In which millimetres methods differ: for every two of them the mean over the segments, and the frame of the
/// largest distance.
fn differences(out: &mut impl std::io::Write, comparison: &StudyComparison) -> std::io::Result<()> {
    let mut pairs: BTreeMap<(&str, &[String; 2]), Vec<&ClipDifference>> = BTreeMap::new();
    for each in &comparison.differences {
        pairs.entry((&each.avatar, &each.methods)).or_default().push(each);
    }
    if pairs.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "methods in millimetres on the skin, root mean square over the frames of all segments:"
    )?;
    for ((avatar, [first, second]), clips) in pairs {
        let parts = &clips[0].difference.parts;
        let mean = |place: usize| {
            let squares = clips.iter().map(|clip| clip.difference.parts[place].rms_mm.powi(2));
            (squares.sum::<f64>() / clips.len() as f64).sqrt()
        };
        let told: Vec<String> = (0..parts.len())
            .map(|place| format!("{} {:.2}", parts[place].part, mean(place)))
            .collect();
        let worst = clips.iter().flat_map(|clip| {
            let whole = clip.difference.parts.last();
            whole.map(|part| (part.largest_mm, part.largest_frame, &clip.segment))
        });
        let worst = worst.max_by(|a, b| a.0.total_cmp(&b.0));
        write!(out, "  {avatar}: {first} and {second}: {}", told.join(", "))?;
        if let Some((most, frame, segment)) = worst {
            write!(out, "; at most {most:.2} in frame {frame} of {segment}")?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// Reads and checks a study file; files that it names are looked for on this machine.
pub fn check_file(file: &Path) -> anyhow::Result<Report> {
    Ok(check(&text_of(file)?, &looked_up(file)))
}

/// The same with the files opened that its clips are made of: every fault of them, before anything is solved.
pub(crate) fn check_opened_file(file: &Path) -> anyhow::Result<Report> {
    let places = Places::of(file, PathBuf::new());
    let opened = |study: &Study| {
        source_faults(study, &places).into_iter().map(PrepareError::issue).collect::<Vec<_>>()
    };
    Ok(check_opened(&text_of(file)?, &looked_up(file), &opened))
}

fn text_of(file: &Path) -> anyhow::Result<String> {
    let bytes = std::fs::read(file)
        .map_err(|error| anyhow::anyhow!("cannot be read ({error}); check the path"))
        .with_context(|| file.display().to_string())?;
    String::from_utf8(bytes).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        anyhow::anyhow!("{}: byte {place}: not UTF-8; save the file as UTF-8", file.display())
    })
}

/// Whether a file that a study file names is there.
fn looked_up(file: &Path) -> impl Fn(&str) -> Result<(), Problem> {
    let folder = file.parent().unwrap_or(Path::new(".")).to_owned();
    let data = std::env::var_os("MIMIQUE_DATA").map(PathBuf::from);
    move |path| {
        let found = resolve_path(path, &folder, data.as_deref())?;
        if mimique_stimulus::is_source(&found) {
            return Ok(());
        }
        Err(Problem::NoFile { path: found.display().to_string() })
    }
}

fn print(
    out: &mut impl std::io::Write,
    file: &Path,
    opened: &StudyFile,
    report: &Report,
) -> std::io::Result<()> {
    for issue in &report.issues {
        let severity = match issue.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let place = issue.place();
        let file = file.display();
        let message = opened.said(&issue.message());
        writeln!(out, "{severity}: {file}: {place}: {message}; {}", issue.remedy())?;
    }
    match &report.study {
        None => writeln!(
            out,
            "{}: {}, {}",
            file.display(),
            counted(report.errors(), "error"),
            counted(report.warnings(), "warning")
        ),
        Some(checked) => {
            let study = checked.study();
            writeln!(
                out,
                "{}: no errors, {}; {}, {} {}, configuration {}",
                file.display(),
                counted(report.warnings(), "warning"),
                counted(study.clips().len(), "clip"),
                if study.languages.len() == 1 { "language" } else { "languages" },
                study.languages.join(" "),
                checked.config_hash()
            )
        }
    }
}
