//! The hypotheses of a study file, each tested as in the thesis and as recommended.

pub(crate) mod call;
mod choices;
pub(crate) mod comparison;
pub(crate) mod conditions;
pub(crate) mod decision;
pub(crate) mod equivalence;
pub(crate) mod family;
pub(crate) mod not_tested;
pub(crate) mod other_clips;
pub(crate) mod person_level;
pub(crate) mod reading;
pub(crate) mod test_line;
pub(crate) mod trial_level;
pub(crate) mod two_way;
pub(crate) mod undefined;

use mimique_locale::Language;
use mimique_stats::{Factor, Labelled};
use mimique_study::columns::ASSIGNED_CONDITION;
use mimique_study::{AnswerOfPair, Hypothesis, Measure as What, Question, Study, TestName};
use serde::Serialize;

use crate::choices::preference::Preference;
use crate::hypothesis::comparison::without_level;
use crate::hypothesis::conditions::InCondition;
use crate::hypothesis::equivalence::Equivalence;
use crate::hypothesis::not_tested::NotTested;
use crate::hypothesis::other_clips::{OtherClips, OtherClipsTests};
use crate::hypothesis::person_level::PersonLevel;
use crate::hypothesis::test_line::{OutcomeP, TestLine, Unit};
use crate::hypothesis::trial_level::TrialLevel;
use crate::hypothesis::undefined::TestOutcome;
use crate::naming::Naming;
use crate::report::section::MOST_LEVELS;
use crate::trials::answer_distribution::AnswerDistribution;
use crate::trials::asked_question::AskedQuestion;
use crate::trials::export::Export;
use crate::trials::matching::Matching;
use crate::trials::measure::{Measure, MeasureKind, as_numbers};

/// A hypothesis and what came out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct HypothesisResult {
    pub id: String,
    pub statement: String,
    pub test: TestName,
    pub measure: String,
    pub kind: MeasureKind,
    pub factors: Vec<String>,
    /// Which clips the decision is about.
    pub scope: ClipScope,
    pub as_in_the_thesis: TrialLevel,
    /// The same of the clips as they are, each person counting once.
    pub recommended: PersonLevel,
    /// Of other clips too, where levels are compared and trials have segments.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub other_clips: Option<OtherClips>,
    /// Whether the difference is smaller than the smallest that matters, where that is what is tested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub equivalence: Option<Equivalence>,
    /// Which level is preferred, of choices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub preference: Option<Preference>,
    /// Which answers are compared, where the first factor is one of the clips.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub matching: Option<Matching>,
    /// How answers are distributed at the levels of each factor that is tested.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub answer_distributions: Vec<AnswerDistribution>,
    /// Trials without a value of a factor, such as those of a method without that parameter: not used.
    pub trials_without_level: usize,
    /// The people of each condition compared, where the assigned condition is a factor.
    #[serde(skip_serializing_if = "Labelled::is_empty")]
    pub people_by_condition: Labelled<InCondition>,
    /// p of the test that decides: the recommended one, or the linear mixed model (or min F') where the hypothesis is
    /// about other clips.
    pub p: Option<f64>,
    /// After Holm's correction over the study's hypotheses.
    pub p_holm_over_hypotheses: Option<f64>,
    /// p of any difference after the same correction, of a hypothesis of equivalence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub p_difference_holm_over_hypotheses: Option<f64>,
    pub reading: String,
}

impl HypothesisResult {
    /// p of any difference, uncorrected, of a hypothesis of equivalence.
    pub(crate) fn p_difference(&self) -> Option<f64> {
        self.equivalence.as_ref()?.p_difference(self.scope)
    }
}

/// Which clips a decision is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum ClipScope {
    /// Other people, and other clips of other segments.
    #[serde(rename = "other_clips")]
    Others,
    /// Other people who see these clips.
    #[serde(rename = "these_clips")]
    These,
    /// The answers are about no clips, or the export does not tell their segments.
    #[serde(rename = "no_clips")]
    NotTold,
}

/// Whether the trials of a measure show segments.
fn has_segments(export: &Export, measure: &Measure) -> bool {
    measure.trial.iter().any(|trial| export.trials[*trial].segment.is_some())
}

/// What both kinds of test give, or why neither can be computed.
type Tests = Result<(Vec<TestOutcome>, PersonLevel), NotTested>;

/// The tests of a hypothesis and what they say.
struct Read {
    trials: Vec<TestOutcome>,
    people: PersonLevel,
    equivalence: Option<Equivalence>,
    reading: String,
}

/// Tests one hypothesis, and whether it holds for other clips by these tests.
pub(crate) fn test_hypothesis(
    naming: &Naming<'_>,
    export: &Export,
    study: &Study,
    hypothesis: &Hypothesis,
    clips: OtherClipsTests,
) -> HypothesisResult {
    let language = naming.language;
    if hypothesis.test.is_of_choices() {
        return choices::of_choices(naming, export, study, hypothesis, clips);
    }
    let measure = measure_of(export, study, hypothesis, language);
    let trials_without_level = measure.as_ref().map_or(0, |measure| {
        let of_clips = hypothesis.factors.iter().filter(|name| export.factors.contains(name));
        let counts = of_clips.map(|name| without_level(&measure.factor(export, name, &[])));
        counts.max().unwrap_or(0)
    });
    let read = match (of_pair(study, hypothesis), &measure) {
        (Some(of_pair), _) => not_tested(language, &NotTested::OfPair(of_pair)),
        (None, Some(measure)) if hypothesis.test == TestName::Equivalence => {
            match equivalence::tested(export, study, hypothesis, measure) {
                Ok(found) => equivalent(naming, hypothesis, measure, found),
                Err(why) => not_tested(language, &why),
            }
        }
        (None, Some(measure)) => match tests(export, study, hypothesis, measure) {
            Ok((trials, people)) => {
                let reading = reading_of(naming, hypothesis, measure, &people);
                Read { trials, people, equivalence: None, reading }
            }
            Err(why) => not_tested(language, &why),
        },
        (None, None) => {
            let response = hypothesis.response.clone();
            not_tested(language, &NotTested::NoAnswers { response })
        }
    };
    let Read { trials, people, mut equivalence, mut reading } = read;
    if trials_without_level > 0 {
        reading.push(' ');
        reading += &reading::trials_without_level(language, trials_without_level);
    }
    let matching = measure.as_ref().and_then(|measure| matching_of(export, hypothesis, measure));
    if let Some(words) = matching.as_ref().and_then(|matching| reading::unmatched(naming, matching))
    {
        reading.push(' ');
        reading += &words;
    }
    let kind = measure.as_ref().map_or(MeasureKind::Rating, |measure| measure.kind);
    let other_clips =
        measure.as_ref().and_then(|measure| of_clips(export, study, hypothesis, measure, clips));
    if let (Some(own), Some(found)) = (&mut equivalence, &other_clips)
        && found.decides
    {
        own.for_other_clips = found.equivalence(own.smallest_effect);
    }
    if let (Some(found), Some(measure)) = (&other_clips, &measure) {
        let tested = if is_two_way(hypothesis.test) { 2 } else { 1 };
        let factors = &hypothesis.factors[..hypothesis.factors.len().min(tested)];
        let words = match &equivalence {
            Some(own) => reading::equivalence_for_other_clips(naming, own, found, measure, factors),
            None => reading::other_clips(naming, found, kind, factors),
        };
        reading = with_words(language, &words, &reading, found.decides);
    }
    let decided = match (&other_clips, &equivalence) {
        (Some(found), Some(own)) if found.decides => own.for_other_clips.map(|tests| tests.p),
        (Some(found), None) if found.decides => found.p(),
        _ => deciding_p(&people),
    };
    let scope = match &other_clips {
        Some(found) if found.decides => ClipScope::Others,
        _ if measure.as_ref().is_some_and(|measure| has_segments(export, measure)) => {
            ClipScope::These
        }
        _ => ClipScope::NotTold,
    };
    let people_by_condition = measure.as_ref().map_or_else(Labelled::default, |measure| {
        conditions::people(export, study, hypothesis, measure)
    });
    reading += &conditions::words(naming, &people_by_condition, kind);
    let distributions =
        measure.as_ref().map_or_else(Vec::new, |own| distributions(export, study, hypothesis, own));
    reading += &sizes_and_distributions(naming, hypothesis, &people, &distributions, kind);
    HypothesisResult {
        id: hypothesis.id.clone(),
        statement: hypothesis.statement.in_language(language.code()).to_owned(),
        test: hypothesis.test,
        kind,
        measure: measure.map_or_else(|| hypothesis.response.clone(), |measure| measure.id),
        factors: hypothesis.factors.clone(),
        scope,
        matching,
        answer_distributions: distributions,
        trials_without_level,
        people_by_condition,
        as_in_the_thesis: TrialLevel::new(trials),
        p: decided,
        p_holm_over_hypotheses: None,
        p_difference_holm_over_hypotheses: None,
        recommended: people,
        other_clips,
        equivalence,
        preference: None,
        reading,
    }
}

/// What is said of these clips with what is said of others; what decides comes first.
fn with_words(language: Language, of_others: &str, of_these: &str, others_decide: bool) -> String {
    if !others_decide {
        return format!("{of_these} {of_others}");
    }
    let these = language.pick("Of these clips alone:", "Pour ces extraits seuls :");
    format!("{of_others} {these} {of_these}")
}

/// What the tests of equivalence say.
fn equivalent(
    naming: &Naming<'_>,
    hypothesis: &Hypothesis,
    measure: &Measure,
    found: equivalence::Tested,
) -> Read {
    let equivalence::Tested { equivalence, trials, people } = found;
    let factor = hypothesis.factors.first().map_or("", String::as_str);
    let reading = reading::equivalence(naming, &equivalence, measure, factor);
    Read { trials, people, equivalence: Some(equivalence), reading }
}

/// Whether what is found holds for other clips too, where the hypothesis is of a kind that this can be asked of.
fn of_clips(
    export: &Export,
    study: &Study,
    hypothesis: &Hypothesis,
    measure: &Measure,
    tests: OtherClipsTests,
) -> Option<OtherClips> {
    let is_undecided =
        hypothesis.test == TestName::Equivalence && !hypothesis.is_about_other_clips();
    if !hypothesis.test.holds_for_other_clips()
        || is_undecided
        || of_pair(study, hypothesis).is_some()
    {
        return None;
    }
    let mut factors = factors(export, study, hypothesis, measure).ok()?;
    factors.truncate(if is_two_way(hypothesis.test) { 2 } else { 1 });
    other_clips::tested(export, measure, &factors, hypothesis.is_about_other_clips(), tests)
}

/// Which answers are compared by the first factor that is one of the clips.
fn matching_of(export: &Export, hypothesis: &Hypothesis, measure: &Measure) -> Option<Matching> {
    let mut names = hypothesis.factors.iter().enumerate();
    let (place, name) = names.find(|(_, name)| export.factors.contains(name))?;
    let levels: Vec<String> = hypothesis.levels.iter().map(ToString::to_string).collect();
    let factor = measure.factor(export, name, if place == 0 { &levels } else { &[] });
    (factor.levels.len() > 1).then(|| measure.matching(export, &factor))
}

/// Standardised effect sizes, floor and ceiling effects and unequal spreads, after the reading of the tests.
fn sizes_and_distributions(
    naming: &Naming<'_>,
    hypothesis: &Hypothesis,
    people: &PersonLevel,
    distributions: &[AnswerDistribution],
    kind: MeasureKind,
) -> String {
    let factor = hypothesis.factors.first().map_or("", String::as_str);
    let sizes = reading::effect_sizes(naming, people, factor);
    let spoken = distributions.iter().filter_map(|own| reading::distribution(naming, own, kind));
    sizes.into_iter().chain(spoken).map(|words| format!(" {words}")).collect()
}

/// How answers are distributed at the levels of each factor that is tested, where these are few.
fn distributions(
    export: &Export,
    study: &Study,
    hypothesis: &Hypothesis,
    measure: &Measure,
) -> Vec<AnswerDistribution> {
    if of_pair(study, hypothesis).is_some() {
        return Vec::new();
    }
    let mut factors = factors(export, study, hypothesis, measure).unwrap_or_default();
    factors.truncate(if is_two_way(hypothesis.test) { 2 } else { 1 });
    let few = factors.iter().filter(|(factor, _)| factor.levels.len() <= MOST_LEVELS);
    few.map(|(factor, _)| AnswerDistribution::of(measure, factor)).collect()
}

/// What the recommended tests say. A hypothesis of two factors is about their interaction, which stands
/// last.
fn reading_of(
    naming: &Naming<'_>,
    hypothesis: &Hypothesis,
    measure: &Measure,
    people: &PersonLevel,
) -> String {
    let mut read = people.clone();
    if is_two_way(hypothesis.test) {
        read.overall = read.overall.split_off(read.overall.len().saturating_sub(1));
    }
    let factor = hypothesis.factors.first().map_or("", String::as_str);
    reading::person_level(naming, &read, measure.kind, factor, &measure.label)
}

/// In the place of tests, why there are none.
fn not_tested(language: Language, why: &NotTested) -> Read {
    let words = why.words(language);
    let reading = language.pick(format!("Not tested: {words}."), format!("Non testée : {words}."));
    let people = PersonLevel {
        people: 0,
        incomplete: 0,
        overall: vec![TestOutcome::undefined(why.clone())],
        pairs: Vec::new(),
    };
    let trials = vec![TestOutcome::undefined(why.clone())];
    Read { trials, people, equivalence: None, reading }
}

/// Whether a test is about two factors and their interaction.
pub(crate) fn is_two_way(test: TestName) -> bool {
    matches!(test, TestName::ScheirerRayHare | TestName::AlignedRankTransform)
}

fn measure_of(
    export: &Export,
    study: &Study,
    hypothesis: &Hypothesis,
    language: Language,
) -> Option<Measure> {
    let asked = export
        .questions(study)
        .into_iter()
        .find(|asked: &AskedQuestion<'_>| asked.id == hypothesis.response)?;
    match hypothesis.measure {
        What::Rt => Measure::response_time(export, &asked, language),
        What::Answer | What::Correct => Measure::of_question(export, &asked, language),
    }
}

/// The factors of a hypothesis, and whether each is one of the clips.
fn factors(
    export: &Export,
    study: &Study,
    hypothesis: &Hypothesis,
    measure: &Measure,
) -> Result<Vec<(Factor, bool)>, NotTested> {
    let levels: Vec<String> = hypothesis.levels.iter().map(ToString::to_string).collect();
    let mut factors = Vec::new();
    for (place, name) in hypothesis.factors.iter().enumerate() {
        let chosen = if place == 0 { levels.as_slice() } else { &[] };
        factors.push(if export.factors.contains(name) {
            (measure.factor(export, name, chosen), true)
        } else {
            (factor_of_people(export, study, measure, name, chosen)?, false)
        });
    }
    for (factor, _) in &factors {
        if let [] | [_] = factor.levels.as_slice() {
            return Err(NotTested::TooFewLevels { factor: factor.name.clone() });
        }
    }
    Ok(factors)
}

fn tests(export: &Export, study: &Study, hypothesis: &Hypothesis, measure: &Measure) -> Tests {
    let factors = factors(export, study, hypothesis, measure)?;
    match factors.as_slice() {
        [(first, first_within), (second, second_within), ..] if is_two_way(hypothesis.test) => {
            Ok((
                TestLine::scheirer_ray_hare(&measure.numbers(), [first, second], &Unit::Trials),
                two_way::two_way(
                    export,
                    measure,
                    [(first, !first_within), (second, !second_within)],
                ),
            ))
        }
        [(factor, true), ..] => Ok(within_people(export, hypothesis, measure, factor)),
        [(factor, false), ..] => Ok(between_people(hypothesis, measure, factor)),
        [] => Err(NotTested::NoFactorNamed),
    }
}

/// Why the answers of a hypothesis cannot be told of the levels of its factors, where they are about two
/// clips.
pub(crate) fn of_pair(study: &Study, hypothesis: &Hypothesis) -> Option<AnswerOfPair> {
    if hypothesis.test.is_of_choices() {
        return None;
    }
    let is_asked = |question: &&Question| question.response_ids().contains(&hypothesis.response);
    let question = study.questions.iter().find(is_asked)?;
    let levels: Vec<String> = hypothesis.levels.iter().map(ToString::to_string).collect();
    let mut factors = hypothesis.factors.iter().enumerate();
    factors.find_map(|(place, factor)| {
        let compared = if place == 0 { levels.as_slice() } else { &[] };
        study.answer_of_pair(question, hypothesis.measure, factor, compared)
    })
}

/// An answer about people, or their condition, as a factor of the `chosen` levels; all if there are none.
fn factor_of_people(
    export: &Export,
    study: &Study,
    measure: &Measure,
    name: &String,
    chosen: &[String],
) -> Result<Factor, NotTested> {
    let factor = measure
        .trait_factor(export, name)
        .ok_or_else(|| NotTested::NoFactor { factor: name.clone() })?;
    // Whoever is in a condition that the study no longer has is compared with nobody.
    let known = |level: &&String| {
        name != ASSIGNED_CONDITION || study.conditions().contains(&level.as_str())
    };
    let wanted = if chosen.is_empty() { factor.levels.as_slice() } else { chosen };
    let wanted: Vec<String> = wanted
        .iter()
        .filter(|level| factor.levels.contains(level))
        .filter(known)
        .cloned()
        .collect();
    Ok(factor.restricted(&wanted).unwrap_or(factor))
}

fn within_people(
    export: &Export,
    hypothesis: &Hypothesis,
    measure: &Measure,
    factor: &Factor,
) -> (Vec<TestOutcome>, PersonLevel) {
    let mut people = person_level::within(export, measure, factor);
    let rating = measure.kind != MeasureKind::Recognition;
    let trials = match hypothesis.test {
        TestName::Wilcoxon if rating => {
            trial_level::pairs(export, measure, factor).into_iter().map(|(.., line)| line).collect()
        }
        TestName::MannWhitney => {
            vec![TestLine::mann_whitney(&measure.numbers(), factor, &Unit::Trials)]
        }
        TestName::Spearman => {
            let x = as_numbers(factor);
            people.overall = vec![person_level::correlation_with_levels(export, measure, factor)];
            people.pairs.clear();
            vec![TestLine::spearman(&x, &measure.numbers(), &Unit::Trials)]
        }
        TestName::KruskalWallis => {
            vec![TestLine::kruskal_wallis(&measure.numbers(), factor, &Unit::Trials)]
        }
        TestName::ChiSquare => vec![trial_level::chi_square(measure, factor)],
        _ => vec![trial_level::overall(measure, factor)],
    };
    (trials, people)
}

fn between_people(
    hypothesis: &Hypothesis,
    measure: &Measure,
    factor: &Factor,
) -> (Vec<TestOutcome>, PersonLevel) {
    if hypothesis.test == TestName::Spearman {
        let x = as_numbers(factor);
        let people = person_level::correlation(&x, measure);
        return (vec![TestLine::spearman(&x, &measure.numbers(), &Unit::Trials)], people);
    }
    let trials = match hypothesis.test {
        TestName::MannWhitney => TestLine::mann_whitney(&measure.numbers(), factor, &Unit::Trials),
        TestName::KruskalWallis => {
            TestLine::kruskal_wallis(&measure.numbers(), factor, &Unit::Trials)
        }
        _ => trial_level::overall(measure, factor),
    };
    (vec![trials], person_level::between(measure, factor))
}

/// The p that a hypothesis stands or falls by: the interaction if there is one, the overall test of
/// several levels, or the one pair.
pub(crate) fn deciding_p(people: &PersonLevel) -> Option<f64> {
    deciding_test(people)?.p_that_counts()
}

/// The test that has it.
pub(crate) fn deciding_test(people: &PersonLevel) -> Option<&TestOutcome> {
    match (people.overall.last(), people.pairs.as_slice()) {
        (Some(last), _) => Some(last),
        (None, [one]) => Some(&one.wilcoxon),
        (None, _) => None,
    }
}
