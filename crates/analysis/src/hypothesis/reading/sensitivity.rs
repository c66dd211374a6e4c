//! How much a verdict depends on choices of the analysis, on single segments and on single participants, in sentences.

use std::collections::BTreeMap;

use mimique_locale::Language;

use super::decision_in_words;
use crate::hypothesis::decision::EffectUnit;
use crate::naming::Naming;
use crate::sensitivity::{
    Change, Dependence, Direction, Finding, HypothesisSensitivity, Influence, Omission,
    OmittedUnit, TestChoice,
};
use crate::trials::measure::MeasureKind;
use crate::trials::rule::Rule;

/// So many dependences, and so many segments or participants, are named in a sentence; the tables have all.
const MOST_NAMED: usize = 5;

/// In how many specifications the verdict is the same, and on which choices it depends.
pub(crate) fn dependence(
    naming: &Naming<'_>,
    rules: &[Rule],
    own: &HypothesisSensitivity,
) -> String {
    let language = naming.language;
    let computed: Vec<&Finding> = (own.specifications.iter())
        .map(|each| &each.finding)
        .filter(|finding| finding.verdict.is_some())
        .collect();
    let (n, unknown) = (computed.len(), own.specifications.len() - computed.len());
    let study_file = own.of_the_study_file().map(|first| &first.finding);
    let Some(study_file) = study_file.filter(|finding| finding.verdict.is_some()) else {
        return without_verdict(naming, own, &computed);
    };
    if own.specifications.len() == 1 {
        return language
            .pick(
                "There is one specification only: the study file sets no rule of exclusion, and one test can decide this hypothesis.",
                "Il n’y a qu’une spécification : le fichier de l’étude ne fixe aucune règle d’exclusion, et un seul test peut décider cette hypothèse.",
            )
            .to_owned();
    }
    let same = computed.iter().filter(|finding| finding.verdict == study_file.verdict).count();
    let verdict = verdict_of(naming, own, study_file);
    let mut sentences = vec![language.pick(
        format!("With the rules and the test as fixed in the study file: {verdict} ({}). The verdict is the same in {same} of {n} specifications.", p_of(language, study_file)),
        format!("Avec les règles et le test tels que fixés dans le fichier de l’étude : {verdict} ({}). Le verdict est le même dans {same} spécifications sur {n}.", p_of(language, study_file)),
    )];
    if unknown > 0 {
        sentences.push(language.pick(
            format!("Not computable: {unknown} more."),
            format!("Non calculables : {unknown} de plus."),
        ));
    }
    if own.dependence.is_empty() {
        let words = language.pick(
            "The verdict depends on none of these choices.",
            "Le verdict ne dépend d’aucun de ces choix.",
        );
        sentences.push(words.to_owned());
    }
    let named = own.dependence.iter().take(MOST_NAMED);
    sentences.extend(named.map(|each| dependence_sentence(naming, rules, own, each)));
    if own.dependence.len() > MOST_NAMED {
        let more = own.dependence.len() - MOST_NAMED;
        sentences.push(language.pick(
            format!("Further combinations of choices change the verdict ({more}); they are in the table."),
            format!(
                "D’autres combinaisons de choix changent le verdict ({more}) ; elles sont dans le tableau."
            ),
        ));
    }
    sentences.join(" ")
}

/// The verdicts of the other specifications, where the study file's cannot be computed.
fn without_verdict(
    naming: &Naming<'_>,
    own: &HypothesisSensitivity,
    computed: &[&Finding],
) -> String {
    let language = naming.language;
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for finding in computed {
        *counts.entry(verdict_of(naming, own, finding)).or_insert(0) += 1;
    }
    let counts: Vec<String> = (counts.into_iter())
        .map(|(verdict, count)| {
            language.pick(format!("{verdict}: {count}"), format!("{verdict} : {count}"))
        })
        .collect();
    let all = own.specifications.len();
    let n = computed.len();
    let end = if counts.is_empty() {
        ".".to_owned()
    } else {
        format!(" ({}).", counts.join(language.pick("; ", " ; ")))
    };
    language.pick(
        format!("With the rules and the test as fixed in the study file there is no verdict. {n} of {all} specifications have one{end}"),
        format!("Avec les règles et le test tels que fixés dans le fichier de l’étude, il n’y a pas de verdict. {n} spécifications sur {all} en ont un{end}"),
    )
}

fn dependence_sentence(
    naming: &Naming<'_>,
    rules: &[Rule],
    own: &HypothesisSensitivity,
    dependence: &Dependence,
) -> String {
    let language = naming.language;
    let finding = &own.specifications[dependence.specification].finding;
    let then = format!("{} ({})", verdict_of(naming, own, finding), p_of(language, finding));
    let rule =
        |place: usize| rules.get(place).map_or_else(String::new, |it| it.words(language, ""));
    match dependence.changes.as_slice() {
        [Change::WithoutRule(place)] => {
            let rule = rule(*place);
            language.pick(
                format!(
                    "The verdict depends on the rule that excludes {rule}. Without it: {then}."
                ),
                format!("Le verdict dépend de la règle qui exclut {rule}. Sans elle : {then}."),
            )
        }
        [Change::Test(test)] => {
            let test = test_choice(language, own.kind, *test);
            language.pick(
                format!("The verdict depends on the test. By {test}: {then}."),
                format!("Le verdict dépend du test. Selon {test} : {then}."),
            )
        }
        changes => {
            let words = changes.iter().map(|change| match change {
                Change::WithoutRule(place) => language.pick(
                    format!("without the rule that excludes {}", rule(*place)),
                    format!("sans la règle qui exclut {}", rule(*place)),
                ),
                Change::Test(test) => {
                    let test = test_choice(language, own.kind, *test);
                    language.pick(format!("by {test}"), format!("selon {test}"))
                }
            });
            let words = words.collect::<Vec<_>>().join(language.pick(" and ", " et "));
            language.pick(
                format!("The verdict depends on several choices together ({words}): {then}."),
                format!("Le verdict dépend de plusieurs choix réunis ({words}) : {then}."),
            )
        }
    }
}

/// Which segments or participants change the verdict when they are omitted.
pub(crate) fn influence(
    naming: &Naming<'_>,
    own: &HypothesisSensitivity,
    influence: &Influence,
) -> String {
    let language = naming.language;
    let has_verdict = own.of_the_study_file().is_some_and(|own| own.finding.verdict.is_some());
    if !has_verdict {
        return String::new();
    }
    let n = influence.omissions.len();
    let [one, many] = match influence.unit {
        OmittedUnit::Segment => [language.pick("segment", "le segment"), "segments"],
        OmittedUnit::Participant => {
            [language.pick("participant", "le participant"), "participants"]
        }
    };
    let changing: Vec<&Omission> = own.changing(influence).collect();
    if changing.is_empty() {
        return language.pick(
            format!("None of the {n} {many} changes the verdict when omitted."),
            format!("Aucun des {n} {many} ne change le verdict quand il est omis."),
        );
    }
    let named = changing.iter().take(MOST_NAMED).map(|each| {
        let verdict = verdict_of(naming, own, &each.finding);
        let p = p_of(language, &each.finding);
        language.pick(
            format!("without {one} {}: {verdict} ({p})", each.omitted),
            format!("sans {one} {} : {verdict} ({p})", each.omitted),
        )
    });
    let named = named.collect::<Vec<_>>().join(language.pick("; ", " ; "));
    let count = changing.len();
    let more = match count.saturating_sub(MOST_NAMED) {
        0 => "",
        _ => language.pick("; the others are in the table", " ; les autres sont dans le tableau"),
    };
    language.pick(
        format!("The verdict depends on {count} of the {n} {many}: {named}{more}."),
        format!("Le verdict dépend de {count} des {n} {many} : {named}{more}."),
    )
}

/// A verdict with its direction, in the middle of a sentence.
pub(crate) fn verdict_of(
    naming: &Naming<'_>,
    own: &HypothesisSensitivity,
    finding: &Finding,
) -> String {
    let language = naming.language;
    let Some(verdict) = &finding.verdict else {
        return language.pick("not computable", "non calculable").to_owned();
    };
    let words = decision_in_words(language, verdict.decision);
    let is_chosen =
        (finding.estimate.as_ref()).is_some_and(|own| own.unit == Some(EffectUnit::Chosen));
    match &verdict.direction {
        None => words.to_owned(),
        Some(Direction::Higher(level)) => {
            let level = naming.level(&own.factor, level);
            let how = match is_chosen {
                true => language.pick("is chosen more often", "est choisi plus souvent"),
                false => language.pick("is higher", "est plus élevé"),
            };
            format!("{words}, {level} {how}")
        }
        Some(Direction::Rising) => format!("{words}, {}", language.pick("positive", "positive")),
        Some(Direction::Falling) => format!("{words}, {}", language.pick("negative", "négative")),
    }
}

fn p_of(language: Language, finding: &Finding) -> String {
    finding.p.map_or_else(String::new, |p| language.p(p))
}

/// A test, with what it is about, after "by".
pub(crate) fn test_choice(language: Language, kind: MeasureKind, test: TestChoice) -> &'static str {
    match test {
        TestChoice::LinearModel => language.pick(
            "the linear mixed model (other clips)",
            "le modèle linéaire mixte (autres extraits)",
        ),
        TestChoice::MinF => language.pick("min F' (other clips)", "min F' (autres extraits)"),
        TestChoice::PersonMeans if kind == MeasureKind::Choice => {
            language.pick("the choices of each person", "les choix de chaque personne")
        }
        TestChoice::PersonMeans => language.pick(
            "the test of person means (these clips)",
            "le test des moyennes par personne (ces extraits)",
        ),
        TestChoice::EquivalenceOfModel => language.pick(
            "two one-sided t tests of the linear mixed model (other clips)",
            "deux tests t unilatéraux du modèle linéaire mixte (autres extraits)",
        ),
        TestChoice::EquivalenceOfRanks => {
            language.pick("two one-sided tests of ranks", "deux tests unilatéraux sur les rangs")
        }
        TestChoice::EquivalenceOfMeans => {
            language.pick("two one-sided t tests", "deux tests t unilatéraux")
        }
    }
}

/// A test in two words.
pub(crate) fn test_choice_short(
    language: Language,
    kind: MeasureKind,
    test: TestChoice,
) -> &'static str {
    match test {
        TestChoice::LinearModel => language.pick("linear model", "modèle linéaire"),
        TestChoice::MinF => "min F'",
        TestChoice::PersonMeans if kind == MeasureKind::Choice => language.pick("choices", "choix"),
        TestChoice::PersonMeans => language.pick("person means", "moyennes"),
        TestChoice::EquivalenceOfModel => language.pick("linear model", "modèle linéaire"),
        TestChoice::EquivalenceOfRanks => language.pick("ranks", "rangs"),
        TestChoice::EquivalenceOfMeans => "t",
    }
}
