//! `mimique trajectories`: random courses of action units for dynamic reverse correlation, as recorded weights that any
//! avatar plays, or with the answers of simulated people.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::{anyhow, bail};
use mimique_adaptive::{Trajectory, TrajectoryDesign, weights_of_units};
use mimique_analysis::{Template, TemplatePart, TemplatePeople};
use mimique_avatar::{ARKIT_SHAPES, ActionUnit};
use mimique_mocap::WeightsTable;
use mimique_stats::Stream;

use crate::output;

/// Frames per second at most: no screen shows more.
const MOST_HZ: f64 = 1000.0;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Folder that the files go to; made if it is not there
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
    /// Action units to draw from, such as AU04,AU12,AU12_L [default: all that ARKit's shapes have]
    #[arg(long, value_name = "UNITS", value_delimiter = ',')]
    units: Vec<String>,
    /// How many people, each with trials of their own
    #[arg(long, value_name = "NUMBER", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=999))]
    people: u32,
    /// Trials of each
    #[arg(long, value_name = "NUMBER", default_value_t = 240, value_parser = clap::value_parser!(u32).range(1..=9999))]
    trials: u32,
    /// Units of a trial on average [default: 3, or all of fewer]
    #[arg(long, value_name = "NUMBER")]
    mean: Option<f64>,
    /// Units of a trial at most [default: 6, or all of fewer]
    #[arg(long, value_name = "NUMBER")]
    most: Option<usize>,
    /// Seconds of a trial
    #[arg(long, value_name = "SECONDS", default_value_t = 1.25)]
    duration: f64,
    /// Frames per second
    #[arg(long, value_name = "HZ", default_value_t = 60.0)]
    rate: f64,
    /// Simulated people who have this face in mind: joy=AU06+AU12, or with times surprise=AU01@0.35+AU26@0.35;
    /// may be given several times. Their answers are written in the place of weights
    #[arg(long, value_name = "CATEGORY=UNITS")]
    template: Vec<String>,
    /// Standard deviation of the simulated people's noise, where a template that is met whole speaks with 1
    #[arg(long, value_name = "NUMBER", default_value_t = 0.15, requires = "template")]
    noise: f64,
    /// What must speak for a category at least; "other" is answered below it
    #[arg(long, value_name = "NUMBER", default_value_t = 0.2, requires = "template")]
    criterion: f64,
    /// Seed: the same seed, the same trials; more of them begin with the same ones
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,
}

/// The trials of one person.
struct Trials {
    /// `p01`.
    name: String,
    shown: Vec<Vec<Trajectory>>,
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let units = units(&args.units)?;
    let design = design(&args, units.len())?;
    let people = people(&args, &units)?;
    let trials = (0..args.people).map(|person| drawn(&args, &design, person));
    let trials = trials.collect::<anyhow::Result<Vec<Trials>>>()?;
    let mut files = vec![(
        "trajectories.csv".to_owned(),
        courses_csv(&trials, &units, people.as_ref())?,
        "a row for each unit of each trial",
    )];
    if people.is_none() {
        files.extend(stimuli(&args, &design, &trials, &units)?);
    }
    output::make_folder(&args.out)?;
    output::write_all(&args.out, &files, json)?;
    if json {
        let text = serde_json::json!({
            "files": files.iter().map(|(name, ..)| args.out.join(name)).collect::<Vec<_>>(),
            "units": units.iter().map(|unit| &unit.name).collect::<Vec<_>>(),
            "people": args.people,
            "trials": args.trials,
            "frames": design.frames(args.rate),
            "rate_hz": args.rate,
            "duration_s": args.duration,
            "seed": args.seed,
        });
        writeln!(std::io::stdout(), "{}", serde_json::to_string_pretty(&text)?)?;
    }
    Ok(())
}

/// An intensity from 0 to 1 on a scale of 1 to 5.
fn of_five(intensity: f64) -> u8 {
    (1.0 + 4.0 * intensity).round() as u8
}

/// The units that are named, or all.
fn units(named: &[String]) -> anyhow::Result<Vec<ActionUnit>> {
    if named.is_empty() {
        return Ok(ActionUnit::of_avatar(&ARKIT_SHAPES));
    }
    let mut units: Vec<ActionUnit> = Vec::new();
    for name in named {
        let Some(unit) = ActionUnit::of(name, &ARKIT_SHAPES) else {
            let all = ActionUnit::of_avatar(&ARKIT_SHAPES);
            let all: Vec<&str> = all.iter().map(|unit| unit.name.as_str()).collect();
            bail!(
                "--units: ARKit's shapes have no \"{name}\"; they have {}, of one side as in AU12_L",
                all.join(", ")
            );
        };
        if let Some(same) = units.iter().find(|known| known.shapes == unit.shapes) {
            bail!("--units: \"{name}\" is the same as \"{}\"; name one of them", same.name);
        }
        units.push(unit);
    }
    Ok(units)
}

fn design(args: &Args, units: usize) -> anyhow::Result<TrajectoryDesign> {
    let usual = TrajectoryDesign::of_units(units);
    let most_units = args.most.unwrap_or(usual.most_units);
    let design = TrajectoryDesign {
        duration_s: args.duration,
        mean_units: args.mean.unwrap_or(usual.mean_units.min(most_units as f64)),
        most_units,
        ..usual
    };
    design.check().map_err(|error| anyhow!("--units, --mean, --most, --duration: {error}"))?;
    if !(args.rate >= 1.0 && args.rate <= MOST_HZ) {
        bail!("--rate: {} Hz; give frames per second from 1 to {MOST_HZ}", args.rate);
    }
    Ok(design)
}

/// The simulated people; none without templates.
fn people(args: &Args, units: &[ActionUnit]) -> anyhow::Result<Option<TemplatePeople>> {
    if args.template.is_empty() {
        return Ok(None);
    }
    let mut templates: Vec<Template> = Vec::new();
    for given in &args.template {
        let template = template(given, units, args.duration)?;
        if templates.iter().any(|known| known.category == template.category) {
            bail!("--template {given}: \"{}\" has two templates; give one", template.category);
        }
        templates.push(template);
    }
    for (option, value) in [("noise", args.noise), ("criterion", args.criterion)] {
        if !(value >= 0.0 && value.is_finite()) {
            bail!("--{option}: {value}; give a number from 0");
        }
    }
    let (noise, criterion) = (args.noise, args.criterion);
    let otherwise = Some("other".to_owned());
    Ok(Some(TemplatePeople { templates, noise, criterion, otherwise, seed: args.seed }))
}

/// `joy=AU06+AU12`, `surprise=AU01@0.35+AU26@0.35`.
fn template(given: &str, units: &[ActionUnit], duration_s: f64) -> anyhow::Result<Template> {
    let form = "give it as in joy=AU06+AU12, or with times in seconds as in joy=AU12@0.9";
    let (category, parts) = given
        .split_once('=')
        .filter(|(category, _)| !category.trim().is_empty())
        .ok_or_else(|| anyhow!("--template {given}: no category; {form}"))?;
    let part = |part: &str| {
        let (name, time) = match part.split_once('@') {
            Some((name, time)) => (name, Some(time)),
            None => (part, None),
        };
        let unit = units.iter().position(|unit| unit.name == name.trim()).ok_or_else(|| {
            anyhow!("--template {given}: \"{name}\" is not among the units that are drawn; {form}")
        })?;
        let within = |time: &&str| {
            let seconds = time.trim().parse::<f64>().ok();
            seconds.filter(|seconds| (0.0..=duration_s).contains(seconds))
        };
        let at_s = time
            .map(|time| {
                within(&time).ok_or_else(|| {
                    anyhow!(
                        "--template {given}: \"{time}\" is no time from 0 to {duration_s} s; {form}"
                    )
                })
            })
            .transpose()?;
        Ok(TemplatePart { unit, at_s })
    };
    let parts = parts.split('+').map(part).collect::<anyhow::Result<Vec<_>>>()?;
    Ok(Template { category: category.trim().to_owned(), parts })
}

/// Each trial has a stream of its own.
fn drawn(args: &Args, design: &TrajectoryDesign, person: u32) -> anyhow::Result<Trials> {
    let one = |trial: u32| {
        let mut stream = Stream::new(args.seed, u64::from(person) << 32 | u64::from(trial));
        Ok(design.draw(&mut || stream.unit())?)
    };
    let shown = (0..args.trials).map(one).collect::<anyhow::Result<_>>()?;
    Ok(Trials { name: format!("p{:02}", person + 1), shown })
}

/// Weights of each person's trials, and what a study file says of them.
fn stimuli(
    args: &Args,
    design: &TrajectoryDesign,
    trials: &[Trials],
    units: &[ActionUnit],
) -> anyhow::Result<Vec<(String, Vec<u8>, &'static str)>> {
    let frames = design.frames(args.rate);
    let (mut files, mut segments) = (Vec::new(), Vec::new());
    let mut captures = serde_json::Map::new();
    for Trials { name, shown } in trials {
        let mut weights = Vec::new();
        for (trial, courses) in shown.iter().enumerate() {
            let activations = design.activations(courses, args.rate);
            weights.extend(weights_of_units(units, &activations, ARKIT_SHAPES.len()));
            segments.push(serde_json::json!({
                "id": format!("{name}t{:04}", trial + 1),
                "capture": name,
                "first": trial * frames,
                "end": (trial + 1) * frames,
            }));
        }
        let shapes = ARKIT_SHAPES.map(str::to_owned).to_vec();
        let table = WeightsTable::at_rate(shapes, weights, 0, args.rate);
        let file = format!("weights-{name}.csv");
        captures.insert(name.clone(), serde_json::json!({ "file": file }));
        let what = "the trials one after the other, as recorded weights of ARKit's shapes";
        files.push((file, table.to_csv().into_bytes(), what));
    }
    let stimuli = serde_json::json!({ "captures": captures, "segments": segments });
    files.push((
        "stimuli.json".to_owned(),
        serde_json::to_vec_pretty(&stimuli)?,
        "captures and segments of a study file",
    ));
    Ok(files)
}

fn courses_csv(
    trials: &[Trials],
    units: &[ActionUnit],
    people: Option<&TemplatePeople>,
) -> anyhow::Result<Vec<u8>> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    let head = ["participant", "trial", "unit", "onset_s", "peak_s", "offset_s"];
    let head = head.into_iter().chain(["amplitude", "acceleration", "deceleration"]);
    let answered: &[&str] = if people.is_some() { &["answer", "intensity"] } else { &[] };
    csv.write_record(head.chain(answered.iter().copied()))?;
    for (person, Trials { name, shown }) in trials.iter().enumerate() {
        let answers = people.map(|people| people.answers(person as u64 + 1, shown));
        for (trial, courses) in shown.iter().enumerate() {
            let answer = answers.as_ref().map(|answers| answers[trial]);
            let answer = answer
                .into_iter()
                .flat_map(|(answer, sum)| [answer.to_owned(), of_five(sum).to_string()]);
            let answer: Vec<String> = answer.collect();
            for course in courses {
                let labels =
                    [name.clone(), (trial + 1).to_string(), units[course.unit].name.clone()];
                let numbers = [
                    course.onset_s,
                    course.peak_s,
                    course.offset_s,
                    course.amplitude,
                    course.acceleration,
                    course.deceleration,
                ];
                let numbers = numbers.map(|number| number.to_string());
                let row = labels.into_iter().chain(numbers).chain(answer.iter().cloned());
                csv.write_record(row)?;
            }
        }
    }
    csv.into_inner().map_err(|error| anyhow!("trajectories.csv: {error}"))
}
