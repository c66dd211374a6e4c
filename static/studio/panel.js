// One method on the avatar: choose it, change its parameters, see the face follow. The face is a viewport, the
// method with its parameters stands in the inspector.
import { made } from "../stage/player.js";
import { Difference } from "./difference.js";
import { drawMatch } from "./overlay.js";
import { Parameters } from "./parameters.js";
import { numeral, say } from "./texts.js";
import { Viewport } from "./viewport.js";
import { faultWords, warningWords } from "./words-engine.js";
import { callWorker } from "./worker-calls.js";

// A change waits so long for the next one before it is solved.
const SETTLE_MS = 180;

// What a change is about: the method, a parameter, a table.
function changedIn(before, after) {
  if (before.method !== after.method) return say("method");
  const at = after.fields.findIndex(([, value], i) => value !== before.fields[i]?.[1]);
  if (at >= 0) return after.fields[at][0];
  return JSON.stringify(before.shapes) === JSON.stringify(after.shapes) ? say("table.importance") : say("table.shapes");
}

export class MethodPanel {
  #slot;
  #page;
  #viewport;
  #facts = made("dl", { className: "preview-clip" });
  #notices = made("div", { role: "status" });
  #select;
  #parameters;
  #difference;
  #saveSettings;
  #timer = null;
  #run = 0;
  #matchBusy = false;
  #generation = 0;
  #lastOwn = false;
  // What the controls held when they were changed last.
  #known;
  #name;
  /// The method with all that belongs to it, for the inspector.
  inspector;
  facts = null;

  /// `page`: {methods, player, camera, panels(), seekFrame(slot, frame), avatar(), avatarKey(), faceMarkers(), trainingMissing(), showMarkers(), first(), name(),
  /// save(name, text), changed(panel), edited(panel), choose(slot), remove(slot), report(error)}
  constructor(slot, page, method, removable) {
    [this.#slot, this.#page, this.#name] = [slot, page, method];
    const { letter } = this;
    this.#viewport = new Viewport(slot, page, removable);
    this.#select = made("select", { ariaLabel: say("panel.method", { letter }) });
    for (const { name } of page.methods) this.#select.append(new Option(name, name));
    this.#select.value = method;
    this.#select.addEventListener("change", () => (this.#controls(), this.#edited()));
    this.trainingChanged();
    this.#parameters = new Parameters(slot, () => this.#edited());
    this.#difference = new Difference(slot, page, (name, words) => this.#row(name, words));
    this.#saveSettings = made("button", { type: "button", disabled: true, ariaLabel: say("settings.save-of", { letter }) }, say("settings.save"));
    this.#saveSettings.addEventListener("click", () => this.#settings().catch(page.report));
    const file = made("input", { type: "file", className: "visually-hidden", accept: ".json" });
    file.addEventListener("change", () => this.#openSettings(file));
    const open = made("label", { className: "button" }, `${say("settings.open")} `, made("span", { className: "visually-hidden" }, say("settings.open-of", { letter })), file);
    this.inspector = made(
      "section", { className: "studio-inspector", ariaLabel: say("panel.method", { letter }), hidden: true },
      made("div", { className: "studio-method" },
        made("div", { className: "studio-panel-head" }, made("span", { className: "studio-letter" }, letter), this.#select),
        this.#parameters.element, ...this.#parameters.tables,
        made("div", { className: "row" }, this.#saveSettings, open)),
      this.#difference.element, this.#facts, this.#notices,
    );
    this.inspector.dataset.slot = slot;
    this.rename(method);
    this.#controls();
    this.sourcesChanged();
    this.#known = this.state();
  }

  // A person has changed something: it is solved, and can be taken back.
  #edited() {
    const [before, after] = [this.#known, this.state()];
    this.#known = after;
    const { history, panel } = this.#page;
    // The newest panel of the slot: this one may have been taken away and brought back meanwhile.
    const put = (state) => panel(this.#slot)?.restore(state);
    const changed = changedIn(before, after);
    history.put({
      what: say("panel.changed", { what: changed, letter: this.letter }), same: `${this.#slot} ${changed}`,
      undo: () => put(before), redo: () => put(after),
    });
    this.solveSoon();
  }

  /// Method and parameters as they stand in the controls, to be kept and put back.
  state() {
    return { method: this.#select.value, ...this.#parameters.state() };
  }

  /// Puts back what `state` has told, unsolved.
  put(state) {
    this.choose(state.method);
    this.#parameters.putState(state);
    this.#known = this.state();
  }

  /// Puts it back and solves; resolves when the face stands.
  async restore(state) {
    this.put(state);
    this.#page.choose(this.#slot);
    await this.solve();
  }

  get element() {
    return this.#viewport.element;
  }

  get slot() {
    return this.#slot;
  }

  get letter() {
    return this.#slot.toUpperCase();
  }

  get clipId() {
    return this.#viewport.clipId;
  }

  get drawn() {
    return this.#viewport.drawn;
  }

  /// The name that tells it from the others.
  title() {
    return this.#name;
  }

  /// What the name is made of (names.js).
  named() {
    const method = this.#select.value;
    const usual = Object.fromEntries(this.#definition().parameters.map(({ key, default: value }) => [key, value]));
    return { letter: this.letter, method, settings: this.facts?.settings ?? null, usual };
  }

  rename(name) {
    this.#name = name;
    this.#viewport.entitle(name);
    this.#difference.rename();
  }

  /// Whether it is the one whose method the inspector shows.
  chosen(isChosen) {
    this.#viewport.chosen(isChosen);
    this.inspector.hidden = !isChosen;
  }

  clip() {
    return this.facts ? this.#viewport.clip() : null;
  }

  #definition(method = this.#select.value) {
    return this.#page.methods.find(({ name }) => name === method);
  }

  // The parameters that the method has.
  #controls() {
    this.#parameters.choose(this.#definition());
  }

  /// Another avatar, take or map: other blendshapes, other markers.
  sourcesChanged() {
    const avatar = this.#page.avatar();
    if (avatar) this.#parameters.put(avatar, this.#page.faceMarkers());
  }

  /// The method that learns can be chosen once there is something to learn from.
  trainingChanged() {
    const missing = this.#page.trainingMissing();
    for (const option of this.#select.options) {
      // What a method is set up with: "shapes", "training" (a take to learn from), "surface", "weights".
      if (this.#definition(option.value).needs !== "training") continue;
      option.disabled = missing !== null;
      option.textContent = missing === null ? option.value : say("method.no-training", { method: option.value, missing });
      if (this.#select.value === option.value) this.solveSoon();
    }
  }

  // A method as #settings wrote it, or as it stands in a study file.
  async #openSettings(input) {
    const [file] = input.files;
    if (!file) return;
    try {
      const { factors, label, training, ...spec } = JSON.parse(await file.text());
      if (!this.#definition(spec.method)) throw new Error(say("method.unknown", { name: JSON.stringify(spec.method) }));
      const before = this.state();
      this.choose(spec.method);
      this.#controls();
      const byName = JSON.stringify([spec.locked, spec.bounds, spec.importance]);
      this.#known = before;
      try {
        this.#parameters.take(byName.includes("*") ? await callWorker("namedMethod", JSON.stringify(spec)) : spec);
      } finally {
        this.#edited();
      }
    } catch (error) {
      this.#page.report(new Error(`${file.name}: ${error.message}`));
    } finally {
      input.value = "";
    }
    await this.solve();
  }

  // The method as it was solved last, for a study file and `mimique solve --settings`.
  async #settings() {
    if (this.#timer !== null) await this.solve();
    if (!this.facts) throw new Error(say("method.unsolved", { letter: this.letter }));
    const text = `${JSON.stringify(this.facts.settings, null, 2)}\n`;
    this.#page.save(`${this.#page.name()}-${this.#slot}-settings.json`, text);
  }

  /// Takes the method `recorded`, for takes that are weights; or the one before.
  choose(method) {
    if (this.#select.value === method) return;
    this.#select.value = method;
    this.#controls();
  }

  isRecorded() {
    return this.#definition().needs === "weights";
  }

  solveSoon() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.solve(), SETTLE_MS);
  }

  /// Solves and shows; resolves when the face stands.
  async solve() {
    const run = ++this.#run;
    clearTimeout(this.#timer);
    this.#timer = null;
    if (this.facts === null) this.#viewport.say(say("solving"));
    try {
      const started = performance.now();
      const facts = await callWorker("solve", this.#slot, JSON.stringify(this.#parameters.spec()));
      const took = performance.now() - started;
      if (facts.problems) {
        const problems = facts.problems.map((problem) => ({ ...problem, text: faultWords(problem) }));
        const words = problems.map(({ place, text }) => say("problem.at", { place, text })).join("\n");
        throw Object.assign(new Error(words), { problems });
      }
      if (run !== this.#run) return;
      const [weights, avatarPack] = await Promise.all([callWorker("weights", this.#slot), callWorker("slotPack", this.#slot)]);
      if (run !== this.#run) return;
      this.#generation += facts.own_avatar || this.#lastOwn ? 1 : 0;
      this.#lastOwn = facts.own_avatar;
      const avatarHash = `${this.#page.avatarKey()}-${facts.own_avatar ? `${this.#slot}${this.#generation}` : "bank"}`;
      await this.#viewport.put({ avatarHash, avatarPack, weights, frames: facts.frames, shapes: facts.shapes.length, rate_hz: facts.rate_hz });
      if (run !== this.#run) return;
      this.facts = facts;
      this.#parameters.problems([]);
      this.#parameters.solved(facts);
      this.#saveSettings.disabled = false;
      this.#describe(facts, took);
      this.#viewport.say(null);
      this.#page.changed(this);
      this.#page.player.draw();
      for (const panel of this.#page.panels()) panel.compare();
    } catch (error) {
      if (run !== this.#run) return;
      this.facts = null;
      this.#saveSettings.disabled = true;
      this.#parameters.problems(error.problems ?? []);
      this.#viewport.say(String(error.message ?? error));
      this.#facts.replaceChildren();
      this.#notices.replaceChildren();
      this.#page.changed(this);
    }
  }

  /// Somebody's weights are others: the difference, too.
  compare() {
    this.#difference.look();
  }

  turn() {
    this.#viewport.turn();
  }

  /// The turned portrait's matrix, once there is one.
  portrait() {
    return this.facts && this.#viewport.isThere() ? this.#viewport.portrait() : null;
  }

  draw(timeMs) {
    if (!this.facts || !this.#viewport.isThere()) return true;
    const drawn = this.#viewport.draw(timeMs);
    if (drawn !== null) this.#drawOver(timeMs);
    return drawn ?? true;
  }

  frameAt(timeMs) {
    const { frames, rate_hz } = this.facts;
    return Math.min(Math.max(Math.round((timeMs * rate_hz) / 1000), 0), frames - 1);
  }

  // What lies over the picture comes from the worker: the newest wish, one at a time.
  #drawOver(timeMs) {
    const frame = this.frameAt(timeMs);
    const { overlay, heat } = this.#viewport;
    overlay.hidden = !this.#page.showMarkers() || this.facts.markers.length === 0;
    if (!overlay.hidden && !this.#matchBusy) {
      this.#matchBusy = true;
      const camera = this.#viewport.matrix();
      callWorker("markerFrame", this.#slot, frame)
        .then((points) => drawMatch(overlay, camera, points), () => {})
        .finally(() => (this.#matchBusy = false));
    }
    this.#difference.paint(heat, () => this.#viewport.matrix(), frame);
  }

  #describe(facts, took) {
    this.#facts.replaceChildren();
    const { summary } = facts;
    this.#row(say("facts.frames"), say("facts.frames-of", { frames: facts.frames, rate: Number(facts.rate_hz.toFixed(2)), ms: took.toFixed(0) }));
    if (summary) {
      this.#row(say("facts.residual"), say("facts.rms-worst", { rms: numeral(summary.residual_rms_mm, 2), worst: numeral(summary.residual_worst_mm, 2) }));
      this.#row(say("facts.iterations"), say("facts.iterations-of", { mean: numeral(summary.iterations_mean, 1), kkt: summary.kkt_worst.toExponential(1) }));
    }
    if (facts.head_lowpass_hz !== undefined) {
      this.#row(say("facts.lowpass"), facts.head_lowpass_hz === null ? say("facts.no-lowpass") : `${facts.head_lowpass_hz} Hz`);
    }
    const atRest = facts.gaze_at_rest?.length ?? 0;
    if (atRest > 0) this.#row(say("gaze"), say("facts.gaze-rest", { count: atRest }));
    else if (facts.gaze) this.#row(say("gaze"), gazeWords(facts.gaze));
    const held = (facts.shapes_told ?? []).filter(({ state }) => state === "held").map(({ shape }) => shape);
    if (held.length > 0) this.#row(say("facts.held"), held.join(", "));
    this.#row(say("facts.weights"), facts.weights_hash.slice(0, 16));
    this.#notices.replaceChildren(...facts.warnings.map((warning) => made("p", { className: "notice warn" }, warningWords(warning))));
  }

  #row(name, value) {
    const known = [...this.#facts.children].find((row) => row.firstChild.textContent === name);
    const row = made("div", {}, made("dt", {}, name), made("dd", { className: "number" }, value));
    if (known) known.replaceWith(row);
    else this.#facts.append(row);
  }

  close() {
    clearTimeout(this.#timer);
    this.#run += 1;
    this.#viewport.close();
    this.inspector.remove();
    callWorker("forget", this.#slot);
  }
}

// Where the eyes look over a take.
function gazeWords({ azimuth_deg: azimuth, elevation_deg: elevation, vergence_deg: vergence }) {
  const span = ([low, high]) => say("facts.gaze-span", { low: numeral(low, 1), high: numeral(high, 1) });
  return say("facts.gaze-of", { azimuth: span(azimuth), elevation: span(elevation), vergence: span(vergence) });
}
