//! The same preregistration by the questions of AsPredicted, by their numbers and in our own words: what is written below a
//! number goes into that field. AsPredicted takes English.

use mimique_locale::Language;

use super::{
    Preregistration, Text, analysis, collection, design, hypotheses, rationale, simulation, size,
    stopping_rule, wanted,
};
use crate::naming::Naming;

/// The text, in markdown and in English, whatever the language that `from` names.
pub fn as_predicted(from: &Preregistration<'_>) -> String {
    // Its fields take text alone.
    let from = &Preregistration { language: Language::English, curve: None, ..*from };
    let naming = Naming { language: Language::English, study: from.study };
    let mut text = Text { text: String::new(), language: Language::English };
    let meta = &from.study.study_metadata;
    let title = meta.title.in_language("en");
    text.line(&format!("# AsPredicted: {title}\n"));
    text.line(
        "*Written by Mimique from the study file: what stands below a number goes into AsPredicted’s field of that number. \
         Square brackets mark what the file does not say: fill them in before you register.*\n",
    );
    question(&mut text, 1, "Data: has any been collected yet?");
    text.line(
        "[No, no data have been collected for this study yet. Change this if it is not so.]\n",
    );

    question(&mut text, 2, "Question or hypothesis");
    let description = meta.description.in_language("en");
    if !description.is_empty() {
        text.line(&format!("{description}\n"));
    }
    hypotheses(&mut text, from);

    question(&mut text, 3, "Dependent variables, and how they are measured");
    design::asked(&mut text, from);
    design::indices(&mut text, from.study);

    question(&mut text, 4, "Conditions: how many, which, who is given which");
    design::plan(&mut text, from, &naming);
    design::manipulated(&mut text, from, &naming);
    design::randomization(&mut text, from, &naming);

    question(&mut text, 5, "Analyses of the question or hypothesis");
    analysis::models(&mut text, from, &naming);
    analysis::criteria(&mut text, from);

    question(&mut text, 6, "Outliers and exclusions");
    analysis::data_exclusion(&mut text, from);
    analysis::missing_data(&mut text);

    question(&mut text, 7, "Sample size, and what decides it");
    size(&mut text, from);
    stopping_rule(&mut text, from);
    rationale(&mut text, from);
    if wanted(from).is_none() {
        text.line("[Say why this number.]\n");
    }

    question(&mut text, 8, "Anything else: secondary and exploratory analyses");
    analysis::exploratory(&mut text);
    collection(&mut text, from);
    text.line(&format!(
        "Version {} of the study file (SHA-256 `{}`).\n",
        meta.version, from.config_hash
    ));

    question(&mut text, 9, "Title");
    text.line(&format!("{title}\n"));
    question(&mut text, 10, "Kind of study");
    text.line("Experiment.\n");
    question(&mut text, 11, "Where the data come from");
    text.line("[Say which service or list of people: Prolific, Mechanical Turk, a university’s list, other.]\n");
    simulation(&mut text, from);
    text.text
}

fn question(text: &mut Text, number: usize, words: &str) {
    text.line(&format!("## {number}) {words}\n"));
}
