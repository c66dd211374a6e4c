//! Levels of a parameter: QUEST+, staircases, psychometric functions, difference scaling.

use mimique_adaptive::{Grid, QuestPlus, Shape, Staircase, StaircaseRules};
use mimique_stats::{
    DifferenceJudgement, Lapse, LevelCount, PsychometricOptions, bootstrap, difference_scaling,
    psychometric as fit,
};
use serde_json::{Value, json};

use super::{Given, Stop, defined};
use crate::VerifyError;
use crate::document::Part;

/// Draws of answers for an interval.
const ROUNDS: usize = 2000;

/// What the cases call the four parameters of each function, in the order of the grid.
const PARAMETERS: [(&str, Shape, [&str; 4]); 2] = [
    ("norm_cdf", Shape::Normal, ["mean", "sd", "lower_asymptote", "lapse_rate"]),
    ("weibull", Shape::Weibull, ["threshold", "slope", "lower_asymptote", "lapse_rate"]),
];

/// The answers of a column of 0 and 1.
fn answers(given: &Given<'_>) -> Result<Vec<bool>, Stop> {
    Ok(given.table(0)?.numbers("answer")?.values.iter().map(|answer| *answer == 1.0).collect())
}

/// Levels chosen one after the other, and what is known after each answer.
pub(super) fn quest_plus(given: &Given<'_>) -> Result<Value, Stop> {
    let function = given.options.get("function")?;
    let own = function.text()?;
    let known = PARAMETERS.iter().find(|(name, _, _)| *name == own);
    let (_, shape, names) = known.ok_or_else(|| function.wrong("norm_cdf or weibull"))?;
    let parameters = given.options.get("parameters")?;
    let mut values = [const { Vec::new() }; 4];
    for (values, name) in values.iter_mut().zip(names) {
        *values = parameters.get(name)?.numbers()?;
    }
    let levels = given.options.get("stimuli")?.numbers()?;
    let prior = [const { None }; 4];
    let grid = Grid { shape: *shape, levels, values, prior };
    let mut quest = QuestPlus::new(grid).map_err(|why| Stop::refused(&why))?;
    let (mut stimuli, mut entropies, mut means) = (Vec::new(), Vec::new(), Vec::new());
    for right in answers(given)? {
        let choice = quest.choice();
        stimuli.push(choice.level);
        entropies.push(choice.entropy);
        quest
            .answer(choice.place, right)
            .map_err(|_| Stop::refused(&"an answer that no cell allows"))?;
        means.push(quest.moments().map(|[mean, _]| mean));
    }
    let (moments, mode) = (quest.moments(), quest.mode());
    let marginals = names.iter().copied().zip(quest.marginals());
    // The smallest lead of a choice over the second describes the case: it is not of the method.
    let lead = given.expected.get("smallest_gap_of_best_to_second")?.value();
    Ok(json!({
        "stimuli": stimuli,
        "expected_entropy": entropies,
        "mean_after_each": means,
        "names": names,
        "mean": moments.map(|[mean, _]| mean),
        "sd": moments.map(|[_, sd]| sd),
        "mode": [mode.location, mode.spread, mode.guess, mode.lapse],
        "marginals": marginals.map(|(name, own)| (name.to_owned(), json!(own))).collect::<serde_json::Map<_, _>>(),
        "final_entropy": quest.entropy(),
        "smallest_gap_of_best_to_second": lead,
    }))
}

/// Levels, turns and threshold of a staircase.
pub(super) fn staircase(given: &Given<'_>) -> Result<Value, Stop> {
    let option = |name: &str| given.options.get(name);
    let bounds = option("bounds")?;
    let rules = StaircaseRules {
        down: u32::try_from(option("down")?.index()?).unwrap_or(u32::MAX),
        start: option("start")?.number()?,
        steps: option("steps")?.numbers()?,
        bounds: <[f64; 2]>::try_from(bounds.numbers()?).map_err(|_| bounds.wrong("two numbers"))?,
    };
    let target = rules.target();
    let mut staircase = Staircase::new(rules).map_err(|why| Stop::refused(&why))?;
    let mut levels = Vec::new();
    for right in answers(given)? {
        levels.push(staircase.level());
        staircase.answer(right);
    }
    let threshold = staircase.threshold(option("ignore_reversals")?.index()?);
    let turns = staircase.reversals();
    Ok(json!({
        "levels": levels,
        "reversal_trials": turns.iter().map(|turn| turn.trial).collect::<Vec<_>>(),
        "reversal_levels": turns.iter().map(|turn| turn.level).collect::<Vec<_>>(),
        "threshold": threshold.map(|threshold| threshold.level),
        "reversals_used": threshold.map_or(0, |threshold| threshold.reversals),
        "target": target,
    }))
}

/// Every function that the case asks for.
pub(super) fn psychometric(given: &Given<'_>) -> Result<Value, Stop> {
    let table = given.table(0)?;
    let column = |name: &str| table.numbers(name);
    let (level, n, correct) = (column("level")?, column("n")?, column("correct")?);
    let counts: Vec<LevelCount> = (0..level.values.len())
        .map(|row| LevelCount {
            level: level.values[row],
            n: n.values[row] as u64,
            correct: correct.values[row] as u64,
        })
        .collect();
    let guess = given.options.get("guess")?.number()?;
    let mut fits = Vec::new();
    for asked in given.expected.get("fits")?.list()? {
        fits.push(one_fit(&asked, &counts, guess)?);
    }
    Ok(json!({ "fits": fits }))
}

fn one_fit(asked: &Part<'_>, counts: &[LevelCount], guess: f64) -> Result<Value, Stop> {
    let (function, words) = (asked.get("function")?, asked.get("lapse")?);
    let shape = Shape::from_name(function.text()?)
        .ok_or_else(|| function.wrong("normal, logistic or weibull"))?;
    let options = PsychometricOptions { shape, guess, lapse: lapse(&words)? };
    let found = defined(fit(counts, &options)?)?;
    let mut told = json!(found);
    told["lapse"] = words.value().clone();
    if asked.find("bootstrap_95").is_some() {
        let drawn = bootstrap(counts, &options, &found.psychometric(), ROUNDS, 1)?;
        told["bootstrap_95"] = json!(drawn.map(|drawn| drawn.location));
    }
    Ok(told)
}

/// `fixed 0.02`, or `free, ...`.
fn lapse(words: &Part<'_>) -> Result<Lapse, VerifyError> {
    let text = words.text()?;
    let unknown = || words.wrong("`fixed` and a number, or `free`");
    match text.strip_prefix("fixed ") {
        Some(number) => Ok(Lapse::Fixed(number.parse().map_err(|_| unknown())?)),
        None if text.starts_with("free") => Ok(Lapse::Free),
        None => Err(unknown()),
    }
}

/// The scale of a parameter.
pub(super) fn difference_scale(given: &Given<'_>) -> Result<Value, Stop> {
    let table = given.table(0)?;
    let kind = given.options.get("kind")?;
    let names: &[&str] = match kind.text()? {
        "triads" => &["a", "b", "c"],
        "quadruples" => &["a", "b", "c", "d"],
        _ => return Err(kind.wrong("triads or quadruples").into()),
    };
    let columns = names.iter().map(|name| table.numbers(name)).collect::<Result<Vec<_>, _>>()?;
    let answer = table.numbers("upper_differs_more")?;
    let judgements: Vec<DifferenceJudgement> = (0..answer.values.len())
        .map(|row| {
            let own = |place: usize| columns[place].values[row];
            let levels = match columns.len() {
                3 => [own(0), own(1), own(1), own(2)],
                _ => [own(0), own(1), own(2), own(3)],
            };
            let second_differs_more = answer.values[row] == 1.0;
            DifferenceJudgement { participant: 0, levels, second_differs_more }
        })
        .collect();
    Ok(json!(defined(difference_scaling(&judgements, 0, 1)?)?))
}
