//! A trial: the clip, then its questions. The canvas stays from one trial to the next.

use mimique_session::flow::{
    BESIDE_CANVAS, BesideView, ChoiceView, Input, OWN_CANVAS, PanelFigure, PanelView, Phase,
    QuestionKindView, QuestionView, TrialView, View,
};

use super::clock::clock;
use super::questions::question_list;
use super::{button, form, heading, hundredth, main, progress_line, px, sends, submit};
use crate::act::Act;
use crate::browser::{document, host};
use crate::dom::{Element, FieldEvent, el, words};
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
        .all(trial.keys.iter().map(|asked| meanwhile(asked, trial.can_press)).collect())
        .with(words("p", "trial-message", &trial.message).key("message").set("role", "status"));
    if let Some((reason, retry)) = failed {
        card = card
            .with(words("p", "notice bad", reason).key("failed"))
            .with(button("primary", "retry", retry).on("click", sends(|| Input::Retry)));
    }
    let questions = seen.then(|| {
        let fields = el("fieldset", "bare")
            .flag("disabled", !trial.can_answer)
            .all(match &trial.panel {
                Some(panel) if panel.is_rated => panel_questions(engine, panel, &trial.questions),
                _ => question_list(engine, &trial.questions),
            })
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

/// A question that is answered while the clip plays.
fn meanwhile(asked: &QuestionView, can_press: bool) -> Element {
    match &asked.kind {
        QuestionKindView::Slider { minimum, maximum, step, left, right, .. } => {
            line(asked, [*minimum, *maximum, *step], [left, right])
        }
        _ => keys(asked, can_press),
    }
}

/// A line that is moved while the clip plays; where it stands, a script notes (`static/participant/bridge.js`).
fn line(asked: &QuestionView, [minimum, maximum, step]: [f64; 3], ends: [&str; 2]) -> Element {
    let field = el("input", "")
        .set("type", "range")
        .set("min", &minimum.to_string())
        .set("max", &maximum.to_string())
        .set("step", &step.to_string())
        .set("aria-label", &asked.prompt)
        .set("data-trace", &asked.id);
    let [left, right] = ends.map(|end| words("span", "", end));
    el("div", "keys")
        .key(&asked.id)
        .set("data-question", &asked.id)
        .with(words("p", "", &asked.prompt))
        .with(left)
        .with(field)
        .with(right)
}

/// A question that keys answer while the clip plays: what is asked, and each option with its key, to be pressed too.
fn keys(asked: &QuestionView, can_press: bool) -> Element {
    let QuestionKindView::Keys { options, keys } = &asked.kind else { return el("div", "") };
    let given = asked.value.as_ref().and_then(|value| value.as_str());
    let option = |(option, key): (&ChoiceView, &Option<String>)| {
        let key = key.as_ref()?;
        let is_given = given == Some(&option.value);
        let opens = can_press && given.is_none();
        let press = {
            let (question, value) = (asked.id.clone(), option.value.clone());
            move |event: FieldEvent| {
                let (question, value) = (question.clone(), value.clone());
                opens.then(|| Act::Input(Input::Press { question, value, at_ms: event.at_ms }))
            }
        };
        Some(
            button("key", "press", "")
                .key(&option.value)
                .set("value", &option.value)
                .set("aria-pressed", if is_given { "true" } else { "false" })
                .flag("aria-disabled", !opens)
                .with(words("kbd", "", key))
                .with(words("span", "", &option.label))
                .handles("pointerdown", press.clone())
                .handles("click", press),
        )
    };
    let buttons = options.iter().zip(keys).filter_map(option).collect();
    el("div", "keys")
        .key(&asked.id)
        .set("role", "group")
        .set("aria-label", &asked.prompt)
        .set("data-question", &asked.id)
        .with(words("p", "", &asked.prompt))
        .all(buttons)
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
    let veil = match trial.phase {
        Phase::Loading { fraction } => {
            let bar = el("progress", "")
                .set("max", "1")
                .set("aria-label", &trial.message)
                .set("value", &fraction.to_string());
            Some(el("div", "veil").with(bar))
        }
        _ => None,
    };
    let (kind, figures) = match &trial.panel {
        Some(panel) => ("stage-frame panel", panel_figures(panel, &look, veil)),
        None => {
            let place = el("div", "stage").with(canvas(&trial.heading, &look, OWN_CANVAS));
            let caption = beside.and_then(|beside| beside.clip_caption.as_ref());
            let figure = el("figure", "")
                .key("clip")
                .with(place.option(veil))
                .option(caption.map(|text| words("figcaption", "", text)));
            let kind = if beside.is_some() { "stage-frame pair" } else { "stage-frame" };
            (kind, vec![figure])
        }
    };
    let mut frame = el("div", kind).key("stage");
    if trial.panel.is_some() {
        let [columns, rows] = panel_grid(figures.len()).map(|count| count.to_string());
        frame = frame.style("--columns", &columns).style("--rows", &rows);
    }
    frame
        .style("--stage-width", &px(width))
        .style("--stage-height", &px(height))
        .style("--stage-ratio", &(width / height).to_string())
        .style("--stage-aspect", &[hundredth(width).as_str(), &hundredth(height)].join(" / "))
        .all(figures)
        .option(beside.map(|beside| companion(beside, &look)))
        .option(play_button(trial, seen))
}

/// The clips of a panel: the open reference, then A, B, C.
fn panel_figures(panel: &PanelView, look: &str, mut veil: Option<Element>) -> Vec<Element> {
    let figure = |figure: &PanelFigure| {
        let stage = el("div", "stage").with(canvas(&figure.caption, look, &figure.canvas));
        el("figure", "")
            .key(&figure.canvas)
            .set("data-place", &figure.place.to_string())
            .with(stage.option(veil.take()))
            .with(words("figcaption", "", &figure.caption))
    };
    panel.figures.iter().map(figure).collect()
}

/// Columns and rows of so many clips of a panel.
fn panel_grid(count: usize) -> [usize; 2] {
    let square = (1..=count).find(|side| side * side >= count).unwrap_or(1);
    let columns = if count <= 3 { count.max(1) } else { square };
    [columns, count.div_ceil(columns)]
}

/// What is asked of the clips of a panel: each with the button that plays it alone.
fn panel_questions(engine: &Engine, panel: &PanelView, questions: &[QuestionView]) -> Vec<Element> {
    let play = |figure: &PanelFigure| {
        let (place, can_play) = (figure.place, figure.can_play);
        button("", "play-alone", &figure.play_label)
            .flag("aria-disabled", !can_play)
            .handles("click", move |_| can_play.then_some(Act::Input(Input::PlayAlone(place))))
    };
    let reference = panel.figures.iter().find(|figure| figure.place == 0).map(play);
    let rated = panel.figures.iter().filter(|figure| figure.place > 0);
    let rows = rated.zip(question_list(engine, questions)).map(|(figure, question)| {
        el("div", "panel-row").key(&figure.canvas).with(play(figure)).with(question)
    });
    let first = el("div", "panel-asked").key("asked").with(words("p", "", &panel.prompt));
    [first.option(reference)].into_iter().chain(rows).collect()
}

/// What is played in step beside the trial's own clip, on its side.
fn companion(beside: &BesideView, look: &str) -> Element {
    let caption = beside.caption.as_deref();
    let canvas = canvas(caption.unwrap_or_default(), look, BESIDE_CANVAS);
    el("figure", if beside.left { "first" } else { "" })
        .key("beside")
        .set("data-beside", "")
        .with(el("div", "stage").with(canvas))
        .option(caption.map(|text| words("figcaption", "", text)))
}

fn canvas(label: &str, look: &str, name: &str) -> Element {
    let (name, look) = (name.to_owned(), look.to_owned());
    el("canvas", "")
        .set("role", "img")
        .maybe("aria-label", (!label.is_empty()).then_some(label))
        .mounted(move |canvas| host::attach_stage(&name, canvas, &look), host::detach_stages)
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
