//! How many segments and people a comparison within participants rests on, and whether trials were excluded more often at
//! one level than at another.

use crate::naming::Naming;
use crate::trials::exclusion_rates::ExclusionRates;
use crate::trials::matching::Matching;

/// How many matched sets remain; `None` where every answer at a level is compared.
pub(crate) fn unmatched(naming: &Naming<'_>, matching: &Matching) -> Option<String> {
    let language = naming.language;
    if matching.answers_unmatched == 0 || matching.by.is_empty() {
        return None;
    }
    let shown = matching.sets_shown;
    let [least, most] = matching.sets_left;
    let left = if least == most { most.to_string() } else { format!("{least}–{most}") };
    let names = matching.by.iter().map(|name| match name.as_str() {
        "segment" => "segment".to_owned(),
        factor => naming.factor(factor),
    });
    let names: Vec<String> = names.collect();
    let names = names.join(" × ");
    let people = language.counted(
        matching.people,
        ["participant", "participants"],
        ["personne", "personnes"],
    );
    let answers = language.counted(
        matching.answers_unmatched,
        ["answer is not compared", "answers are not compared"],
        ["réponse n’est pas comparée", "réponses ne sont pas comparées"],
    );
    let mut words = language.pick(
        format!("Each participant is compared only on what remains at every level, matched by {names}: {left} of {shown} matched sets per participant, {people}; {answers}."),
        format!("Chaque personne n’est comparée que sur ce qui reste à tous les niveaux, apparié par {names} : {left} ensembles appariés sur {shown} par personne, {people} ; {answers}."),
    );
    if matching.people_without > 0 {
        words.push(' ');
        words += &language.counted(
            matching.people_without,
            [
                "participant has no matched set and is not compared.",
                "participants have no matched set and are not compared.",
            ],
            [
                "personne n’a aucun ensemble apparié et n’est pas comparée.",
                "personnes n’ont aucun ensemble apparié et ne sont pas comparées.",
            ],
        );
    }
    Some(words)
}

/// A warning that trials are excluded more often at some levels of a factor.
pub(crate) fn unequal_exclusion(naming: &Naming<'_>, rates: &ExclusionRates, p: f64) -> String {
    let language = naming.language;
    let factor = naming.factor(&rates.factor);
    let levels = rates.counts.iter().map(|(level, [excluded, all])| {
        let level = naming.level(&rates.factor, level);
        let share = language.percent(*excluded as f64 / *all as f64);
        language.pick(
            format!("{level} {share} ({excluded} of {all})"),
            format!("{level} {share} ({excluded} sur {all})"),
        )
    });
    let levels: Vec<String> = levels.collect();
    let levels = levels.join(", ");
    let p = language.p(p);
    if rates.between_people {
        return language.pick(
            format!("The rules exclude trials more often in some conditions than in others: {levels}; {p}, one exclusion rate per participant. The conditions may differ because other trials remain: check the result without the rule."),
            format!("Les règles excluent plus souvent des essais dans certaines conditions que dans d’autres : {levels} ; {p}, un taux d’exclusion par personne. Les conditions peuvent différer parce que d’autres essais restent : vérifiez le résultat sans la règle."),
        );
    }
    language.pick(
        format!("The rules exclude trials more often at some levels of {factor} than at others: {levels}; {p}, one exclusion rate per participant and level. Comparisons within participants use only what remains at every level, but the trials that remain may differ from those that were excluded: check the result without the rule."),
        format!("Les règles excluent plus souvent des essais à certains niveaux du facteur {factor} qu’à d’autres : {levels} ; {p}, un taux d’exclusion par personne et par niveau. Les comparaisons intra-individuelles n’utilisent que ce qui reste à tous les niveaux, mais les essais restants peuvent différer de ceux qui ont été exclus : vérifiez le résultat sans la règle."),
    )
}
