//! A trial: the clip, then its questions. The canvas stays from one trial to the next.

use leptos::html::Canvas;
use leptos::prelude::*;
use mimique_study::flow::{BesideView, Input, Phase, TrialView, View};

use super::ProgressLine;
use super::clock::Clock;
use super::questions::QuestionList;
use crate::session::Session;
use crate::{bridge, focus};

/// A trial.
#[component]
pub fn TrialPage() -> impl IntoView {
    let session = Session::here();
    let View::Trial(first) = session.view.get_untracked() else {
        return ().into_any();
    };
    // After the last trial the view is another before this page is gone: the last one stays.
    let trial: Memo<TrialView> = Memo::new(move |last: Option<&TrialView>| {
        session.view.with(|view| match view {
            View::Trial(trial) => (**trial).clone(),
            _ => last.cloned().unwrap_or_else(|| (*first).clone()),
        })
    });
    let part = move |read: fn(&TrialView) -> String| Memo::new(move |_| trial.with(read));
    let step = part(|trial| trial.step.clone());
    let clip = part(|trial| trial.clip.clone());
    let phase = part(|trial| phase_word(&trial.phase).to_owned());
    let heading = part(|trial| trial.heading.clone());
    let message = part(|trial| trial.message.clone());
    let play_label = part(|trial| trial.play_label.clone());
    let submit_label = part(|trial| trial.button.label.clone());
    let can_play = Memo::new(move |_| trial.with(|trial| trial.can_play));
    let can_answer = Memo::new(move |_| trial.with(|trial| trial.can_answer));
    let questions = Memo::new(move |_| trial.with(|trial| trial.questions.clone()));
    let done = Memo::new(move |_| trial.with(|trial| trial.progress.done));
    let total = Memo::new(move |_| trial.with(|trial| trial.progress.total));
    let fraction = Memo::new(move |_| {
        trial.with(|trial| match trial.phase {
            Phase::Loading { fraction } => Some(fraction),
            _ => None,
        })
    });
    let failed = Memo::new(move |_| {
        trial.with(|trial| match &trial.phase {
            Phase::Failed { reason, retry } => Some((reason.clone(), retry.clone())),
            _ => None,
        })
    });
    // Questions appear once the clip was seen and stay while it is played again.
    let seen = Memo::new(move |last: Option<&(String, bool)>| {
        let step = step.get();
        let before = last.is_some_and(|(of, seen)| *of == step && *seen);
        (step, before || can_answer.get())
    });

    let look = session.engine().plan.study.stimuli.look.clone();
    // In millimetres, the size follows the zoom of the page.
    let size = Memo::new(move |_| {
        let size = trial.with(|trial| trial.size);
        let now = window().device_pixel_ratio();
        let scale = size.device_pixel_ratio.filter(|_| now > 0.0).map_or(1.0, |then| then / now);
        (size.width * scale, size.height * scale)
    });
    let clock = Memo::new(move |_| trial.with(|trial| trial.clock.clone()));
    let look = serde_json::to_string(&look).unwrap_or_default();
    let canvas = NodeRef::<Canvas>::new();
    let beside_look = look.clone();
    canvas.on_load(move |canvas| bridge::attach_stage("clip", &canvas, &look));
    on_cleanup(|| bridge::detach_stage("clip"));
    let beside = Memo::new(move |_| trial.with(|trial| trial.beside.clone()));
    let companion = Memo::new(move |_| beside.with(|it| it.as_ref().map(|it| it.clip.clone())));
    let clip_caption =
        Memo::new(move |_| beside.with(|it| it.as_ref().and_then(|it| it.clip_caption.clone())));
    Effect::new(move |_| {
        if phase.get() == "ready" {
            session.engine().show(clip.get(), companion.get());
        }
    });

    Effect::new(move |before: Option<()>| {
        phase.track();
        if before.is_some() {
            focus::rescue(&[
                "main [data-action=play], main [data-action=retry]",
                "main fieldset[data-question] input",
                "main h1",
            ]);
        }
    });

    view! {
        <main class="page" data-view="trial" data-step=step data-phase=phase data-clip=clip>
            <ProgressLine done total/>
            <div class="card">
                <h1 tabindex="-1">{heading}</h1>
                {move || trial.with(|trial| trial.instruction.clone()).map(|text| view! { <p>{text}</p> })}
                <div class="stage-frame" class:pair=move || companion.get().is_some()
                    style=("--stage-width", move || format!("{:.2}px", size.get().0))
                    style=("--stage-aspect", move || format!("{:.2} / {:.2}", size.get().0, size.get().1))>
                    <figure>
                        <div class="stage">
                            <canvas node_ref=canvas role="img" aria-label=heading></canvas>
                            <Show when=move || fraction.get().is_some()>
                                <div class="veil">
                                    <progress max="1" aria-label=move || message.get()
                                        value=move || fraction.get().unwrap_or(0.0).to_string()></progress>
                                </div>
                            </Show>
                        </div>
                        {move || clip_caption.get().map(|text| view! { <figcaption>{text}</figcaption> })}
                    </figure>
                    <Show when=move || companion.get().is_some()>
                        <BesideStage beside look=beside_look.clone()/>
                    </Show>
                </div>
                <p class="trial-message" role="status">{message}</p>
                {move || failed.get().map(|(reason, retry)| view! {
                    <p class="notice bad">{reason}</p>
                    <button type="button" class="primary" data-action="retry"
                        on:click=move |_| session.send(Input::Retry)>{retry}</button>
                })}
                // It stays while the clip is loaded and played: the keyboard's place does not vanish.
                <Show when=move || failed.with(Option::is_none) && (can_play.get() || phase.with(|now| now != "answering"))>
                    <div class="actions centred">
                        <button type="button" data-action="play"
                            class:primary=move || !seen.get().1
                            aria-disabled=move || (!can_play.get()).then_some("true")
                            on:click=move |_| if can_play.get_untracked() { session.send(Input::Play) }>
                            {play_label}
                        </button>
                    </div>
                </Show>
            </div>
            <Clock clock/>
            <Show when=move || seen.get().1>
                <form class="card" novalidate
                    on:submit=move |event| {
                        event.prevent_default();
                        session.send(Input::Next);
                        focus::problem();
                    }>
                    <fieldset class="bare" disabled=move || !can_answer.get()>
                        <QuestionList step questions/>
                        <div class="actions">
                            <button type="submit" class="primary" data-action="next">{submit_label}</button>
                        </div>
                    </fieldset>
                </form>
            </Show>
        </main>
    }
    .into_any()
}

/// What is played in step beside the trial's own clip, on its side.
#[component]
fn BesideStage(beside: Memo<Option<BesideView>>, look: String) -> impl IntoView {
    let caption =
        Memo::new(move |_| beside.with(|it| it.as_ref().and_then(|it| it.caption.clone())));
    let left = Memo::new(move |_| beside.with(|it| it.as_ref().is_some_and(|it| it.left)));
    let canvas = NodeRef::<Canvas>::new();
    canvas.on_load(move |canvas| bridge::attach_stage("beside", &canvas, &look));
    on_cleanup(|| bridge::detach_stage("beside"));
    view! {
        <figure class:first=left data-beside=move || beside.with(|it| it.as_ref().map(|it| it.clip.clone()))>
            <div class="stage">
                <canvas node_ref=canvas role="img" aria-label=caption></canvas>
            </div>
            {move || caption.get().map(|text| view! { <figcaption>{text}</figcaption> })}
        </figure>
    }
}

fn phase_word(phase: &Phase) -> &'static str {
    match phase {
        Phase::Loading { .. } => "loading",
        Phase::Failed { .. } => "failed",
        Phase::Ready => "ready",
        Phase::Playing => "playing",
        Phase::Answering => "answering",
    }
}
