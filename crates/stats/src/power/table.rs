//! Power as tables: CSV for scripts, markdown for people.

use std::fmt::Write;

use super::{Columns, HypothesisPower, Power, Rate};
use crate::report::Language;

/// One row a number of people, number of clips and hypothesis.
pub fn power_csv(power: &Power) -> String {
    let mut text = String::from("hypothesis,participants,clips,people_used,runs,alpha");
    for kind in ["power", "false_positives"] {
        for column in ["as_in_the_thesis", "recommended", "recommended_holm"] {
            let name = format!("{kind}_{column}");
            let _ = write!(text, ",{name},{name}_low,{name}_high,{name}_undefined");
        }
    }
    text.push('\n');
    for point in &power.points {
        for hypothesis in &point.hypotheses {
            let _ = write!(
                text,
                "{},{},{},{:.3},{},{}",
                csv_cell(&hypothesis.id),
                point.participants,
                point.clips,
                point.people_used,
                power.runs,
                power.alpha
            );
            for columns in [Some(&hypothesis.power), hypothesis.false_positives.as_ref()] {
                for rate in columns.map(all).unwrap_or([None; 3]) {
                    match rate {
                        Some(Rate { share, interval: [low, high], undefined, .. }) => {
                            let _ = write!(text, ",{share:.5},{low:.5},{high:.5},{undefined}");
                        }
                        None => text.push_str(",,,,"),
                    }
                }
            }
            text.push('\n');
        }
    }
    text
}

fn all(columns: &Columns) -> [Option<Rate>; 3] {
    [columns.as_in_the_thesis, columns.recommended, columns.recommended_holm].map(Some)
}

fn csv_cell(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

/// A table a hypothesis.
pub fn power_markdown(power: &Power, language: Language) -> String {
    let mut text = String::new();
    let ids = power.points.first().map(|point| point.hypotheses.len()).unwrap_or(0);
    for place in 0..ids {
        let Some(first) = power.points.first() else { break };
        let _ = writeln!(text, "**{}**\n", first.hypotheses[place].id);
        if !first.hypotheses[place].effect {
            let _ = writeln!(text, "{}\n", no_effect(language));
        }
        let falsely = first.hypotheses[place].false_positives.is_some();
        let mut heading = language
            .pick(
                ["people", "used", "clips", "power, recommended", "with Holm", "as in the thesis"],
                [
                    "personnes",
                    "gardées",
                    "extraits",
                    "puissance, recommandé",
                    "avec Holm",
                    "comme dans la thèse",
                ],
            )
            .to_vec();
        if falsely {
            heading.extend(language.pick(
                ["false positives, recommended", "as in the thesis"],
                ["faux positifs, recommandé", "comme dans la thèse"],
            ));
        }
        let _ = writeln!(text, "| {} |", heading.join(" | "));
        let _ = writeln!(text, "|{}", "---:|".repeat(heading.len()));
        for point in &power.points {
            let hypothesis = &point.hypotheses[place];
            let mut cells = vec![
                point.participants.to_string(),
                language.fixed(point.people_used, 1),
                point.clips.to_string(),
                cell(language, &hypothesis.power.recommended),
                cell(language, &hypothesis.power.recommended_holm),
                cell(language, &hypothesis.power.as_in_the_thesis),
            ];
            if let Some(columns) = &hypothesis.false_positives {
                cells.push(cell(language, &columns.recommended));
                cells.push(cell(language, &columns.as_in_the_thesis));
            }
            let _ = writeln!(text, "| {} |", cells.join(" | "));
        }
        text.push('\n');
    }
    text
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

/// The smallest number of people with this power in the recommended column, and the clips; none where no
/// point has it.
pub(crate) fn enough(power: &Power, place: usize, wanted: f64) -> Option<(usize, usize)> {
    power
        .points
        .iter()
        .filter(|point| {
            let enough = |h: &HypothesisPower| h.effect && h.power.recommended.share >= wanted;
            point.hypotheses.get(place).is_some_and(enough)
        })
        .map(|point| (point.participants, point.clips))
        .min()
}
