//! Clips, pictures and videos: prepared one after the other, the most urgent first, shown and played.

use std::rc::Rc;

use mimique_session::flow::{Input, PlacedClip};
use mimique_session::{PlayLog, StageFailure};
use mimique_study::MEDIA_PREFIX;
use serde::de::DeserializeOwned;
use serde_json::Value;
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast as _, JsValue};
use wasm_bindgen_futures::spawn_local;

use super::Engine;
use crate::browser::{host, stage_failure};

impl Engine {
    /// Prepares clips, the first named first; one that is under way already answers soon.
    pub(super) fn prepare_clips(self: &Rc<Self>, clips: Vec<String>) {
        let mut queue = self.to_prepare.borrow_mut();
        queue.retain(|waiting| !clips.contains(waiting));
        let under_way = self.preparing.borrow();
        let others = clips.into_iter().rev().filter(|clip| under_way.as_ref() != Some(clip));
        others.for_each(|clip| queue.push_front(clip));
        drop(under_way);
        drop(queue);
        self.prepare();
    }

    fn prepare(self: &Rc<Self>) {
        if self.preparing.borrow().is_none() && self.next_to_prepare() {
            let engine = Rc::clone(self);
            spawn_local(async move {
                loop {
                    let Some(clip) = engine.preparing.borrow().clone() else { break };
                    engine.prepare_one(clip).await;
                    engine.next_to_prepare();
                }
            });
        }
    }

    fn next_to_prepare(&self) -> bool {
        let next = self.to_prepare.borrow_mut().pop_front();
        let found = next.is_some();
        self.preparing.replace(next);
        found
    }

    async fn prepare_one(self: &Rc<Self>, clip: String) {
        if self.prepared.borrow().contains_key(&clip) {
            return self.dispatch(Input::ClipPrepared { clip });
        }
        let face = self.plan.face(&clip);
        let at_rest = face.as_ref().map_or(&*clip, |(at_rest, _)| *at_rest);
        let Some(source) = self.clips.get(at_rest) else {
            let message = ["the server has no ", &clip].concat();
            let failure =
                StageFailure { code: "missing".to_owned(), message, ..Default::default() };
            return self.dispatch(Input::ClipFailed { clip, failure });
        };
        let loaded = match clip.strip_prefix(MEDIA_PREFIX) {
            Some(path) => self.load_media(path, source).await,
            None => {
                let mut source = source.clone();
                if let Some((_, drawn_from)) = face {
                    source["face"] = drawn_from;
                }
                self.load_clip(&clip, &source).await
            }
        };
        match loaded {
            Ok(()) => {
                self.prepared.borrow_mut().insert(clip.clone(), ());
                self.dispatch(Input::ClipPrepared { clip });
            }
            Err(thrown) => {
                let failure = stage_failure(&thrown);
                self.dispatch(Input::ClipFailed { clip, failure });
            }
        }
    }

    /// Fetches a picture or a sign-language video, from the bundle's `source`.
    async fn load_media(&self, path: &str, source: &Value) -> Result<(), JsValue> {
        let text = |key: &str| source.get(key).and_then(Value::as_str).unwrap_or_default();
        let address = host::media_address(text("avatar"), text("video")).await?;
        let address = address.as_string().unwrap_or_default();
        self.media.borrow_mut().insert(path.to_owned(), address);
        Ok(())
    }

    async fn load_clip(self: &Rc<Self>, clip: &str, source: &Value) -> Result<(), JsValue> {
        let progress = Closure::<dyn Fn(f64)>::new({
            let (engine, clip) = (Rc::clone(self), clip.to_owned());
            move |fraction| engine.dispatch(Input::ClipProgress { clip: clip.clone(), fraction })
        });
        let source = source.to_string();
        host::prepare_clip(clip, &source, progress.as_ref().unchecked_ref()).await?;
        Ok(())
    }

    /// Chooses the level of a trial of an adaptive block. A module that breaks is asked no more: the page says that
    /// the trial's clip cannot be had.
    pub(super) fn choose_level(self: &Rc<Self>, request: Value) {
        let engine = Rc::clone(self);
        spawn_local(async move {
            let chosen = read(host::next_level(&request.to_string()).await);
            engine.dispatch(Input::LevelChosen(chosen.unwrap_or_default()));
            // What may come next is found out once the level stands there.
            if let Some(ahead) = read(host::levels_ahead().await) {
                engine.dispatch(Input::LevelsAhead(ahead));
            }
        });
    }

    /// Draws the next batch of pairs, under the answers of all others as far as they are told.
    pub(super) fn draw_pairs(self: &Rc<Self>, mut request: Value) {
        let engine = Rc::clone(self);
        spawn_local(async move {
            let component = request["component"].as_str().unwrap_or_default();
            let session = &engine.plan.started.session;
            let others = engine.service.pair_counts(session, component).await;
            request["others"] = others.unwrap_or_else(|_| Value::Array(Vec::new()));
            let event = read(host::draw_pairs(&request.to_string()).await);
            engine.dispatch(Input::PairsDrawn(event.unwrap_or_default()));
        });
    }

    /// Shows the first frame of clips that are prepared, each on its canvas.
    pub fn show(self: &Rc<Self>, clips: &[PlacedClip]) {
        let (engine, clip, clips) = (Rc::clone(self), first(clips), as_json(clips));
        spawn_local(async move {
            if let Err(thrown) = host::show_clips(&clips).await {
                engine.prepared.borrow_mut().remove(&clip);
                let failure = stage_failure(&thrown);
                engine.dispatch(Input::ClipFailed { clip, failure });
            }
        });
    }

    /// Plays clips in step, or in turn.
    pub(super) fn play(self: &Rc<Self>, clips: &[PlacedClip], in_turn: bool) {
        let (engine, clip, clips) = (Rc::clone(self), first(clips), as_json(clips));
        spawn_local(async move {
            let played = host::play_clips(&clips, in_turn).await;
            let input = match played.map(|log| play_log(&log)) {
                Ok(Ok(log)) => Input::Played(log),
                Ok(Err(failure)) => Input::ClipFailed { clip, failure },
                Err(thrown) => Input::ClipFailed { clip, failure: stage_failure(&thrown) },
            };
            engine.dispatch(input);
        });
    }
}

/// Makes the levels of an adaptive block ready. Where that fails, the first trial finds out and says so.
pub(super) fn ready_levels(request: Value) {
    spawn_local(async move { drop(host::next_level(&request.to_string()).await) });
}

/// What a script gave as JSON; nothing where it failed.
fn read<T: DeserializeOwned>(given: Result<JsValue, JsValue>) -> Option<T> {
    serde_json::from_str(&given.ok()?.as_string()?).ok()
}

/// The clip that a failure of the stage is told of.
fn first(clips: &[PlacedClip]) -> String {
    clips.first().map_or_else(String::new, |placed| placed.clip.clone())
}

fn as_json(clips: &[PlacedClip]) -> String {
    serde_json::json!(clips).to_string()
}

fn play_log(log: &JsValue) -> Result<PlayLog, StageFailure> {
    let failure = |message: String| StageFailure { message, ..StageFailure::default() };
    let text = log.as_string().ok_or_else(|| failure("the stage gave no log".to_owned()))?;
    serde_json::from_str(&text).map_err(|error| failure(format!("the stage's log: {error}")))
}
