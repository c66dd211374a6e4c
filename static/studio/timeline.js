// The expressions of a take: suggested, dragged, typed, saved.
import { made } from "../stage/player.js";
import { draw } from "../drawing/lines.js";
import { movable } from "./drag.js";
import { newest } from "./newest.js";
import { isShown, whenShown } from "./tabs.js";
import { numeral, say } from "./texts.js";
import { callWorker } from "./worker-calls.js";

const $ = (id) => document.getElementById(id);

// Segments as the worker takes them.
const edited = (segments) => segments.map(({ label, expression }) => ({ label, expression }));

export class Timeline {
  #page;
  #segments = [];
  #curve = null;
  #rate = 1;
  #frames = 1;
  // One question to the worker at a time; the newest place of the slider counts.
  #follow = newest(() => this.#suggest());

  /// `page`: {history, slot(), seek(ms), timeMs(), changed(segments), save(name, text), report(error)}
  constructor(page) {
    this.#page = page;
    const guarded = (act) => () => act().catch(page.report);
    $("expressions-suggest").addEventListener("click", guarded(() => this.#suggest()));
    // While the slider is moved the expressions are suggested anew, as one step that can be taken back.
    $("expressions-sensitivity").addEventListener("input", () => this.#follow().catch(page.report));
    $("expression-add").addEventListener("click", guarded(() => this.#add()));
    $("expressions-file").addEventListener("change", (event) => this.#open(event.target).catch(page.report));
    $("save-csv").addEventListener("click", guarded(async () => page.save("expressions.csv", await callWorker("expressionsCsv"))));
    $("save-eaf").addEventListener("click", guarded(() => this.#saveEaf(undefined, "expressions.eaf")));
    $("save-study").addEventListener("click", guarded(async () => page.save("segments.json", await callWorker("studySegments"))));
    $("into-eaf").addEventListener("change", (event) => this.#into(event.target).catch(page.report));
    whenShown("expressions", () => this.#draw());
    addEventListener("resize", () => this.#draw());
  }

  /// A new take: nothing is known of it.
  reset(frames, rate) {
    [this.#frames, this.#rate] = [Math.max(frames, 1), rate];
    this.#curve = null;
    $("expressions-note").textContent = "";
    this.#page.history.forget("segments");
    this.#put([]);
  }

  /// Segments that the worker has taken from elsewhere.
  take(segments) {
    this.#curve = null;
    this.#done(say("expressions"), segments);
  }

  // A person has changed the segments: shown, and to be taken back.
  #done(what, segments, same) {
    const [before, after] = [this.#segments, segments];
    const put = async (others) => this.#put((await callWorker("setExpressions", JSON.stringify(edited(others)))).segments);
    this.#page.history.put({ what, same, about: "segments", undo: () => put(before), redo: () => put(after) });
    this.#put(segments);
  }

  async #suggest() {
    // A step of the slider to its end finds expressions that are eight times as weak, or as strong.
    const sensitivity = 8 ** Number($("expressions-sensitivity").value);
    const found = await callWorker("suggestExpressions", this.#page.slot(), $("labels").value, sensitivity);
    this.#curve = { level: found.level, threshold: found.threshold };
    this.#done(say("expressions.suggested"), found.segments, "sensitivity");
  }

  async #open(input) {
    const file = input.files[0];
    input.value = "";
    if (!file) return;
    const found = await callWorker("expressionsFile", file.name, await file.text());
    this.#done(file.name, found.segments);
    $("expressions-note").textContent = found.leftOut ? `${file.name}: ${found.leftOut}` : "";
  }

  async #add() {
    const start = Math.round((this.#page.timeMs() * this.#rate) / 1000);
    const end = Math.min(start + Math.round(this.#rate), this.#frames);
    const own = { label: say("expressions.new", { number: this.#segments.length + 1 }), expression: [Math.min(start, end - 1), end] };
    await this.#set([...this.#segments, own], own.label);
  }

  async #set(segments, what) {
    this.#done(what, (await callWorker("setExpressions", JSON.stringify(edited(segments)))).segments);
  }

  async #saveEaf(document, name) {
    this.#page.save(name, await callWorker("expressionsEaf", document, new Date().toISOString().replace(/\.\d+Z/, "+00:00")));
  }

  async #into(input) {
    const file = input.files[0];
    input.value = "";
    if (file) await this.#saveEaf(await file.text(), file.name);
  }

  #put(segments) {
    this.#segments = segments;
    $("segments").replaceChildren(...segments.map((segment, i) => this.#row(segment, i)));
    for (const id of ["save-csv", "save-eaf", "save-study"]) $(id).disabled = segments.length === 0;
    this.#draw();
    this.#page.changed(segments);
  }

  #edit(index, change) {
    const segments = this.#segments.map((segment, i) => (i === index ? { ...segment, ...change } : segment));
    this.#set(segments, segments[index].label).catch((error) => {
      this.#page.report(error);
      this.#put(this.#segments);
    });
  }

  #row(segment, index) {
    const { label, expression, expression_s, clip_s } = segment;
    const name = made("input", { type: "text", value: label, ariaLabel: say("name") });
    name.addEventListener("change", () => this.#edit(index, { label: name.value }));
    const field = (end) => {
      const input = made("input", {
        type: "number", min: 0, step: 0.01, value: expression_s[end].toFixed(3), ariaLabel: say(end ? "expressions.end-of" : "expressions.start-of", { name: label }),
      });
      input.addEventListener("change", () => {
        const frames = [...expression];
        frames[end] = Math.min(Math.max(Math.round(Number(input.value) * this.#rate), 0), this.#frames);
        this.#edit(index, { expression: frames });
      });
      return made("td", {}, input);
    };
    const remove = made("button", { type: "button", ariaLabel: say("remove.what", { name: label }) }, "✕");
    remove.addEventListener("click", () => this.#set(this.#segments.filter((_, i) => i !== index), say("remove.what", { name: label })).catch(this.#page.report));
    const clip = clip_s.map((s) => numeral(s, 2)).join(" – ");
    return made("tr", {}, made("td", {}, name), field(0), field(1), made("td", {}, clip), made("td", {}, remove));
  }

  #draw() {
    const line = $("timeline");
    if (!isShown("expressions")) return;
    const boxes = this.#segments.map((segment, i) => this.#box(segment, i));
    line.replaceChildren(...boxes);
    if (!this.#curve) return;
    const canvas = made("canvas", { role: "img" });
    line.prepend(canvas);
    draw(canvas, { lines: [{ name: say("expressions.level"), values: this.#curve.level }], unit: "", marks: [this.#curve.threshold] }, null);
  }

  #box({ label, expression, clip_s }, index) {
    const box = made("button", { type: "button", className: "segment", title: label }, label);
    box.addEventListener("click", () => this.#page.seek(1000 * clip_s[0]));
    const line = { element: $("timeline"), frames: this.#frames, rate: this.#rate, least: 2 };
    movable(box, expression, line, (frames) => this.#edit(index, { expression: frames }));
    return box;
  }
}
