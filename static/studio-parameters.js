// The parameters of a panel's method: numbers, words, and the tables of what it takes by name.
import { made } from "./stage-player.js";
import { MarkerTable, ShapeTable, describe, number } from "./studio-lists.js";

const NUMBERS = {
  kappa: ["κ, priors against data", { min: 0, step: 0.01, placeholder: "0.1" }],
  kS: ["k_s, stretching", { min: 0, step: 0.1, placeholder: "1" }],
  kB: ["k_b, bending", { min: 0, step: 0.1, placeholder: "1" }],
  s: ["s, softness of the bounds", { min: 0.01, step: 0.01, placeholder: "0.1" }],
  eps: ["ε, smoothing of the norms", { min: 0, step: "any", placeholder: "default" }],
  sigma: ["σ, zones, m", { min: 0.001, step: 0.001, placeholder: "0.012" }],
  boundsWeight: ["Weight of the bounds", { min: 0, step: "any", placeholder: "0.001" }],
  stiffness: ["Stiffness", { min: 0, step: 0.01, placeholder: "0" }],
  basisVectors: ["Basis vectors, at most", { min: 10, max: 2000, step: 10, placeholder: "200" }],
  lengthScale: ["Length scale", { min: 0, step: "any", placeholder: "by likelihood" }],
  signal: ["Signal", { min: 0, step: "any", placeholder: "by likelihood" }],
  noise: ["Noise", { min: 0, step: "any", placeholder: "by likelihood" }],
  headLowpassHz: ["Head low-pass, Hz", { min: 0.1, step: 0.1, placeholder: "none" }],
};
const WORDS = {
  laplacian: ["Laplacian", ["uniform", "umbrella", "cotan-clamped", "cotan-literal"]],
  association: ["Association", ["points", "zones", "triangles"]],
  unit: ["Unit", ["m", "cm", "mm"]],
  hold: ["At rest", ["unmoved", "nothing"]],
  inference: ["Learns", ["sparse", "exact"]],
};
/// Where the soft bounds begin, and the bounds of a method without them.
const SOFT = [-0.1, 1.1];
const HARD = [0, 1];

export class Parameters {
  #slot;
  #method = "";
  #parameters = [];
  #fields = made("div", { className: "parameters" });
  #shapes;
  #markers;
  #hold = null;
  #changed;

  /// `changed` is called when something is typed.
  constructor(slot, changed) {
    this.#slot = slot;
    this.#changed = changed;
    const owner = `method ${slot.toUpperCase()}`;
    this.#shapes = new ShapeTable(owner, changed);
    this.#markers = new MarkerTable(owner, changed);
    this.element = made("details", {}, made("summary", {}, "Parameters"), this.#fields);
    this.tables = [this.#shapes.element, this.#markers.element];
  }

  /// Whether what no marker sees is held at 0.
  get hold() {
    return this.#hold?.checked ?? true;
  }

  /// The controls of a method: `{name, parameters}`.
  choose({ name, parameters }) {
    [this.#method, this.#parameters] = [name, parameters];
    const rows = [];
    if (parameters.includes("alpha")) rows.push(this.#alpha());
    for (const [key, [label, options]] of Object.entries(NUMBERS)) {
      if (parameters.includes(key)) rows.push(this.#field(key, label, [this.#number({ name: key, ...options })]));
    }
    if (parameters.includes("softBounds")) {
      const ends = ["from", "to"].map((end, i) => this.#number({ name: "softBounds", step: 0.05, placeholder: String(SOFT[i]), ariaLabel: `Soft bounds begin, ${end}` }));
      rows.push(this.#field("softBounds", "Soft bounds begin, from and to", ends));
    }
    for (const [key, [label, words]] of Object.entries(WORDS)) {
      if (!parameters.includes(key)) continue;
      const select = made("select", { name: key }, new Option("default", ""), ...words.map((word) => new Option(word, word)));
      select.addEventListener("change", this.#changed);
      rows.push(this.#field(key, label, [select]));
    }
    if (parameters.includes("locked")) {
      this.#hold = made("input", { type: "checkbox", checked: true });
      this.#hold.addEventListener("change", this.#changed);
      rows.push(made("label", { className: "preview-check" }, this.#hold, " Hold what no marker sees at 0"));
    } else this.#hold = null;
    this.#fields.replaceChildren(...rows);
    this.element.hidden = rows.length === 0;
    this.#shapes.choose(parameters, this.#ends());
    this.#markers.choose(parameters);
  }

  /// The avatar's blendshapes, those that it locks itself, and the markers on the face.
  put({ shapes, locked }, markers) {
    this.#shapes.putAvatar(shapes, locked);
    this.#markers.put(markers);
  }

  /// What the solver answered: those that it held.
  solved({ held = [] }) {
    this.#shapes.putHeld(held);
  }

  #alpha() {
    const value = this.#method === "lsts" ? 0.3 : 0.5;
    const slider = made("input", { type: "range", min: 0, max: 1, step: 0.05, value, name: "alpha" });
    const shown = made("output", { className: "number" }, value.toFixed(2));
    slider.addEventListener("input", () => ((shown.textContent = Number(slider.value).toFixed(2)), this.#changed()));
    return made("label", {}, made("span", {}, "α, thin shell against bounds ", shown), slider);
  }

  #number(options) {
    const input = made("input", { type: "number", ...options });
    input.addEventListener("input", this.#changed);
    return input;
  }

  // A label, its controls, and the place for what is wrong with them.
  #field(name, label, controls) {
    const problem = made("p", { className: "problem", id: `${this.#slot}-${name}-problem`, hidden: true });
    const body =
      controls.length === 1
        ? made("label", {}, label, controls[0])
        : made("fieldset", { className: "bare" }, made("legend", {}, label), made("div", { className: "pair" }, ...controls));
    const field = made("div", { className: "parameter" }, body, problem);
    field.dataset.parameter = name;
    return field;
  }

  #pair() {
    const ends = [...this.#fields.querySelectorAll("[name=softBounds]")];
    const found = ends.map((input) => number({ text: input.value, bad: input.validity.badInput }, "softBounds"));
    return found.some((end) => end !== undefined) ? found.map((end, i) => end ?? SOFT[i]) : null;
  }

  #ends() {
    if (!this.#parameters.includes("softBounds")) return HARD;
    return this.#pair() ?? SOFT;
  }

  /// The method as a study file writes it. Throws where no number is typed.
  spec() {
    const spec = { method: this.#method };
    for (const field of this.#fields.querySelectorAll("[name]")) {
      if (field.name === "softBounds") continue;
      if (field.tagName === "SELECT") {
        if (field.value !== "") spec[field.name] = field.value;
        continue;
      }
      const value = number({ text: field.value, bad: field.validity.badInput }, field.name);
      if (value !== undefined) spec[field.name] = value;
    }
    const soft = this.#pair();
    if (soft) spec.softBounds = soft;
    this.#shapes.choose(this.#parameters, this.#ends());
    this.#shapes.spec(spec);
    this.#markers.spec(spec);
    return spec;
  }

  /// Takes the parameters of a method that was saved. Throws where this page has no place for one of them.
  take({ method, softBounds, locked, bounds, importance, ...single }) {
    const field = (name) => this.#fields.querySelector(`[name="${CSS.escape(name)}"]`);
    const strange = Object.keys(single).filter((name) => !field(name));
    if (strange.length > 0) throw new Error(`${strange.join(", ")}: ${method} takes no such parameter here; remove it from the file`);
    for (const [name, value] of Object.entries(single)) {
      field(name).value = value;
      if (name === "alpha") field(name).previousElementSibling.querySelector("output").textContent = Number(value).toFixed(2);
    }
    for (const [i, input] of [...this.#fields.querySelectorAll("[name=softBounds]")].entries()) input.value = softBounds?.[i] ?? "";
    const missing = [
      ...this.#shapes.takeSpec({ locked, bounds }).map((name) => `no blendshape ${name}`),
      ...this.#markers.takeSpec({ importance }).map((label) => `no marker ${label}`),
    ];
    if (missing.length > 0) throw new Error(`${missing.join(", ")} here: left out`);
  }

  /// Shows an error of the solver beside the control that it is about; null takes it away.
  problem(message) {
    const text = message?.replace(/^(method|solve): /, "") ?? null;
    for (const field of this.#fields.querySelectorAll(".parameter")) {
      const problem = field.querySelector(".problem");
      const own = text?.startsWith(`${field.dataset.parameter}: `) ?? false;
      problem.textContent = own ? text.slice(field.dataset.parameter.length + 2) : "";
      problem.hidden = !own;
      for (const input of field.querySelectorAll("[name]")) describe(input, problem, own);
      if (own) this.element.open = true;
    }
    this.#shapes.problem(text);
    this.#markers.problem(text);
  }
}
