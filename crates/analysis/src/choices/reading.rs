//! Choices between the levels of a factor in plain words.

use mimique_locale::{Language, counted_as, counted_in_french};
use mimique_stats::{Outcome, WorthContrast, WorthEstimates};

use super::preference::{Preference, preference};
use super::tested::ChoiceTests;
use crate::hypothesis::test_line::{TestLine, Unit};
use crate::naming::Naming;
use crate::naming::people_counted;

/// The level of a test.
const LEVEL: f64 = 0.05;
/// Pairs that are each told.
const MOST_PAIRS: usize = 6;

/// What the choices say.
pub(crate) fn choices(
    naming: &Naming<'_>,
    found: &ChoiceTests,
    factor: &str,
    label: &str,
) -> String {
    let language = naming.language;
    let line = match found.recommended.overall.last() {
        Some(Outcome::Ok(line)) => line,
        Some(Outcome::Undefined { reason }) => {
            let why = reason.words(language);
            let mut words = language.pick(
                format!("“{label}”: no test is defined ({why})."),
                format!("« {label} » : aucun test n’est défini ({why})."),
            );
            if found.worths.as_ref().is_some_and(|worths| worths.penalised.is_some()) {
                words += language.pick(
                    " The worths that are given are penalised estimates, without intervals and p.",
                    " Les valeurs données sont des estimations pénalisées, sans intervalles ni p.",
                );
            }
            return words;
        }
        None => return String::new(),
    };
    let estimates = found.worths.as_ref().and_then(|worths| match &worths.estimates {
        Outcome::Ok(estimates) => Some(estimates),
        Outcome::Undefined { .. } => None,
    });
    if found.levels.len() == 2 {
        return of_two(naming, found, estimates, factor, (label, line));
    }
    let mut sentences = vec![overall(naming, factor, label, line)];
    let is_shown = line.p_that_counts() < LEVEL;
    if let Some(Preference::Ranking(levels)) = preference(found).filter(|_| is_shown) {
        let levels: Vec<String> =
            levels.iter().map(|own| naming.level(factor, &own.level)).collect();
        let levels = levels.join(", ");
        sentences.push(language.pick(
            format!("From the most to the least chosen: {levels}."),
            format!("Du plus au moins choisi : {levels}."),
        ));
    }
    if let Some(estimates) = estimates {
        sentences.extend(pairs(naming, factor, estimates));
    }
    sentences.join(" ")
}

/// The test of two levels, and how often each was chosen.
fn of_two(
    naming: &Naming<'_>,
    found: &ChoiceTests,
    estimates: Option<&WorthEstimates>,
    factor: &str,
    (label, line): (&str, &TestLine),
) -> String {
    let language = naming.language;
    let [for_first, for_second] = found.people_for.unwrap_or_default();
    let first = for_first >= for_second;
    let contrast = estimates.and_then(|estimates| estimates.contrasts.first());
    let names = [&found.levels[0], &found.levels[1]].map(|level| naming.level(factor, level));
    let [more, less] = if first { [&names[0], &names[1]] } else { [&names[1], &names[0]] };
    let (for_more, n) = (for_first.max(for_second), for_first + for_second);
    let how_often = contrast.map_or_else(String::new, |contrast| {
        let share = chosen_in(language, contrast, first);
        language.pick(
            format!(" in {share} of decided choices,"),
            format!(" dans {share} des choix tranchés,"),
        )
    });
    let people = language.pick(
        format!(
            "more often by {for_more} of {} who did not choose both equally often",
            people_counted(language, n)
        ),
        format!(
            "plus souvent par {for_more} sur {} ayant choisi l’un des deux plus souvent",
            people_counted(language, n)
        ),
    );
    let p = language.p(line.p_that_counts());
    if line.p_that_counts() < LEVEL {
        return language.pick(
            format!("“{label}”: {more} is chosen over {less}{how_often} {people}; sign test of people, {p}."),
            format!("« {label} » : {more} est préféré à {less}{how_often} {people} ; test du signe sur les personnes, {p}."),
        );
    }
    language.pick(
        format!("“{label}”: that {more} and {less} are not chosen equally often was not shown: {more} was chosen{how_often} {people}; sign test of people, {p}; that is no proof that they are."),
        format!("« {label} » : que {more} et {less} ne soient pas choisis aussi souvent n’a pas été montré : {more} a été choisi{how_often} {people} ; test du signe sur les personnes, {p} ; cela ne prouve pas qu’ils le soient."),
    )
}

/// The test of several levels.
fn overall(naming: &Naming<'_>, factor: &str, label: &str, line: &TestLine) -> String {
    let language = naming.language;
    let what = naming.factor(factor);
    let how = match line.unit {
        Unit::WinsOfPeople => language.pick(
            "Friedman’s test on each person’s wins, since people are few",
            "test de Friedman sur les victoires de chaque personne, celles-ci étant peu nombreuses",
        ),
        _ => language.pick(
            "worths by the Bradley-Terry model, errors clustered by participant",
            "valeurs selon le modèle de Bradley-Terry, erreurs groupées par participant",
        ),
    };
    let effect = line.row.effect.map_or_else(|| "–".to_owned(), |effect| language.fixed(effect, 2));
    let effect = match line.unit {
        Unit::WinsOfPeople => format!("{} = {effect}", line.names.effect_symbol),
        _ => language.pick(
            format!("worths span {effect} just noticeable differences"),
            format!("les valeurs s’étendent sur {effect} différences juste perceptibles"),
        ),
    };
    let numbers = format!(
        "{}{} = {}, {}, {effect}",
        line.names.statistic,
        line.degrees_in_brackets(),
        language.number(line.row.statistic),
        language.p(line.p_that_counts()),
    );
    let n = line.row.n;
    if line.p_that_counts() < LEVEL {
        return language.pick(
            format!("“{label}”: the levels of {what} are not chosen equally often: {numbers}, {} ({how}).", people_counted(language, n)),
            format!("« {label} » : les niveaux du facteur {what} ne sont pas choisis aussi souvent : {numbers}, {} ({how}).", people_counted(language, n)),
        );
    }
    language.pick(
        format!("“{label}”: that the levels of {what} are not chosen equally often was not shown: {numbers}, {} ({how}); that is no proof that they are.", people_counted(language, n)),
        format!("« {label} » : que les niveaux du facteur {what} ne soient pas choisis aussi souvent n’a pas été montré : {numbers}, {} ({how}) ; cela ne prouve pas qu’ils le soient.", people_counted(language, n)),
    )
}

/// Each pair, or of many those that differ.
fn pairs(naming: &Naming<'_>, factor: &str, estimates: &WorthEstimates) -> Vec<String> {
    let language = naming.language;
    let many = estimates.contrasts.len() > MOST_PAIRS;
    let mut sentences = Vec::new();
    let mut open = Vec::new();
    for contrast in &estimates.contrasts {
        let names = [&contrast.a, &contrast.b].map(|level| naming.level(factor, level));
        let Some(p) = contrast.p_holm else { continue };
        if p >= LEVEL {
            open.push(names.join(" – "));
            continue;
        }
        let first = contrast.difference > 0.0;
        let [more, less] = if first { [&names[0], &names[1]] } else { [&names[1], &names[0]] };
        let share = chosen_in(language, contrast, first);
        let p = language.p(p);
        sentences.push(language.pick(
            format!("{more} is chosen over {less} in {share} of decided choices ({p}, Holm)."),
            format!("{more} est préféré à {less} dans {share} des choix tranchés ({p}, Holm)."),
        ));
    }
    if !open.is_empty() && !many {
        let open = open.join(", ");
        sentences.push(language.pick(
            format!("No preference was shown between {open}."),
            format!("Aucune préférence n’a été montrée entre {open}."),
        ));
    } else if !open.is_empty() {
        let count = open.len();
        sentences.push(language.pick(
            format!(
                "No preference was shown in {}.",
                counted_as(count, "other pair", "other pairs")
            ),
            format!(
                "Aucune préférence n’a été montrée pour {}.",
                counted_in_french(count, "autre paire", "autres paires")
            ),
        ));
    }
    sentences
}

/// `72 % (62–81)`: the share of choices of one of two where one was chosen.
pub(crate) fn chosen_in(language: Language, contrast: &WorthContrast, of_a: bool) -> String {
    let own = |share: f64| if of_a { share } else { 1.0 - share };
    let share = language.percent(own(contrast.preferred));
    let Some(ends) = contrast.preferred_interval else { return share };
    let [low, high] = if of_a { ends } else { [ends[1], ends[0]] };
    format!("{share} ({:.0}–{:.0})", 100.0 * own(low), 100.0 * own(high))
}
