// The inputs of an exertion: motion, time, person, heart and face; read as the worker takes them.
import { made } from "../stage/player.js";
import { describe } from "./lists.js";
import { say } from "./texts.js";

/// Sliders of a person: the place in the person's JSON, words, range, step, value.
const SLIDERS = {
  training: [["level", say("body.level"), 0, 10, 0.5, 5]],
  expressivity: [
    ["expressivity/mouthOpen", say("body.mouth-open"), 0, 2, 0.05, 1],
    ["expressivity/mouthExhale", say("body.mouth-exhale"), 0, 2, 0.05, 1],
    ["expressivity/mouthStretch", say("body.mouth-stretch"), 0, 2, 0.05, 1],
    ["expressivity/eyes", say("body.eyes"), 0, 2, 0.05, 1],
    ["expressivity/brows", say("body.brows"), 0, 2, 0.05, 1],
  ],
  loads: [
    ["loads/leftHand", say("body.left-hand"), 0, 20, 0.5, 0],
    ["loads/rightHand", say("body.right-hand"), 0, 20, 0.5, 0],
    ["loads/back", say("body.back"), 0, 40, 0.5, 0],
  ],
};
const NUMBERS = [
  ["age", say("body.age"), 10, 100, 1, 30],
  ["heightM", say("body.height"), 1, 2.5, 0.01, 1.75],
  ["massKg", say("body.mass"), 20, 300, 0.5, 70],
];
/// How long a motion goes on, and how much of it the face shows, s.
const SECONDS = 300;
const WINDOW = 10;

export class ExertionSettings {
  #inputs = new Map();
  #problem = made("p", { className: "problem", id: "exertion-problem", role: "alert", hidden: true });
  #changed;
  #seconds = SECONDS;

  /// Builds the inputs into `place`; `changed` hears that one is another, `open(kind, file)` which file is opened.
  constructor(place, changed, open) {
    this.#changed = changed;
    const source = this.#select("source", say("body.motion"), [["walk", say("body.walk")], ["run", say("body.run")], ["sprint", say("body.sprint")], ["take", say("body.take")], ["file", say("body.file")]], "run");
    const heart = this.#select("heart", say("body.heart"), [["thesis", say("body.thesis")], ["steady", say("body.steady")], ["recorded", say("body.recorded")]], "thesis");
    const model = this.#select("model", say("body.curves"), [["rules", say("body.rules")], ["linear", say("body.linear")], ["file", say("body.model-file")]], "rules");
    this.choice("source", "take", false);
    this.choice("source", "file", false);
    this.choice("heart", "recorded", false);
    this.choice("model", "file", false);
    const sex = this.#select("person/sex", say("body.sex"), [["", say("body.sex-none")], ["female", say("body.female")], ["male", say("body.male")]], "");
    const number = ([name, words, min, max, step, value]) => this.#number(`person/${name}`, words, { min, max, step, value });
    const sliders = (group) => SLIDERS[group].map((slider) => this.#slider(slider));
    const breath = made("input", { type: "checkbox", checked: true });
    const skin = made("input", { type: "checkbox" });
    this.#listen("breath", breath, "change");
    this.#listen("skin", skin, "change");
    place.replaceChildren(
      this.#problem,
      group(say("body.motion"), row(source, opener(say("body.open"), ".bvh,.c3d,.trc,.tsv,.csv,.txt,.fit,.tcx,.gpx", (file) => open("motion", file))),
        row(this.#number("seconds", say("body.seconds"), { min: 1, max: 86400, step: "any", value: SECONDS }), this.#number("from", say("body.from"), { min: 0, step: "any", value: SECONDS - WINDOW }), this.#number("to", say("body.to"), { min: 0, step: "any", value: SECONDS }))),
      group(say("body.person"), ...sliders("training"), row(...NUMBERS.map(number), sex)),
      group(say("body.loads"), ...sliders("loads")),
      group(say("body.expressivity"), ...sliders("expressivity")),
      group(say("body.heart-and-face"), row(heart, model, opener(say("body.open-model"), ".json", (file) => open("model", file))),
        row(made("label", { className: "preview-check" }, breath, say("body.breathe")), made("label", { className: "preview-check" }, skin, say("body.skin")), this.#number("seed", say("body.seed"), { min: 0, step: 1, value: "", placeholder: say("body.no-seed") }))),
    );
  }

  /// Whether a choice can be made.
  choice(name, value, can, words) {
    const option = [...this.#inputs.get(name).options].find((each) => each.value === value);
    option.disabled = !can;
    if (words) option.textContent = words;
  }

  /// Chooses, as a person would.
  choose(name, value) {
    this.#inputs.get(name).value = value;
  }

  /// All inputs as they are, to be kept and put back.
  state() {
    return [...this.#inputs].map(([name, input]) => [name, input.type === "checkbox" ? input.checked : input.value]);
  }

  putState(state) {
    for (const [name, value] of state) {
      const input = this.#inputs.get(name);
      if (input.type === "checkbox") input.checked = value;
      else input.value = value;
      if (input.type === "range") input.nextElementSibling.textContent = input.value;
    }
    this.#seconds = Number(this.value("seconds"));
  }

  value(name) {
    return this.#inputs.get(name).value;
  }

  /// The whole of a motion or recording, its last seconds in the window.
  last(seconds) {
    this.#seconds = seconds;
    this.choose("seconds", seconds);
    this.window([Math.max(0, seconds - WINDOW), seconds]);
  }

  /// How long a motion goes on unless somebody says.
  usual() {
    this.last(SECONDS);
  }

  window([from, to]) {
    this.choose("from", Number(from.toFixed(3)));
    this.choose("to", Number(to.toFixed(3)));
  }

  /// What the worker takes.
  read() {
    const person = {};
    for (const [name, input] of this.#inputs) {
      const [top, key, below] = name.split("/");
      if (top !== "person" || input.value === "") continue;
      const value = input.localName === "select" ? input.value : Number(input.value);
      if (below) person[key] = { ...person[key], [below]: value };
      else person[key] = value;
    }
    const number = (name) => (this.value(name) === "" ? null : Number(this.value(name)));
    return {
      source: this.value("source"), seconds: number("seconds"), person, heart: this.value("heart"), model: this.value("model"),
      breath: this.#inputs.get("breath").checked, skin: this.#inputs.get("skin").checked, seed: number("seed"), window: [number("from") ?? 0, number("to") ?? number("seconds") ?? 0],
    };
  }

  /// Says what is wrong, at its input; null where nothing is.
  say(problem) {
    const place = problem?.place === "window" ? "to" : problem?.place;
    for (const [name, input] of this.#inputs) describe(input, this.#problem, name === place);
    this.#problem.hidden = !problem;
    if (this.#problem.textContent !== (problem?.text ?? "")) this.#problem.textContent = problem?.text ?? "";
  }

  // A shorter or longer motion takes the window along where it lay at the end.
  #timed() {
    const seconds = Number(this.value("seconds"));
    const [from, to] = [Number(this.value("from")), Number(this.value("to"))];
    if (seconds > 0 && (to > seconds || to === this.#seconds)) {
      this.window([Math.max(0, seconds - (to - from)), seconds]);
    }
    this.#seconds = seconds;
  }

  #listen(name, input, event) {
    input.id = `exertion-${name.replaceAll("/", "-")}`;
    this.#inputs.set(name, input);
    input.addEventListener(event, () => {
      if (name === "seconds") this.#timed();
      this.#changed(name);
    });
  }

  #select(name, words, options, value) {
    const select = made("select", {}, ...options.map(([word, text]) => new Option(text, word)));
    select.value = value;
    this.#listen(name, select, "change");
    return made("label", {}, `${words} `, select);
  }

  #number(name, words, properties) {
    const input = made("input", { type: "number", ...properties });
    this.#listen(name, input, "input");
    return made("label", {}, `${words} `, input);
  }

  #slider([place, words, min, max, step, value]) {
    // The range first: a value is held against it.
    const input = made("input", { type: "range", min, max, step, value });
    const shown = made("output", { className: "number" }, String(value));
    input.addEventListener("input", () => (shown.textContent = input.value));
    this.#listen(`person/${place}`, input, "input");
    shown.htmlFor = input.id;
    return made("div", { className: "exertion-slider" }, made("label", { htmlFor: input.id }, words), input, shown);
  }
}

function group(title, ...children) {
  return made("fieldset", {}, made("legend", {}, title), ...children);
}

function row(...children) {
  return made("div", { className: "row" }, ...children);
}

function opener(words, accept, open) {
  const input = made("input", { type: "file", className: "visually-hidden", accept });
  input.addEventListener("change", () => {
    const [file] = input.files;
    input.value = "";
    if (file) open(file);
  });
  return made("label", { className: "button" }, words, input);
}
