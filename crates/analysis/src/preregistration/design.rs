//! Design and variables in words.

use std::borrow::Cow;

use mimique_locale::Language;
use mimique_study::columns::ASSIGNED_CONDITION;
use mimique_study::{
    Clip, Component, Constraint, KindOfQuestion as _, OrderRule, Question, Sequence, SequenceItem,
    Study,
};

use super::{Preregistration, Text, faces, levels, pairs, panels, scaling};
use crate::naming::Naming;
use crate::simulate::factor_levels;

pub(super) fn write(text: &mut Text, from: &Preregistration<'_>, naming: &Naming<'_>) {
    text.heading(2, "Design plan", "Plan d’expérience");
    text.heading(3, "Study type", "Type d’étude");
    text.both(
        "Experiment: the clips are made by the researcher, and each participant gets a drawn order of them.",
        "Expérience : les extraits sont produits par le chercheur et chaque participant en reçoit un ordre tiré au sort.",
    );
    text.heading(3, "Blinding", "Aveugle");
    text.both(
        "Participants are not told by which method a clip was made, nor what is compared, before the last answer. Analyses are computed by a program fixed beforehand.",
        "Les participants ne savent ni par quelle méthode un extrait a été produit, ni ce qui est comparé, avant la dernière réponse. Les analyses sont calculées par un programme fixé d’avance.",
    );
    text.heading(3, "Study design", "Plan");
    plan(text, from, naming);
    text.heading(3, "Randomization", "Tirage au sort");
    randomization(text, from, naming);
}

/// What is shown to whom.
pub(super) fn plan(text: &mut Text, from: &Preregistration<'_>, naming: &Naming<'_>) {
    let (language, study) = (from.language, from.study);
    let clips = study.clips();
    let conditions = study.conditions();
    let trials = trials_in(study, &study.sequence, &clips, None);
    let sampled = samples(&study.sequence);
    let segments = study.stimuli.segments.len();
    let (methods, avatars) = (study.stimuli.methods.len(), study.stimuli.avatars.len());
    let count = language.counted(clips.len(), ["clip", "clips"], ["extrait", "extraits"]);
    let segments = language.counted(
        segments,
        ["segment of performance", "segments of performance"],
        ["segment joué", "segments joués"],
    );
    let methods = language.counted(methods, ["method", "methods"], ["méthode", "méthodes"]);
    let avatars = language.counted(avatars, ["avatar", "avatars"], ["avatar", "avatars"]);
    let words = language.pick(
        format!("Within participants: {count}, made of {segments}, {methods} and {avatars}."),
        format!("Intra-participants : {count}, faits de {segments}, {methods} et {avatars}."),
    );
    text.line(&words);
    for name in &conditions {
        let trials = trials_in(study, &study.sequence, &clips, Some(name));
        let trials = trials_counted(language, trials);
        let words = language.pick(
            format!("Between participants: the condition `{name}`, of {trials}."),
            format!("Inter-participants : la condition `{name}`, de {trials}."),
        );
        text.line(&words);
    }
    let words = trials_in_words(language, sampled, !conditions.is_empty(), trials);
    text.line(&words);
    text.line("");
    for (factor, levels) in factor_levels(study, &clips) {
        if levels.len() < 2 || crate::simulate::traits(study).contains_key(&factor) {
            continue;
        }
        let names: Vec<String> = levels.iter().map(|level| naming.level(&factor, level)).collect();
        text.item(&naming.factor(&factor), &naming.factor(&factor), &names.join(", "));
    }
    text.line("");
    if let Some(training) = &study.training {
        let count = language.counted(
            training.clips.len(),
            ["trial for practice comes", "trials for practice come"],
            ["essai d’entraînement précède", "essais d’entraînement précèdent"],
        );
        let words = language.pick(
            format!("{count} first; answers for practice are not analysed."),
            format!("{count} ; les réponses d’entraînement ne sont pas analysées."),
        );
        text.line(&words);
        text.line("");
    }
}

/// So many trials.
fn trials_counted(language: Language, trials: usize) -> String {
    language.counted(trials, ["trial", "trials"], ["essai", "essais"])
}

/// How many of the trials each participant sees.
fn trials_in_words(
    language: Language,
    sampled: bool,
    has_conditions: bool,
    trials: usize,
) -> String {
    match sampled {
        true if has_conditions => language.pick(
            "Each participant sees a sample of them; over the participants of a condition each is shown equally often.".to_owned(),
            "Chaque participant en voit une partie ; sur l’ensemble des participants d’une condition, chacun est montré aussi souvent.".to_owned(),
        ),
        false if has_conditions => language.pick(
            "Each participant sees those of one condition.".to_owned(),
            "Chaque participant voit ceux d’une condition.".to_owned(),
        ),
        true => language.pick(
            format!("Each participant sees a sample of the {trials} trials; over participants each is shown equally often."),
            format!("Chaque participant voit une partie des {trials} essais ; sur l’ensemble des participants, chacun est montré aussi souvent."),
        ),
        false => language.pick(
            format!("Each participant sees {}.", trials_counted(language, trials)),
            format!("Chaque participant voit {}.", trials_counted(language, trials)),
        ),
    }
}

/// How orders and conditions are drawn.
pub(super) fn randomization(text: &mut Text, from: &Preregistration<'_>, naming: &Naming<'_>) {
    let (language, study) = (from.language, from.study);
    let conditions = study.conditions();
    if !conditions.is_empty() {
        text.both(
            "A participant’s condition is the one that the invitation’s address names (`?condition=`); without one, that in which the fewest have finished or are on their way, drawn where several have as few.",
            "La condition d’un participant est celle que nomme l’adresse de l’invitation (`?condition=`) ; à défaut, celle où le moins de personnes ont fini ou sont en route, tirée au sort en cas d’égalité.",
        );
        text.line("");
    }
    for line in order_in_words(study, language, naming) {
        text.line(&line);
    }
    let words = language.pick(
        format!(
            "The order follows from the study’s seed ({}), the hash of its file and the participant’s number; `mimique order` prints it.",
            study.seed
        ),
        format!(
            "L’ordre découle de la graine de l’étude ({}), de l’empreinte de son fichier et du numéro du participant ; `mimique order` l’imprime.",
            study.seed
        ),
    );
    text.line(&words);
    text.line("");
}

pub(super) fn variables(text: &mut Text, from: &Preregistration<'_>, naming: &Naming<'_>) {
    text.heading(2, "Variables", "Variables");
    text.heading(3, "Manipulated variables", "Variables manipulées");
    manipulated(text, from, naming);
    text.heading(3, "Measured variables", "Variables mesurées");
    asked(text, from);
    text.heading(3, "Indices", "Indices");
    indices(text, from.study);
}

/// What is varied.
pub(super) fn manipulated(text: &mut Text, from: &Preregistration<'_>, naming: &Naming<'_>) {
    let (language, study) = (from.language, from.study);
    let clips = study.clips();
    let about = crate::simulate::traits(study);
    let tested =
        |factor: &str| study.hypotheses.iter().any(|h| h.factors.iter().any(|f| f == factor));
    for (factor, levels) in factor_levels(study, &clips) {
        let between = factor == ASSIGNED_CONDITION;
        if (about.contains_key(&factor) && !between) || levels.len() < 2 {
            continue;
        }
        let role = if tested(&factor) {
            language.pick("tested", "testée")
        } else {
            language.pick("varied, not tested", "variée, non testée")
        };
        let between = match between {
            true => language.pick(", between participants", ", inter-participants"),
            false => "",
        };
        let words = language.pick(
            format!("{} levels ({role}{between}), column `{factor}`", levels.len()),
            format!("{} niveaux ({role}{between}), colonne `{factor}`", levels.len()),
        );
        text.item(&naming.factor(&factor), &naming.factor(&factor), &words);
    }
    text.line("");
    if study.has_sound() {
        text.both(
            "Clips have sound, played by the browser’s audio clock with the first frame of the face; its offset to that frame is measured in every play (`sound_offset_ms`, `sound_drift_ms`). Before practice participants set the volume and count tones (`sound_check`).",
            "Les extraits ont du son, joué par l’horloge audio du navigateur avec la première image du visage ; son décalage par rapport à cette image est mesuré à chaque lecture (`sound_offset_ms`, `sound_drift_ms`). Avant l’entraînement, les participants règlent le volume et comptent des sons (`sound_check`).",
        );
        text.line("");
    }
    if study.mimicry.is_some() {
        text.both(
            "The faces of participants who agree on a page of its own are measured in their browser while clips play (MediaPipe’s Face Landmarker; no picture is kept). Mimicry is the lagged cross-correlation of the clip’s weights with the scores of the face, at lags from −0.5 to 1.5 s, Fisher’s z averaged over shapes, plays, people; tested is its highest value over all lags, against 999 surrogates (each person’s plays against the other clips that the person saw), p corrected over lags.",
            "Les visages des participants qui l’acceptent sur une page à part sont mesurés dans leur navigateur pendant les extraits (Face Landmarker de MediaPipe ; aucune image n’est conservée). Le mimétisme est la corrélation croisée décalée des poids de l’extrait avec les scores du visage, aux décalages de −0,5 à 1,5 s, le z de Fisher moyenné sur les formes, les lectures, les personnes ; est testée sa plus haute valeur sur tous les décalages, contre 999 substituts (les lectures de chaque personne contre les autres extraits qu’elle a vus), p corrigé pour les décalages.",
        );
        text.line("");
    }
    pairs::design(text, study, language, naming);
    panels::design(text, study, language, naming);
    levels::design(text, study, language);
    scaling::design(text, study, language);
    faces::design(text, study, language);
}

/// What is asked and recorded.
pub(super) fn asked(text: &mut Text, from: &Preregistration<'_>) {
    let (language, study) = (from.language, from.study);
    text.both("After each clip:", "Après chaque extrait :");
    let asked: Vec<String> = blocks(study).flat_map(|block| block.questions.clone()).collect();
    let is_asked = |id: &String| asked.contains(id) || study.is_asked_of_no_clip(id);
    for question in study.questions.iter().filter(|question| is_asked(&question.id)) {
        measured(text, language, question);
    }
    text.line("");
    if let Some(page) = study.demographics.as_ref().filter(|page| !page.questions.is_empty()) {
        text.both("About the participant:", "À propos du participant :");
        for question in &page.questions {
            measured(text, language, question);
        }
        text.line("");
    }
    scales(text, study);
    text.both(
        "Recorded with each trial: response time (from the first frame of the first whole play to the last change of the answer), replays, late frames, the longest frame, interruptions.",
        "Enregistrés à chaque essai : temps de réponse (de la première image de la première lecture complète au dernier changement de la réponse), relectures, images en retard, image la plus longue, interruptions.",
    );
}

/// What is made of the answers before they are tested.
pub(super) fn indices(text: &mut Text, study: &Study) {
    text.both(
        "For each participant, response and level: the mean of the answers over the trials kept; for a choice with a right answer the share of right answers; for a response time its mean in seconds. These values, one a person and level, are what is tested.",
        "Pour chaque participant, réponse et niveau : la moyenne des réponses sur les essais gardés ; pour un choix à bonne réponse, la proportion de bonnes réponses ; pour un temps de réponse, sa moyenne en secondes. Ce sont ces valeurs, une par personne et niveau, qui sont testées.",
    );
    if study.hypotheses.iter().any(|hypothesis| hypothesis.test.is_of_choices()) {
        text.line("");
        text.both(
            "For each choice between two clips: the levels on the left and on the right, and which was chosen.",
            "Pour chaque choix entre deux extraits : les niveaux à gauche et à droite, et celui qui a été choisi.",
        );
    }
}

/// The scales, and how their consistency is told.
fn scales(text: &mut Text, study: &Study) {
    if study.scales.is_empty() {
        return;
    }
    text.both(
        "Scales, their consistency told by Cronbach’s alpha with Feldt’s interval:",
        "Échelles, dont la cohérence est donnée par l’alpha de Cronbach et l’intervalle de Feldt :",
    );
    for (name, scale) in &study.scales {
        let items: Vec<String> = scale
            .items
            .iter()
            .map(|item| match scale.reversed.contains(item) {
                true => format!("−`{item}`"),
                false => format!("`{item}`"),
            })
            .collect();
        text.line(&format!("- {name}: {}", items.join(", ")));
    }
    text.line("");
}

fn measured(text: &mut Text, language: Language, question: &Question) {
    let code = language.code();
    let kind = question.kind.described(code);
    let optional = if question.required { "" } else { language.pick(", optional", ", facultatif") };
    let open = language.pick(["“", "”"], ["« ", " »"]);
    text.line(&format!(
        "- `{}`: {}{}{} {kind}{optional}",
        question.id,
        open[0],
        question.prompt.in_language(code),
        open[1]
    ));
}

/// The blocks of trials that the sequence shows.
fn blocks(study: &Study) -> impl Iterator<Item = Cow<'_, mimique_study::TrialsComponent>> {
    let shown = |name| names(&study.sequence, name);
    study.trial_blocks().into_iter().filter_map(move |(name, block)| shown(name).then_some(block))
}

/// How many trials somebody of a condition can be shown.
fn trials_in(study: &Study, sequence: &Sequence, clips: &[Clip], condition: Option<&str>) -> usize {
    let count = |item: &SequenceItem| match item {
        SequenceItem::Sequence(nested) if !nested.is_shown_in(condition) => 0,
        SequenceItem::Sequence(nested) => trials_in(study, nested, clips, condition),
        SequenceItem::Component(name) => match study.components.get(name) {
            Some(Component::Trials(_) | Component::Pairs(_) | Component::Panel(_)) => {
                study.trial_block(name).map_or(0, |block| block.trial_count(clips))
            }
            Some(Component::Adaptive(_)) => {
                study.adaptive().find(|(own, _)| own == name).map_or(0, |(_, block)| block.steps)
            }
            Some(Component::ReverseCorrelation(block)) => block.trials() as usize,
            Some(Component::Scaling(block)) => {
                block.read().map_or(0, |block| block.trials as usize)
            }
            _ => 0,
        },
    };
    sequence.components.iter().map(count).sum()
}

fn names(sequence: &Sequence, wanted: &str) -> bool {
    sequence.components.iter().any(|item| match item {
        SequenceItem::Component(name) => name == wanted,
        SequenceItem::Sequence(nested) => names(nested, wanted),
    })
}

fn samples(sequence: &Sequence) -> bool {
    sequence.num_samples.is_some()
        || sequence.components.iter().any(|item| match item {
            SequenceItem::Component(_) => false,
            SequenceItem::Sequence(nested) => samples(nested),
        })
}

fn order_in_words(study: &Study, language: Language, naming: &Naming<'_>) -> Vec<String> {
    let mut lines = Vec::new();
    sequence_in_words(&study.sequence, language, naming, &mut lines);
    lines
}

fn sequence_in_words(
    sequence: &Sequence,
    language: Language,
    naming: &Naming<'_>,
    lines: &mut Vec<String>,
) {
    let parts: Vec<String> = sequence
        .components
        .iter()
        .map(|item| match item {
            SequenceItem::Component(name) => format!("`{name}`"),
            SequenceItem::Sequence(nested) => {
                format!(
                    "`{}`",
                    nested.id.as_deref().unwrap_or(language.pick("a part", "une partie"))
                )
            }
        })
        .collect();
    let order = match sequence.order {
        OrderRule::Fixed => language.pick("in this order", "dans cet ordre"),
        OrderRule::Random => language.pick(
            "in an order drawn for each participant",
            "dans un ordre tiré au sort pour chaque participant",
        ),
        OrderRule::LatinSquare => language.pick(
            "in the order of a Williams square over participants",
            "dans l’ordre d’un carré de Williams sur les participants",
        ),
    };
    let only = match sequence.conditional {
        true => language.pick(" (only in this condition)", " (dans cette condition seulement)"),
        false => "",
    };
    let name = sequence.id.as_ref().map_or(String::new(), |id| format!("`{id}`{only}: "));
    match parts.as_slice() {
        [] => lines.push(format!("- {name}{}", language.pick("nothing", "rien"))),
        parts => lines.push(format!("- {name}{} {order}", parts.join(", "))),
    }
    for constraint in &sequence.constraints {
        lines.push(format!("  - {}", constraint_in_words(constraint, language, naming)));
    }
    for item in &sequence.components {
        if let SequenceItem::Sequence(nested) = item {
            sequence_in_words(nested, language, naming, lines);
        }
    }
}

fn constraint_in_words(constraint: &Constraint, language: Language, naming: &Naming<'_>) -> String {
    let factor = naming.factor(&constraint.factor);
    let mut words = Vec::new();
    if let Some(most) = constraint.at_most_alike {
        words.push(language.pick(
            format!("{factor}: at most {most} in a row alike"),
            format!("{factor} : au plus {most} de suite identiques"),
        ));
    }
    if let Some(least) = constraint.minimum_distance {
        words.push(language.pick(
            format!("{factor}: the same value at least {least} trials apart"),
            format!("{factor} : même valeur à {least} essais de distance au moins"),
        ));
    }
    words.join("; ")
}
