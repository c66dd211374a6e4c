// The preview of a study's stimuli: two clips side by side, played in step, scrubbed, slowed down.
import { backend, openStage, prepareClip, preparedClip, refreshPeriod } from "../stage/host.js";
import { Player, made } from "../stage/player.js";
import { ExertionPictures } from "../drawing/exertion.js";
import { ShownComparison } from "./comparison.js";
import { PreviewSound } from "./preview-sound.js";

const $ = (id) => document.getElementById(id);
const study = document.body.dataset.study;

const player = new Player();

/// The body of a clip whose capture is an exertion, and its courses: of panel A, else of panel B.
class ShownExertion {
  #pictures = new ExertionPictures();
  #of = new Map();

  constructor() {
    const { body, courses, clip } = this.#pictures;
    $("exertion-pictures").append(body, courses, clip);
  }

  /// A panel shows another clip, or none (null).
  async put(panel, id) {
    this.#of.set(panel, { id, drawing: null });
    this.#show();
    if (id === null) return;
    const answer = await fetch(`/preview/${encodeURIComponent(study)}/exertion?${new URLSearchParams({ clip: id })}`);
    const told = await answer.json();
    if (!answer.ok) throw new Error(`${id}: ${told.message}; ${told.remedy}`);
    if (this.#of.get(panel).id !== id) return;
    this.#of.set(panel, { id, drawing: told });
    this.#show();
  }

  at(timeMs) {
    if (!$("exertion").hidden) this.#pictures.at(timeMs);
  }

  #show() {
    const shown = player.panels.map((panel) => this.#of.get(panel)).find((own) => own?.drawing);
    $("exertion").hidden = !shown;
    $("exertion-clip").textContent = shown?.id ?? "";
    this.#pictures.put(shown?.drawing ?? null);
    this.#pictures.at(player.timeMs);
  }
}

const exertion = new ShownExertion();
const sound = new PreviewSound(player, $("sound"), $("caption"));
const comparison = new ShownComparison((frame) => {
  const rate = player.panels[0]?.clip()?.rate_hz;
  if (rate) player.seek((1000 * frame) / rate);
});

// A block of reverse correlation draws every trial anew: in the place of its avatar at rest stand a few examples.
const EXAMPLES = 5;

function withFaces(prepared, components) {
  const clips = { ...prepared };
  for (const [name, { type, ...block }] of Object.entries(components)) {
    if (type !== "reverseCorrelation") continue;
    const atRest = clips[block.clip];
    delete clips[block.clip];
    for (let trial = 1; trial <= EXAMPLES; trial++) {
      const step = `${name}/${trial}`;
      clips[step] = { ...atRest, face: { step, block, seed: 0, configHash: "preview", slot: 0 } };
    }
  }
  return clips;
}

// What the address asks for: `clip`, `beside` it, and the time `t` in seconds.
class Asked {
  constructor(clips) {
    const address = new URLSearchParams(location.search);
    const known = (name) => {
      const id = address.get(name);
      if (id === null || Object.hasOwn(clips, id)) return id;
      problem(`This study has no clip ${id} (“${name}” in the address of this page): choose one of the list.`);
      return null;
    };
    this.clip = known("clip");
    this.beside = known("beside");
    const seconds = Number(address.get("t") ?? 0);
    if (!(seconds >= 0)) problem(`“t” in the address of this page is ${address.get("t")}: give seconds, such as 1.5.`);
    this.timeMs = seconds > 0 ? 1000 * seconds : 0;
  }
}

/// Shows how the clips of both panels differ.
function compare() {
  const [a, b] = player.panels.map((panel) => panel.wanted());
  comparison.put(a ?? null, b ?? null);
}

class Panel {
  #element;
  #canvas;
  #select;
  #facts;
  #veil;
  #notices;
  #clips;
  #look;
  #stage = null;
  #clipId = null;
  #wanted = null;
  #recovering = false;
  // Frames drawn, ever.
  drawn = 0;

  constructor(element, clips, look, optional) {
    const letter = element.dataset.panel.toUpperCase();
    this.#element = element;
    this.#clips = clips;
    this.#look = look;
    this.#select = made("select", { id: `clip-${letter.toLowerCase()}`, ariaLabel: `Clip ${letter}` });
    if (optional) this.#select.append(new Option("Nothing beside it", ""));
    for (const id of Object.keys(clips).filter((id) => !id.startsWith("media:"))) this.#select.append(new Option(id, id));
    this.#canvas = made("canvas", { role: "img" });
    this.#veil = made("div", { className: "veil", hidden: true });
    const frame = made("div", { className: "stage" }, this.#canvas, this.#veil);
    this.#facts = made("dl", { className: "preview-clip" });
    this.#notices = made("div", { role: "status" });
    element.replaceChildren(this.#select, frame, this.#facts, this.#notices);
    this.#select.addEventListener("change", () => this.choose(this.#select.value));
  }

  focus() {
    this.#select.focus();
  }

  /// Brings the panel to where it is seen, and the keyboard with it.
  reveal() {
    this.#element.scrollIntoView({ block: "start" });
    this.#select.focus({ preventScroll: true });
  }

  clip() {
    return this.#clipId === null ? null : preparedClip(this.#clipId);
  }

  wanted() {
    return this.#wanted;
  }

  async choose(id) {
    this.#wanted = id;
    if (this === player.panels[0]) sound.put(null);
    compare();
    this.#select.value = id;
    this.#element.classList.toggle("empty", id === "");
    this.#clipId = null;
    this.#facts.replaceChildren();
    this.#notices.replaceChildren();
    const face = this.#clips[id]?.face;
    exertion.put(this, id === "" || face ? null : id).catch((error) => this.#wanted === id && this.#notices.append(made("p", { className: "notice warn" }, error.message)));
    if (id === "") return player.draw();
    const bar = made("progress", { max: 1, value: 0 });
    const words = made("span", {}, "Loading and solving");
    this.#veil.replaceChildren(words, bar);
    this.#veil.hidden = false;
    try {
      const summary = await prepareClip(id, this.#clips[id], (part) => (bar.value = part));
      if (this.#wanted !== id) return;
      this.#stage ??= await openStage(this.#canvas, this.#look);
      if (this.#wanted !== id) return;
      this.#clipId = id;
      if (this === player.panels[0]) sound.put(this.clip());
      this.#canvas.setAttribute("aria-label", `Animated face, clip ${id}`);
      this.#describe(summary);
      this.#veil.hidden = true;
      this.turn();
      player.seek(player.timeMs);
    } catch (error) {
      if (this.#wanted === id) this.#veil.replaceChildren(String(error.message ?? error));
    }
  }

  turn() {
    const [yaw, pitch] = $("view").value.split(",").map(Number);
    this.#stage?.setView({ yaw, pitch });
  }

  draw(timeMs) {
    if (this.#clipId === null || this.#recovering) return true;
    try {
      const drawn = this.#stage.drawNow(this.#clipId, timeMs);
      this.drawn += drawn;
      return drawn;
    } catch {
      this.#recover();
      return true;
    }
  }

  #recover() {
    this.#recovering = true;
    this.#veil.replaceChildren("The graphics device was lost; opening it again");
    this.#veil.hidden = false;
    this.#stage.reopen().then(
      () => {
        this.#recovering = false;
        this.#veil.hidden = true;
      },
      (error) => this.#veil.replaceChildren(String(error.message ?? error)),
    );
  }

  #describe(summary) {
    const clip = this.clip();
    const { statistics, gazeAtRest } = clip.report ?? {};
    const { method, sound: heard, face } = this.#clips[this.#clipId];
    const rows = [
      ["Method", face ? "action units drawn at random" : methodWords(method)],
      ["Length", `${(summary.duration_ms / 1000).toFixed(2)} s, ${summary.frames} frames at ${round(summary.rate_hz)} Hz`],
      ["Solved in", `${summary.solve_ms.toFixed(0)} ms`],
      ["Weights", summary.weights_hash.slice(0, 16)],
    ];
    if (heard) rows.push(["Sound", soundWords(heard)]);
    if (method?.headLowpassHz !== undefined) {
      rows.push(["Head low-pass", method.headLowpassHz > 0 ? `${method.headLowpassHz} Hz` : "none"]);
    }
    if (gazeAtRest?.length > 0) rows.push(["Gaze", `at rest: none is given (${gazeAtRest.length} shapes at 0)`]);
    if (statistics) {
      const { residual_rms_mm: rms, residual_worst_mm: worst, iterations_mean: steps } = statistics;
      rows.push(["Residual", `${rms.toFixed(2)} mm rms, ${worst.toFixed(2)} mm worst`]);
      rows.push(["Iterations", `${steps.toFixed(1)} per frame, KKT error ${statistics.kkt_worst.toExponential(1)}`]);
    }
    this.#facts.replaceChildren(
      ...rows.map(([name, value]) => made("div", {}, made("dt", {}, name), made("dd", { className: "number" }, value))),
    );
    this.#notices.append(
      ...summary.warnings.map((warning) => made("p", { className: "notice warn" }, warning)),
    );
  }
}

function methodWords(method) {
  if (typeof method === "string") return method;
  const { kind, name, method: word, headLowpassHz, ...options } = method ?? {};
  const rest = Object.entries(options)
    .filter(([, value]) => typeof value === "number" || typeof value === "string")
    .map(([key, value]) => `${key} ${value}`);
  return [word ?? name ?? kind ?? "recorded", ...rest.slice(0, 3)].join(", ");
}

function soundWords({ file, media_type, duration_s, from_s, delay_ms }) {
  const delay = delay_ms ? `, ${delay_ms > 0 ? "later" : "earlier"} by ${Math.abs(delay_ms)} ms` : "";
  return `${file.slice(0, 16)}, ${media_type}, ${duration_s.toFixed(2)} s, from ${from_s.toFixed(2)} s${delay}`;
}

function round(value) {
  return Number(value.toFixed(2));
}

function problem(error) {
  $("problem").textContent = String(error.message ?? error);
  $("problem").hidden = false;
}

async function start() {
  const answer = await fetch(`/api/studies/${encodeURIComponent(study)}`);
  if (!answer.ok) {
    const refusal = await answer.json().catch(() => ({}));
    throw new Error(refusal.message ?? `The server answered ${answer.status}; reload the page.`);
  }
  const { clips: prepared, study: { look, components } } = await answer.json();
  const clips = withFaces(prepared, components);
  const ids = Object.keys(clips);
  if (ids.length === 0) throw new Error("This study has no clips.");
  $("backend").textContent = await backend();
  player.panels = [...document.querySelectorAll(".preview-panel")].map(
    (element, i) => new Panel(element, clips, look, i > 0),
  );
  player.onRate = (rate, longest) =>
    ($("rate").textContent = `${rate.toFixed(1)} frames/s, longest ${longest.toFixed(1)} ms`);
  player.onDraw = (ms) => {
    exertion.at(ms);
    sound.at(ms);
  };
  player.wire({ a: () => player.panels[0]?.focus(), b: () => player.panels[1]?.focus() });
  refreshPeriod().then((period) => ($("refresh").textContent = `${(1000 / period).toFixed(1)} Hz`));
  comparison.load(study).then(compare, problem);
  const asked = new Asked(clips);
  const first = asked.clip ?? ids[0];
  // B: the same take solved by another method, where the study has one.
  const other = asked.beside ?? ids.find((id) => clips[id].take === clips[first].take && id !== first) ?? "";
  await Promise.all([player.panels[0].choose(first), player.panels[1].choose(other)]);
  if (asked.timeMs > 0) player.seek(asked.timeMs);
  if (asked.clip !== null) player.panels[0].reveal();
}

start().catch(problem);
