//! The flow of people and trials, from the export to the analysis.

use std::collections::BTreeMap;

use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure};
use mimique_report::svg::{Anchor, Svg};

use crate::trials::export::Flow;
use crate::trials::reason::Reason;

/// Letters of a line beside the chart.
const LINE: usize = 22;

/// The same as the chart, in a sentence.
pub(crate) fn flow_in_words(language: Language, flow: &Flow) -> String {
    let colon = colon(language);
    let left_out = language.pick("left out", "écartés");
    let words = steps(language, flow).map(|Step { count, label, left_out: reasons }| match reasons
        .as_slice()
    {
        [] => format!("{count} {label}"),
        reasons => format!("{count} {label} ({left_out}{colon} {})", reasons.join(", ")),
    });
    format!("{}.", words.join(" → "))
}

pub(crate) fn flow_chart(language: Language, flow: &Flow) -> Figure {
    let caption = language
        .pick(
            "Participants and trials, from the export to the analysis",
            "Participants et essais, de l’export à l’analyse",
        )
        .to_owned();
    let steps = steps(language, flow);
    let mut data = DataTable::new(
        "participants",
        caption.clone(),
        language.pick(["step", "number", "left out"], ["étape", "nombre", "écartés"]),
    );
    let (left, width, height) = (4.0, 262.0, 44.0);
    let mut y = 8.0;
    let lines: Vec<Vec<String>> = steps
        .iter()
        .map(|step| step.left_out.iter().flat_map(|reason| wrapped(reason)).collect())
        .collect();
    let tops: Vec<f64> = lines
        .iter()
        .map(|lines| {
            let top = y;
            y += height + 26.0 + 16.0 * (lines.len() as f64 - 1.0).max(0.0);
            top
        })
        .collect();
    let mut svg = Svg::new(&caption, y - 14.0);
    let mut spoken = Vec::new();
    for (place, (Step { count, label, left_out }, top)) in steps.iter().zip(&tops).enumerate() {
        svg.class_rect([left, *top, width, height], "empty");
        svg.text(left + 14.0, top + 27.5, "strong", Anchor::Start, &count.to_string());
        svg.text(left + 58.0, top + 27.5, "", Anchor::Start, label);
        if let Some(next) = tops.get(place + 1) {
            let x = left + 30.0;
            svg.line([x, top + height], [x, *next], "whisker");
            svg.line([x, *next], [x - 4.0, next - 6.0], "whisker");
            svg.line([x, *next], [x + 4.0, next - 6.0], "whisker");
        }
        if !left_out.is_empty() {
            let heading = language.pick("left out", "écartés");
            svg.line([left + width, top + 22.0], [left + width + 16.0, top + 22.0], "whisker");
            svg.text(left + width + 22.0, top + 18.0, "soft", Anchor::Start, heading);
            for (line, words) in lines[place].iter().enumerate() {
                let y = top + 35.0 + 16.0 * line as f64;
                svg.text(left + width + 22.0, y, "", Anchor::Start, words);
            }
        }
        spoken.push(format!("{count} {label}"));
        data.row([(*label).to_owned(), count.to_string(), left_out.join("; ")]);
    }
    let alt = format!("{}.", spoken.join(", "));
    Figure { id: "participants".to_owned(), caption, alt, svg: svg.finish(), data }
}

/// How many are left at a step, and how many were left out after it, by reason.
struct Step {
    count: usize,
    label: &'static str,
    left_out: Vec<String>,
}

fn steps(language: Language, flow: &Flow) -> [Step; 4] {
    let step = |count, english: [&'static str; 2], french: [&'static str; 2], left_out| {
        // English has the plural of 0, French the singular.
        let is_many = language.pick(count != 1, count > 1);
        let label = language.pick(english, french)[usize::from(is_many)];
        Step { count, label, left_out }
    };
    let people_left_out = people_left_out(language, flow);
    let trials_left_out = reasons(language, &flow.trials_left_out);
    let unread = match flow.rows_unread {
        0 => Vec::new(),
        rows => vec![language.pick(
            format!("rows that name no trial or no response: {rows}"),
            format!("lignes sans essai ou sans réponse : {rows}"),
        )],
    };
    [
        step(
            flow.people,
            ["person with answers", "people with answers"],
            ["personne avec des réponses", "personnes avec des réponses"],
            people_left_out,
        ),
        step(
            flow.people_used,
            ["person in the analysis", "people in the analysis"],
            ["personne dans l’analyse", "personnes dans l’analyse"],
            unread,
        ),
        step(
            flow.trials,
            ["trial they answered", "trials they answered"],
            ["essai de ces personnes", "essais de ces personnes"],
            trials_left_out,
        ),
        step(
            flow.trials_used,
            ["trial in the analysis", "trials in the analysis"],
            ["essai dans l’analyse", "essais dans l’analyse"],
            Vec::new(),
        ),
    ]
}

pub(crate) fn people_left_out(language: Language, flow: &Flow) -> Vec<String> {
    let mut people_out = reasons(language, &flow.people_left_out);
    if !flow.researcher_reasons.is_empty() {
        // Each of the researcher's own reasons has its line.
        let whole = format!("{}{} ", in_words(language, Reason::ByResearcher), colon(language));
        let place = people_out.iter().position(|line| line.starts_with(&whole));
        let lines = flow.researcher_reasons.iter().map(|(reason, count)| {
            let by = in_words(language, Reason::ByResearcher);
            format!("{by} ({reason}){} {count}", colon(language))
        });
        if let Some(place) = place {
            people_out.splice(place..=place, lines);
        }
    }
    people_out
}

pub(crate) fn reasons(language: Language, left_out: &BTreeMap<Reason, usize>) -> Vec<String> {
    let line = |(&reason, count): (&Reason, &usize)| {
        format!("{}{} {count}", in_words(language, reason), colon(language))
    };
    left_out.iter().map(line).collect()
}

/// A reason in lines that fit beside the chart; a word longer than a line is cut where the line ends.
fn wrapped(reason: &str) -> Vec<String> {
    let mut lines: Vec<String> = vec![String::new()];
    for word in reason.split(' ') {
        let mut letters: Vec<char> = word.chars().collect();
        loop {
            let line = lines.last_mut().expect("there is a line");
            let used = line.chars().count();
            let between = usize::from(used > 0);
            if used + between + letters.len() <= LINE {
                line.extend(std::iter::repeat_n(' ', between));
                line.extend(&letters);
                break;
            }
            if used > 0 {
                lines.push(String::new());
            } else {
                line.extend(letters.drain(..LINE));
                lines.push(String::new());
            }
        }
    }
    lines
}

fn colon(language: Language) -> &'static str {
    language.pick(":", " :")
}

fn in_words(language: Language, reason: Reason) -> &'static str {
    language.pick(reason.english(), reason.french())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_are_wrapped_and_no_letter_is_lost() {
        let reason = "by the researcher (answered every question with the middle of the scale): 2";
        let lines = wrapped(reason);
        assert!(lines.iter().all(|line| line.chars().count() <= LINE), "{lines:?}");
        assert_eq!(lines.join(" "), reason);
        let long = "a".repeat(60);
        assert_eq!(wrapped(&long).concat(), long);
    }
}
