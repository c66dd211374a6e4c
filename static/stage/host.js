// Joins the canvas module and the solver's worker for the participant's page and the preview.
// The contract is in ARCHITECTURE.md, "The host scripts".
import { backend, loadModule } from "./backend.js";
import { prepareClip, preparedClip, putClip, weightsAt } from "./clips.js";
import { refreshPeriod } from "./clock.js";
import { StageFailure } from "./failure.js";
import { VideoLayer } from "./video.js";
import { fetchPack } from "./packs.js";
import { Playback, joined } from "./playback.js";

// Modules, scripts and shaders are served under the hash of all of them.
const renderer = /\/assets\/([0-9a-f]+)\//.exec(import.meta.url)?.[1] ?? "";

// What pages load them for: the scripts behind this one are not served by themselves.
export { backend, fetchPack, loadModule, prepareClip, preparedClip, putClip, refreshPeriod };

/// A stage on a canvas. `look`: {background: "#rrggbb", width, height (CSS pixels), variant:
/// "stimulus" (or left out) | "reference"}; a clip's own look goes before the variant.
export async function openStage(canvas, look) {
  const stage = new Stage(canvas, look);
  // Measured before anything is drawn, so that plays know when a frame is late. Opening blocks a frame
  // or two of the 24, which their median does not see.
  await Promise.all([stage.reopen(), refreshPeriod()]);
  return stage;
}

class Stage {
  #canvas;
  #look;
  #backend = null;
  #gpu = null;
  #video;
  #lost = null;
  // Whether the canvas's module has panicked: it is loaded anew then.
  #panicked = false;
  #reopening = null;
  #closed = false;
  #playback = null;
  #shown = null;
  #view = { yaw: 0, pitch: 0, zoom: 1 };
  #weights = new Float32Array(0);
  #onContextLost = (event) => {
    // Without this the browser never gives the context back.
    event.preventDefault();
    this.#fail("graphics context: lost");
  };

  constructor(canvas, look) {
    this.#canvas = canvas;
    this.#video = new VideoLayer(canvas);
    this.#look = { background: "", variant: "stimulus", width: 640, height: 640, ...look };
    const { width, height } = this.#look;
    const frame = canvas.closest(".stage");
    if (canvas.closest(".stage-frame")) {
      // style.css lays the canvas out in its frame, whose page gives the size.
    } else if (frame) {
      frame.style.setProperty("--stage-width", `${width}px`);
      frame.style.setProperty("--stage-aspect", `${width} / ${height}`);
    } else {
      Object.assign(canvas.style, { width: `${width}px`, maxWidth: "100%", height: "auto" });
      canvas.style.aspectRatio = `${width} / ${height}`;
    }
    canvas.addEventListener("webglcontextlost", this.#onContextLost);
  }

  /// Draws one frame of a prepared clip; resolves when it is drawn. A lost canvas is opened again.
  async show(clipId, timeMs) {
    const clip = preparedClip(clipId);
    if (clip.video) {
      this.#shown = { clipId, timeMs };
      return this.#video.show(clip, timeMs);
    }
    if (this.#lost !== null) await this.reopen();
    while (!this.drawNow(clipId, timeMs)) await new Promise(requestAnimationFrame);
  }

  /// Draws one frame at once, for loops of animation frames. False when the adapter is still busy
  /// with earlier frames; throws when the canvas is lost.
  drawNow(clipId, timeMs) {
    const clip = preparedClip(clipId);
    this.#shown = { clipId, timeMs };
    if (clip.video) {
      this.#video.show(clip, timeMs);
      return true;
    }
    if (this.#lost !== null) throw new StageFailure("graphics_lost", this.#lost);
    try {
      this.#fit();
      return this.#draw(clip, timeMs);
    } catch (error) {
      this.#fail(error.message);
      throw error;
    }
  }

  /// Plays a prepared clip once; resolves with the log whatever happens. `beside`: [{stage, clipId}] of other
  /// stages, played in step, or with `inTurn` one after the other behind it. Its sound is heard where that is
  /// asked for; `told` as Playback has it.
  async play(clipId, { beside = [], inTurn = false, heard = false, told } = {}) {
    const clip = preparedClip(clipId);
    const others = beside.map(({ stage, clipId }) => ({ stage, clip: preparedClip(clipId) }));
    const parts = [{ stage: this, clip }, ...others];
    if (parts.some(({ stage }) => stage.#playback)) throw new Error("stage: a clip is playing; stop it first");
    const shown = parts.map((part) => part.clip);
    const turns = inTurn ? parts.map((part) => [part]) : [parts];
    const lasts = turns.map((turn) => Math.max(...turn.map((part) => part.clip.duration_ms)));
    const sounds = turns.map((turn) => (heard ? turn[0].clip.sound : undefined));
    const playbacks = turns.map((turn, k) => {
      const before = lasts.slice(0, k).reduce((sum, ms) => sum + ms, 0);
      const isLast = k === turns.length - 1;
      const each = told && { frame: (now, ms) => told.frame(now, before + ms), end: (now) => isLast && told.end(now) };
      return new Playback(turn.map(({ stage, clip }) => stage.#part(clip)), sounds[k], each);
    });
    const plays = (playback) => parts.forEach(({ stage }) => (stage.#playback = playback));
    plays(playbacks[0]);
    const logs = [];
    const heardLogs = [];
    try {
      // What waits for its turn stands at its first frame.
      if (inTurn) for (const { stage, clip } of parts) await stage.show(clip.clip, 0);
      for (const [k, turn] of turns.entries()) {
        plays(playbacks[k]);
        for (const part of parts) part.stage.#wait(!turn.includes(part));
        for (const { stage, clip } of turn) await stage.#ready(clip);
        const log = await playbacks[k].run(lasts[k]);
        logs.push(log);
        if (sounds[k]) heardLogs.push(sounds[k].log(log.onset_ms));
        if (log.failure) for (const { stage } of parts) stage.#fail(log.failure);
        if (log.aborted !== null) break;
      }
      // The trial is offered again: be ready for it. A canvas that cannot be opened says so then.
      for (const { stage } of parts) if (stage.#lost !== null) await stage.reopen().catch(() => {});
      return { ...this.#log(shown, joined(logs, lasts)), sound: ofAll(heardLogs) };
    } catch (error) {
      for (const { stage } of parts) stage.#fail(error.message);
      const last = Math.min(logs.length, playbacks.length - 1);
      logs[last] = playbacks[last].log(error.message);
      return this.#log(shown, joined(logs, lasts));
    } finally {
      for (const { stage, clip } of parts) {
        stage.#playback = null;
        stage.#wait(false);
        stage.#shown = { clipId: clip.clip, timeMs: clip.duration_ms };
      }
    }
  }

  // What a play does of this stage's clip.
  #part(clip) {
    if (clip.video) return { clock: this.#video.clock(clip) };
    return { draw: (timeMs) => this.#draw(clip, timeMs) };
  }

  // style.css fades what waits for its turn.
  #wait(waits) {
    this.#canvas.toggleAttribute("data-waiting", waits);
  }

  async #ready(clip) {
    if (clip.video) return;
    if (this.#lost !== null) await this.reopen();
    this.#fit();
    if (this.#gpu.hasAvatar(clip.avatarHash)) return;
    // The first frame of a head takes longest. It is drawn before the play, like the one that is shown
    // while a play is waited for.
    while (!this.#draw(clip, 0)) await new Promise(requestAnimationFrame);
  }

  /// Aborts the play in progress; the log keeps why.
  stop(why = "stopped") {
    this.#playback?.abort(why);
  }

  /// Gives everything back.
  close() {
    this.stop();
    this.#closed = true;
    this.#canvas.removeEventListener("webglcontextlost", this.#onContextLost);
    this.#video.close();
    this.#free();
  }

  /// Turns the camera: {yaw, pitch} in radians, {zoom} 1 for the standard portrait.
  setView(view) {
    this.#view = { ...this.#view, ...view };
  }

  /// The clip-from-world matrix (16 numbers, column by column) of the camera on a prepared clip.
  camera(clipId) {
    const clip = preparedClip(clipId);
    this.#fit();
    this.#load(clip);
    const { yaw, pitch, zoom } = this.#view;
    return this.#gpu.camera(clip.avatarHash, yaw, pitch, zoom);
  }

  /// Another backdrop or variant.
  setLook(look) {
    this.#look = { ...this.#look, ...look };
    this.#gpu?.setLook(this.#look.background, this.#look.variant);
  }

  /// {backend, adapter, lost: null | reason}
  state() {
    return { backend: this.#backend, adapter: this.#gpu?.adapter() ?? "", lost: this.#lost };
  }

  /// Loses the device on purpose: for tests of the recovery.
  lose() {
    this.#gpu?.lose();
  }

  /// Opens the canvas (again) and draws what it showed.
  reopen() {
    this.#reopening ??= this.#open().finally(() => (this.#reopening = null));
    return this.#reopening;
  }

  async #open() {
    if (this.#closed) throw new Error("stage: closed; open a new one");
    this.#backend = await backend();
    const panicked = this.#panicked;
    this.#panicked = false;
    this.#free();
    if (this.#backend === "webgl2") await restored(this.#canvas);
    const module = await loadModule(this.#backend, panicked);
    const { width, height } = this.#pixels();
    this.#canvas.width = width;
    this.#canvas.height = height;
    const { background, variant } = this.#look;
    this.#gpu = await module.Canvas.open(this.#canvas, width, height, background, variant);
    this.#lost = null;
    if (this.#shown && !this.#playback) this.drawNow(this.#shown.clipId, this.#shown.timeMs);
  }

  #free() {
    try {
      this.#gpu?.free();
    } catch {
      // A module that crashed cannot tidy up; it is dropped whole.
    }
    this.#gpu = null;
  }

  #fail(why) {
    if (this.#closed) return;
    this.#lost ??= why;
    this.#playback?.abort(`renderer lost: ${why}`);
  }

  #pixels() {
    const ratio = globalThis.devicePixelRatio || 1;
    const css = this.#canvas.getBoundingClientRect();
    const width = css.width || this.#look.width;
    const height = css.height || this.#look.height;
    const most = 4096;
    const scale = Math.min(ratio, most / width, most / height);
    return { width: Math.max(1, Math.round(width * scale)), height: Math.max(1, Math.round(height * scale)) };
  }

  #fit() {
    const { width, height } = this.#pixels();
    if (this.#canvas.width === width && this.#canvas.height === height) return;
    this.#canvas.width = width;
    this.#canvas.height = height;
    this.#gpu.resize(width, height);
  }

  #load(clip) {
    this.#video.hide();
    if (clip.look !== this.#look.variant) this.setLook({ variant: clip.look });
    if (this.#gpu.hasAvatar(clip.avatarHash)) return;
    const shapes = this.#gpu.loadAvatar(
      clip.avatarHash,
      clip.avatarPack,
      clip.pictures.widths,
      clip.pictures.pixels,
    );
    if (shapes < clip.shapes) {
      throw new Error(`clip ${clip.clip}: ${clip.shapes} weights per frame, its avatar has ${shapes} blendshapes`);
    }
  }

  // True when the frame went to the display.
  #draw(clip, timeMs) {
    try {
      this.#load(clip);
      if (this.#weights.length !== clip.shapes) this.#weights = new Float32Array(clip.shapes);
      weightsAt(clip, timeMs, this.#weights);
      const { yaw, pitch, zoom } = this.#view;
      return this.#gpu.draw(clip.avatarHash, this.#weights, yaw, pitch, zoom);
    } catch (error) {
      this.#panicked ||= error instanceof WebAssembly.RuntimeError;
      throw error;
    }
  }

  #log(shown, { failure, ...log }) {
    const [clip, beside, ...more] = shown;
    const css = this.#canvas.getBoundingClientRect();
    return {
      backend: this.#backend,
      ...log,
      width: css.width,
      height: css.height,
      device_pixel_ratio: globalThis.devicePixelRatio || 1,
      weights_hash: clip.weights_hash,
      provenance: clip.provenance,
      beside_provenance: beside?.provenance ?? "",
      renderer,
      ...(more.length > 0 && { panel: shown.map(({ clip, provenance, weights_hash }) => ({ clip, provenance, weights_hash })) }),
    };
  }
}

// What was heard of clips in turn: the first that was not played, else the one farthest from its frames.
function ofAll(sounds) {
  const off = ({ offset_ms: offset, delay_ms: delay }) => Math.abs((offset ?? 0) - delay);
  const farthest = (one, other) => (off(other) > off(one) ? other : one);
  return sounds.find(({ status }) => status !== "played") ?? (sounds.length > 0 ? sounds.reduce(farthest) : undefined);
}

// Waits until the browser has given a lost WebGL context back.
async function restored(canvas) {
  const context = canvas.getContext("webgl2");
  if (!context?.isContextLost()) return;
  await new Promise((resolve, reject) => {
    const timer = setTimeout(() => reject(new StageFailure("graphics_lost", "graphics context: not given back within 10 s")), 10_000);
    canvas.addEventListener("webglcontextrestored", () => (clearTimeout(timer), resolve()), { once: true });
  });
}
