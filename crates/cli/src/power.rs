//! `mimique power STUDY`: the study's own analysis over simulated answers, against the number of people
//! and clips; the curve, the tables, and a preregistration written from the study file.

use std::io::{IsTerminal, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::Context as _;
use indicatif::{ProgressBar, ProgressStyle};
use mimique_analysis::{
    Power, PowerOptions, Preregistration, as_predicted, in_scope, no_effect, power, power_csv,
    power_curve, power_markdown, power_runs, precision_csv, precision_markdown, preregistration,
    smallest_cell,
};
use mimique_locale::Language;

use crate::output;
use crate::simulate::Assumptions;
use crate::study_file::load;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Study file (JSON, comments allowed)
    study: PathBuf,
    /// Numbers of people who arrive
    #[arg(long, short = 'n', value_delimiter = ',', default_values_t = [10, 20, 40, 80])]
    participants: Vec<usize>,
    /// Numbers of clips: segments are repeated or left out, whole; the study's own if not given
    #[arg(long, value_delimiter = ',')]
    clips: Vec<usize>,
    /// Simulated studies a point [default: 500, with --mixed 200]
    #[arg(long)]
    runs: Option<usize>,
    /// Fit the linear mixed model of other clips in each of them also where it does not decide
    #[arg(long)]
    mixed: bool,
    /// Seed of all simulations
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// A test is positive below this p
    #[arg(long, default_value_t = 0.05)]
    alpha: f64,
    #[command(flatten)]
    assumptions: Assumptions,
    /// Leave out the false positives, which take as many runs again
    #[arg(long)]
    no_false_positives: bool,
    /// Folder for power.csv, power.json, power.md and power.svg, and precision.csv where blocks tell thresholds, scales or faces in mind
    #[arg(long)]
    out: Option<PathBuf>,
    /// Write a preregistration to this file (markdown), its curve beside it
    #[arg(long)]
    preregistration: Option<PathBuf>,
    /// Form of the preregistration: osf, or aspredicted, whose questions are answered in English
    #[arg(long, value_name = "FORM", default_value = "osf", requires = "preregistration")]
    form: Form,
    /// Language of tables, curve and preregistration: en or fr
    #[arg(long, default_value = "en", value_parser = language)]
    language: Language,
}

/// Form of a preregistration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Form {
    /// The OSF's
    Osf,
    /// AsPredicted's
    Aspredicted,
}

fn language(code: &str) -> Result<Language, String> {
    Language::from_code(code).ok_or_else(|| "power is written in en or fr".to_owned())
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let (file, study) = load(&args.study)?;
    let place = || args.study.display().to_string();
    let config_hash = mimique_study::config_hash(&file);
    let parameters = args.assumptions.read(&study)?;
    let options = power_options(&args);
    let bar = progress_bar(power_runs(&study, &options));
    let result = power(&study, &config_hash, &parameters, &options, &|| bar.inc(1));
    bar.finish_and_clear();
    let power = result.with_context(place)?;
    let language = args.language;
    let mut written = Vec::new();
    let mut write = |path: PathBuf, text: String| -> anyhow::Result<()> {
        write_with_folder(&path, &text)?;
        written.push(path.display().to_string());
        Ok(())
    };
    let curve = power_curve(&power, language);
    if let Some(out) = &args.out {
        let json = serde_json::json!({"parameters": parameters, "config_hash": config_hash, "power": power});
        write(out.join("power.csv"), power_csv(&power))?;
        write(out.join("power.json"), format!("{}\n", serde_json::to_string_pretty(&json)?))?;
        write(out.join("power.md"), power_markdown(&power, language))?;
        if !power.precision.is_empty() {
            write(out.join("precision.csv"), precision_csv(&power))?;
        }
        if !power.points.is_empty() {
            write(out.join("power.svg"), curve.clone())?;
        }
    }
    if let Some(path) = &args.preregistration {
        let figure = path.with_extension("svg");
        let name = figure.file_name().map(|name| name.to_string_lossy().into_owned());
        let from = Preregistration {
            study: &study,
            config_hash: &config_hash,
            power: &power,
            parameters: &parameters,
            language,
            // Without a hypothesis nothing is drawn.
            curve: name.as_deref().filter(|_| !power.points.is_empty()),
        };
        let text = match args.form {
            Form::Osf => preregistration(&from),
            Form::Aspredicted => as_predicted(&from),
        };
        write(path.clone(), text)?;
        if !power.points.is_empty() {
            write(figure, curve)?;
        }
    }
    let mut out = std::io::stdout().lock();
    if json {
        let all = serde_json::json!({"config_hash": config_hash, "power": power, "files": written});
        writeln!(out, "{all:#}")?;
        return Ok(());
    }
    print(&mut out, &power)?;
    if !power.precision.is_empty() {
        write!(out, "\n{}", precision_markdown(&power, Language::English).trim_end())?;
        writeln!(out)?;
    }
    if args.assumptions.is_default() {
        writeln!(
            out,
            "\nEffects, spreads and dropout are the study's defaults; `mimique simulate` writes them into \
             parameters.json, `--parameters` takes your own."
        )?;
    }
    for path in &written {
        writeln!(out, "  {path}")?;
    }
    Ok(())
}

/// What is simulated: every number of people and of clips once, in ascending order.
fn power_options(args: &Args) -> PowerOptions {
    let ascending = |numbers: &[usize]| {
        let mut numbers = numbers.to_vec();
        numbers.sort_unstable();
        numbers.dedup();
        numbers
    };
    PowerOptions {
        participants: ascending(&args.participants),
        clips: ascending(&args.clips),
        runs: args.runs.unwrap_or(if args.mixed { 200 } else { 500 }),
        mixed: args.mixed,
        seed: args.seed,
        alpha: args.alpha,
        false_positives: !args.no_false_positives,
    }
}

/// Writes a file, and makes its folder where it is not there.
fn write_with_folder(path: &Path, text: &str) -> anyhow::Result<()> {
    if let Some(parent) = path.parent().filter(|parent| !parent.as_os_str().is_empty()) {
        std::fs::create_dir_all(parent)
            .map_err(|error| anyhow::anyhow!("no folder can be made ({error})"))
            .with_context(|| parent.display().to_string())?;
    }
    output::write(path, text.as_bytes())
}

/// A bar on stderr, where somebody looks at it.
fn progress_bar(runs: u64) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(runs);
    let style = "{bar:40} {human_pos} of {human_len} studies, {per_sec}, {eta} left";
    if let Ok(style) = ProgressStyle::with_template(style) {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

fn print(out: &mut impl std::io::Write, power: &Power) -> std::io::Result<()> {
    writeln!(
        out,
        "{}: {} simulated studies a point, alpha {}, seed {}; in brackets Wilson's 95 % interval",
        power.study, power.runs, power.alpha, power.seed
    )?;
    let ids = power.points.first().map_or(0, |point| point.hypotheses.len());
    for place in 0..ids {
        let first = &power.points[0].hypotheses[place];
        writeln!(out, "\n{}{}", first.id, in_scope(first.scope, Language::English))?;
        if !power.points[0].hypotheses[place].effect {
            writeln!(out, "{}", no_effect(Language::English))?;
        }
        let falsely = power.points[0].hypotheses[place].false_positives.is_some();
        write!(
            out,
            "{:>7} {:>6}  {:<22} {:<22}",
            "people",
            "clips",
            if ids > 1 { "power, corrected" } else { "power" },
            "as in the thesis"
        )?;
        writeln!(out, "{}", if falsely { " false positives        as in the thesis" } else { "" })?;
        for point in &power.points {
            let hypothesis = &point.hypotheses[place];
            let cell = |rate: &mimique_analysis::Rate| {
                let [low, high] = rate.interval.map(|share| 100.0 * share);
                format!("{:5.1} % [{low:.1}, {high:.1}]", 100.0 * rate.share)
            };
            let columns = &hypothesis.power;
            write!(
                out,
                "{:>7} {:>6}  {:<22} {:<22}",
                point.participants,
                point.clips,
                cell(&columns.deciding_holm),
                cell(&columns.as_in_the_thesis)
            )?;
            if let Some(columns) = &hypothesis.false_positives {
                let (people, trials) = (cell(&columns.deciding), cell(&columns.as_in_the_thesis));
                write!(out, " {people:<22} {trials}")?;
            }
            writeln!(out)?;
        }
        of_clips(out, power, place)?;
        smallest_differences(out, power, place)?;
    }
    Ok(())
}

/// For each number of people the smallest difference that the deciding test detects.
fn smallest_differences(
    out: &mut impl std::io::Write,
    power: &Power,
    place: usize,
) -> std::io::Result<()> {
    let smallest = |point: &mimique_analysis::PowerPoint| {
        let own = point.hypotheses[place].smallest_difference?;
        let of = smallest_cell(Language::English, own);
        Some(format!("{of} ({} people, {} clips)", point.participants, point.clips))
    };
    let all: Vec<String> = power.points.iter().filter_map(smallest).collect();
    if all.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "smallest difference between two levels detected with 80 %, uncorrected: {}",
        all.join(", ")
    )
}

/// People x segments, of other clips too, where a hypothesis compares ratings within people.
fn of_clips(out: &mut impl std::io::Write, power: &Power, place: usize) -> std::io::Result<()> {
    let own = |point: &mimique_analysis::PowerPoint| point.hypotheses[place].power;
    if power.points.iter().all(|point| own(point).min_f.is_none()) {
        return Ok(());
    }
    let mixed = power.points.iter().any(|point| own(point).mixed.is_some());
    let falsely =
        power.points.iter().any(|point| point.hypotheses[place].false_positives.is_some());
    let name = if mixed { "linear mixed model" } else { "" };
    write!(
        out,
        "for other clips\n{:>7} {:>8}  {:<22} {name:<22}",
        "people", "segments", "power, min F'"
    )?;
    writeln!(
        out,
        " {}",
        if falsely { format!("false positives        {name}") } else { String::new() }
    )?;
    for point in &power.points {
        write!(out, "{:>7} {:>8} ", point.participants, point.segments)?;
        for columns in
            [Some(own(point)), point.hypotheses[place].false_positives].into_iter().flatten()
        {
            for rate in [columns.min_f, columns.mixed] {
                let text = rate.map_or_else(String::new, |rate| {
                    let [low, high] = rate.interval.map(|share| 100.0 * share);
                    format!("{:5.1} % [{low:.1}, {high:.1}]", 100.0 * rate.share)
                });
                write!(out, " {text:<22}")?;
            }
        }
        writeln!(out)?;
    }
    Ok(())
}
