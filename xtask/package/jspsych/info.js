// What jsPsych is told of the plugin: its parameters, the columns of its data, how it is cited.

/** The version of Mimique that the plugin belongs to. */
export const version = "0.1.0";

/** `ParameterType`: jsPsych's own. */
export const infoOf = (ParameterType) => ({
  name: "mimique",
  version,
  parameters: {
    /** One to nine clips, beside each other: each an object with what the element `<mimique-stage>` takes: `src`, `clip`, `packs`; or `source`; or `avatar`, `capture`, `map`, `method`, `frames`. */
    clips: { type: ParameterType.COMPLEX, array: true, default: undefined },
    /** Plays the clips one after the other instead of in step. */
    in_turn: { type: ParameterType.BOOL, default: false },
    /** Words above the clips, one for each; empty for none. */
    clip_labels: { type: ParameterType.STRING, array: true, default: [] },
    /** How many clips stand in a row; null for what the page has room for. */
    columns: { type: ParameterType.INT, default: null },
    /** Width and height of a clip in CSS pixels; a narrow page makes them smaller. */
    clip_size: { type: ParameterType.INT, default: 320 },
    /** What is behind the face, `#rrggbb`. */
    background: { type: ParameterType.STRING, default: "#808080" },
    /** Where the faces are seen from: `{yaw, pitch}` in radians, `{zoom}` 1 for the standard portrait. */
    view: { type: ParameterType.OBJECT, default: null },
    /** Whether the sound of the clips is heard: the person must have clicked or pressed a key before. */
    sound: { type: ParameterType.BOOL, default: false },
    /** HTML between the clips and the answers: the question. */
    prompt: { type: ParameterType.HTML_STRING, default: null },
    /** Labels of the buttons, from the first answer on; empty where keys answer alone. */
    choices: { type: ParameterType.STRING, array: true, default: [] },
    /** Keys that answer, the first for the first answer and so on; beside the buttons, or alone. */
    keys: { type: ParameterType.STRING, array: true, default: [] },
    /** The HTML of a button, from its label and its number. */
    button_html: {
      type: ParameterType.FUNCTION,
      default: (choice) => `<button class="jspsych-btn">${choice}</button>`,
    },
    /** Whether an answer counts while the clips play. */
    response_allowed_while_playing: { type: ParameterType.BOOL, default: false },
    /** Whether an answer ends the trial; if not, the trial ends with the clips, or after `trial_duration`. */
    response_ends_trial: { type: ParameterType.BOOL, default: true },
    /** Whether the trial ends when the clips have ended. */
    trial_ends_after_clips: { type: ParameterType.BOOL, default: false },
    /** Longest trial in milliseconds from the first frame; null for any length. */
    trial_duration: { type: ParameterType.INT, default: null },
    /** Whether the data keeps every frame. */
    save_frames: { type: ParameterType.BOOL, default: true },
    /** Label of the button that plays clips again whose play was interrupted. */
    again_label: { type: ParameterType.STRING, default: "Play again" },
  },
  data: {
    /** Milliseconds from the first frame that was shown to the answer; null without an answer. */
    rt: { type: ParameterType.FLOAT },
    /** Which answer, from 0; null without one. */
    response: { type: ParameterType.INT },
    /** `button` or `key`. */
    response_source: { type: ParameterType.STRING },
    /** The key that answered. */
    response_key: { type: ParameterType.STRING },
    /** The clips' names. */
    clips: { type: ParameterType.STRING, array: true },
    /** SHA-256 per clip over avatar, capture, map, method, parameters and version of the solver. */
    provenance: { type: ParameterType.STRING, array: true },
    /** SHA-256 per clip of the weights as this browser solved them. */
    weights_hash: { type: ParameterType.STRING, array: true },
    /** When the first frame was shown, in the clock of `performance.now()`. */
    onset_ms: { type: ParameterType.FLOAT },
    /** When the last frame was shown. */
    end_ms: { type: ParameterType.FLOAT },
    /** Every frame: [shown at, time of the clip, 1 where it was late], milliseconds; null with `save_frames: false`. */
    frames: { type: ParameterType.COMPLEX, array: true },
    /** How many frames were late. */
    late: { type: ParameterType.INT },
    /** Longest time between two frames, milliseconds. */
    longest_ms: { type: ParameterType.FLOAT },
    /** How far clips in step were apart at most, milliseconds. */
    drift_ms: { type: ParameterType.FLOAT },
    /** Of the display. */
    refresh_hz: { type: ParameterType.FLOAT },
    /** `webgpu` or `webgl2`. */
    backend: { type: ParameterType.STRING },
    /** What drew: package and version. */
    renderer: { type: ParameterType.STRING },
    /** Why the last play ended early; null for a whole play. */
    aborted: { type: ParameterType.STRING },
    /** Why earlier plays of this trial were interrupted. */
    interrupted: { type: ParameterType.STRING, array: true },
    /** What was wrong where nothing could be shown: `{code, message}`; the trial then ends without an answer. */
    failure: { type: ParameterType.OBJECT },
  },
  citations: {
    apa: "The Mimique maintainers. (2026). Mimique: perceptual studies of avatar faces driven by motion capture (Version 0.1.0) [Computer software].",
    bibtex: "@software{mimique2026, author = {{The Mimique maintainers}}, title = {Mimique: perceptual studies of avatar faces driven by motion capture}, version = {0.1.0}, year = {2026}}",
  },
});
