//! Components and their order: references, blocks without clips, constraints that cannot be met.

use std::collections::{BTreeMap, BTreeSet};

use super::between::{self, Named, shown_before};
use super::issue::{Issues, below};
use super::problem::Problem;
use super::values::Nearest;
use super::{Subject, adaptive, pairs, panel, reverse_correlation, scaling};
use crate::order::{CYCLES, Draw, Flaw, OrderError, prove};
use crate::study_file::{
    Beside, Clip, ClipSelection, Component, OrderRule, Sequence, SequenceItem, TrialsComponent,
};

/// Names of steps that are no components.
const RESERVED: [&str; 5] = ["consent", "demographics", "instructions", "training", "debriefing"];
/// Most trials of a study: far beyond what a person can do, and small enough to plan at once.
const MOST_TRIALS: usize = 10_000;

pub(super) fn examine(subject: &Subject<'_>, issues: &mut Issues) {
    let study = subject.study;
    let questions: Vec<&str> = study.questions.iter().map(|each| each.id.as_str()).collect();
    for (name, component) in &study.components {
        let pointer = below("/components", name);
        let plain = |letter: char| letter.is_ascii_alphanumeric() || "_-".contains(letter);
        if name.is_empty() || !name.chars().all(plain) || RESERVED.contains(&name.as_str()) {
            issues.error(&pointer, Problem::ComponentName { name: name.clone() });
        }
        match component {
            Component::Trials(block) => trials(subject, block, &questions, &pointer, issues),
            Component::Pairs(block) => pairs::examine(subject, block, &pointer, issues),
            Component::Panel(block) => panel::examine(subject, block, &pointer, issues),
            Component::Adaptive(block) => adaptive::examine(subject, block, &pointer, issues),
            Component::Scaling(block) => scaling::examine(subject, block, &pointer, issues),
            Component::ReverseCorrelation(block) => {
                reverse_correlation::examine(subject, block, &pointer, issues);
            }
            Component::Break(rest) if !(0.0..=3600.0).contains(&rest.minimum_seconds) => {
                let place = below(&pointer, "minimumSeconds");
                issues.error(place, Problem::BreakSeconds { seconds: rest.minimum_seconds });
            }
            _ => {}
        }
    }
    if let Some(training) = &study.training {
        references(&training.questions, &questions, "/training/questions", "question", issues);
        let clips: Vec<&str> = subject.clips.iter().map(|clip| clip.id.as_str()).collect();
        references(&training.clips, &clips, "/training/clips", "clip", issues);
    }
    let mut named = Named::new();
    sequence(subject, &study.sequence, "/sequence", None, &mut named, issues);
    between::examine(&study.sequence, issues);
    for name in study.components.keys().filter(|name| !named.contains_key(name.as_str())) {
        issues.warning(below("/components", name), Problem::NeverShown { component: name.clone() });
    }
    let mut total = 0;
    for condition in between::each(study) {
        let count = trial_count(subject, &study.sequence, condition);
        if count == 0 {
            let problem = match condition {
                None => Problem::NoTrials,
                Some(name) => Problem::NoTrialsIn { condition: name.to_owned() },
            };
            issues.error("/sequence", problem);
        }
        total = total.max(count);
    }
    if total > MOST_TRIALS {
        issues.error("/sequence", Problem::TooManyTrials { trials: total, most: MOST_TRIALS });
    } else if !issues.errors().any(changes_order) {
        feasible(subject, issues);
    }
}

/// A block that the page carries as JSON; what cannot be read is reported.
pub(super) fn read_block<T>(
    read: Result<T, serde_json::Error>,
    pointer: &str,
    issues: &mut Issues,
) -> Option<T> {
    let reported = |error: &serde_json::Error| {
        issues.error(pointer, Problem::Shape { what: error.to_string() });
    };
    read.inspect_err(reported).ok()
}

fn references(
    given: &[String],
    known: &[&str],
    pointer: &str,
    what: &'static str,
    issues: &mut Issues,
) {
    for (index, name) in given.iter().enumerate() {
        if !known.contains(&name.as_str()) {
            issues.error(below(pointer, index), Problem::unknown(what, name, known));
        } else if what == "question" && given[..index].contains(name) {
            issues.error(below(pointer, index), Problem::AskedTwice { question: name.clone() });
        }
    }
}

fn trials(
    subject: &Subject<'_>,
    block: &TrialsComponent,
    questions: &[&str],
    pointer: &str,
    issues: &mut Issues,
) {
    references(&block.questions, questions, &below(pointer, "questions"), "question", issues);
    if block.questions.is_empty() {
        issues.warning(below(pointer, "questions"), Problem::AsksNothing);
    }
    if block.repetitions == 0 {
        issues.error(below(pointer, "repetitions"), Problem::NoRepetition);
    }
    selection(subject, &block.clips, &all_factors(subject), pointer, issues);
    if let Some(companion) = &block.beside {
        beside(subject, block, companion, &below(pointer, "beside"), issues);
    }
}

/// Which clips a block takes: there are such clips.
pub(super) fn selection(
    subject: &Subject<'_>,
    clips: &ClipSelection,
    factors: &BTreeMap<String, BTreeSet<String>>,
    pointer: &str,
    issues: &mut Issues,
) {
    let ids: Vec<&str> = subject.clips.iter().map(|clip| clip.id.as_str()).collect();
    references(&clips.ids, &ids, &format!("{pointer}/clips/ids"), "clip", issues);
    let names: Vec<&str> = factors.keys().map(String::as_str).collect();
    for (factor, wanted) in &clips.factors {
        let place = below(&format!("{pointer}/clips/where"), factor);
        let Some(values) = factors.get(factor) else {
            issues.error(place, Problem::unknown("factor", factor, &names));
            continue;
        };
        let values: Vec<&str> = values.iter().map(String::as_str).collect();
        for (index, value) in wanted.iter().enumerate() {
            let value = value.to_string();
            if !values.contains(&value.as_str()) {
                issues.error(
                    below(&place, index),
                    Problem::NoClipWith {
                        factor: factor.clone(),
                        known: Nearest::to(&value, &values),
                        level: value,
                    },
                );
            }
        }
    }
    if !subject.clips.iter().any(|clip| clips.takes(clip)) {
        issues.error(below(pointer, "clips"), Problem::NoClip);
    }
}

/// Each clip of the block needs a companion.
fn beside(
    subject: &Subject<'_>,
    block: &TrialsComponent,
    companion: &Beside,
    pointer: &str,
    issues: &mut Issues,
) {
    let stimuli = &subject.study.stimuli;
    let methods: Vec<&str> = stimuli.methods.keys().map(String::as_str).collect();
    let avatars: Vec<&str> = stimuli.avatars.keys().map(String::as_str).collect();
    let before = issues.count();
    let method = std::slice::from_ref(&companion.method);
    for (given, known, key) in
        [(method, &methods, "method"), (companion.avatar.as_slice(), &avatars, "avatar")]
    {
        for name in given.iter().filter(|name| !known.contains(&name.as_str())) {
            issues.error(below(pointer, key), Problem::unknown(key, name, known));
        }
    }
    if issues.count() > before {
        return;
    }
    let alone =
        |clip: &&Clip| block.clips.takes(clip) && companion.of(clip, subject.clips).is_none();
    if let Some(clip) = subject.clips.iter().find(alone) {
        issues.error(
            pointer,
            Problem::NoCompanion {
                clip: clip.id.clone(),
                segment: clip.segment.clone(),
                method: companion.method.clone(),
                avatar: companion.avatar.as_ref().unwrap_or(&clip.avatar).clone(),
            },
        );
    }
}

/// Every factor with its values as text, `clip`, `avatar` and `segment` among them.
pub(super) fn all_factors(subject: &Subject<'_>) -> BTreeMap<String, BTreeSet<String>> {
    let mut factors: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for clip in subject.clips {
        let named = ["clip", "avatar", "segment"];
        for name in clip.factors.keys().map(String::as_str).chain(named) {
            if let Some(value) = clip.factor_text(name) {
                factors.entry(name.to_owned()).or_default().insert(value);
            }
        }
    }
    factors
}

fn sequence<'a>(
    subject: &Subject<'a>,
    here: &'a Sequence,
    pointer: &str,
    condition: Option<&'a str>,
    named: &mut Named<'a>,
    issues: &mut Issues,
) {
    // A condition without a name is said elsewhere.
    let condition = match here.conditional {
        true => Some(here.id.as_deref().unwrap_or_default()),
        false => condition,
    };
    let components: Vec<&str> = subject.study.components.keys().map(String::as_str).collect();
    if here.components.is_empty() && !here.conditional {
        issues.error(below(pointer, "components"), Problem::EmptySequence);
    }
    for (index, item) in here.components.iter().enumerate() {
        let place = format!("{pointer}/components/{index}");
        match item {
            SequenceItem::Sequence(nested) => {
                sequence(subject, nested, &place, condition, named, issues);
            }
            SequenceItem::Component(name) => {
                if !components.contains(&name.as_str()) {
                    issues.error(&place, Problem::unknown("component", name, &components));
                }
                if let Some(first) = shown_before(named, name, condition) {
                    issues.error(&place, Problem::ShownAlready { component: name.clone(), first });
                }
                named.entry(name).or_default().push((condition, place));
            }
        }
    }
    interruptions(subject, here, pointer, condition, named, issues);
    constraints(subject, here, pointer, issues);
    reach(subject, here, pointer, issues);
}

fn interruptions<'a>(
    subject: &Subject<'a>,
    here: &'a Sequence,
    pointer: &str,
    condition: Option<&'a str>,
    named: &mut Named<'a>,
    issues: &mut Issues,
) {
    for (index, interruption) in here.interruptions.iter().enumerate() {
        let place = format!("{pointer}/interruptions/{index}");
        let name = &interruption.component;
        match subject.study.components.get(name) {
            None => {
                let known = subject.study.components.keys();
                let problem = Problem::unknown("component", name, known);
                issues.error(below(&place, "component"), problem);
            }
            Some(component) if component.is_block() => {
                let problem = Problem::InterruptedByTrials { component: name.clone() };
                issues.error(below(&place, "component"), problem);
            }
            Some(_) => {
                if shown_before(named, name, condition).is_none() {
                    named.entry(name).or_default().push((condition, place.clone()));
                }
            }
        }
        if interruption.spacing == 0 {
            issues.error(below(&place, "spacing"), Problem::NoSpacing);
        }
    }
}

/// Constraints order single trials: a sequence that stays together keeps its own.
fn reach(subject: &Subject<'_>, here: &Sequence, pointer: &str, issues: &mut Issues) {
    if here.constraints.is_empty() {
        return;
    }
    let pointer = below(pointer, "constraints");
    if let Some(index) =
        here.components.iter().position(|item| matches!(item, SequenceItem::Sequence(_)))
    {
        issues.error(pointer, Problem::ConstraintOnSequence { part: index + 1 });
        return;
    }
    let named = |item: &SequenceItem| match item {
        SequenceItem::Component(name) => subject.study.trial_block(name),
        SequenceItem::Sequence(_) => None,
    };
    let blocks: Vec<_> = here.components.iter().filter_map(named).collect();
    let factors = all_factors(subject);
    for (index, constraint) in here.constraints.iter().enumerate() {
        let factor = constraint.factor.as_str();
        let has = |clip: &&Clip| clip.factor_text(factor).is_some();
        let shown = |clip: &Clip| blocks.iter().any(|block| block.clips.takes(clip));
        if factors.contains_key(factor) && !subject.clips.iter().filter(has).any(shown) {
            issues.error(
                below(&pointer, index),
                Problem::ConstraintOnNothing { factor: factor.to_owned() },
            );
        }
    }
}

fn constraints(subject: &Subject<'_>, here: &Sequence, pointer: &str, issues: &mut Issues) {
    if here.num_samples == Some(0) {
        issues.error(below(pointer, "numSamples"), Problem::NoSamples);
    }
    for item in here.components.iter().filter(|_| here.num_samples.is_some()) {
        let SequenceItem::Component(name) = item else { continue };
        if matches!(subject.study.components.get(name), Some(Component::Pairs(_))) {
            let problem = Problem::SampledPairs { component: name.clone() };
            issues.error(below(pointer, "numSamples"), problem);
        }
    }
    if !here.constraints.is_empty() && here.order != OrderRule::Random {
        issues.error(below(pointer, "constraints"), Problem::OrderNotRandom);
    }
    let factors = all_factors(subject);
    let names: Vec<&str> = factors.keys().map(String::as_str).collect();
    for (index, constraint) in here.constraints.iter().enumerate() {
        let place = format!("{pointer}/constraints/{index}");
        if !names.contains(&constraint.factor.as_str()) {
            issues.error(
                below(&place, "factor"),
                Problem::unknown("factor", &constraint.factor, &names),
            );
        }
        if constraint.at_most_alike.is_none() && constraint.minimum_distance.is_none() {
            issues.error(place, Problem::EmptyConstraint);
        } else if constraint.at_most_alike == Some(0) || constraint.minimum_distance == Some(0) {
            issues.error(place, Problem::ConstraintOfZero);
        }
    }
}

fn trial_count(subject: &Subject<'_>, sequence: &Sequence, condition: Option<&str>) -> usize {
    let count = |item: &SequenceItem| match item {
        SequenceItem::Sequence(nested) if !nested.is_shown_in(condition) => 0,
        SequenceItem::Sequence(nested) => trial_count(subject, nested, condition),
        SequenceItem::Component(name) => match subject.study.components.get(name) {
            Some(Component::Trials(_) | Component::Pairs(_) | Component::Panel(_)) => {
                subject.study.trial_block(name).map_or(0, |block| block.trial_count(subject.clips))
            }
            Some(Component::Adaptive(_)) => {
                let of = subject.study.adaptive().find(|(own, _)| own == name);
                of.map_or(0, |(_, block)| block.steps)
            }
            Some(Component::ReverseCorrelation(block)) => block.trials() as usize,
            Some(Component::Scaling(block)) => {
                block.read().map_or(0, |block| block.trials as usize)
            }
            _ => 0,
        },
    };
    sequence.components.iter().map(count).fold(0, usize::saturating_add)
}

/// Whether to correct what is wrong at this place changes what is shown, or the constraints on it.
fn changes_order(pointer: &str) -> bool {
    let is_in = |part: &str| pointer.starts_with(part);
    // Without a factor that is not there a constraint asks for less, not for more.
    (is_in("/sequence") && !pointer.ends_with("/factor") && !pointer.contains("/interruptions/"))
        || (is_in("/components")
            && ["/clips", "/repetitions"].iter().any(|key| pointer.contains(key)))
        || ["/stimuli/segments", "/stimuli/clips"].into_iter().any(is_in)
        || (is_in("/stimuli") && pointer.contains("/factors"))
}

/// Proves that an order exists for every participant, or says which constraints cannot be met.
fn feasible(subject: &Subject<'_>, issues: &mut Issues) {
    let draw = Draw {
        seed: subject.study.seed,
        config_hash: subject.hash,
        participant: 0,
        condition: None,
    };
    for flaw in prove(&subject.study.projection(), draw) {
        match flaw {
            Flaw::NoOrder(OrderError { pointer, why }) => {
                issues.error(pointer, Problem::NoOrder { remedy: why.remedy(), why });
            }
            Flaw::TooManySamples { pointer, parts, samples } => {
                issues.error(
                    below(&pointer, "numSamples"),
                    Problem::TooManySamples { parts, samples },
                );
            }
            Flaw::Unbalanced { pointer, anew, first } => {
                issues.warning(
                    below(&pointer, "numSamples"),
                    Problem::UnevenSamples { rounds: CYCLES, anew, first },
                );
            }
        }
    }
}
