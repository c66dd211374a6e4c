//! The flow of people and trials, from the export to the analysis.

use crate::language::Language;
use crate::report::document::{DataTable, Figure};
use crate::report::figure::svg::{Anchor, Svg};
use crate::trials::export::{BY_RESEARCHER, Flow};

pub(crate) fn flow_chart(language: Language, flow: &Flow) -> Figure {
    let caption = language
        .pick(
            "Participants and trials, from the export to the analysis",
            "Participants et essais, de l’export à l’analyse",
        )
        .to_owned();
    let reasons = |left_out: &std::collections::BTreeMap<&'static str, usize>| -> Vec<String> {
        left_out
            .iter()
            .map(|(reason, count)| format!("{}: {count}", in_words(language, reason)))
            .collect()
    };
    let mut people_out = reasons(&flow.people_left_out);
    if !flow.researcher_reasons.is_empty() {
        // Each of the researcher's own reasons has its line.
        let whole = format!("{}: ", in_words(language, BY_RESEARCHER));
        let place = people_out.iter().position(|line| line.starts_with(&whole));
        let lines = flow.researcher_reasons.iter().map(|(reason, count)| {
            format!("{} ({}): {count}", in_words(language, BY_RESEARCHER), shortened(reason))
        });
        if let Some(place) = place {
            people_out.splice(place..=place, lines);
        }
    }
    let trials_out = reasons(&flow.trials_left_out);
    let steps = [
        (
            flow.people,
            language.pick("people with answers", "personnes avec des réponses"),
            people_out,
        ),
        (
            flow.people_used,
            language.pick("people in the analysis", "personnes dans l’analyse"),
            Vec::new(),
        ),
        (flow.trials, language.pick("trials they answered", "essais de ces personnes"), trials_out),
        (
            flow.trials_used,
            language.pick("trials in the analysis", "essais dans l’analyse"),
            Vec::new(),
        ),
    ];
    let mut data = DataTable::new(
        "participants",
        caption.clone(),
        language.pick(["step", "number", "left out"], ["étape", "nombre", "écartés"]),
    );
    let (left, width, height) = (4.0, 262.0, 44.0);
    let mut y = 8.0;
    let tops: Vec<f64> = steps
        .iter()
        .map(|(_, _, out)| {
            let top = y;
            y += height + 26.0 + 16.0 * (out.len() as f64 - 1.0).max(0.0);
            top
        })
        .collect();
    let mut svg = Svg::new(&caption, y - 14.0);
    let mut spoken = Vec::new();
    for (place, ((count, label, out), top)) in steps.iter().zip(&tops).enumerate() {
        svg.class_rect([left, *top, width, height], "empty");
        svg.text(left + 14.0, top + 27.5, "strong", Anchor::Start, &count.to_string());
        svg.text(left + 58.0, top + 27.5, "", Anchor::Start, label);
        if let Some(next) = tops.get(place + 1) {
            let x = left + 30.0;
            svg.line([x, top + height], [x, *next], "whisker");
            svg.line([x, *next], [x - 4.0, next - 6.0], "whisker");
            svg.line([x, *next], [x + 4.0, next - 6.0], "whisker");
        }
        if !out.is_empty() {
            let heading = language.pick("left out", "écartés");
            svg.line([left + width, top + 22.0], [left + width + 16.0, top + 22.0], "whisker");
            svg.text(left + width + 22.0, top + 18.0, "soft", Anchor::Start, heading);
            for (line, reason) in out.iter().enumerate() {
                let y = top + 35.0 + 16.0 * line as f64;
                svg.text(left + width + 22.0, y, "", Anchor::Start, reason);
            }
        }
        spoken.push(format!("{count} {label}"));
        data.row([(*label).to_owned(), count.to_string(), out.join("; ")]);
    }
    let alt = format!("{}.", spoken.join(", "));
    Figure { id: "participants".to_owned(), caption, alt, svg: svg.finish(), data }
}

/// A reason as it fits beside the chart.
fn shortened(reason: &str) -> String {
    const MOST: usize = 40;
    if reason.chars().count() <= MOST {
        return reason.to_owned();
    }
    reason.chars().take(MOST - 1).chain(['…']).collect()
}

fn in_words(language: Language, reason: &str) -> String {
    let french = match reason {
        "pilot" => "pilote",
        "withdrawn" => "retirés",
        "declined" => "sans accord",
        BY_RESEARCHER => "exclus par le chercheur",
        "screened out" => "non retenus",
        "incomplete" => "incomplets",
        "attention checks" => "contrôles d’attention",
        "late frames" => "images en retard",
        "long frame" => "image trop longue",
        "answered too soon" => "réponse trop rapide",
        other => other,
    };
    language.pick(reason, french).to_owned()
}
