//! Tables of tests: as in the thesis beside recommended.

use mimique_locale::Language;
use mimique_report::document::DataTable;
use mimique_stats::{Labelled, MixedModel, Outcome, Proportion, Term, TestResult as _};

use crate::hypothesis::call::Design;
use crate::hypothesis::comparison::Comparison;
use crate::hypothesis::other_clips::OtherClips;
use crate::hypothesis::person_level::{Pair, PersonLevel};
use crate::hypothesis::reading;
use crate::hypothesis::trial_level::TrialLevel;
use crate::hypothesis::undefined::TestOutcome;
use crate::naming::Naming;
use crate::trials::measure::MeasureKind;

/// Cells of one test: what was computed, p without correction, effect.
pub(crate) fn cells(language: Language, outcome: &TestOutcome) -> [String; 3] {
    match outcome {
        Outcome::Undefined { reason } => [
            format!("{}{}", language.pick("undefined: ", "non défini : "), reason.words(language)),
            String::new(),
            String::new(),
        ],
        Outcome::Ok(line) => [
            format!(
                "{} {}{} = {}, n = {}",
                Some(line.names.short)
                    .filter(|short| *short != line.names.statistic_symbol)
                    .unwrap_or_default(),
                line.names.statistic_symbol,
                line.degrees_in_brackets(),
                language.number(line.row.statistic),
                line.row.n
            )
            .trim_start()
            .to_owned(),
            language.p_cell(line.row.p_value, line.row.ln_p),
            line.row.effect.map_or_else(String::new, |effect| {
                format!("{} = {}", line.names.effect_symbol, language.fixed(effect, 2))
            }),
        ],
    }
}

fn difference(language: Language, kind: MeasureKind, pair: &Pair) -> String {
    pair.difference.map_or_else(String::new, |d| {
        let [estimate, low, high] = [d.estimate, d.ci_low, d.ci_high]
            .map(|value| reading::difference(language, kind, value));
        format!("{estimate} [{low}; {high}]")
    })
}

fn difference_heading(language: Language, kind: MeasureKind) -> String {
    let unit = match kind {
        MeasureKind::Recognition => language.pick(" (points of %)", " (points de %)"),
        MeasureKind::ResponseTime => " (s)",
        MeasureKind::Rating | MeasureKind::Choice => "",
    };
    language.pick(format!("difference{unit} [95 %]"), format!("différence{unit} [95 %]"))
}

/// Over tests of trials.
pub(crate) fn thesis_heading(language: Language) -> &'static str {
    language.pick(
        "As in the thesis (assumes independent observations)",
        "Comme dans la thèse (suppose des observations indépendantes)",
    )
}

/// Over tests of people.
pub(crate) fn recommended_heading(language: Language) -> &'static str {
    language.pick(
        "Recommended, of these clips (one value a person)",
        "Recommandé, pour ces extraits (une valeur par personne)",
    )
}

/// Both kinds of test of one measure and factor, line by line beside each other.
pub(crate) fn two_columns(
    naming: &Naming<'_>,
    id: String,
    caption: String,
    factor: &str,
    kind: MeasureKind,
    trials: &TrialLevel,
    people: &PersonLevel,
) -> DataTable {
    let language = naming.language;
    let heading = language.pick(
        ["", "test", "p", "effect", "test", "p", "p (Holm)", "effect"],
        ["", "test", "p", "effet", "test", "p", "p (Holm)", "effet"],
    );
    let last = difference_heading(language, kind);
    let mut table =
        DataTable::new(id, caption, heading.into_iter().map(str::to_owned).chain([last]));
    table.groups = vec![
        (String::new(), 1),
        (thesis_heading(language).to_owned(), 3),
        (recommended_heading(language).to_owned(), 5),
    ];
    let recommended = recommended_lines(naming, factor, kind, people, PAIRS_BESIDE);
    // With two levels the paired test of trials stands beside the pair.
    let mut of_trials: Vec<&TestOutcome> = trials.tests.iter().collect();
    if people.overall.is_empty() {
        of_trials.reverse();
    }
    for place in 0..of_trials.len().max(recommended.len()) {
        let label = match (recommended.get(place), of_trials.get(place)) {
            (Some((label, ..)), _) => label.clone(),
            (None, Some(outcome)) => term_of(naming, factor, outcome),
            (None, None) => String::new(),
        };
        let mut row = vec![label];
        match of_trials.get(place) {
            Some(outcome) => row.extend(cells(language, outcome)),
            None => row.extend([String::new(), String::new(), String::new()]),
        }
        match recommended.get(place) {
            Some((_, outcome, difference)) => {
                let [test, p, effect] = cells(language, outcome);
                // A pair alone is corrected for nothing.
                let corrected = match people.pairs.len() {
                    1 => String::new(),
                    _ => corrected_cell(language, outcome),
                };
                row.extend([test, p, corrected, effect, difference.clone()]);
            }
            None => row.extend([const { String::new() }; 5]),
        }
        table.row(row);
    }
    // Interactions and many levels have no differences to show, and one test alone is not corrected.
    drop_if_empty(&mut table, DIFFERENCE);
    drop_if_empty(&mut table, CORRECTED);
    table
}

/// Columns of the table of both kinds of test, as it is built.
const CORRECTED: usize = 6;
const DIFFERENCE: usize = 8;

/// p after Holm's correction over several tests, where there was one.
pub(crate) fn corrected_cell(language: Language, outcome: &TestOutcome) -> String {
    match outcome {
        Outcome::Ok(line) => line.p_holm.map_or_else(String::new, |p| language.p_cell(p, p.ln())),
        Outcome::Undefined { .. } => String::new(),
    }
}

/// Over tests of choices between two clips, which do not take one value per person.
pub(crate) fn headings_of_choices(language: Language, table: &mut DataTable) {
    let headings = language.pick(
        ["Assumes independent answers", "Recommended (each person’s answers belong together)"],
        [
            "Suppose des réponses indépendantes",
            "Recommandé (les réponses d’une personne vont ensemble)",
        ],
    );
    for (group, heading) in table.groups.iter_mut().skip(1).zip(headings) {
        group.0 = heading.to_owned();
    }
}

/// Label, test and difference of each recommended test, as those of trials stand: overall first, then
/// pairs, unless there are more than so many.
pub(crate) fn recommended_lines<'p>(
    naming: &Naming<'_>,
    factor: &str,
    kind: MeasureKind,
    people: &'p PersonLevel,
    most_pairs: usize,
) -> Vec<(String, &'p TestOutcome, String)> {
    let overall = people
        .overall
        .iter()
        .map(|outcome| (term_of(naming, factor, outcome), outcome, String::new()));
    let beside = if people.pairs.len() > most_pairs { &[] } else { people.pairs.as_slice() };
    let pairs = beside.iter().map(|pair| {
        (
            naming.pair(factor, &pair.a, &pair.b),
            &pair.wilcoxon,
            difference(naming.language, kind, pair),
        )
    });
    overall.chain(pairs).collect()
}

/// Takes a column of recommended tests off that has nothing in it.
fn drop_if_empty(table: &mut DataTable, column: usize) {
    if table.rows.iter().all(|row| row[column].is_empty()) {
        table.columns.remove(column);
        table.rows.iter_mut().for_each(|row| drop(row.remove(column)));
        table.groups[2].1 -= 1;
    }
}

/// Tests of other clips too, as a table of their own below.
pub(crate) fn other_clips(
    naming: &Naming<'_>,
    id: String,
    caption: String,
    factor: &str,
    found: &OtherClips,
) -> DataTable {
    let language = naming.language;
    let heading = language.pick(
        ["For other clips", "test", "p", "effect [95 %]", "first is higher of two"],
        ["Pour d’autres extraits", "test", "p", "effet [95 %]", "la première plus haute de deux"],
    );
    let mut table = DataTable::new(id, caption, heading);
    let whole = naming.factor(factor);
    let name = language.pick("linear mixed model", "modèle linéaire mixte");
    match &found.linear_model {
        None => {}
        Some(Outcome::Ok(model)) => {
            let test =
                format!("{name} {}, n = {}", reading::f_of(language, model), model.observations);
            let p = language.p_cell(model.p, model.ln_p);
            table.row([whole.clone(), test, p, String::new(), String::new()]);
            for pair in &model.pairs {
                let [low, high] = pair.interval_95.map(|end| language.fixed(end, 2));
                table.row([
                    naming.pair(factor, &pair.a, &pair.b),
                    format!("{name}, Holm"),
                    language.p_cell(pair.p_corrected, pair.p_corrected.ln()),
                    format!("{} [{low}; {high}]", language.fixed(pair.difference, 2)),
                    String::new(),
                ]);
            }
        }
        Some(Outcome::Undefined { reason }) => {
            let undefined = language.pick("no result: ", "sans résultat : ");
            let test = format!("{name}, {undefined}{}", reason.words(language));
            table.row([whole.clone(), test, String::new(), String::new(), String::new()]);
        }
    }
    let names = MixedModel::NAMES;
    let name = language.pick("cumulative mixed model", "modèle mixte cumulatif");
    match &found.mixed_model {
        None => {}
        Some(Outcome::Ok(model)) => {
            let test = format!(
                "{name} {}({}) = {}, n = {}",
                names.statistic_symbol,
                model.df,
                language.number(model.likelihood_ratio),
                model.observations
            );
            let p = language.p_cell(model.p, model.ln_p);
            table.row([whole.clone(), test, p, String::new(), String::new()]);
            for pair in &model.pairs {
                // The model's odds are those at the second level; pairs are told as elsewhere, the first level first.
                let [low, high] = pair.interval_95;
                let [odds, low, high] =
                    [pair.odds_ratio, high, low].map(|value| language.fixed(1.0 / value, 2));
                table.row([
                    naming.pair(factor, &pair.a, &pair.b),
                    format!("{name}, Holm"),
                    language.p_cell(pair.p_corrected, pair.p_corrected.ln()),
                    format!("{} = {odds} [{low}; {high}]", names.effect_symbol),
                    language.percent(1.0 - pair.higher),
                ]);
            }
        }
        Some(Outcome::Undefined { reason }) => {
            let undefined = language.pick("no result: ", "sans résultat : ");
            let test = format!("{name}, {undefined}{}", reason.words(language));
            table.row([whole.clone(), test, String::new(), String::new(), String::new()]);
        }
    }
    if let Some(min_f) = &found.min_f {
        let [test, p, effect] = cells(language, min_f);
        table.row([whole, test, p, effect, String::new()]);
    }
    table
}

/// More pairs than this stand in a table of their own, below.
const PAIRS_BESIDE: usize = 3;

/// The pairs of a factor with many levels, recommended tests only; none where there are few.
pub(crate) fn many_pairs(
    naming: &Naming<'_>,
    id: String,
    factor: &str,
    kind: MeasureKind,
    people: &PersonLevel,
) -> Option<DataTable> {
    if people.pairs.len() <= PAIRS_BESIDE {
        return None;
    }
    let language = naming.language;
    let caption = language.pick(
        "All pairs (recommended: exact Wilcoxon on person means, Holm’s correction)",
        "Toutes les paires (recommandé : Wilcoxon exact sur les moyennes des personnes, correction de Holm)",
    );
    let heading = language.pick(["p (Holm)", "effect", "test"], ["p (Holm)", "effet", "test"]);
    let columns = [String::new(), difference_heading(language, kind)];
    let columns = columns.into_iter().chain(heading.map(str::to_owned));
    let mut table = DataTable::new(id, caption, columns);
    for pair in &people.pairs {
        let [test, _, effect] = cells(language, &pair.wilcoxon);
        let p = corrected_cell(language, &pair.wilcoxon);
        let label = naming.pair(factor, &pair.a, &pair.b);
        table.row([label, difference(language, kind, pair), p, effect, test]);
    }
    Some(table)
}

/// Standardised effect sizes of the recommended tests with their intervals; none where no test has one.
pub(crate) fn effect_sizes(
    naming: &Naming<'_>,
    id: String,
    factor: &str,
    people: &PersonLevel,
) -> Option<DataTable> {
    let language = naming.language;
    let caption = language.pick(
        "Standardised effect sizes (d_w counts participants without a difference; r of the tests does not)",
        "Tailles d’effet standardisées (d_w compte les personnes sans différence ; r des tests ne les compte pas)",
    );
    let heading = language.pick(
        ["", "effect size", "estimate", "95 % CI", "n"],
        ["", "taille d’effet", "estimation", "IC à 95 %", "n"],
    );
    let mut table = DataTable::new(id, caption, heading);
    for (label, outcome, _) in
        recommended_lines(naming, factor, MeasureKind::Rating, people, usize::MAX)
    {
        let Outcome::Ok(line) = outcome else { continue };
        for size in &line.effect_sizes {
            let number = |value: f64| reading::effect_size_number(language, size, value);
            let interval = size.interval_95.map(|ends| ends.map(number));
            let interval = interval.map_or_else(
                || "–".to_owned(),
                |[low, high]| format!("[{low}{} {high}]", language.pick(",", " ;")),
            );
            table.row([
                label.clone(),
                size.kind.symbol().to_owned(),
                number(size.estimate),
                interval,
                size.n.to_string(),
            ]);
        }
    }
    (!table.rows.is_empty()).then_some(table)
}

/// What a line is about: the factor, or the effect of two.
fn term_of(naming: &Naming<'_>, factor: &str, outcome: &TestOutcome) -> String {
    match outcome {
        Outcome::Ok(line) if line.call.design != Design::Columns => match &line.row.term {
            Term::Whole => naming.factor(factor),
            Term::Pair(groups) => groups.join(" − "),
            Term::Effect(factors) => naming.interaction(factors),
            term @ (Term::Differences(_) | Term::Relation(_)) => term.to_string(),
        },
        _ => naming.factor(factor),
    }
}

/// Right answers of each level.
pub(crate) fn recognition(
    naming: &Naming<'_>,
    id: String,
    caption: String,
    factor: &str,
    shares: &[(String, Proportion)],
    person_means: &Labelled<Option<f64>>,
) -> DataTable {
    let language = naming.language;
    let heading = language.pick(
        ["", "trials", "right", "share", "95 % interval (Wilson)", "mean share of people"],
        [
            "",
            "essais",
            "justes",
            "part",
            "intervalle à 95 % (Wilson)",
            "part moyenne des personnes",
        ],
    );
    let mut table = DataTable::new(id, caption, heading);
    for (level, share) in shares {
        let percent = |value: f64| format!("{} %", language.fixed(value * 100.0, 1));
        let mean = person_means.get(level).copied().flatten();
        table.row([
            naming.level(factor, level),
            share.n.to_string(),
            share.successes.to_string(),
            share.proportion.map_or_else(|| "–".to_owned(), percent),
            share.wilson.map_or_else(
                || "–".to_owned(),
                |[low, high]| format!("{} – {}", percent(low), percent(high)),
            ),
            mean.map_or_else(|| "–".to_owned(), percent),
        ]);
    }
    table
}

/// Description of each level.
pub(crate) fn descriptions(
    naming: &Naming<'_>,
    id: String,
    caption: String,
    result: &Comparison,
) -> DataTable {
    let language = naming.language;
    let heading = language.pick(
        ["", "trials", "mean", "sd", "median", "q1", "q3", "mean of person means"],
        ["", "essais", "moyenne", "écart type", "médiane", "q1", "q3", "moyenne des personnes"],
    );
    let mut table = DataTable::new(id, caption, heading);
    for (level, outcome) in result.descriptions.iter() {
        let mut cells = vec![naming.level(&result.factor, level)];
        match outcome {
            Outcome::Ok(d) => {
                cells.push(d.n.to_string());
                cells.push(language.fixed(d.mean, 2));
                cells.push(d.sd.map_or_else(|| "–".to_owned(), |sd| language.fixed(sd, 2)));
                cells.extend([d.median, d.q1, d.q3].map(|value| language.number(value)));
            }
            Outcome::Undefined { .. } => {
                cells.extend(["0", "–", "–", "–", "–", "–"].map(str::to_owned));
            }
        }
        let mean = result.person_means.get(level).copied().flatten();
        cells.push(mean.map_or_else(|| "–".to_owned(), |mean| language.fixed(mean, 2)));
        table.row(cells);
    }
    table
}
