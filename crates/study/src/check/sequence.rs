//! Components and their order: references, blocks without clips, constraints that cannot be met.

use std::collections::{BTreeMap, BTreeSet};

use super::Subject;
use super::between::{self, Named, shown_before};
use super::issue::{Issues, below};
use super::nearest::suggestion;
use crate::order::{CYCLES, Draw, Flaw, prove};
use crate::study_file::{
    Beside, Clip, Component, OrderRule, Sequence, SequenceItem, TrialsComponent,
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
            let message = format!("\"{name}\" cannot be the name of a component");
            let hint = "use letters, digits, _ and -, and none of the names of the file's sections";
            issues.error(&pointer, "bad-id", message, hint);
        }
        match component {
            Component::Trials(block) => trials(subject, block, &questions, &pointer, issues),
            Component::Break(rest) if !(0.0..=3600.0).contains(&rest.minimum_seconds) => {
                let message = format!("a break of {} s", rest.minimum_seconds);
                let place = below(&pointer, "minimumSeconds");
                issues.error(place, "out-of-range", message, "take 0 to 3600");
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
        let message = format!("component \"{name}\" is never shown");
        let hint = "name it in /sequence, or remove it";
        issues.warning(below("/components", name), "unused", message, hint);
    }
    let mut total = 0;
    for condition in between::each(study) {
        let count = trial_count(subject, &study.sequence, condition);
        if count == 0 {
            let message = match condition {
                None => "no trial is shown".to_owned(),
                Some(name) => format!("no trial is shown in the condition \"{name}\""),
            };
            issues.error("/sequence", "empty", message, "name a component of type \"trials\"");
        }
        total = total.max(count);
    }
    if total > MOST_TRIALS {
        let message = format!("{total} trials");
        let hint = format!("show at most {MOST_TRIALS}");
        issues.error("/sequence", "too-many", message, hint);
    } else if !issues.errors().any(changes_order) {
        feasible(subject, issues);
    }
}

fn references(given: &[String], known: &[&str], pointer: &str, what: &str, issues: &mut Issues) {
    for (index, name) in given.iter().enumerate() {
        if !known.contains(&name.as_str()) {
            let message = format!("there is no {what} \"{name}\"");
            let hint = suggestion(name, known);
            issues.error(below(pointer, index), "unknown-reference", message, hint);
        } else if what == "question" && given[..index].contains(name) {
            let message = format!("\"{name}\" is asked twice");
            issues.error(below(pointer, index), "duplicate", message, "name it once");
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
        let message = "trials that ask nothing";
        let hint = "name questions of /questions";
        issues.warning(below(pointer, "questions"), "empty", message, hint);
    }
    if block.repetitions == 0 {
        let message = "each clip is shown 0 times";
        issues.error(below(pointer, "repetitions"), "out-of-range", message, "write 1 or more");
    }
    let ids: Vec<&str> = subject.clips.iter().map(|clip| clip.id.as_str()).collect();
    references(&block.clips.ids, &ids, &format!("{pointer}/clips/ids"), "clip", issues);
    let factors = all_factors(subject);
    let names: Vec<&str> = factors.keys().map(String::as_str).collect();
    for (factor, wanted) in &block.clips.factors {
        let place = below(&format!("{pointer}/clips/where"), factor);
        let Some(values) = factors.get(factor) else {
            let message = format!("there is no factor \"{factor}\"");
            issues.error(place, "unknown-reference", message, suggestion(factor, &names));
            continue;
        };
        let values: Vec<&str> = values.iter().map(String::as_str).collect();
        for (index, value) in wanted.iter().enumerate() {
            let value = value.to_string();
            if !values.contains(&value.as_str()) {
                let message = format!("no clip has {factor} \"{value}\"");
                let hint = suggestion(&value, &values);
                issues.error(below(&place, index), "unknown-reference", message, hint);
            }
        }
    }
    if let Some(companion) = &block.beside {
        beside(subject, block, companion, &below(pointer, "beside"), issues);
    }
    if !subject.clips.iter().any(|clip| block.clips.takes(clip)) {
        let message = "no clip is chosen";
        issues.error(below(pointer, "clips"), "empty", message, "loosen the choice");
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
            let message = format!("there is no {key} \"{name}\"");
            let hint = suggestion(name, known);
            issues.error(below(pointer, key), "unknown-reference", message, hint);
        }
    }
    if issues.count() > before {
        return;
    }
    let alone =
        |clip: &&Clip| block.clips.takes(clip) && companion.of(clip, subject.clips).is_none();
    if let Some(clip) = subject.clips.iter().find(alone) {
        let avatar = companion.avatar.as_ref().unwrap_or(&clip.avatar);
        let message = format!(
            "clip \"{}\" has no other clip of segment \"{}\" by \"{}\" on \"{avatar}\" to stand beside it",
            clip.id, clip.segment, companion.method
        );
        let hint = "make such clips in /stimuli/clips, or leave this clip out of the block";
        issues.error(pointer, "no-companion", message, hint);
    }
}

/// Every factor with its values as text, `clip`, `avatar` and `segment` among them.
fn all_factors(subject: &Subject<'_>) -> BTreeMap<String, BTreeSet<String>> {
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
        let message = "an empty sequence";
        issues.error(below(pointer, "components"), "empty", message, "name a component");
    }
    for (index, item) in here.components.iter().enumerate() {
        let place = format!("{pointer}/components/{index}");
        match item {
            SequenceItem::Sequence(nested) => {
                sequence(subject, nested, &place, condition, named, issues);
            }
            SequenceItem::Component(name) => {
                if !components.contains(&name.as_str()) {
                    let message = format!("there is no component \"{name}\"");
                    issues.error(
                        &place,
                        "unknown-reference",
                        message,
                        suggestion(name, &components),
                    );
                }
                if let Some(first) = shown_before(named, name, condition) {
                    let message = format!("\"{name}\" is shown at {first} already");
                    let hint = "give its trials \"repetitions\", or write a second component";
                    issues.error(&place, "duplicate", message, hint);
                }
                named.entry(name).or_default().push((condition, place));
            }
        }
    }
    for (index, interruption) in here.interruptions.iter().enumerate() {
        let place = format!("{pointer}/interruptions/{index}");
        let name = &interruption.component;
        match subject.study.components.get(name) {
            None => {
                let message = format!("there is no component \"{name}\"");
                let hint = suggestion(name, &components);
                issues.error(below(&place, "component"), "unknown-reference", message, hint);
            }
            Some(Component::Trials(_)) => {
                let message = format!("\"{name}\" is a block of trials");
                let hint = "interrupt by a break, a page or a questionnaire";
                issues.error(below(&place, "component"), "bad-interruption", message, hint);
            }
            Some(_) => {
                if shown_before(named, name, condition).is_none() {
                    named.entry(name).or_default().push((condition, place.clone()));
                }
            }
        }
        if interruption.spacing == 0 {
            let message = "after every 0 trials";
            issues.error(below(&place, "spacing"), "out-of-range", message, "write 1 or more");
        }
    }
    constraints(subject, here, pointer, issues);
    reach(subject, here, pointer, issues);
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
        let message = format!(
            "constraints order single trials, and part {} of this sequence is a sequence that stays \
             together",
            index + 1
        );
        let hint = "write constraints in the nested sequences, or name their components here";
        issues.error(pointer, "constraint-on-sequence", message, hint);
        return;
    }
    let blocks: Vec<&TrialsComponent> = here
        .components
        .iter()
        .filter_map(|item| match item {
            SequenceItem::Component(name) => subject.study.components.get(name),
            SequenceItem::Sequence(_) => None,
        })
        .filter_map(|component| match component {
            Component::Trials(block) => Some(block),
            _ => None,
        })
        .collect();
    let factors = all_factors(subject);
    for (index, constraint) in here.constraints.iter().enumerate() {
        let factor = constraint.factor.as_str();
        let has = |clip: &&Clip| clip.factor_text(factor).is_some();
        let shown = |clip: &Clip| blocks.iter().any(|block| block.clips.takes(clip));
        if factors.contains_key(factor) && !subject.clips.iter().filter(has).any(shown) {
            let message = format!("no trial of this sequence has the factor \"{factor}\"");
            let hint = "move the constraint to the sequence with these trials, or remove it";
            issues.error(below(&pointer, index), "constraint-on-nothing", message, hint);
        }
    }
}

fn constraints(subject: &Subject<'_>, here: &Sequence, pointer: &str, issues: &mut Issues) {
    if here.num_samples == Some(0) {
        let message = "0 of the parts are shown";
        issues.error(below(pointer, "numSamples"), "out-of-range", message, "write 1 or more");
    }
    if !here.constraints.is_empty() && here.order != OrderRule::Random {
        let message = "constraints on an order that is not random";
        let hint = "write \"order\": \"random\", or remove the constraints";
        issues.error(below(pointer, "constraints"), "not-needed", message, hint);
    }
    let factors = all_factors(subject);
    let names: Vec<&str> = factors.keys().map(String::as_str).collect();
    for (index, constraint) in here.constraints.iter().enumerate() {
        let place = format!("{pointer}/constraints/{index}");
        if !names.contains(&constraint.factor.as_str()) {
            let message = format!("there is no factor \"{}\"", constraint.factor);
            let hint = suggestion(&constraint.factor, &names);
            issues.error(below(&place, "factor"), "unknown-reference", message, hint);
        }
        if constraint.at_most_alike.is_none() && constraint.minimum_distance.is_none() {
            let message = "a constraint that asks for nothing";
            issues.error(place, "empty", message, "add atMostAlike or minimumDistance");
        } else if constraint.at_most_alike == Some(0) || constraint.minimum_distance == Some(0) {
            let message = "0 in a row, or at a distance of 0";
            issues.error(place, "out-of-range", message, "write 1 or more");
        }
    }
}

fn trial_count(subject: &Subject<'_>, sequence: &Sequence, condition: Option<&str>) -> usize {
    let count = |item: &SequenceItem| match item {
        SequenceItem::Sequence(nested) if !nested.is_shown_in(condition) => 0,
        SequenceItem::Sequence(nested) => trial_count(subject, nested, condition),
        SequenceItem::Component(name) => match subject.study.components.get(name) {
            Some(Component::Trials(block)) => {
                let chosen = subject.clips.iter().filter(|clip| block.clips.takes(clip)).count();
                chosen.saturating_mul(block.repetitions as usize)
            }
            _ => 0,
        },
    };
    sequence.components.iter().map(count).fold(0, usize::saturating_add)
}

/// Whether to mend what is wrong at this place changes what is shown, or the constraints on it.
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
    for flaw in prove(subject.study, draw) {
        match flaw {
            Flaw::NoOrder(error) => {
                let text = error.to_string();
                let (pointer, message) = text.split_once(": ").unwrap_or(("/sequence", &text));
                let (message, hint) =
                    message.split_once("; ").unwrap_or((message, "loosen one of them"));
                issues.error(pointer, "unsatisfiable-order", message, hint);
            }
            Flaw::TooManySamples { pointer, parts, samples } => {
                let message = format!(
                    "{samples} of {parts} parts under constraints are too many samples to try each"
                );
                let hint =
                    format!("take a numSamples that divides {parts}, or drop the constraints");
                issues.error(below(&pointer, "numSamples"), "too-many", message, hint);
            }
            Flaw::Unbalanced { pointer, anew, first } => {
                let message = format!(
                    "of {CYCLES} rounds of samples after the first, {anew} had to be drawn anew to meet \
                     the constraints and {first} repeat the first: some parts will be shown together \
                     more often than others"
                );
                let hint = "loosen the constraints or take a larger numSamples; each part is still \
                            shown equally often";
                issues.warning(below(&pointer, "numSamples"), "uneven-samples", message, hint);
            }
        }
    }
}
