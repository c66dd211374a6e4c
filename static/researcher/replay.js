// The replay of a session: the pages that a participant saw, one after the other, with the clips drawn again on the
// frames of their logs: the same times of the clip at the same moments, late frames late.
//
// The page is complete without this script but for the drawings; its words stand in the page.
import { openStage, prepareClip, preparedClip } from "../stage/host.js";
import { Player, made } from "../stage/player.js";

const $ = (id) => document.getElementById(id);
const root = $("replay");
const words = JSON.parse(root?.dataset.words ?? "{}");
const number = (value, digits) => value.toLocaleString(document.documentElement.lang, { minimumFractionDigits: digits, maximumFractionDigits: digits, useGrouping: false });
const say = (word, values) => words[word].replace(/\{(\w+)\}/g, (_, name) => values[name]);
/// Hash of all assets, the renderer's among them, as logs have it.
const renderer = /\/assets\/([0-9a-f]+)\//.exec(import.meta.url)?.[1] ?? "";
/// Late frames that are listed.
const MOST_LATE = 20;
const SVG = "http://www.w3.org/2000/svg";

/// Steps from one shown frame to the next.
class ReplayPlayer extends Player {
  log = null;
  words = { play: words.play, pause: words.pause };
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

const player = root && new ReplayPlayer();
let bundle = null;
// Counts what was asked to be shown: what comes later than its page is dropped.
let asked = 0;

/// All that a page needs of the version of the study that was shown.
function study(configHash) {
  bundle ??= fetched(`/api/studies/${encodeURIComponent(root.dataset.study)}?${new URLSearchParams({ config_hash: configHash })}`);
  return bundle;
}

async function fetched(address) {
  const answer = await fetch(address, { headers: { accept: "application/json" } });
  const told = await answer.json();
  if (!answer.ok) throw new Error([told.message, told.remedy].filter(Boolean).join("; "));
  return told;
}

/// What the stage draws a clip from.
function sourceOf({ clip, face }, clips) {
  if (!face) return clips[clip];
  const [atRest, from] = face;
  return { ...clips[atRest], face: from };
}

function clear() {
  player.pause();
  for (const panel of player.panels) panel.close();
  player.panels = [];
  player.log = null;
  player.timeMs = 0;
  for (const id of ["stages", "strip", "same", "late"]) $(id).replaceChildren();
  $("problem").hidden = true;
  $("heard").hidden = true;
}

/// Shows the page at a place, from 1.
async function showPage(place) {
  const mine = ++asked;
  const pages = [...root.querySelectorAll(".seen")];
  pages.forEach((page, at) => (page.hidden = at !== place - 1));
  $("page").value = place;
  $("before").disabled = place === 1;
  $("after").disabled = place === pages.length;
  history.replaceState(null, "", `#page-${place}`);
  clear();
  const page = pages[place - 1];
  const list = page.querySelector(".replay-plays");
  $("player").hidden = !list;
  if (!list) return;
  list.after($("player"));
  try {
    const { configHash, besideLeft, plays } = await fetched(`${root.dataset.plays}/${place}`);
    if (mine !== asked) return;
    const which = $("which");
    which.replaceChildren(...plays.map(({ aborted }, at) => new Option(say(aborted ? "cut" : "whole", { number: at + 1 }), at)));
    $("which-label").hidden = plays.length < 2;
    $("stages").className = `replay-stages${plays[0].clips.length === 2 ? " pair" : ""}${besideLeft ? " mirrored" : ""}`;
    which.onchange = () => showPlay(configHash, plays[which.value], ++asked).catch(problem);
    await showPlay(configHash, plays[0], mine);
  } catch (error) {
    if (mine === asked) problem(error);
  }
}

async function showPlay(configHash, play, mine) {
  clear();
  if (play.frames.length === 0) return $("strip").replaceChildren(words.nothing);
  const { clips, study: { look } } = await study(configHash);
  if (mine !== asked) return;
  const log = new FrameLog(play.frames);
  const [width, height] = play.size[0] > 0 ? play.size : [look.width, look.height];
  const shown = await Promise.all(play.clips.map((clip) => opened(clip, sourceOf(clip, clips), { ...look, width, height }, mine)));
  if (mine !== asked) return shown.forEach((one) => one?.stage.close());
  let before = 0;
  player.panels = shown.map(({ stage, canvas, summary }, at) => {
    const panel = new LoggedClip(stage, canvas, play.clips[at].clip, log, before);
    if (play.inTurn) before += summary.duration_ms;
    return panel;
  });
  player.log = log;
  drawStrip(log, play);
  $("same").replaceChildren(...play.clips.map((clip, at) => made("span", {}, comparison(clip, shown[at].summary, clips, play))));
  $("heard").hidden = !play.clips.some(({ clip }) => clips[clip]?.sound);
  player.seek(0);
}

/// A clip prepared, and its stage.
async function opened({ clip }, source, look, mine) {
  const canvas = made("canvas", { role: "img" });
  canvas.setAttribute("aria-label", say("face", { clip }));
  const bar = made("progress", { max: 1, value: 0, ariaLabel: words.loading });
  const veil = made("div", { className: "veil" }, made("span", {}, words.loading), bar);
  const frame = made("div", { className: "stage" }, canvas, veil);
  $("stages").append(made("figure", {}, frame, made("figcaption", { className: "soft" }, clip)));
  const summary = await prepareClip(clip, source, (part) => (bar.value = part));
  if (mine !== asked) return null;
  const stage = await openStage(canvas, look);
  veil.hidden = true;
  return { stage, canvas, summary };
}

/// Whether what is drawn now is what was shown.
function comparison({ clip, face, weightsHash, provenance }, summary, clips, play) {
  const hash = summary.weights_hash.slice(0, 12);
  if (weightsHash && summary.weights_hash) {
    const word = weightsHash !== summary.weights_hash ? "different" : play.renderer === renderer ? "same" : "otherRenderer";
    return say(word, { clip, hash, then: weightsHash.slice(0, 12) });
  }
  const now = clips[face ? face[0] : clip].provenance;
  return say(provenance && provenance === now ? "prepared" : "unknown", { clip });
}

/// A tick for each frame over the time in which they were shown, and a cursor.
function drawStrip(log, { longestMs }) {
  const duration = Math.max(log.durationMs(), 1);
  const x = (ms) => ((1000 * ms) / duration).toFixed(2);
  const late = log.late();
  const label = say("strip", { frames: log.frames.length, seconds: number(duration / 1000, 2), late: late.length, longest: number(longestMs, 1) });
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
  svg.addEventListener("pointerdown", (event) => {
    const box = svg.getBoundingClientRect();
    player.pause();
    player.seek((duration * (event.clientX - box.left)) / box.width);
  });
  player.onDraw = (timeMs) => cursor.setAttribute("d", `M${x(timeMs)} 0V40`);
  $("strip").replaceChildren(svg, made("p", { className: "soft" }, label));
  if (late.length === 0) return;
  const buttons = late.slice(0, MOST_LATE).map(({ shown, ms }) => {
    const button = made("button", { type: "button", className: "quiet" }, say("lateFrame", { seconds: number(shown / 1000, 2), ms: number(ms, 0) }));
    button.addEventListener("click", () => (player.pause(), player.seek(shown)));
    return button;
  });
  $("late").replaceChildren(words.late, " ", ...buttons, late.length > MOST_LATE ? "…" : "");
}

function problem(error) {
  $("problem").textContent = String(error.message ?? error);
  $("problem").hidden = false;
}

function start() {
  const pages = root.querySelectorAll(".seen").length;
  const turn = (by) => showPage(Math.min(Math.max(Number($("page").value) + by, 1), pages));
  $("pages").hidden = false;
  $("before").addEventListener("click", () => turn(-1));
  $("after").addEventListener("click", () => turn(1));
  $("page").addEventListener("change", () => showPage(Number($("page").value)));
  player.wireControls();
  player.wireKeys({ p: () => turn(-1), n: () => turn(1) });
  addEventListener("resize", () => player.panels.forEach((panel) => panel.forget()), { capture: true });
  const wanted = Number(/^#page-(\d+)$/.exec(location.hash)?.[1] ?? 1);
  showPage(Math.min(Math.max(wanted, 1), pages));
}

if (root) start();
