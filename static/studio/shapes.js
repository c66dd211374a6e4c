// The shapes of the chosen face: their weight at the play head, which are drawn as curves, one that is isolated.
import { made } from "../stage/player.js";
import { style } from "../drawing/lines.js";
import { numeral, say } from "./texts.js";
import { WORDS } from "./words.js";

const $ = (id) => document.getElementById(id);
/// So many curves are drawn before somebody chooses: of the shapes that move most.
const FIRST = 5;

/// The part of the face that a shape's name begins with: browDownLeft is of the brow.
const regionOf = (name) => /^[A-Za-z]?[a-z]*/.exec(name)[0].toLowerCase() || name;
const regionWords = (region) => (WORDS[`region.${region}`] ? say(`region.${region}`) : region);

export class Shapes {
  #changed;
  #panel = null;
  #order = [];
  #drawn = null;
  #rows = new Map();
  /// The shape whose curve stands out; null where none does.
  isolated = null;

  /// `changed` hears that other curves are to be drawn.
  constructor(changed) {
    this.#changed = changed;
    $("shapes-filter").addEventListener("input", () => this.#filter());
    $("shapes-region").addEventListener("change", ({ target }) => {
      // The curves of a region, without a region those that move most.
      this.#drawn = target.value === "" ? null : new Set(this.#order.filter((name) => regionOf(name) === target.value));
      this.#list();
      changed();
    });
  }

  /// The face that is chosen, solved or not.
  put(panel) {
    this.#panel = panel?.facts ? panel : null;
    $("shapes").hidden = !this.#panel;
    if (!this.#panel) return;
    const { shapes } = panel.facts;
    const { weights } = panel.clip();
    const most = new Float64Array(shapes.length);
    for (let i = 0; i < weights.length; i++) most[i % shapes.length] = Math.max(most[i % shapes.length], Math.abs(weights[i]));
    this.#order = [...shapes.keys()].sort((a, b) => most[b] - most[a]).map((k) => shapes[k]);
    if (this.#drawn && ![...this.#drawn].some((name) => shapes.includes(name))) this.#drawn = null;
    if (!shapes.includes(this.isolated)) this.isolated = null;
    this.#regions();
    this.#list();
  }

  #regions() {
    const select = $("shapes-region");
    const before = select.value;
    const regions = [...new Set(this.#order.map(regionOf))].sort();
    select.replaceChildren(new Option(say("shapes.all"), ""), ...regions.map((region) => new Option(regionWords(region), region)));
    select.value = regions.includes(before) ? before : "";
  }

  /// The names of the shapes whose curves are drawn, in the order of their colours.
  drawn() {
    const wanted = this.#drawn ?? new Set(this.#order.slice(0, FIRST));
    return this.#order.filter((name) => wanted.has(name));
  }

  /// Lets the curve of one shape stand out, or all of them again.
  isolate(name) {
    this.isolated = this.isolated === name ? null : name;
    if (this.isolated !== null && !this.drawn().includes(name)) this.#drawn = new Set([...this.drawn(), name]);
    this.#list();
    this.#changed();
  }

  #list() {
    const drawn = this.drawn();
    this.#rows = new Map(this.#order.map((name) => [name, this.#row(name, drawn.indexOf(name))]));
    $("shapes-list").replaceChildren(...[...this.#rows.values()].map(({ row }) => row));
    this.#filter();
  }

  #row(name, index) {
    const draws = made("input", { type: "checkbox", checked: index >= 0, ariaLabel: say("shapes.draw", { name }) });
    draws.addEventListener("change", () => {
      this.#drawn = new Set(draws.checked ? [...this.drawn(), name] : this.drawn().filter((each) => each !== name));
      this.#list();
      $("shapes-list").querySelector(`[data-name="${CSS.escape(name)}"] input`)?.focus();
      this.#changed();
    });
    const isolate = made("button", { type: "button", title: say("shapes.isolate", { name }) }, name);
    isolate.setAttribute("aria-pressed", String(this.isolated === name));
    isolate.addEventListener("click", () => {
      this.isolate(name);
      $("shapes-list").querySelector(`[data-name="${CSS.escape(name)}"] button`)?.focus();
    });
    const bar = made("i", {});
    const value = made("span", { className: "number" });
    const row = made("li", {}, draws, isolate, made("span", { className: "studio-weight" }, bar), value);
    row.dataset.name = name;
    if (index >= 0) row.style.setProperty("--swatch", style(index).colour);
    return { row, bar, value, shown: "" };
  }

  #filter() {
    const wanted = $("shapes-filter").value.trim().toLowerCase();
    const region = $("shapes-region").value;
    for (const [name, { row }] of this.#rows) row.hidden = !name.toLowerCase().includes(wanted) || (region !== "" && regionOf(name) !== region);
  }

  /// The weights at a time.
  at(timeMs) {
    const clip = this.#panel?.clip();
    if (!clip) return;
    const { shapes } = this.#panel.facts;
    const from = this.#panel.frameAt(timeMs) * shapes.length;
    for (const [k, name] of shapes.entries()) {
      const own = this.#rows.get(name);
      const text = numeral(clip.weights[from + k], 2);
      if (!own || own.shown === text) continue;
      own.shown = text;
      own.value.textContent = text;
      own.bar.style.width = `${Math.min(Math.abs(clip.weights[from + k]), 1) * 100}%`;
    }
  }
}
