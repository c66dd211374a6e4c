// plugin-mimique: one to nine clips of avatar faces and a question, answered by buttons or keys. The clips are elements
// <mimique-stage>, which index.js and browser.js import.
import { infoOf } from "./info.js";
import { Response } from "./response.js";
import { Row } from "./row.js";

const MOST_CLIPS = 9;

/** The plugin's class, of jsPsych's `ParameterType`. */
export function pluginOf(ParameterType) {
  return class extends MimiquePlugin {
    static info = infoOf(ParameterType);
  };
}

class MimiquePlugin {

  /** Prepares clips ahead, as in `{type: jsPsychCallFunction, async: true, func: (done) => MimiquePlugin.preload(clips).then(done)}`. */
  static async preload(clips) {
    const element = await Row.element();
    return Promise.all(clips.map((clip) => element.prepare(clip)));
  }

  constructor(jsPsych) {
    this.jsPsych = jsPsych;
  }

  trial(display, trial, onLoad) {
    return this.run(display, trial, onLoad);
  }

  /** `onOnset({duration, answer(index)})` is told of each first frame: simulated people answer from there. */
  async run(display, trial, onLoad = () => {}, onOnset = () => {}) {
    checked(trial);
    const row = new Row(display, trial);
    const answers = new Response(this.jsPsych, display, trial);
    try {
      await row.ready();
      onLoad();
      return await this.shown(row, answers, trial, onOnset);
    } catch (error) {
      console.error(error);
      return { ...nothingShown(trial), failure: { code: error.code ?? "failed", message: error.message } };
    } finally {
      answers.close();
      row.close();
    }
  }

  async shown(row, answers, trial, onOnset) {
    const interrupted = [];
    for (;;) {
      const limit = new Limit(this.jsPsych, trial.trial_duration);
      const log = row.play((onset) => {
        answers.from(onset);
        if (trial.response_allowed_while_playing) answers.open();
        limit.from(onset);
        onOnset({ duration: row.duration, answers });
      });
      // Whatever ends the trial during the play stops it.
      const ended = Promise.race(trial.response_ends_trial ? [answers.given, limit.over] : [limit.over]);
      ended.then(() => row.stop("the trial ended"));
      const found = await log;
      if (found.aborted !== null && found.aborted !== "the trial ended") {
        interrupted.push(found.aborted);
        limit.close();
        answers.withdraw();
        await row.again(trial.again_label);
        continue;
      }
      answers.open();
      const waits = (trial.response_ends_trial && answers.isPossible) || trial.trial_duration !== null;
      if (found.aborted === null && !trial.trial_ends_after_clips && waits) await ended;
      limit.close();
      return { ...answers.data(), ...row.data(found, trial.save_frames), interrupted, failure: null };
    }
  }

  simulate(trial, mode, options, onLoad) {
    if (mode === "visual") return this.simulateVisual(trial, options, onLoad);
    onLoad();
    return this.jsPsych.finishTrial(this.simulated(trial, options, durationOf(trial)));
  }

  /** The data of a simulated person, who answers `duration` after the first frame at the earliest unless answers count before. */
  simulated(trial, options, duration) {
    const count = Math.max(trial.choices.length, trial.keys.length);
    const byKey = trial.choices.length === 0;
    const response = count > 0 ? this.jsPsych.randomization.randomInt(0, count - 1) : null;
    const waits = trial.response_allowed_while_playing ? 0 : duration;
    const given = {
      ...nothingShown(trial),
      rt: response === null ? null : waits + this.jsPsych.randomization.sampleExGaussian(500, 50, 1 / 150, true),
      response,
      response_source: response === null ? null : byKey ? "key" : "button",
      response_key: response !== null && byKey ? trial.keys[response] : null,
    };
    const data = this.jsPsych.pluginAPI.mergeSimulationData(given, options);
    this.jsPsych.pluginAPI.ensureSimulationDataConsistency(trial, data);
    if (data.rt === null) Object.assign(data, { response: null, response_source: null, response_key: null });
    return data;
  }

  /** Shows the trial and answers it as a person does; what is measured of it is the data. */
  simulateVisual(trial, options, onLoad) {
    let isFirst = true;
    return this.run(this.jsPsych.getDisplayElement(), trial, onLoad, ({ duration, answers }) => {
      if (!isFirst) return;
      isFirst = false;
      const data = this.simulated(trial, options, duration);
      if (data.rt !== null) answers.simulate(data);
    });
  }
}

function checked(trial) {
  const { clips, clip_labels: labels, choices, keys } = trial;
  const wrong = (what) => new Error(`plugin-mimique: ${what}`);
  if (!Array.isArray(clips) || clips.length < 1 || clips.length > MOST_CLIPS) {
    throw wrong(`clips: ${Array.isArray(clips) ? clips.length : JSON.stringify(clips)}; give a list of 1 to ${MOST_CLIPS} clips`);
  }
  if (labels.length > 0 && labels.length !== clips.length) throw wrong(`clip_labels: ${labels.length} for ${clips.length} clips; give one for each`);
  if (choices.length > 0 && keys.length > choices.length) {
    throw wrong(`keys: ${keys.length} for ${choices.length} choices; give at most one key for each, or no choices`);
  }
  const endsBefore = trial.trial_ends_after_clips || (!trial.response_ends_trial && trial.trial_duration === null);
  if (choices.length + keys.length > 0 && endsBefore && !trial.response_allowed_while_playing) {
    throw wrong("the trial ends with its clips, before anything can be answered; set response_allowed_while_playing, or trial_duration");
  }
}

function nothingShown({ clips }) {
  return {
    rt: null,
    response: null,
    response_source: null,
    response_key: null,
    clips: clips.map(nameOf),
    provenance: clips.map((clip) => clip.source?.provenance ?? ""),
    weights_hash: clips.map((clip) => clip.source?.weights_hash ?? ""),
    onset_ms: null,
    end_ms: null,
    frames: null,
    late: null,
    longest_ms: null,
    drift_ms: null,
    refresh_hz: null,
    backend: null,
    renderer: null,
    aborted: null,
    interrupted: [],
    failure: null,
  };
}

const nameOf = (clip) => clip.clip || clip.src || (typeof clip.capture === "string" ? clip.capture : "clip");

// As far as descriptions that are given whole say it; nothing is loaded to simulate data alone.
const durationOf = ({ clips, in_turn: inTurn }) => {
  const each = clips.map((clip) => clip.source?.duration_ms ?? 0);
  return inTurn ? each.reduce((sum, ms) => sum + ms, 0) : Math.max(...each);
};

/** The longest trial, from its first frame. */
class Limit {
  #jsPsych;
  #duration;
  #timer = null;
  #end;
  over = new Promise((end) => (this.#end = end));

  constructor(jsPsych, duration) {
    [this.#jsPsych, this.#duration] = [jsPsych, duration];
  }

  from(onset) {
    if (this.#duration === null) return;
    const left = Math.max(0, onset + this.#duration - performance.now());
    this.#timer = this.#jsPsych.pluginAPI.setTimeout(() => this.#end(), left);
  }

  close() {
    if (this.#timer !== null) clearTimeout(this.#timer);
  }
}
