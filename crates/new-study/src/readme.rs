//! The README of a new study's folder: what it is, what to do next, and what its instruments are: citation, licence,
//! scoring.

use crate::Wishes;
use crate::library::Instrument;

/// The text, in Markdown; `by` is what wrote the study.
pub(crate) fn readme(
    by: &str,
    design: &str,
    wishes: &Wishes,
    instruments: &[Instrument],
    notes: &[String],
) -> String {
    let mut out = String::new();
    let id = &wishes.id;
    out.push_str(&format!("# {id}\n\n"));
    out.push_str(&format!("A study of avatar faces, written by {by} with the design `{design}`. Everything about it stands in\n\
         `study.json`, which explains itself.\n\n"));
    out.push_str("## Next\n\n```sh\n");
    for (command, what) in [
        (
            "mimique check study.json".to_owned(),
            "every problem at once, with its place and a remedy",
        ),
        ("mimique serve study.json".to_owned(), "questionnaire, preview, researchers' pages"),
        (
            "mimique simulate study.json --participants 20 --seed 1 --out simulated".to_owned(),
            "simulated people take part",
        ),
        (
            format!("mimique analyze simulated/{id}_responses.csv --study study.json --out report"),
            "every table and figure",
        ),
    ] {
        out.push_str(&format!("# {what}\n{command}\n"));
    }
    out.push_str("```\n\n");
    out.push_str(
        "Before anybody takes part: write the real contact, ethics board, retention and debriefing into `study.json`, \
         look\nat every clip in the preview, and let somebody read the texts of each language.\n",
    );
    if !notes.is_empty() {
        out.push_str("\n## To be looked at\n\n");
        for note in notes {
            out.push_str(&format!("- {note}\n"));
        }
    }
    if !instruments.is_empty() {
        out.push_str("\n## Instruments\n");
    }
    for own in instruments {
        out.push_str(&format!("\n### {}\n\n", own.name));
        out.push_str(&format!("- Source: {}\n", own.citation));
        out.push_str(&format!("- Licence: {}\n", own.licence));
        out.push_str(&format!("- Scoring: {}\n", own.scoring));
        for (language, from) in &own.translations {
            if wishes.languages.contains(language) {
                out.push_str(&format!(
                    "- Words in `{language}`: {}\n",
                    from.as_str().unwrap_or_default()
                ));
            }
        }
    }
    out
}
