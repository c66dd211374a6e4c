//! `README.md` and `LICENSE.md`: what people read first.

use mimique_locale::counted_as;

use crate::about::{About, SOFTWARE_LICENCE, SOFTWARE_REPOSITORY, SOFTWARE_VERSION};
use crate::author::Author;
use crate::described::{FOLDERS, MANIFEST};
use crate::personal::{Finding, Judged};
use crate::psych_ds;
use crate::study_files::Changed;

/// What the README tells beside what is known of the data set.
pub(crate) struct Told<'a> {
    /// What became of what is personal.
    pub judged: &'a Judged,
    /// What was taken out of each version of the study file.
    pub changes: &'a [Changed],
    /// Whether stimuli, avatars and captures are deposited themselves, and not their hashes alone.
    pub with_stimuli: bool,
}

/// The README, in Markdown.
pub(crate) fn readme(about: &About, told: &Told<'_>) -> String {
    let authors: Vec<String> = about.authors.iter().map(Author::said_name).collect();
    let people = counted_as(about.participants, "participant", "participants");
    let mut text = format!(
        "# {}\n\n{}\n\nBy {}. {people}, {} rows of answers. Version {}, deposited {}.\n\n## What lies where\n\n\
         | folder | what |\n|---|---|\n",
        about.title,
        about.description,
        authors.join(", "),
        about.rows,
        about.version,
        about.date
    );
    for (folder, words) in FOLDERS {
        text.push_str(&format!("| `{folder}/` | {words} |\n"));
    }
    text.push_str(&format!(
        "\n`CITATION.cff` says how to cite the data, `LICENSE.md` what may be done with them, `ro-crate-metadata.json` (and the\n\
         page `ro-crate-preview.html`) what each file is. `sha256sum --check {MANIFEST}` shows that all of it is whole.\n"
    ));
    text.push_str(&format!(
        "\n## The same results again\n\n```sh\npip install mimique=={SOFTWARE_VERSION}\n\
         mimique analyze {} --study study/study.json --out again\n```\n\n\
         gives the report in `report/` again, from the answers in this deposit. Its scripts compute the same in R and Python.\n",
        psych_ds::data_file(&about.study)
    ));
    if told.with_stimuli {
        text.push_str("`mimique serve study/study.json` shows the study as participants saw it.\n");
    } else {
        text.push_str(
            "Clips, avatars and captures are not part of the deposit: `stimuli/stimuli.csv` and `study/provenance.json` have\n\
             their SHA-256, so that whoever is given them can tell that they are the same.\n",
        );
    }
    text.push_str(&left_out(told));
    text
}

/// What is not there.
fn left_out(told: &Told<'_>) -> String {
    let mut text = String::from("\n## What was left out\n\n");
    let mut line = |words: String| text.push_str(&format!("- {words}\n"));
    let names: Vec<String> = told.judged.left_out.iter().map(|name| format!("`{name}`")).collect();
    if !names.is_empty() {
        line(format!("Columns, and answers to questions: {}.", names.join(", ")));
    }
    for changed in told.changes {
        if !changed.removed.is_empty() {
            line(format!(
                "Of the study file: {} (completion codes and addresses that take answers).",
                changed.removed.join(", ")
            ));
        }
        if changed.served_hash != changed.deposited_hash {
            line(format!(
                "The study file was served with the SHA-256 `{}`, which the column `config_hash` has, and which decides the\n  \
                 order of trials; as it stands here its own is `{}`.",
                changed.served_hash, changed.deposited_hash
            ));
        }
    }
    let kept: Vec<String> = told.judged.kept.iter().map(kept).collect();
    if !kept.is_empty() {
        line(format!("Looked at, and kept: {}.", kept.join("; ")));
    }
    line("Identifiers of recruiting services, which are never deposited.".to_owned());
    text
}

fn kept(finding: &Finding) -> String {
    format!("`{}` ({}, {} values)", finding.key, finding.kind.words(), finding.values)
}

/// What is under which licence, in Markdown.
pub(crate) fn licences(about: &About) -> String {
    let (data, code) = (about.data_licence, about.code_licence);
    format!(
        "# Licences\n\n\
         | what | licence |\n|---|---|\n\
         | data, stimuli, report (`psych-ds`, `bids`, `stimuli`, `report`) | [{}]({}) (`{}`) |\n\
         | study file, scripts (`study`, `report/*.R`, `report/*.py`) | [{}]({}) (`{}`) |\n\
         | the software itself, which is not part of the deposit ({SOFTWARE_REPOSITORY}) | `{SOFTWARE_LICENCE}` |\n\n\
         Avatars, captures, sounds and videos of other people keep their own licences.\n",
        data.name, data.address, data.spdx, code.name, code.address, code.spdx
    )
}
