//! Power as tables: CSV for scripts, markdown for people.

use std::fmt::Write;

use mimique_locale::Language;
use mimique_report::document::csv_text;
use serde::Serialize;

use super::precision_table::precision_markdown;
use super::{Columns, HypothesisPower, Power, PowerPoint, Rate, SmallestDifference};
use crate::hypothesis::ClipScope;
use crate::hypothesis::decision::EffectUnit;

/// One row a number of people, number of clips and hypothesis.
pub fn power_csv(power: &Power) -> String {
    let mut heading: Vec<String> =
        ["hypothesis", "participants", "clips", "people_used", "runs", "alpha"]
            .map(str::to_owned)
            .into();
    for kind in ["power", "false_positives"] {
        for column in ["as_in_the_thesis", "deciding", "deciding_holm"] {
            let ends = ["", "_low", "_high", "_undefined"];
            heading.extend(ends.map(|end| format!("{kind}_{column}{end}")));
        }
    }
    for kind in ["power", "false_positives"] {
        for column in ["min_f", "mixed"] {
            let ends = ["", "_low", "_high", "_undefined"];
            heading.extend(ends.map(|end| format!("{kind}_{column}{end}")));
        }
    }
    let last = ["segments", "scope", "smallest_difference", "smallest_difference_unit"];
    heading.extend(last.map(str::to_owned));
    let points = power.points.iter().flat_map(|point| {
        point.hypotheses.iter().map(move |hypothesis| row(power, point, hypothesis))
    });
    csv_text(std::iter::once(heading).chain(points))
}

fn row(power: &Power, point: &PowerPoint, hypothesis: &HypothesisPower) -> Vec<String> {
    let mut row = vec![
        hypothesis.id.clone(),
        point.participants.to_string(),
        point.clips.to_string(),
        format!("{:.3}", point.people_used),
        power.runs.to_string(),
        power.alpha.to_string(),
    ];
    let kinds = || [Some(&hypothesis.power), hypothesis.false_positives.as_ref()].into_iter();
    for columns in kinds() {
        columns
            .map(all)
            .unwrap_or([None; 3])
            .into_iter()
            .for_each(|rate| row.extend(rate_cells(rate)));
    }
    // Behind them, so that older scripts find their columns where they were.
    for columns in kinds() {
        let of_clips = columns.map_or([None; 2], |columns| [columns.min_f, columns.mixed]);
        of_clips.into_iter().for_each(|rate| row.extend(rate_cells(rate)));
    }
    row.push(point.segments.to_string());
    row.push(code(hypothesis.scope));
    let smallest = hypothesis.smallest_difference;
    row.push(smallest.map_or_else(String::new, |own| format!("{:.5}", own.value)));
    row.push(smallest.map_or_else(String::new, |own| code(own.unit)));
    row
}

/// Share, interval and count of the undefined; blank where there is no rate.
fn rate_cells(rate: Option<Rate>) -> [String; 4] {
    match rate {
        Some(Rate { share, interval: [low, high], undefined, .. }) => {
            let [share, low, high] = [share, low, high].map(|share| format!("{share:.5}"));
            [share, low, high, undefined.to_string()]
        }
        None => [""; 4].map(str::to_owned),
    }
}

fn all(columns: &Columns) -> [Option<Rate>; 3] {
    [columns.as_in_the_thesis, columns.deciding, columns.deciding_holm].map(Some)
}

/// A table a hypothesis.
pub fn power_markdown(power: &Power, language: Language) -> String {
    let mut text = String::new();
    let ids = power.points.first().map(|point| point.hypotheses.len()).unwrap_or(0);
    for place in 0..ids {
        let Some(first) = power.points.first().map(|point| &point.hypotheses[place]) else { break };
        let _ = writeln!(text, "**{}**{}\n", first.id, in_scope(first.scope, language));
        if !first.effect {
            let _ = writeln!(text, "{}\n", no_effect(language));
        }
        hypothesis_table(&mut text, power, place, language);
        text.push('\n');
        text += &of_clips(power, place, language);
    }
    text + &precision_markdown(power, language)
}

/// A row for each number of people and of clips.
fn hypothesis_table(text: &mut String, power: &Power, place: usize, language: Language) {
    let own = || power.points.iter().map(|point| &point.hypotheses[place]);
    let falsely = own().any(|hypothesis| hypothesis.false_positives.is_some());
    let smallest = own().any(|hypothesis| hypothesis.smallest_difference.is_some());
    let mut heading = language
        .pick(
            [
                "people",
                "used",
                "clips",
                "power, corrected (Holm)",
                "uncorrected",
                "as in the thesis",
            ],
            [
                "personnes",
                "gardées",
                "extraits",
                "puissance, corrigée (Holm)",
                "non corrigée",
                "comme dans la thèse",
            ],
        )
        .to_vec();
    if falsely {
        heading.extend(language.pick(
            ["false positives, uncorrected", "as in the thesis"],
            ["faux positifs, sans correction", "comme dans la thèse"],
        ));
    }
    if smallest {
        heading.push(language.pick("smallest difference (80 %)", "plus petite différence (80 %)"));
    }
    let _ = writeln!(text, "| {} |", heading.join(" | "));
    let _ = writeln!(text, "|{}", "---:|".repeat(heading.len()));
    for point in &power.points {
        let hypothesis = &point.hypotheses[place];
        let mut cells = vec![
            point.participants.to_string(),
            language.fixed(point.people_used, 1),
            point.clips.to_string(),
            cell(language, &hypothesis.power.deciding_holm),
            cell(language, &hypothesis.power.deciding),
            cell(language, &hypothesis.power.as_in_the_thesis),
        ];
        if let Some(columns) = &hypothesis.false_positives {
            cells.push(cell(language, &columns.deciding));
            cells.push(cell(language, &columns.as_in_the_thesis));
        }
        if smallest {
            let own = hypothesis.smallest_difference;
            cells.push(own.map_or_else(|| "–".to_owned(), |own| smallest_cell(language, own)));
        }
        let _ = writeln!(text, "| {} |", cells.join(" | "));
    }
}

/// People x segments of a hypothesis of other clips too; nothing of another one.
fn of_clips(power: &Power, place: usize, language: Language) -> String {
    let mut text = String::new();
    let own = |point: &PowerPoint| point.hypotheses[place].power;
    if power.points.iter().all(|point| own(point).min_f.is_none()) {
        return text;
    }
    let mixed = power.points.iter().any(|point| own(point).mixed.is_some());
    let falsely =
        power.points.iter().any(|point| point.hypotheses[place].false_positives.is_some());
    let (names, false_names) = language.pick(
        (
            ["power, min F'", "linear mixed model"],
            ["false positives, min F'", "linear mixed model"],
        ),
        (["puissance, min F'", "modèle mixte"], ["faux positifs, min F'", "modèle mixte"]),
    );
    let count = if mixed { 2 } else { 1 };
    let mut heading = language.pick(["people", "segments"], ["personnes", "segments"]).to_vec();
    heading.extend(&names[..count]);
    if falsely {
        heading.extend(&false_names[..count]);
    }
    let caption = language.pick("For other clips:", "Pour d’autres extraits\u{a0}:");
    let _ = writeln!(text, "{caption}\n\n| {} |", heading.join(" | "));
    let _ = writeln!(text, "|{}", "---:|".repeat(heading.len()));
    for point in &power.points {
        let mut cells = vec![point.participants.to_string(), point.segments.to_string()];
        let false_positives = point.hypotheses[place].false_positives;
        for columns in [Some(own(point)), false_positives.filter(|_| falsely)].into_iter().flatten()
        {
            for rate in &[columns.min_f, columns.mixed][..count] {
                cells.push(rate.map_or_else(|| "–".to_owned(), |rate| cell(language, &rate)));
            }
        }
        let _ = writeln!(text, "| {} |", cells.join(" | "));
    }
    text.push('\n');
    text
}

/// `, for other clips`: which clips the decision is about; nothing where it is about none.
pub fn in_scope(scope: ClipScope, language: Language) -> &'static str {
    match scope {
        ClipScope::Others => language.pick(", for other clips", ", pour d’autres extraits"),
        ClipScope::These => language.pick(", for these clips", ", pour ces extraits"),
        ClipScope::NotTold => "",
    }
}

/// A scope or a unit as the JSON form writes it.
fn code(value: impl Serialize) -> String {
    let json = serde_json::to_value(value).ok();
    json.as_ref().and_then(serde_json::Value::as_str).unwrap_or_default().to_owned()
}

/// `0.43 points`: a difference in the unit of its answers.
pub fn smallest_cell(language: Language, own: SmallestDifference) -> String {
    let (scale, decimals, unit) = match own.unit {
        EffectUnit::Points => (1.0, 2, ""),
        EffectUnit::Seconds => (1.0, 2, " s"),
        EffectUnit::Shares | EffectUnit::Chosen | EffectUnit::ChosenOverOthers => {
            (100.0, 1, language.pick(" percentage points", " points de pourcentage"))
        }
        EffectUnit::Worth => (1.0, 2, language.pick(" JND", " DJP")),
    };
    format!("{}{unit}", language.fixed(scale * own.value, decimals))
}

/// What stands above the numbers of a hypothesis that has no effect in the parameters.
pub fn no_effect(language: Language) -> &'static str {
    language.pick(
        "The parameters hold no effect of its factors on its response: its power is not known, and what stands here are false positives.",
        "Les paramètres ne contiennent aucun effet de ses facteurs sur sa réponse\u{a0}: sa puissance est inconnue, et ces nombres sont des faux positifs.",
    )
}

/// `81.2 % [79.4; 82.9]`, with what was undefined.
pub(crate) fn cell(language: Language, rate: &Rate) -> String {
    let percent = |share: f64| language.fixed(100.0 * share, 1);
    let [low, high] = rate.interval.map(percent);
    let mut text = format!("{} % [{low}; {high}]", percent(rate.share));
    if rate.undefined > 0 {
        let _ = write!(text, " ({} {})", rate.undefined, language.pick("undefined", "non définis"));
    }
    text
}

/// The smallest number of people with this power of the deciding test after the correction, and the clips; none where no
/// point has it.
pub(crate) fn enough(power: &Power, place: usize, wanted: f64) -> Option<(usize, usize)> {
    power
        .points
        .iter()
        .filter(|point| {
            let enough = |h: &HypothesisPower| h.effect && h.power.deciding_holm.share >= wanted;
            point.hypotheses.get(place).is_some_and(enough)
        })
        .map(|point| (point.participants, point.clips))
        .min()
}
