//! The README of a new study's folder: what it is, what to do next, and what its instruments are: citation, licence,
//! scoring.

use std::fmt::Write as _;

use super::Wishes;
use super::library::Instrument;

/// The text, in Markdown.
pub(super) fn readme(
    wishes: &Wishes,
    instruments: &[Instrument],
    notes: &[String],
) -> Result<String, std::fmt::Error> {
    let mut out = String::new();
    let id = &wishes.id;
    writeln!(out, "# {id}\n")?;
    writeln!(
        out,
        "A study of avatar faces, written by `mimique new` with the design `{}`. Everything about it stands in\n\
         `study.json`, which explains itself.\n",
        wishes.design
    )?;
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
        writeln!(out, "# {what}\n{command}")?;
    }
    out.push_str("```\n\n");
    out.push_str(
        "Before anybody takes part: write the real contact, ethics board, retention and debriefing into `study.json`, \
         look\nat every clip in the preview, and let somebody read the texts of each language.\n",
    );
    if !notes.is_empty() {
        out.push_str("\n## To be looked at\n\n");
        for note in notes {
            writeln!(out, "- {note}")?;
        }
    }
    if !instruments.is_empty() {
        out.push_str("\n## Instruments\n");
    }
    for own in instruments {
        writeln!(out, "\n### {}\n", own.name)?;
        writeln!(out, "- Source: {}", own.citation)?;
        writeln!(out, "- Licence: {}", own.licence)?;
        writeln!(out, "- Scoring: {}", own.scoring)?;
        for (language, from) in &own.translations {
            if wishes.languages.contains(language) {
                writeln!(out, "- Words in `{language}`: {}", from.as_str().unwrap_or_default())?;
            }
        }
    }
    Ok(out)
}
