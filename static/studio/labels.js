// Labels of a take: a model suggests, a person confirms, relabels and moves; learnt from again.
import { made } from "../stage/player.js";
import { draw, style } from "../drawing/lines.js";
import { movable } from "./drag.js";
import { isShown, whenShown } from "./tabs.js";
import { numeral, say } from "./texts.js";
import { callWorker } from "./worker-calls.js";

const $ = (id) => document.getElementById(id);
// Suggestions below it are hatched, and are those that "Least sure" shows.
const SURE = 0.6;
const LEAST_FRAMES = 2;
const date = () => new Date().toISOString().replace(/\.\d+Z/, "+00:00");
const share = (probability) => numeral(probability, 2);

export class Labels {
  #page;
  #state = { names: [], boxes: [], counts: {}, model: null, learntFromSuggestions: [] };
  #curves = [];
  #chosen = -1;
  #rate = 1;
  #frames = 1;

  /// `page`: {history, slot(), seek(ms), name(), save(name, text), expressions(segments), busy(words, work), report(error)}
  constructor(page) {
    this.#page = page;
    const on = (id, act) => $(id).addEventListener("click", () => act().catch(page.report));
    on("labels-suggest", () => this.#asked(say("labels.looking"), "suggestLabels"));
    on("labels-learn", () => this.#asked(say("labels.learning"), "learnLabels"));
    on("labels-take", async () => this.#anew(await callWorker("labelsFromExpressions", $("labels-rest").checked)));
    on("labels-put", async () => page.expressions((await callWorker("labelsToExpressions", $("labels-only").checked)).segments));
    on("labels-csv", async () => page.save(`${page.name()}-labels.csv`, await callWorker("labelsCsv")));
    on("labels-eaf", () => this.#saveEaf(undefined, `${page.name()}-labels.eaf`));
    on("labels-model", async () => page.save(`${page.name()}-model.json`, await callWorker("labelModelJson")));
    on("label-confirm", () => this.#confirm(this.#chosen));
    on("label-release", () => this.#change(this.#chosen, "releaseLabel"));
    on("label-name", () => this.#change(this.#chosen, "relabel", $("label-new").value));
    $("label-choice").addEventListener("change", () => this.#change(this.#chosen, "relabel", $("label-choice").value).catch(page.report));
    $("labels-unsure").addEventListener("change", () => this.#draw());
    this.#file("label-model", async (file) => this.#anew(await callWorker("labelModel", file.name, await file.text())));
    this.#file("labels-into-eaf", async (file) => this.#saveEaf(await file.text(), file.name));
    whenShown("labelling", () => this.#draw());
    addEventListener("resize", () => this.#draw());
  }

  /// A new take: the model stays, nothing is labelled.
  async reset(frames, rate) {
    [this.#frames, this.#rate] = [Math.max(frames, 1), rate];
    await this.#anew(await callWorker("labelsState"));
  }

  #file(id, act) {
    $(id).addEventListener("change", async ({ target }) => {
      const [file] = target.files;
      target.value = "";
      if (file) await act(file).catch(this.#page.report);
    });
  }

  async #asked(words, call) {
    const state = await this.#page.busy(words, () => callWorker(call, this.#page.slot()));
    if (state) await this.#anew(state);
  }

  // Other boxes than before: steps that were about those lead nowhere.
  async #anew(state) {
    this.#page.history.forget("labels");
    await this.#put(state);
  }

  async #saveEaf(document, name) {
    this.#page.save(name, await callWorker("labelsEaf", document, date()));
  }

  // Something done to a box; the focus stays on it.
  async #change(index, call, ...args) {
    if (index < 0) return;
    const state = await this.#step(call, index, ...args);
    await this.#put(state, state.at ?? index);
  }

  // What is done to a box can be taken back, until labels are suggested or learnt anew.
  async #step(call, index, ...args) {
    const what = say("labels.box", { label: this.#state.boxes[index].label });
    const before = await callWorker("keepLabels");
    const state = await callWorker(call, index, ...args);
    const after = await callWorker("keepLabels");
    const put = async (kept) => this.#put(await callWorker("restoreLabels", kept));
    this.#page.history.put({ what, about: "labels", undo: () => put(before), redo: () => put(after) });
    return state;
  }

  // Then the next box in order of time that is not confirmed.
  async #confirm(index) {
    if (index < 0) return;
    const state = await this.#step("confirmLabel", index);
    const next = state.boxes.findIndex((box, i) => i > index && !box.confirmed && this.#isShown(box));
    await this.#put(state, next < 0 ? index : next);
  }

  #isShown({ confirmed, probability }) {
    return !$("labels-unsure").checked || (!confirmed && probability < SURE);
  }

  async #put(state, chosen = -1) {
    this.#state = state;
    this.#chosen = Math.min(chosen, state.boxes.length - 1);
    const known = state.model?.labels ?? [];
    const values = await Promise.all(known.map((_, i) => callWorker("labelProbabilities", i)));
    this.#curves = known.map((name, i) => ({ name, values: values[i] })).filter(({ values }) => values.length > 0);
    this.#tell();
    this.#draw();
    if (this.#chosen >= 0) $("label-line").querySelector(`[data-box="${this.#chosen}"]`)?.focus();
  }

  #tell() {
    const { names, boxes, counts, model, learntFromSuggestions } = this.#state;
    const words = [];
    if (model) words.push(say("labels.model-is", { labels: model.labels.join(", "), takes: model.takes.join(", "), frames: model.holdsFrames ? say("labels.holds-frames") : "" }));
    if (learntFromSuggestions.length > 0) words.push(say("labels.from-suggestions", { labels: learntFromSuggestions.join(", ") }));
    if (boxes.length > 0) words.push(say("labels.counts", { ...counts, all: boxes.length }));
    $("labels-note").textContent = words.join(" ");
    $("labels-keys").replaceChildren(...names.map((name, i) => {
      const item = made("span", {}, i < 9 ? `${i + 1} ${name}` : name);
      item.style.setProperty("--swatch", style(i).colour);
      return item;
    }));
    $("labels-suggest").disabled = !model;
    $("labels-model").disabled = !model;
    $("labels-learn").disabled = counts.confirmed === 0;
    for (const id of ["labels-put", "labels-csv", "labels-eaf"]) $(id).disabled = boxes.length === 0;
  }

  #draw() {
    if (!isShown("labelling")) return;
    const line = $("label-line");
    line.hidden = this.#state.boxes.length === 0;
    line.replaceChildren(...this.#state.boxes.map((box, i) => this.#box(box, i)));
    const plot = $("label-plot");
    plot.hidden = this.#curves.length === 0;
    if (!plot.hidden) draw(plot, { lines: this.#curves, unit: "", low: 0, high: 1 }, null);
    this.#choice();
  }

  // The chosen box and what can be done with it by mouse.
  #choice() {
    const box = this.#state.boxes[this.#chosen];
    $("label-chosen").hidden = !box;
    if (!box) return;
    $("label-words").textContent = this.#words(box);
    $("label-choice").replaceChildren(...this.#state.names.map((name) => new Option(name, name, false, name === box.label)));
    $("label-confirm").disabled = box.confirmed;
    $("label-release").disabled = !box.confirmed;
  }

  #words({ label, probability, second, confirmed, frames }) {
    const [from, to] = frames.map((frame) => numeral(frame / this.#rate, 2));
    const next = second ? say("labels.then", { label: second.label, share: share(second.probability) }) : "";
    return confirmed ? say("labels.box-confirmed", { label, from, to }) : say("labels.box-suggested", { label, from, to, share: share(probability), next });
  }

  #box(own, index) {
    const words = this.#words(own);
    const box = made("button", { type: "button", className: "segment", title: words, ariaLabel: words }, own.label);
    box.dataset.box = index;
    box.dataset.state = own.confirmed ? "confirmed" : own.probability < SURE ? "unsure" : "sure";
    box.style.setProperty("--colour", style(own.color).colour);
    box.style.setProperty("--strength", `${Math.round(own.confirmed ? 45 : 5 + 35 * own.probability)}%`);
    box.hidden = !this.#isShown(own);
    const line = { element: $("label-line"), frames: this.#frames, rate: this.#rate, least: LEAST_FRAMES };
    const report = this.#page.report;
    const moved = ([from, to]) => this.#change(index, "moveLabel", Math.max(from, 0), Math.min(to, this.#frames)).catch((error) => (report(error), this.#draw()));
    box.addEventListener("keydown", (event) => this.#key(event, index));
    box.addEventListener("focus", () => ((this.#chosen = index), this.#choice()));
    box.addEventListener("click", () => this.#page.seek((1000 * own.frames[0]) / this.#rate));
    movable(box, own.frames, line, moved);
    return box;
  }

  #key(event, index) {
    const name = /^[1-9]$/.test(event.key) ? this.#state.names[Number(event.key) - 1] : undefined;
    const acts = { Enter: () => this.#confirm(index), Delete: () => this.#change(index, "releaseLabel") };
    const act = name === undefined ? acts[event.key] : () => this.#change(index, "relabel", name);
    if (!act || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    act().catch(this.#page.report);
  }
}
