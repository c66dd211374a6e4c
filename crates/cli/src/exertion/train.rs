//! `mimique exertion train`: a model from recorded bodies, hearts and faces.

use std::io::Write as _;
use std::path::Path;

use anyhow::{anyhow, bail};
use mimique_exertion::{Feature, Person, Plan, RecordedHeart, ShapeTable};
use mimique_exertion_training::{Grid, Lesson, LessonTake, train};
use mimique_locale::{counted, counted_as};
use mimique_mocap::{ActivityColumn, WeightOptions, read_activity};
use mimique_stimulus::read_performance;
use serde_json::json;

use super::args::TrainOptions;
use super::inputs::{is_none, part};
use super::{blame, text_of, values};
use crate::output;

/// Runs the command.
pub(super) fn run(args: &TrainOptions, json: bool) -> anyhow::Result<()> {
    let shapes = match &args.shapes {
        None => ShapeTable::default(),
        Some(file) => ShapeTable::of_text(&text_of(file)?).map_err(|e| blame(file, e))?,
    };
    let features: Vec<Feature> = args
        .features
        .iter()
        .map(|name| Feature::by_name("--features", name).map_err(|e| anyhow!("{e}")))
        .collect::<anyhow::Result<_>>()?;
    for (place, feature) in features.iter().enumerate() {
        if features[..place].contains(feature) {
            bail!("--features: {} is given twice; give it once", feature.name());
        }
    }
    let takes = takes(args)?;
    let lesson = Lesson::of(&takes, &features, &shapes, args.every)?;
    let grid = Grid { c: args.c.0, gamma: args.gamma.0, epsilon: args.epsilon, folds: args.folds };
    let mut out = std::io::stdout().lock();
    if !json {
        let people = counted_as(lesson.people.len(), "person", "people");
        writeln!(out, "{} of {people}", counted(lesson.rows.len(), "row"))?;
    }
    let mut unwritten = None;
    let trained = train(&lesson, &grid, &mut |curve| {
        if json || unwritten.is_some() {
            return;
        }
        let people: String =
            curve.rmse_of_people.iter().map(|rmse| format!(" {rmse:.1}")).collect();
        let of_people =
            if people.is_empty() { String::new() } else { format!("; of people{people}") };
        unwritten = writeln!(
            out,
            "{:<13} C 10^{}, gamma 10^{}, {} vectors, RMSE {:.1} %{of_people}",
            curve.name, curve.best.c, curve.best.gamma, curve.vectors, curve.rmse
        )
        .and_then(|()| out.flush())
        .err();
    })?;
    if let Some(error) = unwritten {
        return Err(error.into());
    }
    let text = serde_json::to_string(&trained.file)? + "\n";
    output::write(&args.out, text.as_bytes())?;
    if json {
        let told = json!({"out": args.out, "training": trained.file["training"]});
        writeln!(out, "{}", serde_json::to_string_pretty(&told)?)?;
    } else {
        writeln!(out, "{}: {} bytes", args.out.display(), text.len())?;
    }
    Ok(())
}

/// The recordings.
fn takes(args: &TrainOptions) -> anyhow::Result<Vec<LessonTake>> {
    let count = args.take.len();
    for (option, found) in
        [("--heart-rate", args.heart_rate.len()), ("--weights", args.weights.len())]
    {
        if found != count {
            bail!(
                "{option}: {found} files for {count} takes; give one for each, in the same order"
            );
        }
    }
    if !(args.person.len() <= 1 || args.person.len() == count) {
        bail!(
            "--person: {} files for {count} takes; give one for each, or one for all",
            args.person.len()
        );
    }
    (0..count).map(|place| take(args, place)).collect()
}

fn take(args: &TrainOptions, place: usize) -> anyhow::Result<LessonTake> {
    let file = args.person.get(place).or(args.person.first());
    let person = values::person_of(file.map(std::path::PathBuf::as_path))?;
    let who = file.map_or("somebody".to_owned(), |file| {
        file.file_stem().unwrap_or_default().to_string_lossy().into_owned()
    });
    let mut own = part(&args.take[place], None, &person, &args.motion)?.part;
    let heart = &args.heart_rate[place];
    if !is_none(heart) {
        own.rcn = Some(heart_of(heart, &person)?);
        let recorded = own.rcn.as_ref().map_or(0, |rcn| rcn.len() - 1) as f64;
        // Behind the last heartbeat nothing is known of the body.
        own.seconds = own.seconds.min(recorded);
        if own.seconds <= 0.0 {
            bail!("{}: less than a second was recorded; give a longer recording", heart.display());
        }
    }
    let plan = Plan::of(own).map_err(|e| blame(&args.take[place], e))?;
    let file = &args.weights[place];
    let read = read_performance(file, &WeightOptions::default());
    let weights = read.map_err(|e| blame(file, e))?.table;
    if weights.rate_hz().is_none() {
        bail!("{}: column time: no rate; write the seconds of every frame", file.display());
    }
    Ok(LessonTake { who, person, plan, weights })
}

/// The share of the heart's reserve at whole seconds.
fn heart_of(file: &Path, person: &Person) -> anyhow::Result<Vec<f64>> {
    let activity = read_activity(file).map_err(|e| blame(file, e))?;
    let Some(rates) = activity.column(ActivityColumn::HeartRate) else {
        bail!("{}: no heart rate; give a file with one, or \"none\"", file.display());
    };
    let seen: Vec<usize> = (0..rates.len()).filter(|&i| !rates[i].is_nan()).collect();
    let of = |values: &[f64]| -> Vec<f64> { seen.iter().map(|&i| values[i]).collect() };
    // It begins with the file, whose first samples may lack it.
    let (mut time, mut rate) = (of(&activity.time_s), of(rates));
    if let (Some(&first), Some(&own)) = (time.first(), rate.first())
        && first > 0.0
    {
        time.insert(0, 0.0);
        rate.insert(0, own);
    }
    let heart = RecordedHeart::of(person, &time, &rate).map_err(|e| blame(file, e))?;
    Ok(heart.rcn)
}
