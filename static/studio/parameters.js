// The parameters of a panel's method: numbers, words, and the tables of what it takes by name. Which
// there are, with label, range, step and default, comes from the solver's own table.
import { made } from "../stage/player.js";
import { numeral, say } from "./texts.js";
import { wordsOf } from "./words-methods.js";
import { MarkerTable, ShapeTable, describe, number } from "./lists.js";

/// The bounds of a method without soft ones.
const HARD = [0, 1];
/// Parameters that have tables of their own (lists.js).
const BY_NAME = ["names", "number-by-name", "interval-by-name"];

export class Parameters {
  #slot;
  #method = "";
  #parameters = [];
  #fields = made("div", { className: "parameters" });
  #shapes;
  #markers;
  #changed;

  /// `changed` is called when something is typed.
  constructor(slot, changed) {
    this.#slot = slot;
    this.#changed = changed;
    const owner = say("table.owner", { letter: slot.toUpperCase() });
    this.#shapes = new ShapeTable(owner, changed);
    this.#markers = new MarkerTable(owner, changed);
    this.element = made("details", {}, made("summary", {}, say("parameters")), this.#fields);
    this.tables = [this.#shapes.element, this.#markers.element];
  }

  /// The controls of a method: its name, and its rows of the solver's table of parameters.
  choose({ name, parameters }) {
    [this.#method, this.#parameters] = [name, parameters];
    const rows = parameters.filter(({ kind }) => !BY_NAME.includes(kind)).map((row) => this.#control(row));
    const keys = parameters.map(({ key }) => key);
    this.#fields.replaceChildren(...rows);
    this.element.hidden = rows.length === 0;
    this.#shapes.choose(keys, this.#ends());
    this.#markers.choose(keys);
  }

  // The control of one parameter.
  #control(row) {
    const words = wordsOf(row);
    const label = row.unit ? `${words.label}, ${row.unit}` : words.label;
    if (row.kind === "word") {
      const select = made("select", { name: row.key }, new Option(say("parameters.default"), ""), ...row.words.map((word) => new Option(word, word)));
      select.addEventListener("change", this.#changed);
      return this.#field(row, label, [select]);
    }
    if (row.kind === "interval") {
      const ends = [say("parameters.from"), say("parameters.to")].map((end, i) =>
        this.#number(row, { placeholder: String(row.default[i]), ariaLabel: `${label}, ${end}` }));
      return this.#field(row, say("parameters.interval", { label }), ends);
    }
    // A share is a slider, which always stands somewhere: one without a default is a number.
    if (row.minimum === 0 && row.maximum === 1 && !row.unit && row.default !== null) return this.#share(row, label);
    return this.#field(row, label, [this.#number(row, { placeholder: String(row.default ?? words.foundBy) })]);
  }

  /// The avatar's blendshapes, those that it locks itself, and the markers on the face.
  put({ shapes, locked }, markers) {
    this.#shapes.putAvatar(shapes, locked);
    this.#markers.put(markers);
  }

  /// What the solver answered: how each shape gets its weight.
  solved({ shapes_told: told = [] }) {
    this.#shapes.putTold(told);
  }

  #share(row, label) {
    const slider = made("input", { type: "range", min: 0, max: 1, step: row.step, value: row.default, name: row.key });
    const shown = made("output", { className: "number" }, numeral(row.default, 2));
    slider.addEventListener("input", () => ((shown.textContent = numeral(Number(slider.value), 2)), this.#changed()));
    return made("label", {}, made("span", {}, `${label} `, shown), slider);
  }

  #number(row, options) {
    const { key: name, minimum, maximum, step } = row;
    const input = made("input", { type: "number", name, step: step ?? "any", ...options });
    if (minimum !== undefined && row.kind !== "interval") input.min = minimum;
    if (maximum !== undefined && row.kind !== "interval") input.max = maximum;
    input.addEventListener("input", this.#changed);
    return input;
  }

  // A label, its controls, and the place for what is wrong with them.
  #field(row, label, controls) {
    const { key } = row;
    const problem = made("p", { className: "problem", id: `${this.#slot}-${key}-problem`, hidden: true });
    const body =
      controls.length === 1
        ? made("label", {}, label, controls[0])
        : made("fieldset", { className: "bare" }, made("legend", {}, label), made("div", { className: "pair" }, ...controls));
    const field = made("div", { className: "parameter", title: wordsOf(row).help }, body, problem);
    field.dataset.parameter = key;
    return field;
  }

  // The numbers of an interval that is typed, null where nothing is; an end left empty keeps its default.
  #interval({ key, default: usual }) {
    const ends = [...this.#fields.querySelectorAll(`[name="${CSS.escape(key)}"]`)];
    const found = ends.map((input) => number({ text: input.value, bad: input.validity.badInput }, key));
    return found.some((end) => end !== undefined) ? found.map((end, i) => end ?? usual[i]) : null;
  }

  // The bounds of shapes that have none of their own.
  #ends() {
    const soft = this.#parameters.find(({ key }) => key === "softBounds");
    return soft ? (this.#interval(soft) ?? soft.default) : HARD;
  }

  /// The method as a study file writes it. Throws where no number is typed.
  spec() {
    const spec = { method: this.#method };
    for (const row of this.#parameters.filter(({ kind }) => !BY_NAME.includes(kind))) {
      if (row.kind === "interval") {
        const ends = this.#interval(row);
        if (ends) spec[row.key] = ends;
        continue;
      }
      const field = this.#fields.querySelector(`[name="${CSS.escape(row.key)}"]`);
      if (row.kind === "word") {
        if (field.value !== "") spec[row.key] = field.value;
        continue;
      }
      const value = number({ text: field.value, bad: field.validity.badInput }, row.key);
      if (value !== undefined) spec[row.key] = value;
    }
    this.#shapes.choose(this.#parameters.map(({ key }) => key), this.#ends());
    this.#shapes.spec(spec);
    this.#markers.spec(spec);
    return spec;
  }

  /// What the controls hold, as it can be kept and put back.
  state() {
    const inputs = [...this.#fields.querySelectorAll("[name]")];
    return { fields: inputs.map(({ name, value }) => [name, value]), shapes: this.#shapes.state(), markers: this.#markers.state() };
  }

  /// Puts back what was kept of the same method.
  putState({ fields = [], shapes = [], markers = [] }) {
    const inputs = [...this.#fields.querySelectorAll("[name]")];
    // An interval has two controls of one name, in their order.
    const seen = new Map();
    for (const [name, value] of fields) {
      const nth = seen.get(name) ?? 0;
      seen.set(name, nth + 1);
      const input = inputs.filter((each) => each.name === name)[nth];
      if (input) this.#fill(input, value);
    }
    this.#shapes.choose(this.#parameters.map(({ key }) => key), this.#ends());
    this.#shapes.putState(shapes);
    this.#markers.putState(markers);
  }

  #fill(input, value) {
    input.value = value;
    if (input.type === "range") input.previousElementSibling.querySelector("output").textContent = numeral(Number(input.value), 2);
  }

  /// Takes the parameters of a method that was saved. Throws where this page has no place for one of them.
  take({ method, locked, bounds, importance, ...single }) {
    const fields = (name) => [...this.#fields.querySelectorAll(`[name="${CSS.escape(name)}"]`)];
    const strange = Object.keys(single).filter((name) => fields(name).length === 0);
    if (strange.length > 0) throw new Error(say("parameters.strange", { names: strange.join(", "), method }));
    for (const { key, kind } of this.#parameters) {
      const value = single[key];
      for (const [i, input] of fields(key).entries()) {
        if (kind === "interval") input.value = value?.[i] ?? "";
        else if (value !== undefined && value !== null) this.#fill(input, value);
      }
    }
    const missing = [
      ...this.#shapes.takeSpec({ locked, bounds }).map((name) => say("parameters.no-shape", { name })),
      ...this.#markers.takeSpec({ importance }).map((name) => say("parameters.no-marker", { name })),
    ];
    if (missing.length > 0) throw new Error(say("parameters.left-out", { missing: missing.join(", ") }));
  }

  /// Shows the problems of the method, `{field, entry, text}` each, beside the controls that they are
  /// about; an empty list takes them away.
  problems(list) {
    for (const field of this.#fields.querySelectorAll(".parameter")) {
      const problem = field.querySelector(".problem");
      const own = list.filter((each) => each.field === field.dataset.parameter).map(({ text }) => text);
      problem.textContent = own.join(" ");
      problem.hidden = own.length === 0;
      for (const input of field.querySelectorAll("[name]")) describe(input, problem, own.length > 0);
      if (own.length > 0) this.element.open = true;
    }
    this.#shapes.problems(list);
    this.#markers.problems(list);
  }
}
