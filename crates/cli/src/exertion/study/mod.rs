//! `mimique exertion study`: a study file of faces that exert themselves, its stimuli computed from the
//! built-in body's motions; `frame.json` has its texts.

mod hypotheses;

use std::io::Write as _;

use anyhow::{anyhow, bail};
use mimique_exertion::{
    FRAMES_PER_SECOND, Heart, HeartModel, Person, PersonSpec, Plan, Series, Start,
};
use mimique_stimulus::{ExertionPart, MotionOptions, built_in_motion};
use mimique_study::{
    BuiltinMotion, Capture, Constraint, ExertionCapture, ExertionExpressivity, ExertionHeart,
    ExertionPerson, FactorValue, Factors, Segment, Severity, Study, check,
};
use serde_json::json;

use super::args::StudyOptions;
use super::values::NamedExpressivity;
use super::{blame, text_of};
use crate::output;

/// Texts, questions and head of the study.
const FRAME: &str = include_str!("frame.json");

/// One cell of the design.
struct Cell<'a> {
    activity: BuiltinMotion,
    level: f64,
    expressivity: &'a NamedExpressivity,
    model: &'a str,
    breath: Breath,
}

/// Whether the mouth moves with the breath.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Breath {
    /// It does
    With,
    /// It does not
    Without,
}

impl Breath {
    fn word(self) -> &'static str {
        match self {
            Self::With => "with",
            Self::Without => "without",
        }
    }
}

/// A motion of the built-in body by its name.
pub(super) fn activity(name: &str) -> Result<BuiltinMotion, String> {
    [BuiltinMotion::Walk, BuiltinMotion::Run, BuiltinMotion::Sprint]
        .into_iter()
        .find(|motion| motion.word() == name)
        .ok_or_else(|| "use walk, run or sprint".to_owned())
}

/// How long somebody keeps it up, seconds, where nothing is said.
fn usual_seconds(motion: BuiltinMotion) -> f64 {
    match motion {
        BuiltinMotion::Walk | BuiltinMotion::Run => 300.0,
        BuiltinMotion::Sprint => 60.0,
    }
}

/// Runs the command.
pub(super) fn run(args: &StudyOptions, json: bool) -> anyhow::Result<()> {
    refuse_repeated(args)?;
    let person = match &args.person {
        None => ExertionPerson::default(),
        Some(file) => serde_json::from_str(&text_of(file)?).map_err(|e| blame(file, e))?,
    };
    let mut study = Study::from_text(FRAME)?;
    let mut borg = Vec::new();
    let cells = cells(args);
    if cells.len() < 2 {
        bail!(
            "--levels: one clip alone, which nothing compares; give several levels, activities or expressivities"
        );
    }
    for cell in &cells {
        borg.push(add(&mut study, cell, &person, args)?);
    }
    if args.activities.len() > 1 {
        study.sequence.constraints = vec![Constraint {
            factor: "activity".to_owned(),
            at_most_alike: Some(2),
            minimum_distance: None,
        }];
    }
    study.hypotheses = hypotheses::of(args);
    let text = serde_json::to_string_pretty(&study)? + "\n";
    // Files that the study names are looked for when it is prepared.
    let report = check(&text, &|_| Ok(()));
    if let Some(issue) = report.issues.iter().find(|issue| issue.severity == Severity::Error) {
        bail!("{}: {}; {}", issue.pointer, issue.message(), issue.remedy());
    }
    output::write(&args.out, text.as_bytes())?;
    let [low, high] = [borg.iter().copied().fold(f64::INFINITY, f64::min), max(&borg)];
    let mut out = std::io::stdout().lock();
    if json {
        let told = json!({"file": args.out, "clips": borg.len(), "borg": [low, high]});
        writeln!(out, "{}", serde_json::to_string_pretty(&told)?)?;
    } else {
        writeln!(
            out,
            "{}: {} clips of {} s, exertion {low:.1} to {high:.1} of 6 to 20 at their ends",
            args.out.display(),
            borg.len(),
            args.clip.0
        )?;
    }
    Ok(())
}

fn max(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// Every combination, in the order of the options.
fn cells(args: &StudyOptions) -> Vec<Cell<'_>> {
    let mut cells = Vec::new();
    for &activity in &args.activities {
        for &level in &args.levels {
            for expressivity in &args.expressivities {
                for model in &args.models {
                    for &breath in &args.breaths {
                        cells.push(Cell { activity, level, expressivity, model, breath });
                    }
                }
            }
        }
    }
    cells
}

/// A value given twice would make a clip twice.
fn refuse_repeated(args: &StudyOptions) -> anyhow::Result<()> {
    fn repeated<T: PartialEq>(values: &[T]) -> Option<&T> {
        values.iter().enumerate().find(|(i, own)| values[..*i].contains(own)).map(|(_, own)| own)
    }
    if let Some(activity) = repeated(&args.activities) {
        bail!("--activities: {} is given twice; give it once", activity.word());
    }
    if let Some(level) = repeated(&args.levels) {
        bail!("--levels: {level} is given twice; give it once");
    }
    if let Some(model) = repeated(&args.models) {
        bail!("--models: {model} is given twice; give it once");
    }
    if let Some(breath) = repeated(&args.breaths) {
        bail!("--breaths: {} is given twice; give it once", breath.word());
    }
    let names: Vec<&str> = args.expressivities.iter().map(|own| &own.name[..]).collect();
    if let Some(name) = repeated(&names) {
        bail!("--expressivities: {name} is given twice; give it once");
    }
    Ok(())
}

/// Adds the clip of a cell; returns its exertion on the scale from 6 to 20 at the clip's end.
fn add(
    study: &mut Study,
    cell: &Cell<'_>,
    person: &ExertionPerson,
    args: &StudyOptions,
) -> anyhow::Result<f64> {
    let seconds = args.duration.map_or_else(|| usual_seconds(cell.activity), |own| own.0);
    let clip = args.clip.0;
    if clip > seconds {
        bail!("--clip: {clip} s of {seconds} s of {}; shorten it", cell.activity.word());
    }
    let name = &cell.expressivity.name;
    let own = exertion(cell, person, seconds, args);
    let borg = borg_at_end(&own, args)?;
    let mut id = format!("{}-level{}-{name}", cell.activity.word(), cell.level).replace('.', "_");
    // Factors of one value alone would explain nothing.
    let mut factors = Factors::new();
    if args.exertion_differs() {
        let rounded = FactorValue::Number((borg * 10.0).round() / 10.0);
        factors.insert("borg".to_owned(), rounded);
    }
    if args.activities.len() > 1 {
        let activity = cell.activity.word().to_owned();
        factors.insert("activity".to_owned(), FactorValue::Text(activity));
    }
    if args.levels.len() > 1 {
        factors.insert("level".to_owned(), FactorValue::Number(cell.level));
    }
    if args.expressivities.len() > 1 {
        factors.insert("expressivity".to_owned(), FactorValue::Text(name.clone()));
    }
    if args.models.len() > 1 {
        let number = args.models.iter().position(|own| own == cell.model).unwrap_or_default() + 1;
        id += &format!("-model{number}");
        factors.insert("model".to_owned(), FactorValue::Text(cell.model.to_owned()));
    }
    if args.breaths.len() > 1 {
        id += &format!("-{}", cell.breath.word());
        factors.insert("breath".to_owned(), FactorValue::Text(cell.breath.word().to_owned()));
    }
    let frame = |second: f64| (second * FRAMES_PER_SECOND).round() as usize;
    study.stimuli.segments.push(Segment {
        id: id.clone(),
        capture: id.clone(),
        first: Some(frame(seconds - clip)),
        end: Some(frame(seconds)),
        performance: None,
        sound: None,
        factors,
    });
    let capture = Capture { exertion: Some(own), ..Capture::default() };
    study.stimuli.captures.insert(id, capture);
    Ok(borg)
}

/// The exertion of a cell, in the study file's words.
fn exertion(
    cell: &Cell<'_>,
    person: &ExertionPerson,
    seconds: f64,
    args: &StudyOptions,
) -> ExertionCapture {
    // What a person's own face does strongly is kept: the factors of the design multiply it.
    let given = person.expressivity.clone().unwrap_or_default();
    let factors = cell.expressivity.factors;
    let scaled = |own: Option<f64>, factor: f64| Some(own.unwrap_or(1.0) * factor);
    let expressivity = ExertionExpressivity {
        mouth_open: scaled(given.mouth_open, factors.mouth_open),
        mouth_exhale: scaled(given.mouth_exhale, factors.mouth_exhale),
        mouth_stretch: scaled(given.mouth_stretch, factors.mouth_stretch),
        eyes: scaled(given.eyes, factors.eyes),
        brows: scaled(given.brows, factors.brows),
    };
    ExertionCapture {
        builtin: Some(cell.activity),
        motion: None,
        activity: None,
        plan: vec![],
        seconds: Some(seconds),
        joints: None,
        motion_rate_hz: None,
        motion_unit: None,
        person: ExertionPerson {
            level: Some(cell.level),
            expressivity: Some(expressivity),
            ..person.clone()
        },
        heart: Some(ExertionHeart::Thesis),
        model: cell.model.to_owned(),
        breath: cell.breath == Breath::With,
        skin: args.skin,
        seed: None,
    }
}

/// How hard the body works at the end, from 6 to 20.
fn borg_at_end(own: &ExertionCapture, args: &StudyOptions) -> anyhow::Result<f64> {
    let spec = PersonSpec::of_json(&serde_json::to_value(&own.person)?);
    let person = spec.and_then(Person::new).map_err(|error| {
        match (error.place().split('/').next().unwrap_or_default(), &args.person) {
            ("level", _) => anyhow!("--levels: {error}"),
            ("expressivity", _) => anyhow!("--expressivities: {error}"),
            (_, Some(file)) => blame(file, &error),
            (_, None) => anyhow!("{error}"),
        }
    })?;
    let motion = built_in_motion(own.builtin.unwrap_or(BuiltinMotion::Walk));
    let part = ExertionPart::motion(&motion, own.seconds, &person, &MotionOptions::default());
    let plan = Plan::of(part?.part).map_err(|error| anyhow!("--for: {error}"))?;
    let heart = Heart::Law(HeartModel::Thesis);
    let series = Series::of(&person, &plan, heart, Start::default())
        .map_err(|error| anyhow!("--for: {error}"))?;
    Ok(series.metabolism.borg.last().copied().unwrap_or(6.0))
}
