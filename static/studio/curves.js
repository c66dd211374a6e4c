// Curves over the take: residual and KKT error of every method, weights of one.
import { draw, swatch } from "../drawing/lines.js";

const $ = (id) => document.getElementById(id);
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
      if (!legend?.classList.contains("line-keys")) {
        legend = document.createElement("p");
        legend.className = "line-keys";
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
