// The preview of a study's stimuli: two clips side by side, played in step, scrubbed, slowed down.
import { backend, openStage, prepareClip, preparedClip } from "./stage-host.js";
import { refreshPeriod } from "./stage-clock.js";

const $ = (id) => document.getElementById(id);
const study = document.body.dataset.study;

const player = {
  panels: [],
  timeMs: 0,
  playing: false,
  speed: 1,
  last: null,
  drawn: 0,
  since: null,
  longest: 0,

  durationMs() {
    return Math.max(0, ...this.panels.map((panel) => panel.clip()?.duration_ms ?? 0));
  },

  frameMs() {
    const rates = this.panels.map((panel) => panel.clip()?.rate_hz ?? 0);
    return 1000 / Math.max(...rates, 1);
  },

  seek(timeMs) {
    this.timeMs = Math.min(Math.max(timeMs, 0), this.durationMs());
    this.draw();
  },

  draw() {
    const drawn = this.panels.map((panel) => panel.draw(this.timeMs));
    // A busy adapter takes the frame later; a play draws anew anyway.
    if (!this.playing && drawn.includes(false)) requestAnimationFrame(() => this.playing || this.draw());
    const duration = this.durationMs();
    const scrub = $("scrub");
    scrub.max = Math.max(1, Math.round(duration));
    scrub.value = Math.round(this.timeMs);
    const text = `${(this.timeMs / 1000).toFixed(2)} / ${(duration / 1000).toFixed(2)} s`;
    $("clock").textContent = text;
    scrub.setAttribute("aria-valuetext", text);
  },

  toggle() {
    if (this.playing) return this.pause();
    if (this.durationMs() === 0) return;
    if (this.timeMs >= this.durationMs()) this.timeMs = 0;
    this.playing = true;
    this.last = null;
    this.since = null;
    $("play").textContent = "Pause";
    requestAnimationFrame((now) => this.tick(now));
  },

  pause() {
    this.playing = false;
    $("play").textContent = "Play";
  },

  tick(now) {
    if (!this.playing) return;
    if (this.last !== null) this.timeMs += (now - this.last) * this.speed;
    this.count(now);
    this.last = now;
    const duration = this.durationMs();
    if (this.timeMs >= duration) {
      if ($("loop").checked && duration > 0) this.timeMs %= duration;
      else {
        this.timeMs = duration;
        this.draw();
        return this.pause();
      }
    }
    this.draw();
    requestAnimationFrame((next) => this.tick(next));
  },

  // Frames a second and the longest frame, over each second.
  count(now) {
    if (this.since === null) {
      [this.since, this.drawn, this.longest] = [now, this.framesDrawn(), 0];
      return;
    }
    this.longest = Math.max(this.longest, now - this.last);
    if (now - this.since < 1000) return;
    const rate = (1000 * (this.framesDrawn() - this.drawn)) / (now - this.since);
    $("rate").textContent = `${rate.toFixed(1)} frames/s, longest ${this.longest.toFixed(1)} ms`;
    [this.since, this.drawn, this.longest] = [now, this.framesDrawn(), 0];
  },

  // Of the panel that drew most.
  framesDrawn() {
    return Math.max(...this.panels.map((panel) => panel.drawn));
  },
};

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

  clip() {
    return this.#clipId === null ? null : preparedClip(this.#clipId);
  }

  async choose(id) {
    this.#wanted = id;
    this.#select.value = id;
    this.#element.classList.toggle("empty", id === "");
    this.#clipId = null;
    this.#facts.replaceChildren();
    this.#notices.replaceChildren();
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
    const { statistics } = clip.report ?? {};
    const { method } = this.#clips[this.#clipId];
    const rows = [
      ["Method", methodWords(method)],
      ["Length", `${(summary.duration_ms / 1000).toFixed(2)} s, ${summary.frames} frames at ${round(summary.rate_hz)} Hz`],
      ["Solved in", `${summary.solve_ms.toFixed(0)} ms`],
      ["Weights", summary.weights_hash.slice(0, 16)],
    ];
    if (statistics) {
      const { residual_rms_mm: rms, residual_worst_mm: worst, iterations_mean: steps } = statistics;
      rows.push(["Residual", `${rms.toFixed(2)} mm rms, ${worst.toFixed(2)} mm worst`]);
      rows.push(["Iterations", `${steps.toFixed(1)} a frame, KKT error ${statistics.kkt_worst.toExponential(1)}`]);
    }
    this.#facts.replaceChildren(
      ...rows.map(([name, value]) => made("div", {}, made("dt", {}, name), made("dd", { className: "number" }, value))),
    );
    this.#notices.replaceChildren(
      ...summary.warnings.map((warning) => made("p", { className: "notice warn" }, warning)),
    );
  }
}

function methodWords(method) {
  if (typeof method === "string") return method;
  const { kind, name, method: word, ...options } = method ?? {};
  const rest = Object.entries(options)
    .filter(([, value]) => typeof value === "number" || typeof value === "string")
    .map(([key, value]) => `${key} ${value}`);
  return [word ?? name ?? kind ?? "recorded", ...rest.slice(0, 3)].join(", ");
}

function round(value) {
  return Number(value.toFixed(2));
}

function made(tag, properties, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name in element) element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

function problem(error) {
  $("problem").textContent = String(error.message ?? error);
  $("problem").hidden = false;
}

function cycle(select) {
  select.selectedIndex = (select.selectedIndex + 1) % select.options.length;
  select.dispatchEvent(new Event("change"));
}

const KEYS = {
  " ": () => player.toggle(),
  ",": () => (player.pause(), player.seek(player.timeMs - player.frameMs())),
  ".": () => (player.pause(), player.seek(player.timeMs + player.frameMs())),
  l: () => ($("loop").checked = !$("loop").checked),
  s: () => cycle($("speed")),
  v: () => cycle($("view")),
  a: () => player.panels[0]?.focus(),
  b: () => player.panels[1]?.focus(),
};

function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const inControl = event.target.closest("select, button, input, a");
  // A control keeps its own keys: typing chooses in a list, Space presses a button.
  if (inControl?.matches("select") || (inControl && event.key === " ")) return;
  const act = KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!act) return;
  event.preventDefault();
  act();
}

function wire() {
  $("play").addEventListener("click", () => player.toggle());
  $("back").addEventListener("click", KEYS[","]);
  $("forth").addEventListener("click", KEYS["."]);
  $("speed").addEventListener("change", () => (player.speed = Number($("speed").value)));
  $("view").addEventListener("change", () => {
    for (const panel of player.panels) panel.turn();
    player.draw();
  });
  $("scrub").addEventListener("input", () => (player.pause(), player.seek(Number($("scrub").value))));
  addEventListener("keydown", onKey);
  addEventListener("resize", () => player.playing || player.draw());
}

async function start() {
  const answer = await fetch(`/api/studies/${encodeURIComponent(study)}`);
  if (!answer.ok) {
    const refusal = await answer.json().catch(() => ({}));
    throw new Error(refusal.message ?? `The server answered ${answer.status}; reload the page.`);
  }
  const { clips, study: file } = await answer.json();
  const ids = Object.keys(clips);
  if (ids.length === 0) throw new Error("This study has no clips.");
  // As the study file's reader: grey, 480 x 480, unless it says otherwise.
  const look = { background: "#808080", width: 480, height: 480, ...file?.stimuli?.look };
  $("backend").textContent = await backend();
  player.panels = [...document.querySelectorAll(".preview-panel")].map(
    (element, i) => new Panel(element, clips, look, i > 0),
  );
  wire();
  refreshPeriod().then((period) => ($("refresh").textContent = `${(1000 / period).toFixed(1)} Hz`));
  // B: the same take solved by another method, where the study has one.
  const other = ids.find((id) => clips[id].take === clips[ids[0]].take && id !== ids[0]) ?? "";
  await Promise.all([player.panels[0].choose(ids[0]), player.panels[1].choose(other)]);
}

start().catch(problem);
