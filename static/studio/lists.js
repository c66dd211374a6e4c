// What a method takes by name: blendshapes locked or bounded, importance of markers. Tables that are
// built when they are opened; what was typed stays while the method changes.
import { made } from "../stage/player.js";
import { numeral, say } from "./texts.js";

/// A table of rows by name, folded, with a filter and a reset.
class NamedTable {
  #kind;
  #owner;
  #changed;
  #filter;
  #count;
  #rows;
  #head;
  #names = [];
  /// What was typed, by name.
  values = new Map();

  /// `kind`: {title, one, hint}; `owner` names the panel to screen readers.
  constructor(kind, owner, changed) {
    [this.#kind, this.#owner, this.#changed] = [kind, owner, changed];
    this.#count = made("span", { className: "soft" });
    this.#filter = made("input", { type: "search", placeholder: say("filter"), ariaLabel: say("table.filter", { title: kind.title.toLowerCase(), owner }) });
    this.#filter.addEventListener("input", () => this.#hide());
    const reset = made("button", { type: "button", ariaLabel: say("table.reset-of", { title: kind.title.toLowerCase(), owner }) }, say("table.reset"));
    reset.addEventListener("click", () => {
      this.values.clear();
      this.#filter.value = "";
      this.fill();
      changed();
    });
    this.#head = made("thead", {});
    this.#rows = made("tbody", {});
    const table = made("table", {}, this.#head, this.#rows);
    const region = made("div", { className: "studio-table", tabIndex: 0, role: "region", ariaLabel: say("table.of", { title: kind.title, owner }) }, table);
    this.element = made(
      "details", { className: "studio-named" },
      made("summary", {}, `${kind.title} `, this.#count),
      made("p", { className: "soft" }, kind.hint),
      made("div", { className: "row" }, this.#filter, reset),
      region,
    );
    this.element.addEventListener("toggle", () => this.fill());
  }

  get owner() {
    return this.#owner;
  }

  /// New names; what was typed of others goes.
  put(names) {
    this.#names = names;
    for (const name of [...this.values.keys()]) if (!names.includes(name)) this.values.delete(name);
    this.fill();
  }

  of(name) {
    return this.values.get(name) ?? {};
  }

  /// Takes what a file says, name by name, in place of all that was typed; answers the names that are not here.
  take(values) {
    this.values = new Map([...values].filter(([name]) => this.#names.includes(name)));
    this.fill();
    return [...values.keys()].filter((name) => !this.#names.includes(name));
  }

  /// All that was typed, as it can be kept and put back.
  state() {
    return [...this.values].map(([name, value]) => [name, { ...value }]);
  }

  putState(entries = []) {
    this.values = new Map(entries.filter(([name]) => this.#names.includes(name)));
    this.fill();
  }

  /// Something was typed.
  set(name, change) {
    this.values.set(name, { ...this.of(name), ...change });
    this.#tally();
    this.#changed();
  }

  /// Builds the rows, once somebody looks.
  fill() {
    this.#tally();
    if (!this.element.open) return this.#rows.replaceChildren();
    const columns = this.columns();
    this.#head.replaceChildren(made("tr", {}, ...columns.map((name) => made("th", { scope: "col" }, name))));
    this.#rows.replaceChildren(...this.#names.map((name) => this.#row(name, columns.length)));
    this.#hide();
  }

  #row(name, columns) {
    const problem = made("p", { className: "problem", id: `${this.#kind.one}-${this.#owner}-${name}-problem`.replaceAll(/\s/g, "-"), hidden: true });
    const cells = this.cells(name).map((cell) => made("td", {}, ...cell));
    const first = made("th", { scope: "row" }, ...breakable(name), ...this.notes(name), problem);
    const row = made("tr", {}, first, ...cells.slice(0, columns - 1));
    row.dataset.name = name;
    return row;
  }

  #hide() {
    const wanted = this.#filter.value.trim().toLowerCase();
    for (const row of this.#rows.children) row.hidden = !row.dataset.name.toLowerCase().includes(wanted);
    this.#tally();
  }

  #tally() {
    const changed = [...this.values.keys()].filter((name) => this.isChanged(name)).length;
    this.#count.textContent = changed > 0 ? say("table.changed", { changed, all: this.#names.length }) : "";
  }

  /// Shows the problems that are about rows beside them, and opens the table.
  problems(list) {
    for (const row of this.#rows.querySelectorAll("tr:has(.problem:not([hidden]))")) mark(row, "");
    for (const { field, entry, text } of list) {
      if (!this.fields().includes(field) || !this.#names.includes(entry)) continue;
      this.element.open = true;
      if (this.#rows.childElementCount === 0) this.fill();
      const row = [...this.#rows.children].find((each) => each.dataset.name === entry);
      row.hidden = false;
      mark(row, text);
    }
  }

  // Fields of the method whose errors belong to rows.
  fields() {
    return [];
  }

  notes() {
    return [];
  }
}

// A name may go on in the next line where its next word begins.
function breakable(name) {
  const parts = name.split(/(?<=_)|(?<=[a-z0-9])(?=[A-Z])/);
  return parts.flatMap((part, i) => (i === 0 ? [part] : [made("wbr", {}), part]));
}

function mark(row, text) {
  const problem = row.querySelector(".problem");
  problem.textContent = text;
  problem.hidden = text === "";
  for (const input of row.querySelectorAll("input[type=number]")) describe(input, problem, text !== "");
}

/// Joins a control and what is wrong with it, for those who hear the page.
export function describe(input, problem, isWrong) {
  if (isWrong) {
    input.setAttribute("aria-invalid", "true");
    input.setAttribute("aria-describedby", problem.id);
  } else {
    input.removeAttribute("aria-invalid");
    input.removeAttribute("aria-describedby");
  }
}

/// The number of a field, undefined where it is empty; throws where no number is typed, with the problem
/// of the field, or of its entry.
export function number(input, field, entry = null) {
  if (input.bad) {
    const text = say("parameters.no-number");
    throw Object.assign(new Error(`${entry === null ? field : `${field}.${entry}`}: ${text}`), { problems: [{ field, entry, text }] });
  }
  return input.text === "" || input.text === undefined ? undefined : Number(input.text);
}

const typed = (input) => ({ text: input.value, bad: input.validity.badInput });

/// Locked blendshapes, and bounds of single ones.
export class ShapeTable extends NamedTable {
  #own = new Set();
  #told = new Map();
  #parameters = [];
  #ends = [0, 1];

  constructor(owner, changed) {
    super({ title: say("table.shapes"), one: "shape", hint: say("table.shapes-hint") }, owner, changed);
  }

  /// `own`: those that the avatar locks itself.
  putAvatar(shapes, own) {
    this.#own = new Set(own);
    this.put(shapes);
  }

  /// The method takes these parameters, and bounds everything by `ends`.
  choose(parameters, ends) {
    const same = this.#parameters.join() === parameters.join() && this.#ends.join() === ends.join();
    [this.#parameters, this.#ends] = [parameters, ends];
    this.element.hidden = !parameters.includes("locked") && !parameters.includes("bounds");
    if (!same) this.fill();
  }

  /// How each shape gets its weight, and how well the markers tell it.
  putTold(told) {
    this.#told = new Map(told.map((row) => [row.shape, row]));
    const rows = this.element.querySelectorAll("tbody tr");
    for (const row of rows) row.querySelector(".note")?.replaceWith(this.notes(row.dataset.name)[0]);
  }

  columns() {
    return ["table.shape", "table.locked", ...(this.#parameters.includes("bounds") ? ["table.lower", "table.upper"] : [])].map((key) => say(key));
  }

  fields() {
    return ["bounds"];
  }

  notes(name) {
    const words = this.#own.has(name) ? say("table.avatar-locked") : this.#toldWords(this.#told.get(name));
    return [made("span", { className: "note soft" }, words)];
  }

  #toldWords(told) {
    if (!told) return "";
    const { state, standardError, confusedWith } = told;
    const error = standardError === undefined ? "" : say("table.noise", { error: numeral(standardError, 2) });
    if (state === "solved") return error;
    if (state === "shared") return `${error}, ${say("table.together", { name: confusedWith?.[0] ?? say("table.others") })}`;
    if (state === "untold") return `${error}, ${say("table.untold")}`;
    const key = { held: "table.held", atRest: "table.at-rest", driven: "table.driven" }[state];
    return key ? say(key) : "";
  }

  isChanged(name) {
    const { locked, lower, upper } = this.of(name);
    return Boolean(locked) || Boolean(lower?.text || lower?.bad) || Boolean(upper?.text || upper?.bad);
  }

  cells(name) {
    const own = this.#own.has(name);
    const known = this.of(name);
    const bound = (end, index) => {
      const input = made("input", {
        type: "number", step: 0.05, value: known[end]?.text ?? "", placeholder: String(this.#ends[index]), ariaLabel: say(`table.${end}-of`, { name }),
        disabled: own || Boolean(known.locked),
      });
      input.addEventListener("input", () => this.set(name, { [end]: typed(input) }));
      return input;
    };
    const bounds = [bound("lower", 0), bound("upper", 1)];
    const lock = made("input", { type: "checkbox", checked: own || Boolean(known.locked), disabled: own, ariaLabel: say("table.locked-of", { name }) });
    lock.addEventListener("change", () => {
      for (const input of bounds) input.disabled = lock.checked;
      this.set(name, { locked: lock.checked });
    });
    return [[lock], ...bounds.map((input) => [input])];
  }

  /// Takes a method's lists; answers the names that the avatar does not have.
  takeSpec({ locked = [], bounds = {} }) {
    const values = new Map(Object.entries(bounds).map(([name, [lower, upper]]) => [name, { lower: { text: String(lower) }, upper: { text: String(upper) } }]));
    for (const name of locked) if (!this.#own.has(name)) values.set(name, { ...values.get(name), locked: true });
    return this.take(values);
  }

  /// Adds to a method what it takes of the table.
  spec(spec) {
    const bounds = {};
    const locked = [];
    for (const [name, known] of this.values) {
      if (known.locked) {
        locked.push(name);
        continue;
      }
      const [lower, upper] = [known.lower ?? {}, known.upper ?? {}].map((input) => number(input, "bounds", name));
      if (lower !== undefined || upper !== undefined) bounds[name] = [lower ?? this.#ends[0], upper ?? this.#ends[1]];
    }
    if (this.#parameters.includes("locked") && locked.length > 0) spec.locked = locked;
    if (this.#parameters.includes("bounds") && Object.keys(bounds).length > 0) spec.bounds = bounds;
  }
}

/// How much each marker counts.
export class MarkerTable extends NamedTable {
  #taken = false;

  constructor(owner, changed) {
    super({ title: say("table.importance"), one: "marker", hint: say("table.importance-hint") }, owner, changed);
  }

  choose(parameters) {
    this.#taken = parameters.includes("importance");
    this.element.hidden = !this.#taken;
  }

  columns() {
    return [say("marker"), say("table.importance-column")];
  }

  fields() {
    return ["importance"];
  }

  isChanged(name) {
    const { text, bad } = this.of(name);
    return bad || (text !== undefined && text !== "");
  }

  cells(name) {
    const input = made("input", { type: "number", min: 0, step: 0.1, value: this.of(name).text ?? "", placeholder: "1", ariaLabel: say("table.importance-of", { name }) });
    input.addEventListener("input", () => this.set(name, typed(input)));
    return [[input]];
  }

  /// Takes a method's importances; answers the labels that are on no face.
  takeSpec({ importance = {} }) {
    return this.take(new Map(Object.entries(importance).map(([name, value]) => [name, { text: String(value) }])));
  }

  spec(spec) {
    if (!this.#taken) return;
    const importance = {};
    for (const name of this.values.keys()) {
      const value = number(this.of(name), "importance", name);
      if (value !== undefined) importance[name] = value;
    }
    if (Object.keys(importance).length > 0) spec.importance = importance;
  }
}
