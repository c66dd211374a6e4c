//! Power as tables: CSV for scripts, markdown for people.

use std::fmt::Write;

use super::{Columns, HypothesisPower, Power, PowerPoint, Rate};
use crate::language::Language;
use crate::report::document::csv_text;

/// One row a number of people, number of clips and hypothesis.
pub fn power_csv(power: &Power) -> String {
    let mut heading: Vec<String> =
        ["hypothesis", "participants", "clips", "people_used", "runs", "alpha"]
            .map(str::to_owned)
            .into();
    for kind in ["power", "false_positives"] {
        for column in ["as_in_the_thesis", "recommended", "recommended_holm"] {
            let ends = ["", "_low", "_high", "_undefined"];
            heading.extend(ends.map(|end| format!("{kind}_{column}{end}")));
        }
    }
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
    for columns in [Some(&hypothesis.power), hypothesis.false_positives.as_ref()] {
        for rate in columns.map(all).unwrap_or([None; 3]) {
            row.extend(match rate {
                Some(Rate { share, interval: [low, high], undefined, .. }) => {
                    let [share, low, high] = [share, low, high].map(|share| format!("{share:.5}"));
                    [share, low, high, undefined.to_string()]
                }
                None => [""; 4].map(str::to_owned),
            });
        }
    }
    row
}

fn all(columns: &Columns) -> [Option<Rate>; 3] {
    [columns.as_in_the_thesis, columns.recommended, columns.recommended_holm].map(Some)
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
