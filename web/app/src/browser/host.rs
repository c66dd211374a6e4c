//! The border to the scripts of the stage (`static/participant/bridge.js`): canvas, solver, locks.

use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;
use web_sys::Node;

#[wasm_bindgen(raw_module = "./participant/bridge.js")]
extern "C" {
    /// Takes the lock of a session for as long as the page lives; false if another tab has it.
    #[wasm_bindgen(js_name = holdSession, catch)]
    pub async fn hold_session(name: &str) -> Result<JsValue, JsValue>;

    /// Browser name, its major version and platform class, as JSON: nothing finer.
    #[wasm_bindgen(js_name = about)]
    pub fn about() -> String;

    /// Fetches and solves a clip; calls back with 0..1.
    #[wasm_bindgen(js_name = prepareClip, catch)]
    pub async fn prepare_clip(
        clip: &str,
        source: &str,
        progress: &js_sys::Function,
    ) -> Result<JsValue, JsValue>;

    /// Puts a stage on a canvas, by the canvas's name (`mimique_session::flow::PlacedClip`).
    #[wasm_bindgen(js_name = attachStage)]
    pub fn attach_stage(name: &str, canvas: &Node, look: &str);

    /// Takes the stages off the canvases that have gone.
    #[wasm_bindgen(js_name = detachStages)]
    pub fn detach_stages();

    /// Shows the first frame of clips, JSON of `PlacedClip`s.
    #[wasm_bindgen(js_name = showClips, catch)]
    pub async fn show_clips(clips: &str) -> Result<JsValue, JsValue>;

    /// Plays clips once, JSON of `PlacedClip`s, in step or in turn; resolves with the log as JSON, its times on
    /// the page's clock.
    #[wasm_bindgen(js_name = playClips, catch)]
    pub async fn play_clips(clips: &str, in_turn: bool) -> Result<JsValue, JsValue>;

    /// Opens the way to a program on this machine that is told what is shown; `settings`: JSON of the study's
    /// triggers.
    #[wasm_bindgen(js_name = openTriggers)]
    pub fn open_triggers(settings: &str);

    /// Tells that program of events, JSON.
    #[wasm_bindgen(js_name = tellTriggers)]
    pub fn tell_triggers(events: &str);

    /// What browser and display can do, as the JSON of `mimique_study::Display`; where a clip is given, while
    /// it is drawn in the study's look.
    #[wasm_bindgen(js_name = measure, catch)]
    pub async fn measure(
        clip: Option<String>,
        source: &str,
        look: &str,
    ) -> Result<JsValue, JsValue>;

    /// Lets the page fill the screen; called from a press.
    #[wasm_bindgen(js_name = requestFullscreen)]
    pub fn request_fullscreen();

    /// Gives the screen back.
    #[wasm_bindgen(js_name = leaveFullscreen)]
    pub fn leave_fullscreen();

    /// Whether the page fills the screen.
    #[wasm_bindgen(js_name = isFullscreen)]
    pub fn is_fullscreen() -> bool;

    /// The address of a picture or a sign-language video of the study, fetched by its hash.
    #[wasm_bindgen(js_name = mediaAddress, catch)]
    pub async fn media_address(hash: &str, media_type: &str) -> Result<JsValue, JsValue>;

    /// Copies a text; resolves with whether that was possible.
    #[wasm_bindgen(js_name = copy, catch)]
    pub async fn copy(text: &str) -> Result<JsValue, JsValue>;

    /// Gives the participant a text as a file.
    #[wasm_bindgen(js_name = download)]
    pub fn download(name: &str, text: &str);

    /// Goes on measuring the participant's face after a reload; `pages`: JSON of what the study says of it, `camera`: the
    /// answer `mimicry_camera`.
    #[wasm_bindgen(js_name = openMimicry)]
    pub fn open_mimicry(pages: &str, camera: &str);

    /// Gives a page whose controls are a script's (its hidden input), or the captions below a clip, their place.
    #[wasm_bindgen(js_name = attachSound)]
    pub fn attach_sound(node: &Node);

    /// The next level of an adaptive block: what `Effect::ChooseLevel` holds as JSON in, its event as JSON out.
    #[wasm_bindgen(js_name = nextLevel, catch)]
    pub async fn next_level(request: &str) -> Result<JsValue, JsValue>;

    /// The clips that may come after the level that was chosen last, a list as JSON.
    #[wasm_bindgen(js_name = levelsAhead, catch)]
    pub async fn levels_ahead() -> Result<JsValue, JsValue>;

    /// The next batch of pairs: `mimique_study::PairRequest` as JSON in, the event as JSON out.
    #[wasm_bindgen(js_name = drawPairs, catch)]
    pub async fn draw_pairs(request: &str) -> Result<JsValue, JsValue>;

    /// Aborts the play in progress.
    #[wasm_bindgen(js_name = stopClip)]
    pub fn stop_clip();
}
