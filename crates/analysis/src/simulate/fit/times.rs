//! Times, frames and dropout of an export.

use std::collections::{BTreeMap, HashMap};

use mimique_session::Standing;
use mimique_stats::Table;

use super::super::parameters::Parameters;

/// Overwrites what the export can tell of times, frames, replays and dropout.
pub(super) fn fit(table: &Table, parameters: &mut Parameters) {
    let place = |name: &str| table.position(name).ok();
    let (Some(person), Some(trial), Some(kind)) =
        (place("participant_id"), place("trial_id"), place("trial_type"))
    else {
        return;
    };
    let number = |row: usize, name: &str| -> Option<f64> {
        table.cell(row, place(name)?)?.parse().ok().filter(|value: &f64| value.is_finite())
    };
    // A trial each, in the order of the file.
    let mut trials: Vec<Trial> = Vec::new();
    let mut known: HashMap<(&str, &str), usize> = HashMap::new();
    let mut statuses: BTreeMap<&str, &str> = BTreeMap::new();
    for row in 0..table.rows() {
        let (Some(who), Some(which)) = (table.cell(row, person), table.cell(row, trial)) else {
            continue;
        };
        let status =
            place("status").and_then(|column| table.cell(row, column)).unwrap_or("completed");
        statuses.insert(who, status);
        if table.cell(row, kind) != Some("trial") {
            continue;
        }
        let at = *known.entry((who, which)).or_insert_with(|| {
            trials.push(Trial {
                person: who.to_owned(),
                times: Vec::new(),
                frames: number(row, "frames"),
                late: number(row, "frames_late"),
                refresh_hz: number(row, "refresh_hz").filter(|hz| *hz > 0.0),
                replays: number(row, "replays").unwrap_or(0.0),
                interrupted: number(row, "interruptions").unwrap_or(0.0) > 0.0,
                focus_lost: number(row, "focus_losses").unwrap_or(0.0) > 0.0,
            });
            trials.len() - 1
        });
        trials[at].times.extend(number(row, "rt"));
    }
    if trials.is_empty() {
        return;
    }
    answering(&mut trials, parameters);
    display(&trials, parameters);
    let is_open =
        |status: &&&str| Standing::from_export_word(status).is_some_and(Standing::is_open);
    let left = statuses.values().filter(is_open).count() as f64;
    parameters.dropout.per_trial = left / (left + trials.len() as f64);
}

struct Trial {
    person: String,
    times: Vec<f64>,
    frames: Option<f64>,
    late: Option<f64>,
    refresh_hz: Option<f64>,
    replays: f64,
    interrupted: bool,
    focus_lost: bool,
}

/// Medians and spreads of the logarithm of the time from one answer to the next.
fn answering(trials: &mut [Trial], parameters: &mut Parameters) {
    // All frames, late ones twice: a late frame misses the place before it.
    let lengths: Vec<f64> = trials
        .iter()
        .filter_map(|trial| {
            let frames = trial.frames? + trial.late.unwrap_or(0.0) - 1.0;
            Some(1000.0 * frames / trial.refresh_hz?)
        })
        .collect();
    if let Some(length) = middle(lengths).filter(|length| *length > 0.0) {
        parameters.times.clip_ms = length;
    }
    let mut by_person: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for trial in trials.iter_mut().filter(|trial| trial.replays == 0.0) {
        trial.times.sort_by(f64::total_cmp);
        let mut before = parameters.times.clip_ms;
        for &time in &trial.times {
            // Answers sent together have one time between them.
            if time - before > 1.0 {
                by_person.entry(&trial.person).or_default().push(libm::log(time - before));
            }
            before = time;
        }
    }
    // One-way analysis of variance by people.
    let groups: Vec<(f64, f64, f64)> = by_person
        .values()
        .map(|values| {
            let n = values.len() as f64;
            let mean = values.iter().sum::<f64>() / n;
            (n, mean, values.iter().map(|value| (value - mean).powi(2)).sum())
        })
        .collect();
    let total: f64 = groups.iter().map(|(n, ..)| n).sum();
    let people = groups.len() as f64;
    if people < 2.0 || total <= people {
        return;
    }
    let mean = groups.iter().map(|(n, mean, _)| n * mean).sum::<f64>() / total;
    let within = groups.iter().map(|(.., ss)| ss).sum::<f64>() / (total - people);
    let between =
        groups.iter().map(|(n, m, _)| n * (m - mean).powi(2)).sum::<f64>() / (people - 1.0);
    let size = (total - groups.iter().map(|(n, ..)| n * n).sum::<f64>() / total) / (people - 1.0);
    parameters.times.median_ms = libm::exp(mean);
    parameters.times.sigma = within.sqrt();
    parameters.times.person_sigma = ((between - within) / size).max(0.0).sqrt();
}

/// A computer is called slow where more than this share of its frames is late.
const SLOW: f64 = 0.05;

fn display(trials: &[Trial], parameters: &mut Parameters) {
    let display = &mut parameters.display;
    let share = |count: usize| count as f64 / trials.len() as f64;
    display.replay = share(trials.iter().filter(|trial| trial.replays > 0.0).count());
    display.focus_loss = share(trials.iter().filter(|trial| trial.focus_lost).count());
    // The export counts reloads and plays cut short together.
    let interrupted = share(trials.iter().filter(|trial| trial.interrupted).count());
    let both = display.cut_short + display.reload;
    let cut = if both > 0.0 { display.cut_short / both } else { 0.5 };
    (display.cut_short, display.reload) = (cut * interrupted, (1.0 - cut) * interrupted);
    if let Some(rate) = middle(trials.iter().filter_map(|trial| trial.refresh_hz).collect()) {
        display.refresh_hz = rate;
    }
    let mut people: BTreeMap<&str, (f64, f64)> = BTreeMap::new();
    for trial in trials {
        if let (Some(frames), Some(late)) = (trial.frames, trial.late) {
            let sum = people.entry(&trial.person).or_default();
            (sum.0, sum.1) = (sum.0 + late, sum.1 + frames);
        }
    }
    let of = |slow: bool| {
        let chosen =
            people.values().filter(|(late, frames)| (late / frames.max(1.0) > SLOW) == slow);
        chosen.fold((0.0, 0.0, 0.0), |sum, each| (sum.0 + each.0, sum.1 + each.1, sum.2 + 1.0))
    };
    let (quick, slow) = (of(false), of(true));
    if quick.1 > 0.0 {
        display.late_share = quick.0 / quick.1;
    }
    if slow.1 > 0.0 {
        display.slow_late_share = slow.0 / slow.1;
    }
    if !people.is_empty() {
        display.slow_people = slow.2 / people.len() as f64;
    }
}

fn middle(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
