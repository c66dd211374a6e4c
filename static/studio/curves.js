// Curves over the take: residual and KKT error of every method, weights of one.
import { fitted } from "./overlay.js";

const $ = (id) => document.getElementById(id);
// Told apart by colour-blind people and by their dashes.
const COLOURS = ["#3b82c4", "#d9822b", "#3a9a6e", "#b0508c", "#8a6d3b", "#5b5bd6", "#c4453b", "#2a9d9d"];
const DASHES = [[], [7, 3], [2, 3], [9, 3, 2, 3]];

/// Colour and dash of the line of a number.
export const style = (index) => ({ colour: COLOURS[index % COLOURS.length], dash: DASHES[Math.floor(index / 2) % DASHES.length] });

export class Curves {
  #page;
  #plots = new Map();
  #timeMs = 0;
  #durationMs = 0;

  /// `page`: {panels(), seek(ms), series(slot, name), weights(slot)}
  constructor(page) {
    this.#page = page;
    $("curves").addEventListener("toggle", () => this.update());
    $("weights-slot").addEventListener("change", () => this.#weights(true));
    $("weights-shapes").addEventListener("change", () => this.#weights(false));
    for (const id of ["plot-residual", "plot-kkt", "plot-weights"]) {
      $(id).addEventListener("click", (event) => {
        const { left, width } = event.currentTarget.getBoundingClientRect();
        page.seek((this.#durationMs * (event.clientX - left)) / width);
      });
    }
    addEventListener("resize", () => this.#drawAll());
  }

  /// Everything anew, once the section is open.
  async update() {
    if (!$("curves").open) return;
    const panels = this.#page.panels().filter((panel) => panel.facts);
    this.#durationMs = Math.max(1, ...panels.map((panel) => panel.clip().duration_ms));
    const of = (name) => Promise.all(panels.map(async (panel) => ({ name: panel.title(), values: await this.#page.series(panel.slot, name) })));
    const [residual, kkt] = await Promise.all([of("residual"), of("kkt")]);
    this.#plots.set("plot-residual", { lines: residual, unit: "mm" });
    this.#plots.set("plot-kkt", { lines: kkt, log: true, unit: "" });
    const slots = $("weights-slot");
    const before = slots.value;
    slots.replaceChildren(...panels.map((panel) => new Option(panel.title(), panel.slot)));
    if (panels.some((panel) => panel.slot === before)) slots.value = before;
    await this.#weights(true);
    this.#legend(panels);
  }

  // The curves of the chosen shapes; `anew` chooses those that move most.
  async #weights(anew) {
    const panel = this.#page.panels().find((each) => each.slot === $("weights-slot").value && each.facts);
    if (!panel) return this.#drawAll();
    const { shapes } = panel.facts;
    const weights = panel.clip().weights;
    const list = $("weights-shapes");
    if (anew) {
      const most = new Float64Array(shapes.length);
      for (let i = 0; i < weights.length; i++) most[i % shapes.length] = Math.max(most[i % shapes.length], Math.abs(weights[i]));
      const order = [...shapes.keys()].sort((a, b) => most[b] - most[a]);
      const kept = new Set([...list.selectedOptions].map((option) => option.value).filter((name) => shapes.includes(name)));
      list.replaceChildren(...order.map((k, rank) => new Option(shapes[k], shapes[k], false, kept.size ? kept.has(shapes[k]) : rank < 5)));
    }
    const chosen = [...list.selectedOptions].map((option) => option.value);
    const lines = chosen.map((name) => {
      const k = shapes.indexOf(name);
      return { name, values: Float32Array.from({ length: weights.length / shapes.length }, (_, f) => weights[f * shapes.length + k]) };
    });
    this.#plots.set("plot-weights", { lines, unit: "", low: 0, high: 1 });
    $("plot-legend").replaceChildren(...lines.map(({ name }, i) => swatch(name, i)));
    this.#drawAll();
  }

  #legend(panels) {
    for (const id of ["plot-residual", "plot-kkt"]) {
      const words = panels.map((panel, i) => swatch(panel.title(), i));
      let legend = $(id).nextElementSibling;
      if (!legend?.classList.contains("studio-legend")) {
        legend = document.createElement("p");
        legend.className = "studio-legend";
        $(id).after(legend);
      }
      legend.replaceChildren(...words);
    }
  }

  /// Moves the playhead.
  at(timeMs) {
    this.#timeMs = timeMs;
    if ($("curves").open) this.#drawAll();
  }

  #drawAll() {
    if (!$("curves").open) return;
    for (const [id, plot] of this.#plots) draw($(id), plot, this.#timeMs / this.#durationMs);
  }
}

/// A name with the colour of its line.
export function swatch(name, index) {
  const item = document.createElement("span");
  item.textContent = name;
  item.style.setProperty("--swatch", style(index).colour);
  return item;
}

/// Lines over the width of a canvas, the highest of each pixel's values; a playhead at `part` of it.
export function draw(canvas, { lines, log = false, unit, low, high }, part) {
  const { context, width, height } = fitted(canvas);
  const css = getComputedStyle(canvas);
  const [ink, soft] = [css.getPropertyValue("--ink"), css.getPropertyValue("--line")];
  const value = log ? (x) => Math.log10(Math.max(x, 1e-18)) : (x) => x;
  let [from, to] = [Infinity, -Infinity];
  for (const { values } of lines) for (const x of values) if (Number.isFinite(x)) [from, to] = [Math.min(from, value(x)), Math.max(to, value(x))];
  if (from > to) return;
  if (log) [from, to] = [Math.floor(from), Math.max(Math.ceil(to), Math.floor(from) + 1)];
  else from = Math.min(from, low ?? 0);
  to = Math.max(to, high ?? -Infinity, from + 1e-9);
  const [left, top, bottom] = [46, 8, 6];
  const y = (x) => height - bottom - ((value(x) - from) / (to - from)) * (height - top - bottom);
  context.font = "12px system-ui, sans-serif";
  context.textBaseline = "middle";
  for (const at of ticks(from, to, log)) {
    const row = height - bottom - ((at - from) / (to - from)) * (height - top - bottom);
    context.strokeStyle = soft;
    context.beginPath();
    context.moveTo(left, row);
    context.lineTo(width, row);
    context.stroke();
    context.fillStyle = ink;
    context.fillText(log ? `1e${at.toFixed(0)}` : `${Number(at.toPrecision(2))} ${at === to ? unit : ""}`, 2, Math.max(row, 8));
  }
  lines.forEach(({ values }, index) => {
    const { colour, dash } = style(index);
    context.strokeStyle = colour;
    context.setLineDash(dash);
    context.lineWidth = 1.6;
    context.beginPath();
    const columns = Math.max(1, Math.floor(width - left));
    let pen = false;
    for (let c = 0; c < columns; c++) {
      const begin = Math.floor((c * values.length) / columns);
      const end = Math.max(begin + 1, Math.floor(((c + 1) * values.length) / columns));
      let highest = -Infinity;
      for (let f = begin; f < end && f < values.length; f++) if (values[f] > highest) highest = values[f];
      if (!Number.isFinite(highest)) {
        pen = false;
        continue;
      }
      if (pen) context.lineTo(left + c, y(highest));
      else context.moveTo(left + c, y(highest));
      pen = true;
    }
    context.stroke();
  });
  context.setLineDash([]);
  context.strokeStyle = ink;
  context.lineWidth = 1;
  context.beginPath();
  context.moveTo(left + part * (width - left), 0);
  context.lineTo(left + part * (width - left), height);
  context.stroke();
  const words = lines.map(({ name, values }) => `${name}: highest ${Math.max(...sampled(values)).toPrecision(3)} ${unit}`);
  canvas.setAttribute("aria-label", words.join("; "));
}

// Four parts of the way; of a logarithmic axis whole powers of ten, five of them at most.
function ticks(from, to, log) {
  if (!log) return [0, 1, 2, 3, 4].map((i) => (i === 4 ? to : from + ((to - from) * i) / 4));
  const step = Math.ceil((to - from) / 4);
  return Array.from({ length: Math.floor((to - from) / step) + 1 }, (_, i) => from + i * step);
}

// Math.max takes no more arguments than the stack holds.
function sampled(values) {
  const step = Math.max(1, Math.floor(values.length / 5000));
  const out = [];
  for (let i = 0; i < values.length; i += step) if (Number.isFinite(values[i])) out.push(values[i]);
  return out.length > 0 ? out : [0];
}
