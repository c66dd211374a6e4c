//! `mimique test reverse-correlation`.

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
use crate::words::format_number;

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
    r: "",
    python: "",
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
