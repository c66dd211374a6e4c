// Curves over the take, in line with its time: weights of the chosen face, residual and KKT error of all.
import { draw, partAt, swatch } from "../drawing/lines.js";
import { made } from "../stage/player.js";
import { isShown, whenShown } from "./tabs.js";
import { say } from "./texts.js";
import { callWorker } from "./worker-calls.js";

const $ = (id) => document.getElementById(id);

export class Curves {
  #page;
  #shapes;
  #tracks;
  #durationMs = 1;
  #run = 0;

  /// `page`: {panels(), chosen(), seek(ms), report(error)}; `shapes` says which weights are drawn.
  constructor(page, shapes) {
    [this.#page, this.#shapes] = [page, shapes];
    this.#tracks = { weights: this.#track(), residual: this.#track(), kkt: this.#track() };
    $("tracks").replaceChildren(...Object.values(this.#tracks).map(({ element }) => element));
    whenShown("curves", () => this.update().catch(page.report));
    new ResizeObserver(() => this.#drawAll()).observe($("tracks"));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.#drawAll());
  }

  // A canvas with its title and its keys: a key lets its line stand out.
  #track() {
    const title = made("h3", {});
    const canvas = made("canvas", { className: "studio-plot", role: "img", ariaLabel: say("curves") });
    const keys = made("p", { className: "line-keys" });
    const track = { element: made("div", { className: "studio-track" }, made("div", { className: "row" }, title, keys), canvas), title, canvas, keys, plot: null, isolated: null };
    canvas.addEventListener("click", (event) => this.#page.seek(this.#durationMs * partAt(canvas, event)));
    return track;
  }

  /// Everything anew, once it is seen.
  async update() {
    if (!isShown("curves")) return;
    const run = ++this.#run;
    const panels = this.#page.panels().filter((panel) => panel.facts);
    $("curves-none").hidden = panels.length > 0;
    $("tracks").hidden = panels.length === 0;
    this.#durationMs = Math.max(1, ...panels.map((panel) => panel.clip().duration_ms));
    const of = (name) => Promise.all(panels.map(async (panel) => ({ name: panel.title(), values: await callWorker("series", panel.slot, name) })));
    const [residual, kkt] = await Promise.all([of("residual"), of("kkt")]);
    if (run !== this.#run) return;
    const tracks = this.#tracks;
    // Recorded weights have neither.
    const told = (lines) => lines.some(({ values }) => values.length > 0);
    this.#put(tracks.residual, say("curves.residual"), told(residual) && { lines: residual, unit: "mm" });
    this.#put(tracks.kkt, say("curves.kkt"), told(kkt) && { lines: kkt, log: true, unit: "" });
    this.weights();
  }

  /// The weights that are drawn now.
  weights() {
    const track = this.#tracks.weights;
    const panel = this.#page.chosen();
    if (!panel?.facts || !panel.clip()) return this.#put(track, "", null);
    const { shapes } = panel.facts;
    const { weights } = panel.clip();
    const lines = this.#shapes.drawn().map((name) => {
      const k = shapes.indexOf(name);
      return { name, values: Float32Array.from({ length: weights.length / shapes.length }, (_, f) => weights[f * shapes.length + k]) };
    });
    track.isolated = this.#shapes.isolated;
    this.#put(track, say("curves.weights", { name: panel.title() }), lines.length > 0 && { lines, unit: "", low: 0, high: 1 });
  }

  #put(track, title, plot) {
    track.title.textContent = title;
    track.plot = plot || null;
    track.element.hidden = !plot;
    const lines = plot ? plot.lines : [];
    if (!lines.some(({ name }) => name === track.isolated)) track.isolated = null;
    track.keys.replaceChildren(...lines.map(({ name }, i) => this.#key(track, name, i)));
    this.#draw(track);
  }

  #key(track, name, index) {
    const key = made("button", { type: "button", title: say("shapes.isolate", { name }) }, swatch(name, index));
    key.setAttribute("aria-pressed", String(track.isolated === name));
    key.addEventListener("click", () => {
      if (track === this.#tracks.weights) this.#shapes.isolate(name);
      else track.isolated = track.isolated === name ? null : name;
      for (const [i, each] of [...track.keys.children].entries()) each.setAttribute("aria-pressed", String(track.plot.lines[i].name === track.isolated));
      this.#draw(track);
      track.keys.children[index]?.focus();
    });
    return key;
  }

  // The play head stands over the curves: they are drawn when they change, not with every frame.
  #draw({ canvas, plot, isolated, element, title }) {
    if (!plot || element.hidden || canvas.getClientRects().length === 0) return;
    const lines = plot.lines.map((line) => ({ ...line, faint: isolated !== null && line.name !== isolated }));
    draw(canvas, { ...plot, lines, time: { from: 0, to: this.#durationMs / 1000, unit: "s" } }, null);
    const highest = (values) => values.reduce((most, value) => (value > most ? value : most), -Infinity).toPrecision(3);
    const words = lines.map(({ name, values }) => say("curves.highest", { name, value: highest(values), unit: plot.unit }));
    canvas.setAttribute("aria-label", `${title.textContent}. ${words.join("; ")}`);
  }

  #drawAll() {
    for (const track of Object.values(this.#tracks)) this.#draw(track);
  }
}
