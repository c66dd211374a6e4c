//! `mimique test reverse-correlation`.

use mimique_locale::format_number;

use super::{
    CategoryImages, GroupImage, ReverseCorrelation, ReverseCorrelationOptions, ReverseTrials,
    UnitImage, reverse_correlation,
};
use crate::numerics::largest::{FEWEST_PERMUTATIONS, LEVEL};
use crate::outcome::Outcome;
use crate::procedure::arguments::{Arguments, ProcedureOption, SEED};
use crate::procedure::lines::{self, Lines};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::table::Table;

const DEFAULT_BINS: u64 = 30;
const DEFAULT_PERMUTATIONS: u64 = 1000;
/// More bins than any clip has frames.
const MOST_BINS: f64 = 1000.0;

/// `mimique test reverse-correlation`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "reverse-correlation",
    question: "Which action units at which times make people answer so? Classification images of random courses",
    options: &[&[
        ProcedureOption::text("participant", "Column of the people").required(),
        ProcedureOption::text("trial", "Column that numbers each person's trials").required(),
        ProcedureOption::text("answer", "Column of what was answered").required(),
        ProcedureOption::text("unit", "Column of the action units, a row each").required(),
        ProcedureOption::text("onset", "Column of onsets, seconds").required(),
        ProcedureOption::text("peak", "Column of the peaks' times, seconds").required(),
        ProcedureOption::text("offset", "Column of offsets, seconds").required(),
        ProcedureOption::text("amplitude", "Column of peak amplitudes, above 0 to 1").required(),
        ProcedureOption::text(
            "acceleration",
            "Column of the share of the rise at half the height [default: one half]",
        )
        .requires(&["deceleration"]),
        ProcedureOption::text("deceleration", "The same of the fall").requires(&["acceleration"]),
        ProcedureOption::text("intensity", "Column of how intense it was said to be"),
        ProcedureOption::text("duration", "Seconds of a clip [default: the latest offset]"),
        ProcedureOption::text("bins", "Time bins of the clip [default: 30]"),
        ProcedureOption::text("permutations", "Draws of the test, at least 19 [default: 1000]"),
        SEED,
    ]],
    run,
    sample: Sample::Other,
    r: r#"
# Each person who answered with a category in some trials and not in all: the answers, the cells less their means, and
# what makes sums of them z; 0 where a cell does not vary.
of_each_person <- function(who, cells, said) {
  of_person <- function(own) {
    answers <- as.numeric(said[own])
    n <- length(answers)
    k <- sum(answers)
    if (k == 0 || k == n) return(NULL)
    x <- cells[own, , drop = FALSE]
    centred <- sweep(x, 2, colMeans(x))
    squares <- colSums(centred^2)
    varies <- squares > 1e-12 * colSums(x^2)
    list(answers = answers, centred = centred, share = n / (k * (n - k)),
         scale = ifelse(varies, sqrt(n * (n - 1) / (k * (n - k)) / squares), 0))
  }
  Filter(Negate(is.null), lapply(split(seq_along(said), who), of_person))
}
# How many people have a z of each cell, as a root.
pooling <- function(people) sqrt(pmax(Reduce(`+`, lapply(people, function(own) own$scale > 0)), 1))
# Classification images: `cells` has a row per trial; `said` tells the trials that were answered with the category.
# Difference and z of each cell over people.
classification_image <- function(who, cells, said) {
  people <- of_each_person(who, cells, said)
  over <- function(each) Reduce(`+`, lapply(people, function(own) drop(own$answers %*% own$centred) * own[[each]]))
  list(difference = over("share") / length(people), z = over("scale") / pooling(people))
}
# The p of these z, corrected over all cells: each person's answers dealt anew over that person's trials, 1000 times.
classification_p <- function(who, cells, said, draws = 1000) {
  people <- of_each_person(who, cells, said)
  dealt <- function(own) sweep(t(replicate(draws, sample(own$answers))) %*% own$centred, 2, own$scale, `*`)
  total <- sweep(Reduce(`+`, lapply(people, dealt)), 2, pooling(people), `/`)
  largest <- apply(abs(total), 1, max)
  z <- abs(classification_image(who, cells, said)$z)
  list(p = vapply(z, function(one) (1 + sum(largest >= one - 1e-9)) / (1 + draws), 0))
}
"#,
    python: r#"
def of_each_person(who, cells, said):
    """Of each person who answered so in some trials and not in all: the answers, the cells less their means, and what
    makes sums of them z; 0 where a cell does not vary."""
    for one in np.unique(who):
        own = who == one
        answers, x = said[own], cells[own]
        n, k = len(answers), answers.sum()
        if 0 < k < n:
            centred = x - x.mean(axis=0)
            squares = (centred**2).sum(axis=0)
            varies = squares > 1e-12 * (x**2).sum(axis=0)
            scale = np.sqrt(n * (n - 1) / (k * (n - k)) / np.where(varies, squares, 1.0)) * varies
            yield answers.astype(float), centred, scale


def classification_image(who, cells, said):
    """Classification images: `cells` has a row per trial; `said` tells the trials answered with the category. Difference
    and z of each cell over people who answered so in some of their trials and not in all."""
    people = list(of_each_person(who, cells, said))
    sums = [answers @ centred for answers, centred, _ in people]
    shares = [len(answers) / (answers.sum() * (len(answers) - answers.sum())) for answers, _, _ in people]
    difference = sum(own * share for own, share in zip(sums, shares)) / len(people)
    z = sum(own * scale for own, (_, _, scale) in zip(sums, people))
    return dict(difference=difference, z=z / np.sqrt(np.maximum(sum(scale > 0 for _, _, scale in people), 1)))


def classification_p(who, cells, said, draws=1000):
    """The p of these z, corrected over all cells: each person's answers dealt anew over that person's trials, 1000
    times."""
    random = np.random.default_rng(1)
    total, found = 0.0, 0
    for answers, centred, scale in of_each_person(who, cells, said):
        dealt = random.permuted(np.tile(answers, (draws, 1)), axis=1)
        total, found = total + dealt @ centred * scale, found + (scale > 0)
    largest = np.abs(total / np.sqrt(np.maximum(found, 1))).max(axis=1)
    z = np.abs(classification_image(who, cells, said)["z"])
    return dict(p=[(1 + (largest >= one - 1e-9).sum()) / (1 + draws) for one in z])
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let factor = |option: &str| arguments.factor(table, option);
    let numbers = |option: &str| arguments.numbers(table, option);
    let given = |option: &str| arguments.has(option).then(|| numbers(option)).transpose();
    let labels = [factor("participant")?, factor("trial")?, factor("answer")?, factor("unit")?];
    let courses = [numbers("onset")?, numbers("peak")?, numbers("offset")?, numbers("amplitude")?];
    let bends = given("acceleration")?.zip(given("deceleration")?);
    let intensity = given("intensity")?;
    let trials = ReverseTrials::of(
        labels.each_ref(),
        courses.each_ref(),
        bends.as_ref().map(|(rise, fall)| [rise, fall]),
        intensity.as_ref(),
    )?;
    let within = |option, least, most, default| -> Result<usize, Refusal> {
        let whole = arguments.whole(option, default)?;
        arguments.real(option, [least, most])?;
        Ok(whole as usize)
    };
    let latest = trials.latest_offset_s();
    let options = ReverseCorrelationOptions {
        bins: within("bins", 1.0, MOST_BINS, DEFAULT_BINS)?,
        duration_s: arguments.real("duration", [latest, f64::MAX])?.unwrap_or(latest),
        permutations: within(
            "permutations",
            FEWEST_PERMUTATIONS as f64,
            1e6,
            DEFAULT_PERMUTATIONS,
        )?,
        seed: arguments.whole("seed", 1)?,
    };
    Ok(Answer::of(&Outcome::Ok(reverse_correlation(&trials, options)?), words))
}

fn words(result: &ReverseCorrelation) -> String {
    let mut lines = Lines::default();
    lines.add("Dynamic reverse correlation (answers dealt anew within people)");
    lines.add(format!(
        "{} trials of {} people, {} draws with seed {}{}",
        result.n,
        result.participants,
        result.permutations,
        result.seed,
        lines::dropped(result.dropped)
    ));
    for found in &result.categories {
        category(&mut lines, found, &result.times_s);
    }
    lines.into_text()
}

fn category(lines: &mut Lines, found: &CategoryImages, times_s: &[f64]) {
    lines.add(format!("{}: {} answers, {} people", found.category, found.answers, found.people));
    let group = match &found.group {
        Outcome::Ok(group) => group,
        Outcome::Undefined { reason } => return lines.add(format!("  undefined: {reason}")),
    };
    let heads =
        ["unit", "share more", "z", "p", "people", "bits", "significant times", "intensity", "p"];
    let mut rows = vec![lines::row(heads)];
    let told = group.units.iter().filter(|unit| {
        let intense = unit.intensity.is_some_and(|test| test.p <= LEVEL);
        unit.presence.p <= LEVEL || intense || unit.p.iter().any(|p| *p <= LEVEL)
    });
    for unit in told {
        let of = |value: Option<f64>| value.map_or_else(String::new, format_number);
        rows.push(vec![
            unit.unit.clone(),
            format_number(unit.presence.effect),
            format_number(unit.presence.z),
            format_number(unit.presence.p),
            unit.people.to_string(),
            format_number(unit.information_bits),
            spans(unit, group, times_s),
            of(unit.intensity.map(|test| test.effect)),
            of(unit.intensity.map(|test| test.p)),
        ]);
    }
    match rows.len() {
        1 => lines.add("  no unit is significant at any time"),
        _ => lines.table(&rows),
    }
}

/// `0.23-0.67 s`; with a minus where the unit is weaker in trials that were answered so.
fn spans(unit: &UnitImage, group: &GroupImage, times_s: &[f64]) -> String {
    let sign = |bin: usize| match unit.z[bin] {
        z if z > group.critical_z => 1,
        z if z < -group.critical_z => -1,
        _ => 0,
    };
    let half = times_s.first().copied().unwrap_or_default();
    let mut spans: Vec<(i32, f64, f64)> = Vec::new();
    for (bin, time) in times_s.iter().enumerate() {
        match spans.last_mut() {
            Some((known, _, end)) if bin > 0 && *known == sign(bin) => *end = time + half,
            _ => spans.push((sign(bin), time - half, time + half)),
        }
    }
    let told = spans.into_iter().filter(|(sign, ..)| *sign != 0);
    let words = told.map(|(sign, from, to)| {
        format!("{}{from:.2}-{to:.2} s", if sign < 0 { "less " } else { "" })
    });
    words.collect::<Vec<_>>().join(", ")
}
