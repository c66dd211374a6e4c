// One method on the avatar: choose it, change its parameters, see the face follow.
import { openStage, preparedClip, putClip } from "../stage/host.js";
import { made } from "../stage/player.js";
import { callWorker } from "./worker-calls.js";
import { drawMatch } from "./overlay.js";
import { Parameters } from "./parameters.js";

const LOOK = { background: "#808080", width: 480, height: 480 };
// A change waits so long for the next one before it is solved.
const SETTLE_MS = 180;

export class MethodPanel {
  #slot;
  #page;
  #element;
  #canvas;
  #overlay;
  #heat;
  #veil;
  #facts;
  #notices;
  #select;
  #parameters;
  #saveSettings;
  #compare;
  #scale;
  #stage = null;
  #opening = null;
  #timer = null;
  #run = 0;
  #heatBusy = false;
  #matchBusy = false;
  #generation = 0;
  facts = null;
  drawn = 0;

  /// `page`: {methods, player, avatar(), faceMarkers(), trainingMissing(), showMarkers(), name(), save(name, text),
  /// changed(panel), remove(panel), report(error)}
  constructor(slot, page, method, removable) {
    this.#slot = slot;
    this.#page = page;
    const letter = slot.toUpperCase();
    this.#select = made("select", { ariaLabel: `Method ${letter}` });
    for (const { name } of page.methods) this.#select.append(new Option(name, name));
    this.#select.value = method;
    this.#select.addEventListener("change", () => (this.#controls(), this.solveSoon()));
    this.trainingChanged();
    const head = made("div", { className: "studio-panel-head" }, made("strong", {}, letter), this.#select);
    if (removable) {
      const remove = made("button", { type: "button", ariaLabel: `Remove method ${letter}` }, "✕");
      remove.addEventListener("click", () => page.remove(this));
      head.append(remove);
    }
    this.#parameters = new Parameters(slot, () => this.solveSoon());
    this.#saveSettings = made("button", { type: "button", disabled: true, ariaLabel: `Save settings of method ${letter}` }, "Save settings");
    this.#saveSettings.addEventListener("click", () => this.#settings().catch(page.report));
    this.#canvas = made("canvas", { role: "img" });
    this.#heat = made("canvas", { className: "studio-overlay", hidden: true });
    this.#overlay = made("canvas", { className: "studio-overlay" });
    this.#veil = made("div", { className: "veil" }, "Nothing to show yet");
    const frame = made("div", { className: "stage studio-stage" }, this.#canvas, this.#heat, this.#overlay, this.#veil);
    this.#facts = made("dl", { className: "preview-clip" });
    this.#notices = made("div", { role: "status" });
    const below = made("div", { className: "studio-below" });
    if (removable) {
      this.#compare = made("input", { type: "checkbox" });
      this.#compare.addEventListener("change", () => page.player.draw());
      this.#scale = made("input", { type: "number", min: 0.1, step: 0.1, value: 1, ariaLabel: "Brightest colour, mm" });
      this.#scale.addEventListener("change", () => page.player.draw());
      below.append(
        made("label", { className: "preview-check" }, this.#compare, " Difference from A"),
        made("div", { className: "studio-heat-scale" }, "0", made("i", {}), this.#scale, "mm"),
      );
    }
    // The tables stand below the face, so that it is seen while they are filled in.
    const file = made("input", { type: "file", className: "visually-hidden", accept: ".json" });
    file.addEventListener("change", () => this.#openSettings(file));
    const openSettings = made("label", { className: "button" }, "Open settings… ", made("span", { className: "visually-hidden" }, `of method ${letter}`), file);
    const save = made("div", { className: "row" }, this.#saveSettings, openSettings);
    below.append(made("div", { className: "studio-method" }, ...this.#parameters.tables, save), this.#facts, this.#notices);
    this.#element = made("section", { className: "preview-panel", ariaLabel: `Method ${letter}` });
    this.#element.append(made("div", { className: "studio-method" }, head, this.#parameters.element), frame, below);
    this.#controls();
    this.sourcesChanged();
  }

  get element() {
    return this.#element;
  }

  get slot() {
    return this.#slot;
  }

  get canvas() {
    return this.#canvas;
  }

  title() {
    return `${this.#slot.toUpperCase()}: ${this.#select.value}`;
  }

  clip() {
    return this.facts ? preparedClip(this.#clipId()) : null;
  }

  #clipId() {
    return `studio-${this.#slot}`;
  }

  // What a method is set up with: "shapes", "training" (a take to learn from), "surface", "weights".
  #needs(method) {
    return this.#page.methods.find(({ name }) => name === method).needs;
  }

  // The parameters that the method has.
  #controls() {
    this.#parameters.choose(this.#page.methods.find(({ name }) => name === this.#select.value));
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
      if (this.#needs(option.value) !== "training") continue;
      option.disabled = missing !== null;
      option.textContent = missing === null ? option.value : `${option.value} (under Files: ${missing})`;
      if (this.#select.value === option.value) this.solveSoon();
    }
  }

  // A method as #settings wrote it, or as it stands in a study file.
  async #openSettings(input) {
    const [file] = input.files;
    if (!file) return;
    try {
      const { factors, label, training, ...spec } = JSON.parse(await file.text());
      if (!this.#page.methods.some(({ name }) => name === spec.method)) {
        throw new Error(`method ${JSON.stringify(spec.method)}: there is none of that name; open a file that a panel saved`);
      }
      this.choose(spec.method);
      this.#controls();
      const byName = JSON.stringify([spec.locked, spec.bounds, spec.importance]);
      this.#parameters.take(byName.includes("*") ? await callWorker("namedMethod", JSON.stringify(spec)) : spec);
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
    if (!this.facts) throw new Error(`method ${this.#slot.toUpperCase()}: nothing is solved; correct its parameters first`);
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
    return this.#needs(this.#select.value) === "weights";
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
    this.#veil.hidden = this.facts !== null;
    this.#veil.textContent = "Solving";
    try {
      const started = performance.now();
      const facts = await callWorker("solve", this.#slot, JSON.stringify(this.#parameters.spec()));
      const took = performance.now() - started;
      if (facts.problems) {
        const words = facts.problems.map(({ place, text }) => `${place}: ${text}`).join("\n");
        throw Object.assign(new Error(words), { problems: facts.problems });
      }
      if (run !== this.#run) return;
      const [weights, pack] = await Promise.all([callWorker("weights", this.#slot), callWorker("slotPack", this.#slot)]);
      if (run !== this.#run) return;
      this.#generation += facts.own_avatar || this.#lastOwn ? 1 : 0;
      this.#lastOwn = facts.own_avatar;
      const avatarHash = `${this.#page.avatarKey()}-${facts.own_avatar ? `${this.#slot}${this.#generation}` : "bank"}`;
      await putClip({
        clip: this.#clipId(), avatarHash, avatarPack: pack, weights,
        frames: facts.frames, shapes: facts.shapes.length, rate_hz: facts.rate_hz,
      });
      if (run !== this.#run) return;
      this.facts = facts;
      this.#parameters.problems([]);
      this.#parameters.solved(facts);
      this.#saveSettings.disabled = false;
      this.#opening ??= openStage(this.#canvas, LOOK);
      this.#stage = await this.#opening;
      this.#canvas.setAttribute("aria-label", `Animated face, method ${this.#select.value}`);
      this.turn();
      this.#describe(facts, took);
      this.#veil.hidden = true;
      this.#page.changed(this);
      this.#page.player.draw();
    } catch (error) {
      if (run !== this.#run) return;
      this.facts = null;
      this.#saveSettings.disabled = true;
      this.#parameters.problems(error.problems ?? []);
      this.#veil.hidden = false;
      this.#veil.textContent = String(error.message ?? error);
      this.#facts.replaceChildren();
      this.#notices.replaceChildren();
      this.#page.changed(this);
    }
  }

  #lastOwn = false;

  turn() {
    const [yaw, pitch] = document.getElementById("view").value.split(",").map(Number);
    this.#stage?.setView({ yaw, pitch });
  }

  draw(timeMs) {
    if (!this.facts || !this.#stage) return true;
    try {
      const drawn = this.#stage.drawNow(this.#clipId(), timeMs);
      this.drawn += drawn;
      this.#drawOver(timeMs);
      return drawn;
    } catch (error) {
      this.#stage.reopen().then(() => this.#page.player.draw(), this.#page.report);
      return true;
    }
  }

  frameAt(timeMs) {
    const { frames, rate_hz } = this.facts;
    return Math.min(Math.max(Math.round((timeMs * rate_hz) / 1000), 0), frames - 1);
  }

  // What lies over the picture comes from the worker: the newest wish, one at a time.
  #drawOver(timeMs) {
    const frame = this.frameAt(timeMs);
    const markers = this.#page.showMarkers() && this.facts.markers.length > 0;
    this.#overlay.hidden = !markers;
    if (markers && !this.#matchBusy) {
      this.#matchBusy = true;
      const camera = this.#stage.camera(this.#clipId());
      callWorker("markerFrame", this.#slot, frame)
        .then((points) => drawMatch(this.#overlay, camera, points), () => {})
        .finally(() => (this.#matchBusy = false));
    }
    const first = this.#page.first();
    const heat = Boolean(this.#compare?.checked && first?.facts);
    this.#heat.hidden = !heat;
    if (heat && !this.#heatBusy) {
      this.#heatBusy = true;
      this.#paintHeat(first.slot, frame).catch(this.#page.report).finally(() => (this.#heatBusy = false));
    }
  }

  async #paintHeat(first, frame) {
    const size = 480;
    const camera = this.#stage.camera(this.#clipId());
    const [rgba, { rms_mm, worst_mm }] = await Promise.all([
      callWorker("heatMap", this.#slot, first, frame, camera, size, size, Number(this.#scale.value) || 1),
      callWorker("difference", this.#slot, first, frame),
    ]);
    this.#heat.width = this.#heat.height = size;
    this.#heat.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(rgba), size, size), 0, 0);
    const words = `${rms_mm.toFixed(2)} mm rms, ${worst_mm.toFixed(2)} mm worst`;
    this.#heat.setAttribute("aria-label", `Difference from A: ${words}`);
    this.#row("Difference from A", words);
  }

  #describe(facts, took) {
    this.#facts.replaceChildren();
    const { summary } = facts;
    this.#row("Frames", `${facts.frames} at ${Number(facts.rate_hz.toFixed(2))} Hz, in ${took.toFixed(0)} ms`);
    if (summary) {
      this.#row("Residual", `${summary.residual_rms_mm.toFixed(2)} mm rms, ${summary.residual_worst_mm.toFixed(2)} mm worst`);
      this.#row("Iterations", `${summary.iterations_mean.toFixed(1)} per frame, KKT error ${summary.kkt_worst.toExponential(1)}`);
    }
    if (facts.head_lowpass_hz !== undefined) {
      this.#row("Head low-pass", facts.head_lowpass_hz === null ? "none" : `${facts.head_lowpass_hz} Hz`);
    }
    if (facts.gaze && !(facts.gaze_at_rest?.length > 0)) this.#row("Gaze", facts.gaze);
    if (facts.gaze_at_rest?.length > 0) this.#row("Gaze", `at rest: none is given (${facts.gaze_at_rest.length} shapes at 0)`);
    const held = (facts.shapes_told ?? []).filter(({ state }) => state === "held").map(({ shape }) => shape);
    if (held.length > 0) this.#row("Held at 0", held.join(", "));
    this.#row("Weights", facts.weights_hash.slice(0, 16));
    this.#notices.replaceChildren(...facts.warnings.map((text) => made("p", { className: "notice warn" }, text)));
  }

  #row(name, value) {
    const known = [...this.#facts.children].find((row) => row.firstChild.textContent === name);
    const row = made("div", {}, made("dt", {}, name), made("dd", { className: "number" }, value));
    if (known) known.replaceWith(row);
    else this.#facts.append(row);
  }

  /// Draws a frame for certain, for exports.
  async show(timeMs) {
    await this.#stage.show(this.#clipId(), timeMs);
  }

  close() {
    clearTimeout(this.#timer);
    this.#run += 1;
    this.#opening?.then((stage) => stage.close(), () => {});
    this.#element.remove();
    callWorker("forget", this.#slot);
  }
}
