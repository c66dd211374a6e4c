//! What a report says of answers that were given to another version of the study.

use mimique_locale::Language;

use crate::trials::versions::{Difference, OtherVersion, Part};

/// A warning about one other version.
pub(crate) fn other_version(language: Language, version: &OtherVersion) -> String {
    let hash: String = version.config_hash.chars().take(12).collect();
    let people = language.counted(
        version.people,
        ["participant answered", "participants answered"],
        ["personne a répondu", "personnes ont répondu"],
    );
    let first = language.pick(
        format!("{people} another version of this study ({hash}) than the study file of this report."),
        format!("{people} à une autre version de cette étude ({hash}) que le fichier d’étude de ce rapport."),
    );
    let Some(differences) = &version.differences else {
        let unknown = language.pick(
            "The file of that version is not known here, so that it cannot be shown which rules, hypotheses and factors differ: analyse with the study file that was served, or give the files of all versions.",
            "Le fichier de cette version n’est pas connu ici ; les règles, hypothèses et facteurs qui diffèrent ne peuvent être montrés : analysez avec le fichier d’étude qui a été servi, ou donnez les fichiers de toutes les versions.",
        );
        return format!("{first} {unknown}");
    };
    if differences.is_empty() {
        let none = language.pick(
            "Its rules, hypotheses and factors are the same.",
            "Ses règles, hypothèses et facteurs sont les mêmes.",
        );
        return format!("{first} {none}");
    }
    let differing = differences.iter().map(|own| difference(language, own));
    let differing: Vec<String> = differing.collect();
    let colon = language.pick(":", " :");
    let heading = language.pick("What differs", "Ce qui diffère");
    let separator = language.pick("; ", " ; ");
    format!("{first} {heading}{colon} {}.", differing.join(separator))
}

fn difference(language: Language, own: &Difference) -> String {
    let of = match own.of {
        Part::Rule => language.pick("rule", "règle"),
        Part::Hypothesis => language.pick("hypothesis", "hypothèse"),
        Part::Factor => language.pick("factor", "facteur"),
    };
    let absent = || language.pick("absent", "absent").to_owned();
    let served = own.served.clone().unwrap_or_else(absent);
    let analysed = own.analysed.clone().unwrap_or_else(absent);
    language.pick(
        format!("{of} {} (served: {served}; here: {analysed})", own.name),
        format!("{of} {} (servie : {served} ; ici : {analysed})", own.name),
    )
}
