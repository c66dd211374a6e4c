//! Analysis plan and exclusions in words. What is said here is what `report::hypothesis` computes.

use std::collections::BTreeSet;

use mimique_locale::Language;
use mimique_stats::{
    ChiSquare, EquivalenceOfGroups, Friedman, KruskalWallis, LinearMixedModel, MannWhitney,
    ScheirerRayHare, Sign, Spearman, TestNames, TestResult, WORTHS_RATIO, Wilcoxon,
};
use mimique_study::{Hypothesis, KindOfQuestion as _, Measure, Study, TestName};

use super::{Preregistration, Text, equivalence, faces, levels, scaling};
use crate::hypothesis::is_two_way;
use crate::naming::Naming;
use crate::simulate::{factor_levels, traits};
use crate::trials::rule::Rule;

pub(super) fn write(text: &mut Text, from: &Preregistration<'_>, naming: &Naming<'_>) {
    text.heading(2, "Analysis plan", "Plan d’analyse");
    text.heading(3, "Statistical models", "Modèles statistiques");
    models(text, from, naming);
    text.heading(3, "Transformations", "Transformations");
    text.both(
        "None, beyond the means a person and level above. Ratings are used as coded on the scale.",
        "Aucune, au-delà des moyennes par personne et niveau ci-dessus. Les notes sont utilisées telles que codées sur l’échelle.",
    );
    text.heading(3, "Inference criteria", "Critères d’inférence");
    criteria(text, from);
    text.heading(3, "Data exclusion", "Exclusion de données");
    data_exclusion(text, from);
    text.heading(3, "Missing data", "Données manquantes");
    missing_data(text);
    text.heading(3, "Exploratory analysis", "Analyses exploratoires");
    exploratory(text);
}

/// The test of each hypothesis, and what blocks tell that no hypothesis tests.
pub(super) fn models(text: &mut Text, from: &Preregistration<'_>, naming: &Naming<'_>) {
    let study = from.study;
    for hypothesis in &study.hypotheses {
        model(text, from, naming, hypothesis);
    }
    text.line("");
    levels::analysis(text, study);
    scaling::analysis(text, study);
    faces::analysis(text, study);
    text.both(
        "All are computed by `mimique analyze` on the export, with this study file.",
        "Tous sont calculés par `mimique analyze` sur l’export, avec ce fichier d’étude.",
    );
}

/// When a test is positive.
pub(super) fn criteria(text: &mut Text, from: &Preregistration<'_>) {
    let (language, study) = (from.language, from.study);
    let count = study.hypotheses.len();
    let alpha = language.number(from.power.alpha);
    let words = language.pick(
        format!("Two-sided tests at α = {alpha}, after Holm’s correction over the {count} hypotheses. Comparisons of pairs within a hypothesis are corrected by Holm among themselves. Effect sizes with 95 % intervals are reported whatever the outcome: rank-biserial correlation and Hodges-Lehmann difference of pairs, Kendall’s W of several levels, partial η² of the aligned rank transform. A test that is not significant is not taken as evidence that there is no difference."),
        format!("Tests bilatéraux à α = {alpha}, après correction de Holm sur les {count} hypothèses. Les comparaisons par paires au sein d’une hypothèse sont corrigées entre elles par Holm. Les tailles d’effet et leurs intervalles à 95 % sont rapportés quel que soit le résultat : corrélation bisériale des rangs et différence de Hodges-Lehmann pour les paires, W de Kendall pour plusieurs niveaux, η² partiel pour la transformation des rangs alignés. Un test non significatif n’est pas pris pour la preuve d’une absence de différence."),
    );
    text.line(&words);
    text.line("");
    equivalence::criteria(text, study);
}

/// Which people and trials are left out.
pub(super) fn data_exclusion(text: &mut Text, from: &Preregistration<'_>) {
    for rule in exclusions(from, from.language) {
        text.line(&format!("- {rule}"));
    }
    text.line("");
    text.both(
        "Each exclusion is counted by its reason in the report’s flow chart. There are no others.",
        "Chaque exclusion est comptée par motif dans le diagramme de flux du rapport. Il n’y en a pas d’autre.",
    );
}

/// What becomes of people without a value.
pub(super) fn missing_data(text: &mut Text) {
    text.both(
        "A person without a value at every level that a test compares is left out of that test and counted. Nothing is imputed.",
        "Une personne sans valeur à chacun des niveaux qu’un test compare est écartée de ce test et comptée. Rien n’est imputé.",
    );
}

/// What is not tested.
pub(super) fn exploratory(text: &mut Text) {
    text.both(
        "Everything else in the report (confusion matrices, other factors, response times, order and fatigue, late frames) is exploratory and will be called so. With one clip for a combination of performance and method, tests of person means are about these clips: they do not generalise to other performances.",
        "Tout le reste du rapport (matrices de confusion, autres facteurs, temps de réponse, ordre et fatigue, images en retard) est exploratoire et sera présenté comme tel. Avec un seul extrait par combinaison de performance et de méthode, les tests sur les moyennes des personnes portent sur ces extraits : ils ne se généralisent pas à d’autres performances.",
    );
}

/// Model of a hypothesis: what is compared, which test decides, and the one of the thesis.
fn model(
    text: &mut Text,
    from: &Preregistration<'_>,
    naming: &Naming<'_>,
    hypothesis: &Hypothesis,
) {
    let language = from.language;
    let setting = Setting::of(from.study, hypothesis);
    let recommended = recommended_test(language, hypothesis, &setting);
    let thesis = test_of_the_thesis(language, hypothesis, &setting);
    let factors: Vec<String> = hypothesis.factors.iter().map(|each| naming.factor(each)).collect();
    let of = match hypothesis.measure {
        Measure::Answer => format!("`{}`", hypothesis.response),
        Measure::Correct => language.pick(
            format!("right answers to `{}`", hypothesis.response),
            format!("bonnes réponses à `{}`", hypothesis.response),
        ),
        Measure::Rt => language.pick(
            format!("response time of `{}`", hypothesis.response),
            format!("temps de réponse à `{}`", hypothesis.response),
        ),
    };
    let by = factors.join(" × ");
    text.line(&format!("- **{}** ({of}, {by}){}", hypothesis.id, language.pick(":", " :")));
    if !hypothesis.levels.is_empty() {
        let levels: Vec<String> = hypothesis
            .levels
            .iter()
            .map(|level| naming.level(&hypothesis.factors[0], &level.to_string()))
            .collect();
        let words = language.pick("levels compared: ", "niveaux comparés : ");
        text.line(&format!("  - {words}{}", levels.join(", ")));
    }
    equivalence::smallest_effect(text, language, hypothesis);
    let decides = language.pick("decides:", "décide :");
    if hypothesis.is_about_other_clips() {
        text.line(&format!("  - {decides} {}.", test_of_other_clips(language, hypothesis)));
        let beside =
            language.pick("beside it, of these clips alone:", "à côté, pour ces extraits seuls :");
        text.line(&format!("  - {beside} {recommended}."));
    } else {
        text.line(&format!("  - {decides} {recommended}."));
    }
    text.line(&format!(
        "  - {} {thesis}.",
        language.pick(
            "for comparison with earlier work, not evidence (trials of one person are not independent):",
            "pour comparaison avec les travaux antérieurs, sans valeur de preuve (les essais d’une personne ne sont pas indépendants) :"
        )
    ));
}

/// What of a study decides which tests a hypothesis gets.
struct Setting {
    /// Levels compared of the first factor.
    levels: usize,
    /// Whether the first factor is one of the clips.
    of_clips: bool,
    /// Whether the first factor is about people.
    is_trait: bool,
    /// How many of the first two factors are about people.
    traits_of_two: usize,
    /// Whether right answers are counted.
    recognition: bool,
}

impl Setting {
    fn of(study: &Study, hypothesis: &Hypothesis) -> Self {
        let factor = hypothesis.factors.first().map_or("", String::as_str);
        let asked = study.all_questions().find(|question| question.id == hypothesis.response);
        let chosen_between = asked.filter(|_| hypothesis.test.is_of_choices()).map(|question| {
            let pairs = study.levels_chosen_between(question, factor, &[]);
            pairs.iter().flatten().collect::<BTreeSet<_>>().len()
        });
        let levels = match hypothesis.levels.len() {
            0 if chosen_between.is_some() => chosen_between.unwrap_or_default(),
            0 => factor_levels(study, &study.clips()).get(factor).map_or(0, Vec::len),
            named => named,
        };
        let about_people = |factor: &str| {
            !study.factor_names().iter().any(|name| name == factor)
                && (traits(study).contains_key(factor)
                    || study.demographics.iter().flat_map(|p| &p.questions).any(|q| q.id == factor))
        };
        Self {
            levels,
            of_clips: study.factor_names().iter().any(|name| name == factor),
            is_trait: about_people(factor),
            traits_of_two: hypothesis.factors.iter().take(2).filter(|f| about_people(f)).count(),
            recognition: hypothesis.measure != Measure::Rt
                && asked.is_some_and(|question| question.kind.truth().is_some()),
        }
    }
}

fn name(language: Language, names: TestNames) -> &'static str {
    names.in_words[language.pick(0, 1)]
}

fn of_trials(language: Language, names: TestNames) -> String {
    let name = name(language, names);
    language.pick(format!("{name} of trials"), format!("{name} sur les essais"))
}

fn of_people(language: Language, names: TestNames) -> String {
    let name = name(language, names);
    language.pick(
        format!("{name} on one mean a person"),
        format!("{name} sur une moyenne par personne"),
    )
}

/// The test that decides, in words.
fn recommended_test(language: Language, hypothesis: &Hypothesis, setting: &Setting) -> String {
    let wilcoxon = name(language, Wilcoxon::NAMES);
    let wilcoxon = language.pick(
        format!("{wilcoxon} on person means, exact and conditional on the observed ranks, zeros by Pratt"),
        format!("{wilcoxon} sur les moyennes par personne, exact et conditionnel aux rangs observés, zéros selon Pratt"),
    );
    if hypothesis.test.is_of_choices() {
        test_of_choices(language, setting.levels)
    } else if hypothesis.test == TestName::Equivalence {
        equivalence::tests(language, hypothesis, setting.is_trait)
    } else if is_two_way(hypothesis.test) {
        interaction_test(language, setting.traits_of_two).to_owned()
    } else if setting.is_trait {
        match (hypothesis.test, setting.levels) {
            (TestName::Spearman, _) => {
                let name = name(language, Spearman::NAMES);
                language.pick(
                    format!("{name} with person means"),
                    format!("{name} avec les moyennes par personne"),
                )
            }
            (_, 2) => of_people(language, MannWhitney::NAMES),
            _ => of_people(language, KruskalWallis::NAMES),
        }
    } else if hypothesis.test == TestName::Spearman {
        language.pick(
            "signed rank test of each person’s own Spearman correlation against zero",
            "test des rangs signés des corrélations de Spearman propres à chaque personne contre zéro",
        )
        .to_owned()
    } else if setting.levels == 2 {
        wilcoxon
    } else {
        let friedman = name(language, Friedman::NAMES);
        language.pick(
            format!("{friedman} on person means with Iman and Davenport’s F; then, for pairs, {wilcoxon}, corrected by Holm"),
            format!("{friedman} sur les moyennes par personne, F d’Iman et Davenport ; puis, pour les paires, {wilcoxon}, corrigé par Holm"),
        )
    }
}

/// The test of a hypothesis about other clips too.
fn test_of_other_clips(language: Language, hypothesis: &Hypothesis) -> String {
    if hypothesis.test.is_of_choices() {
        return language.pick(
            "F test of a linear model of choices (1/2 where the left clip is chosen, −1/2 where the right one is, 0 for neither; Scheffé 1952), fitted by restricted maximum likelihood with independent random effects of people (who prefer a side), of people with each level and of segments with each level, with Satterthwaite’s degrees of freedom, so that it holds for other people and other clips; pairs by t, corrected by Holm; where the model cannot be estimated the hypothesis counts as not shown",
            "test F d’un modèle linéaire des choix (1/2 si l’extrait de gauche est choisi, −1/2 si c’est celui de droite, 0 pour aucun ; Scheffé 1952), ajusté par maximum de vraisemblance restreinte avec des effets aléatoires indépendants des personnes (qui préfèrent un côté), des personnes à chaque niveau et des segments à chaque niveau, aux degrés de liberté de Satterthwaite, de sorte qu’il vaut pour d’autres personnes et d’autres extraits ; paires par t, corrigées par Holm ; si le modèle ne peut être estimé l’hypothèse est tenue pour non montrée",
        )
        .to_owned();
    }
    let name = name(language, LinearMixedModel::NAMES);
    if hypothesis.test == TestName::Equivalence {
        let least = language.number(hypothesis.smallest_effect.unwrap_or(f64::NAN));
        return language.pick(
            format!("two one-sided t tests of whether the difference in a {name} lies between −{least} and {least}, p being the larger of the two, fitted by restricted maximum likelihood with independent random effects of people and of segments, of both with each level, and of people with segments, with Satterthwaite’s degrees of freedom, so that it holds for other people and other clips; where the model cannot be estimated the hypothesis counts as undecided"),
            format!("deux tests t unilatéraux : la différence dans un {name} est-elle entre −{least} et {least}, p étant le plus grand des deux, le modèle étant ajusté par maximum de vraisemblance restreinte avec des effets aléatoires indépendants des personnes et des segments, de chacun à chaque niveau, et des personnes pour chaque segment, aux degrés de liberté de Satterthwaite, de sorte qu’il vaut pour d’autres personnes et d’autres extraits ; si le modèle ne peut être estimé l’hypothèse est tenue pour indécise"),
        );
    }
    language.pick(
        format!("{name}, fitted by restricted maximum likelihood with independent random effects of people and of segments, of both with each level (and combination of levels), and of people with segments, so that it holds for other people and other clips; a random effect that parts the answers as another one does is left out; pairs by t, corrected by Holm; where the model cannot be estimated, Clark’s min F' decides, and where that is undefined too the hypothesis counts as not shown; beside it, of ratings, a cumulative mixed model"),
        format!("{name}, ajusté par maximum de vraisemblance restreinte avec des effets aléatoires indépendants des personnes et des segments, de chacun à chaque niveau (et combinaison de niveaux), et des personnes pour chaque segment, de sorte qu’il vaut pour d’autres personnes et d’autres extraits ; un effet aléatoire qui partage les réponses comme un autre est omis ; paires par t, corrigées par Holm ; si le modèle ne peut être estimé, le min F' de Clark décide, et s’il n’est pas défini non plus l’hypothèse est tenue pour non montrée ; à côté, pour des notes, un modèle mixte cumulatif"),
    )
}

/// The test of choices between two clips that decides.
fn test_of_choices(language: Language, levels: usize) -> String {
    if levels == 2 {
        let sign = name(language, Sign::NAMES);
        return language.pick(
            format!("{sign} of people: whether more of them choose one more often than the other, exact binomial, two-sided; who chooses both equally often is left out"),
            format!("{sign} sur les personnes : si davantage choisissent l’un plus souvent que l’autre, binomial exact, bilatéral ; qui choisit les deux aussi souvent n’est pas compté"),
        );
    }
    let few = 2 * levels.saturating_sub(1);
    language.pick(
        format!("equal worths in the Bradley-Terry model, with Davidson’s ties where “no difference” is an answer and a side bias where the sides vary: Wald’s F with errors clustered by participant (with {few} participants or fewer: Friedman’s test on each one’s wins); then, for pairs, t tests clustered by participant, corrected by Holm, with the intervals of these t"),
        format!("égalité des valeurs dans le modèle de Bradley-Terry, avec les égalités de Davidson si « pas de différence » est une réponse et un biais de côté si les côtés varient : F de Wald à erreurs groupées par participant (avec {few} participants ou moins : test de Friedman sur les victoires de chacun) ; puis, pour les paires, tests t groupés par participant, corrigés par Holm, avec les intervalles de ces t"),
    )
}

/// The test of an interaction that decides, by how many of the two factors are about people.
fn interaction_test(language: Language, traits: usize) -> &'static str {
    match traits {
        1 => language.pick(
            "interaction by people’s differences: for each pair of levels of the factor within people, whether each person’s difference of means depends on the factor about people (Mann-Whitney of two groups, Kruskal-Wallis of more), smallest p after Holm’s correction over the pairs",
            "interaction par les différences des personnes : pour chaque paire de niveaux du facteur intra-personnes, la différence des moyennes de chaque personne dépend-elle du facteur propre aux personnes (Mann-Whitney pour deux groupes, Kruskal-Wallis au-delà), plus petit p après correction de Holm sur les paires",
        ),
        2 => language.pick(
            "interaction of the Scheirer-Ray-Hare test on one mean a person",
            "interaction du test de Scheirer-Ray-Hare sur une moyenne par personne",
        ),
        _ => language.pick(
            "interaction of the aligned rank transform on the means of each person and combination (a balanced design; the transform is not fully reliable on ordinal data, so the cumulative-link mixed model of `analysis.R` is reported beside it; the clips are taken as they are)",
            "interaction de la transformation des rangs alignés sur les moyennes de chaque personne et combinaison (plan équilibré ; la transformation n’étant pas pleinement fiable sur des données ordinales, le modèle mixte à liens cumulatifs de `analysis.R` est rapporté à côté ; les extraits sont pris tels qu’ils sont)",
        ),
    }
}

/// The test of the thesis, in words.
fn test_of_the_thesis(language: Language, hypothesis: &Hypothesis, setting: &Setting) -> String {
    match hypothesis.test {
        _ if hypothesis.test.is_of_choices() && setting.levels == 2 => {
            of_trials(language, Sign::NAMES)
        }
        _ if hypothesis.test.is_of_choices() => of_trials(language, WORTHS_RATIO),
        TestName::Equivalence => of_trials(language, EquivalenceOfGroups::NAMES),
        _ if is_two_way(hypothesis.test) => {
            of_trials(language, ScheirerRayHare::NAMES) + ", type I"
        }
        TestName::Spearman => of_trials(language, Spearman::NAMES),
        TestName::MannWhitney => of_trials(language, MannWhitney::NAMES),
        TestName::Wilcoxon if !setting.recognition && setting.of_clips => language
            .pick(
                "Wilcoxon’s test of matched trials as R computed it in 2019",
                "test de Wilcoxon sur les essais appariés tel que R le calculait en 2019",
            )
            .to_owned(),
        TestName::KruskalWallis => of_trials(language, KruskalWallis::NAMES),
        _ if setting.recognition => of_trials(language, ChiSquare::NAMES),
        TestName::ChiSquare if setting.of_clips => of_trials(language, ChiSquare::NAMES),
        _ => of_trials(language, KruskalWallis::NAMES),
    }
}

fn exclusions(from: &Preregistration<'_>, language: Language) -> Vec<String> {
    let mut words = vec![
        language
            .pick(
                "people who do not agree or who take their answers back (their answers are deleted)",
                "les personnes qui refusent ou qui retirent leurs réponses (elles sont effacées)",
            )
            .to_owned(),
        language.pick("pilot sessions", "les sessions pilotes").to_owned(),
    ];
    let device = from.study.device.as_ref();
    if let Some(share) = device.and_then(|device| device.minimum_frame_share) {
        let percent = language.fixed(100.0 * share, 0);
        words.push(language.pick(
            format!(
                "people whose device shows less than {percent} % of a clip's frames (of 60 a second at most) in two plays of it: their session ends there"
            ),
            format!(
                "les personnes dont l’appareil affiche moins de {percent} % des images d’un extrait (sur 60 par seconde au plus) en deux lectures : leur session s’arrête là"
            ),
        ));
    }
    words.extend(Rule::of(from.study).iter().map(|rule| rule.words(language, "`")));
    words
}
