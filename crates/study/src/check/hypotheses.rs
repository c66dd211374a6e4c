//! Hypotheses: that the test fits the response and the factors that it names.

mod equivalence;

use std::collections::{BTreeMap, BTreeSet};

use super::issue::{Issues, below};
use super::problem::Problem;
use super::values::{Count, Counted, Nearest};
use super::{Subject, assigned, responses};
use crate::columns::ASSIGNED_CONDITION;
use crate::question::{KindOfQuestion as _, Question};
use crate::study_file::{Generalise, Hypothesis, Measure, SEGMENTS_FOR_OTHER_CLIPS, TestName};

pub(super) fn examine(subject: &Subject<'_>, issues: &mut Issues) {
    let hypotheses = &subject.study.hypotheses;
    for (index, hypothesis) in hypotheses.iter().enumerate() {
        let pointer = below("/hypotheses", index);
        if hypotheses[..index].iter().any(|each| each.id == hypothesis.id) {
            issues.error(
                below(&pointer, "id"),
                Problem::HypothesisTwice { id: hypothesis.id.clone() },
            );
        }
        response(subject, hypothesis, &pointer, issues);
        assigned::hypothesis(subject, hypothesis, &pointer, issues);
        factors(subject, hypothesis, &pointer, issues);
        levels(subject, hypothesis, &pointer, issues);
        generalise(subject, hypothesis, &pointer, issues);
        equivalence::examine(subject, hypothesis, &pointer, issues);
    }
}

/// That a hypothesis about other clips has a test of them, and segments enough.
fn generalise(subject: &Subject<'_>, hypothesis: &Hypothesis, pointer: &str, issues: &mut Issues) {
    let place = below(pointer, "generalise");
    let asked = hypothesis.generalise == Some(Generalise::Clips);
    if asked && !hypothesis.test.holds_for_other_clips() {
        let id = hypothesis.id.clone();
        issues.error(&place, Problem::NotOfOtherClips { hypothesis: id });
        return;
    }
    let segments: BTreeSet<&str> = subject.clips.iter().map(|clip| clip.segment.as_str()).collect();
    if !hypothesis.is_about_other_clips() || segments.is_empty() {
        return;
    }
    if asked && segments.len() < SEGMENTS_FOR_OTHER_CLIPS {
        let segments = Counted(segments.len(), "segment");
        issues
            .error(&place, Problem::TooFewSegments { segments, needed: SEGMENTS_FOR_OTHER_CLIPS });
    } else if segments.len() < SEGMENTS_FOR_OTHER_CLIPS {
        let (hypothesis, segments) = (hypothesis.id.clone(), Counted(segments.len(), "segment"));
        let problem =
            Problem::FewSegments { hypothesis, segments, needed: SEGMENTS_FOR_OTHER_CLIPS };
        issues.warning(pointer, problem);
    } else if of_one_segment_each(subject, hypothesis) {
        let hypothesis = hypothesis.id.clone();
        issues.warning(pointer, Problem::OneSegmentPerLevel { hypothesis });
    }
}

/// Whether each level that is compared has one segment of its own, which nothing tells from the level; of two factors, each
/// combination of levels one clip.
fn of_one_segment_each(subject: &Subject<'_>, hypothesis: &Hypothesis) -> bool {
    let factors = &hypothesis.factors[..hypothesis.factors.len().min(2)];
    let names = subject.study.factor_names();
    if factors.is_empty() || !factors.iter().all(|factor| names.contains(factor)) {
        return false;
    }
    let mut segments_of: BTreeMap<Vec<Option<String>>, BTreeSet<&str>> = BTreeMap::new();
    let mut levels_of: BTreeMap<&str, BTreeSet<Vec<Option<String>>>> = BTreeMap::new();
    for clip in subject.clips {
        let level: Vec<_> = factors.iter().map(|factor| clip.factor_text(factor)).collect();
        segments_of.entry(level.clone()).or_default().insert(&clip.segment);
        levels_of.entry(&clip.segment).or_default().insert(level);
    }
    let alone = segments_of.values().all(|segments| segments.len() == 1);
    match factors {
        [_] => alone && levels_of.values().all(|levels| levels.len() == 1),
        _ => alone,
    }
}

fn response(subject: &Subject<'_>, hypothesis: &Hypothesis, pointer: &str, issues: &mut Issues) {
    let place = below(pointer, "response");
    let of_conditions = hypothesis.factors.iter().any(|factor| factor == ASSIGNED_CONDITION);
    let response = hypothesis.response.as_str();
    let Some(question) = responses::tested(subject, response, place, of_conditions, issues) else {
        return;
    };
    let levels: Vec<String> = hypothesis.levels.iter().map(ToString::to_string).collect();
    if hypothesis.test.is_of_choices() {
        choices(subject, hypothesis, (question, &levels), pointer, issues);
        return;
    }
    for (index, factor) in hypothesis.factors.iter().enumerate() {
        let compared = if index == 0 { levels.as_slice() } else { &[] };
        let of_pair = subject.study.answer_of_pair(question, hypothesis.measure, factor, compared);
        if let Some(of_pair) = of_pair {
            issues.error(below(&below(pointer, "factors"), index), of_pair.into());
        }
    }
    if hypothesis.measure == Measure::Correct && question.kind.truth().is_none() {
        issues
            .error(below(pointer, "measure"), Problem::NoTruthOf { question: question.id.clone() });
    }
    let wants_numbers = !matches!(hypothesis.test, TestName::ChiSquare);
    if hypothesis.measure == Measure::Answer && wants_numbers && !question.kind.is_numeric() {
        issues.error(
            below(pointer, "response"),
            Problem::NotTested { question: question.id.clone() },
        );
    }
}

/// That a test of choices is of answers that choose between levels, all of which are joined by choices.
fn choices(
    subject: &Subject<'_>,
    hypothesis: &Hypothesis,
    (question, levels): (&Question, &[String]),
    pointer: &str,
    issues: &mut Issues,
) {
    let id = || question.id.clone();
    if !question.kind.compares_clips() || hypothesis.measure != Measure::Answer {
        let test = hypothesis.test.as_str();
        issues.error(below(pointer, "test"), Problem::NoChoice { question: id(), test });
        return;
    }
    let [factor] = hypothesis.factors.as_slice() else { return };
    if !factor_names(subject).contains(factor) {
        return;
    }
    let place = below(&below(pointer, "factors"), 0);
    let pairs = subject.study.levels_chosen_between(question, factor, levels);
    let parts = parts(&pairs, levels);
    match parts.as_slice() {
        [] => {
            let factor = factor.clone();
            issues.error(place, Problem::NoPairsOf { question: id(), factor });
        }
        [_] => {}
        several => {
            let parts: Vec<String> = several.iter().map(|part| part.join(", ")).collect();
            let parts = format!("({})", parts.join("), ("));
            issues.error(place, Problem::PairsInParts { question: id(), parts });
        }
    }
}

/// The levels in parts that pairs join; levels that are named and in no pair are parts of their own.
fn parts(pairs: &BTreeSet<[String; 2]>, levels: &[String]) -> Vec<Vec<String>> {
    if pairs.is_empty() {
        return Vec::new();
    }
    let of_pairs = pairs.iter().flatten();
    let all: BTreeSet<&String> = of_pairs.chain(levels).collect();
    let mut parts: Vec<Vec<String>> = all.into_iter().map(|level| vec![level.clone()]).collect();
    for [one, other] in pairs {
        let place = |level: &String| parts.iter().position(|part| part.contains(level));
        if let (Some(one), Some(other)) = (place(one), place(other))
            && one != other
        {
            let joined = parts.remove(one.max(other));
            parts[one.min(other)].extend(joined);
        }
    }
    parts
}

/// What an analysis can group by.
pub(super) fn factor_names(subject: &Subject<'_>) -> BTreeSet<String> {
    let mut names: BTreeSet<String> = subject.study.factor_names().into_iter().collect();
    // People differ by what they report about themselves.
    names.extend(
        subject.study.demographics.iter().flat_map(|page| &page.questions).map(|q| q.id.clone()),
    );
    names.extend(["avatar", "segment"].map(str::to_owned));
    if !subject.study.conditions().is_empty() {
        names.insert(ASSIGNED_CONDITION.to_owned());
    }
    names
}

fn factors(subject: &Subject<'_>, hypothesis: &Hypothesis, pointer: &str, issues: &mut Issues) {
    let place = below(pointer, "factors");
    let wanted = match hypothesis.test {
        TestName::ScheirerRayHare => 2..=2,
        TestName::AlignedRankTransform => 2..=3,
        _ => 1..=1,
    };
    if !wanted.contains(&hypothesis.factors.len()) {
        issues.error(
            &place,
            Problem::FactorCount {
                factors: Counted(hypothesis.factors.len(), "factor"),
                wanted: Count(wanted),
            },
        );
    }
    for (index, factor) in hypothesis.factors.iter().enumerate() {
        assigned::factor(subject, factor, below(&place, index), issues);
    }
}

fn levels(subject: &Subject<'_>, hypothesis: &Hypothesis, pointer: &str, issues: &mut Issues) {
    let Some(factor) = hypothesis.factors.first() else { return };
    let assigned = factor == ASSIGNED_CONDITION;
    let values: BTreeSet<String> = match assigned {
        true => subject.study.conditions().into_iter().map(str::to_owned).collect(),
        false => subject.clips.iter().filter_map(|clip| clip.factor_text(factor)).collect(),
    };
    if values.is_empty() {
        return;
    }
    let known: Vec<&str> = values.iter().map(String::as_str).collect();
    let place = below(pointer, "levels");
    let levels: Vec<String> = hypothesis.levels.iter().map(ToString::to_string).collect();
    for (index, level) in levels.iter().enumerate() {
        let place = below(&place, index);
        if !known.contains(&level.as_str()) {
            let (level, known) = (level.clone(), Nearest::to(level, &known));
            let problem = match assigned {
                true => Problem::UnknownReference { what: "condition", name: level, known },
                false => Problem::NoClipWith { factor: factor.clone(), level, known },
            };
            issues.error(place, problem);
        } else if levels[..index].contains(level) {
            issues.error(place, Problem::LevelTwice { level: level.clone() });
        }
    }
    let count = match (levels.len(), choice_levels(subject, hypothesis)) {
        (0, Some(compared)) => compared,
        (0, None) => values.len(),
        (named, _) => named,
    };
    let two = matches!(
        hypothesis.test,
        TestName::Wilcoxon | TestName::MannWhitney | TestName::Sign | TestName::Equivalence
    );
    if (two && count != 2) || count < 2 {
        let factor = factor.clone();
        let problem = match two {
            true => Problem::NotTwoLevels { levels: Counted(count, "level"), factor },
            false => Problem::TooFewLevels { levels: Counted(count, "level"), factor },
        };
        issues.error(place, problem);
    }
}

/// How many levels a test of choices compares where none are named: those that stand beside each other; none of
/// another test, or where that is a problem of its own.
fn choice_levels(subject: &Subject<'_>, hypothesis: &Hypothesis) -> Option<usize> {
    if !hypothesis.test.is_of_choices() {
        return None;
    }
    let question = responses::question(subject.study, &hypothesis.response)?;
    let factor = hypothesis.factors.first()?;
    let pairs = subject.study.levels_chosen_between(question, factor, &[]);
    let levels: BTreeSet<&String> = pairs.iter().flatten().collect();
    (!levels.is_empty()).then_some(levels.len())
}
