//! A trial: the clip, then its questions. The canvas stays from one trial to the next.

use mimique_session::flow::{BesideView, Input, Phase, TrialView, View};

use super::clock::clock;
use super::questions::question_list;
use super::{button, form, heading, hundredth, main, progress_line, px, sends, submit};
use crate::act::Act;
use crate::browser::{document, host};
use crate::dom::{Element, el, words};
use crate::engine::Engine;

/// Which trial's clip has been seen: its questions appear then, and stay while it is played again.
#[derive(Default)]
pub struct WatchedClip(Option<String>);

impl WatchedClip {
    /// Takes note of what stands on the screen.
    pub fn look(&mut self, view: &View) {
        match view {
            View::Trial(trial) if trial.can_answer => self.0 = Some(trial.step.clone()),
            View::Trial(trial) if self.0.as_ref() == Some(&trial.step) => {}
            _ => self.0 = None,
        }
    }
}

/// A trial.
pub fn trial(engine: &Engine, trial: &TrialView, watched: &WatchedClip) -> Element {
    let seen = watched.0.is_some();
    let failed = match &trial.phase {
        Phase::Failed { reason, retry } => Some((reason, retry)),
        _ => None,
    };
    let mut card = el("div", "card clip-card")
        .key("clip")
        .with(heading(&trial.heading))
        .option(trial.instruction.as_ref().map(|text| words("p", "", text).key("instruction")))
        .with(frame(engine, trial, seen))
        .option(trial.captions.as_ref().map(captions))
        .with(words("p", "trial-message", &trial.message).key("message").set("role", "status"));
    if let Some((reason, retry)) = failed {
        card = card
            .with(words("p", "notice bad", reason).key("failed"))
            .with(button("primary", "retry", retry).on("click", sends(|| Input::Retry)));
    }
    let questions = seen.then(|| {
        let fields = el("fieldset", "bare")
            .flag("disabled", !trial.can_answer)
            .all(question_list(engine, &trial.questions))
            .with(submit(&trial.button.label));
        form().with(fields)
    });
    let answers = el("div", "answers")
        .key("answers")
        .option(trial.clock.as_ref().map(clock))
        .option(questions);
    main("page trial-page", "trial")
        .set("data-phase", phase_word(&trial.phase))
        .with(progress_line(trial.progress))
        .with(el("div", "trial").key("trial").with(card).with(answers))
}

/// The place of the captions, which a script fills (`static/sound/sound.js`).
fn captions([rule, label]: &[String; 2]) -> Element {
    el("div", "captions")
        .key("captions")
        .set("data-captions", rule)
        .set("data-label", label)
        .mounted(host::attach_sound, || ())
}

/// The button that plays, on the picture. It stays while the clip is loaded and played: the keyboard's place
/// does not vanish.
fn play_button(trial: &TrialView, seen: bool) -> Option<Element> {
    let can_play = trial.can_play;
    let stays = match &trial.phase {
        Phase::Failed { .. } => false,
        Phase::Answering => can_play,
        _ => true,
    };
    stays.then(|| {
        let play = button(if seen { "" } else { "primary" }, "play", &trial.play_label)
            .flag("aria-disabled", !can_play)
            .handles("click", move |_| can_play.then_some(Act::Input(Input::Play)));
        el("div", "play").key("play").with(play)
    })
}

/// The clip, and the one beside it.
fn frame(engine: &Engine, trial: &TrialView, seen: bool) -> Element {
    let size = trial.size;
    // In millimetres, the size follows the zoom of the page.
    let now = document::pixel_ratio();
    let scale = size.device_pixel_ratio.filter(|_| now > 0.0).map_or(1.0, |then| then / now);
    let (width, height) = (size.width * scale, size.height * scale);
    let look = serde_json::json!(engine.plan.study.look).to_string();
    let beside = trial.beside.as_ref();
    let mut place = el("div", "stage").with(canvas(&trial.heading, &look, false));
    if let Phase::Loading { fraction } = trial.phase {
        let bar = el("progress", "")
            .set("max", "1")
            .set("aria-label", &trial.message)
            .set("value", &fraction.to_string());
        place = place.with(el("div", "veil").with(bar));
    }
    let caption = beside.and_then(|beside| beside.clip_caption.as_ref());
    let figure = el("figure", "")
        .key("clip")
        .with(place)
        .option(caption.map(|text| words("figcaption", "", text)));
    el("div", if beside.is_some() { "stage-frame pair" } else { "stage-frame" })
        .key("stage")
        .style("--stage-width", &px(width))
        .style("--stage-height", &px(height))
        .style("--stage-ratio", &(width / height).to_string())
        .style("--stage-aspect", &[hundredth(width).as_str(), &hundredth(height)].join(" / "))
        .with(figure)
        .option(beside.map(|beside| companion(beside, &look)))
        .option(play_button(trial, seen))
}

/// What is played in step beside the trial's own clip, on its side.
fn companion(beside: &BesideView, look: &str) -> Element {
    let caption = beside.caption.as_deref();
    let canvas = canvas(caption.unwrap_or_default(), look, true);
    el("figure", if beside.left { "first" } else { "" })
        .key("beside")
        .set("data-beside", "")
        .with(el("div", "stage").with(canvas))
        .option(caption.map(|text| words("figcaption", "", text)))
}

fn canvas(label: &str, look: &str, beside: bool) -> Element {
    let look = look.to_owned();
    let place = if beside { "beside" } else { "clip" };
    let gone: fn() =
        if beside { || host::detach_stage("beside") } else { || host::detach_stage("clip") };
    el("canvas", "")
        .set("role", "img")
        .maybe("aria-label", (!label.is_empty()).then_some(label))
        .mounted(move |canvas| host::attach_stage(place, canvas, &look), gone)
}

/// The word by which tests and scripts know a phase.
pub fn phase_word(phase: &Phase) -> &'static str {
    match phase {
        Phase::Loading { .. } => "loading",
        Phase::Failed { .. } => "failed",
        Phase::Ready => "ready",
        Phase::Playing => "playing",
        Phase::Answering => "answering",
    }
}
