// What draws a play again on the frames of its log: the same times of the clip at the same moments, late frames late.
// Pages that hold the player's elements load it: the researchers' replay, and the pages of a capsule.
import { openStage, prepareClip, preparedClip } from "../stage/host.js";
import { Player, made } from "../stage/player.js";

const $ = (id) => document.getElementById(id);
const number = (value, digits) => value.toLocaleString(document.documentElement.lang, { minimumFractionDigits: digits, maximumFractionDigits: digits, useGrouping: false });
/// Hash of all assets, the renderer's among them, as logs have it.
const renderer = /\/assets\/([0-9a-f]+)\//.exec(import.meta.url)?.[1] ?? "";
/// Late frames that are listed.
const MOST_LATE = 20;
const SVG = "http://www.w3.org/2000/svg";

/// Steps from one shown frame to the next.
class ReplayPlayer extends Player {
  log = null;
  written = (seconds) => number(seconds, 2);

  durationMs() {
    return this.log?.durationMs() ?? 0;
  }

  step(by) {
    if (!this.log) return;
    this.pause();
    this.seek(this.log.shownMs(this.log.at(this.timeMs) + by));
  }
}

/// The frames of a play: when each was shown, ms after the first, and which time of the clip.
class FrameLog {
  constructor(frames) {
    this.frames = frames;
  }

  /// The frame that stood on the screen at a time.
  at(timeMs) {
    let [low, high] = [0, this.frames.length - 1];
    while (low < high) {
      const middle = Math.ceil((low + high) / 2);
      if (this.frames[middle][0] <= timeMs) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  shownMs(at) {
    const place = Math.min(Math.max(at, 0), this.frames.length - 1);
    return this.frames[place]?.[0] ?? 0;
  }

  durationMs() {
    return this.shownMs(this.frames.length - 1);
  }

  /// Frames that came late: place, when, and how long the frame before stood.
  late() {
    return this.frames.flatMap(([shown, , late], at) => (late ? [{ at, shown, ms: shown - this.shownMs(at - 1) }] : []));
  }
}

/// A clip of a play on its canvas.
class LoggedClip {
  drawn = 0;
  #stage;
  #canvas;
  #id;
  #log;
  #before;
  #shown = null;

  /// `before`: how long clips are played before this one's turn, ms.
  constructor(stage, canvas, id, log, before) {
    [this.#stage, this.#canvas, this.#id, this.#log, this.#before] = [stage, canvas, id, log, before];
  }

  clip() {
    return preparedClip(this.#id);
  }

  turn() {}

  draw(timeMs) {
    const [, clipMs] = this.#log.frames[this.#log.at(timeMs)];
    const ms = Math.min(Math.max(clipMs - this.#before, 0), this.clip().duration_ms);
    if (ms === this.#shown) return true;
    if (!this.#stage.drawNow(this.#id, ms)) return false;
    this.#shown = ms;
    this.drawn += 1;
    this.#canvas.dataset.clipMs = ms;
    return true;
  }

  /// Draws anew what is drawn already: the canvas has another size.
  forget() {
    this.#shown = null;
  }

  close() {
    this.#stage.close();
  }
}

/// What the stage draws a clip from.
function sourceOf({ clip, face }, clips) {
  if (!face) return clips[clip];
  const [atRest, from] = face;
  return { ...clips[atRest], face: from };
}

/// The player of a page: draws plays, one at a time.
export class Replay {
  #words;
  #player = new ReplayPlayer();
  // Counts what was asked to be shown: what comes later than its page is dropped.
  #asked = 0;

  /// `words` as `researcher/pages/replay/words.rs` has them.
  constructor(words) {
    this.#words = words;
    this.#player.words = { play: words.play, pause: words.pause };
  }

  #say(word, values) {
    return this.#words[word].replace(/\{(\w+)\}/g, (_, name) => values[name]);
  }

  /// Joins the page's controls and keys; `more` are further keys.
  wire(more) {
    this.#player.wireControls();
    this.#player.wireKeys(more);
    addEventListener("resize", () => this.#player.panels.forEach((panel) => panel.forget()), { capture: true });
  }

  /// Takes away what is shown; the function that comes back says whether nothing else was asked for since.
  begin() {
    const mine = ++this.#asked;
    this.#clear();
    return () => mine === this.#asked;
  }

  #clear() {
    const player = this.#player;
    player.pause();
    for (const panel of player.panels) panel.close();
    player.panels = [];
    player.log = null;
    player.timeMs = 0;
    for (const id of ["stages", "strip", "same", "late"]) $(id).replaceChildren();
    $("problem").hidden = true;
    $("heard").hidden = true;
  }

  /// Shows the plays of a page, the first of them first; `study(configHash)` gives the version that was shown.
  async showPlays({ configHash, besideLeft, plays }, study, isMine) {
    const which = $("which");
    which.replaceChildren(...plays.map(({ aborted }, at) => new Option(this.#say(aborted ? "cut" : "whole", { number: at + 1 }), at)));
    $("which-label").hidden = plays.length < 2;
    $("stages").className = `replay-stages${plays[0].clips.length === 2 ? " pair" : ""}${besideLeft ? " mirrored" : ""}`;
    const show = (at, mine) => study(configHash).then((bundle) => mine() && this.#showPlay(bundle, plays[at], mine));
    which.onchange = () => show(which.value, this.begin()).catch((error) => this.problem(error));
    await show(0, isMine);
  }

  async #showPlay({ clips, study: { look } }, play, isMine) {
    this.#clear();
    if (play.frames.length === 0) return $("strip").replaceChildren(this.#words.nothing);
    const log = new FrameLog(play.frames);
    const [width, height] = play.size[0] > 0 ? play.size : [look.width, look.height];
    const shown = await Promise.all(play.clips.map((clip) => this.#opened(clip, sourceOf(clip, clips), { ...look, width, height }, isMine)));
    if (!isMine()) return shown.forEach((one) => one?.stage.close());
    let before = 0;
    const player = this.#player;
    player.panels = shown.map(({ stage, canvas, summary }, at) => {
      const panel = new LoggedClip(stage, canvas, play.clips[at].clip, log, before);
      if (play.inTurn) before += summary.duration_ms;
      return panel;
    });
    player.log = log;
    this.#drawStrip(log, play);
    $("same").replaceChildren(...play.clips.map((clip, at) => made("span", {}, this.#comparison(clip, shown[at].summary, clips, play))));
    $("heard").hidden = !play.clips.some(({ clip }) => clips[clip]?.sound);
    player.seek(0);
  }

  /// A clip prepared, and its stage.
  async #opened({ clip }, source, look, isMine) {
    const canvas = made("canvas", { role: "img" });
    canvas.setAttribute("aria-label", this.#say("face", { clip }));
    const bar = made("progress", { max: 1, value: 0, ariaLabel: this.#words.loading });
    const veil = made("div", { className: "veil" }, made("span", {}, this.#words.loading), bar);
    const frame = made("div", { className: "stage" }, canvas, veil);
    $("stages").append(made("figure", {}, frame, made("figcaption", { className: "soft" }, clip)));
    const summary = await prepareClip(clip, source, (part) => (bar.value = part));
    if (!isMine()) return null;
    const stage = await openStage(canvas, look);
    veil.hidden = true;
    return { stage, canvas, summary };
  }

  /// Whether what is drawn now is what was shown.
  #comparison({ clip, face, weightsHash, provenance }, summary, clips, play) {
    const hash = summary.weights_hash.slice(0, 12);
    if (weightsHash && summary.weights_hash) {
      const word = weightsHash !== summary.weights_hash ? "different" : play.renderer === renderer ? "same" : "otherRenderer";
      return this.#say(word, { clip, hash, then: weightsHash.slice(0, 12) });
    }
    const now = clips[face ? face[0] : clip].provenance;
    return this.#say(provenance && provenance === now ? "prepared" : "unknown", { clip });
  }

  /// A tick for each frame over the time in which they were shown, and a cursor.
  #drawStrip(log, { longestMs }) {
    const duration = Math.max(log.durationMs(), 1);
    const x = (ms) => ((1000 * ms) / duration).toFixed(2);
    const late = log.late();
    const label = this.#say("strip", { frames: log.frames.length, seconds: number(duration / 1000, 2), late: late.length, longest: number(longestMs, 1) });
    const part = (tag, attributes) => {
      const element = document.createElementNS(SVG, tag);
      for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
      return element;
    };
    const ticks = (frames) => frames.map(([shown, , isLate]) => `M${x(shown)} ${isLate ? 2 : 14}V${isLate ? 38 : 26}`).join("");
    const svg = part("svg", { viewBox: "0 0 1000 40", preserveAspectRatio: "none", role: "img", "aria-label": label });
    const gaps = late.map(({ at, ms }) => part("rect", { class: "gap", x: x(log.shownMs(at - 1)), y: 14, width: x(ms), height: 12 }));
    const cursor = part("path", { class: "cursor", d: "M0 0V40" });
    svg.append(
      ...gaps,
      part("path", { class: "tick", d: ticks(log.frames.filter(([, , isLate]) => !isLate)) }),
      part("path", { class: "tick late", d: ticks(log.frames.filter(([, , isLate]) => isLate)) }),
      cursor,
    );
    const player = this.#player;
    svg.addEventListener("pointerdown", (event) => {
      const box = svg.getBoundingClientRect();
      player.pause();
      player.seek((duration * (event.clientX - box.left)) / box.width);
    });
    player.onDraw = (timeMs) => cursor.setAttribute("d", `M${x(timeMs)} 0V40`);
    $("strip").replaceChildren(svg, made("p", { className: "soft" }, label));
    if (late.length === 0) return;
    const buttons = late.slice(0, MOST_LATE).map(({ shown, ms }) => {
      const button = made("button", { type: "button", className: "quiet" }, this.#say("lateFrame", { seconds: number(shown / 1000, 2), ms: number(ms, 0) }));
      button.addEventListener("click", () => (player.pause(), player.seek(shown)));
      return button;
    });
    $("late").replaceChildren(this.#words.late, " ", ...buttons, late.length > MOST_LATE ? "…" : "");
  }

  problem(error) {
    $("problem").textContent = String(error.message ?? error);
    $("problem").hidden = false;
  }
}
