// A face that shows what the body does: inputs, the face, the body beside it, courses below; live.
import { openStage, preparedClip, putClip } from "../stage/host.js";
import { made } from "../stage/player.js";
import { ExertionPictures } from "../drawing/exertion.js";
import { ExertionSettings } from "./exertion-settings.js";
import { newest } from "./newest.js";
import { isShown, whenShown } from "./tabs.js";
import { numeral, say } from "./texts.js";
import { findingWords, warningWords } from "./words-engine.js";
import { callWorker } from "./worker-calls.js";

const $ = (id) => document.getElementById(id);
const LOOK = { background: "#808080", width: 480, height: 480 };
const SLOT = "exertion";
const CLIP = "studio-exertion";

/// One of the player's panels.
export class Exertion {
  #page;
  #settings;
  #pictures;
  #canvas = $("exertion-canvas");
  #veil = $("exertion-veil");
  #opening = null;
  #stage = null;
  #drawing = null;
  #pack = { key: null, bytes: null };
  #computed = newest(() => this.#compute());
  // The inputs as they were changed last.
  #known;
  facts = null;
  drawn = 0;
  slot = SLOT;

  /// `page`: {player, camera, tabs, history, avatarKey(), takeIsMotion(), captureOptions(), save(name, text), changed(), report(error)}
  constructor(page) {
    this.#page = page;
    this.#settings = new ExertionSettings($("exertion-settings"), (name) => this.#set(name), (kind, file) => this.#open(kind, file).catch(page.report));
    this.#known = this.#settings.state();
    this.#pictures = new ExertionPictures((window) => {
      this.#settings.window(window);
      this.#edited("window");
      this.update();
    });
    $("exertion-body").append(this.#pictures.body);
    $("exertion-courses").append(this.#pictures.courses, this.#pictures.clip);
    whenShown("exertion", () => this.sourcesChanged());
    const on = (id, act) => $(id).addEventListener("click", () => act().catch(page.report));
    const name = () => `exertion-${this.#settings.value("source")}`;
    on("exertion-weights", async () => page.save(`${name()}-weights.csv`, await callWorker("exertionWeightsCsv")));
    on("exertion-series", async () => page.save(`${name()}-series.csv`, await callWorker("exertionSeriesCsv")));
    on("exertion-plot", async () => page.save(`${name()}.svg`, await callWorker("exertionPlot")));
    on("exertion-study", async () => page.save(`${name()}-study.json`, await callWorker("exertionStudy")));
    on("exertion-copy", async () => {
      await navigator.clipboard.writeText(await callWorker("exertionStudy"));
      $("exertion-copied").textContent = say("exertion.copied");
    });
  }

  get clipId() {
    return CLIP;
  }

  title() {
    return say("exertion");
  }

  clip() {
    if (this.facts) return preparedClip(CLIP);
    if (!this.#drawing) return null;
    const [from, to] = this.#drawing.windowS;
    return { duration_ms: 1000 * (to - from), rate_hz: 60 };
  }

  frameAt(timeMs) {
    const { frames, rate_hz } = this.facts;
    return Math.min(Math.max(Math.round((timeMs * rate_hz) / 1000), 0), frames - 1);
  }

  turn() {
    const { yaw, pitch, zoom } = this.#page.camera.of(SLOT);
    this.#stage?.setView({ yaw, pitch, zoom });
  }

  draw(timeMs) {
    if (!isShown("exertion")) return true;
    this.#pictures.at(timeMs);
    if (!this.facts || !this.#stage) return true;
    try {
      const drawn = this.#stage.drawNow(CLIP, timeMs);
      this.drawn += drawn;
      return drawn;
    } catch {
      this.#stage.reopen().then(() => this.#page.player.draw(), this.#page.report);
      return true;
    }
  }

  /// Another avatar or capture, or the section was opened.
  sourcesChanged() {
    const can = this.#page.takeIsMotion();
    this.#settings.choice("source", "take", can);
    if (!can && this.#settings.value("source") === "take") this.#settings.choose("source", "run");
    return this.update();
  }

  /// Computes and shows; of what is set meanwhile the last counts.
  async update() {
    if (!isShown("exertion")) return;
    await this.#computed().catch((error) => this.#page.report(error));
  }

  // A motion goes on for minutes, a recording as long as it is.
  #set(name) {
    if (name === "source" && this.#settings.value("source") !== "file") this.#settings.usual();
    if (name === "source") this.#heartOf(false);
    this.#edited(name);
    this.update();
  }

  // A person has changed an input: a step that can be taken back.
  #edited(name) {
    const [before, after] = [this.#known, this.#settings.state()];
    this.#known = after;
    const put = async (state) => {
      this.#settings.putState(state);
      this.#known = state;
      this.#page.tabs.show("exertion");
      await this.update();
    };
    this.#page.history.put({ what: say("exertion"), same: `exertion ${name}`, undo: () => put(before), redo: () => put(after) });
  }

  #heartOf(recorded) {
    this.#settings.choice("heart", "recorded", recorded);
    if (!recorded && this.#settings.value("heart") === "recorded") this.#settings.choose("heart", "thesis");
    if (recorded) this.#settings.choose("heart", "recorded");
  }

  async #open(kind, file) {
    if (kind === "model") {
      await callWorker("exertionModel", file.name, await file.text());
      this.#settings.choice("model", "file", true, file.name);
      this.#settings.choose("model", "file");
      return this.update();
    }
    const bytes = new Uint8Array(await file.arrayBuffer());
    const { isActivity, hasHeart, spanS } = await callWorker("exertionFile", file.name, bytes, ...this.#page.captureOptions());
    this.#settings.choice("source", "file", true, file.name);
    this.#settings.choose("source", "file");
    if (isActivity) this.#settings.last(spanS);
    else this.#settings.usual();
    this.#heartOf(hasHeart);
    return this.update();
  }

  async #compute() {
    const started = performance.now();
    const told = await callWorker("exertion", JSON.stringify(this.#settings.read()));
    this.#settings.say(told.problem ?? null);
    for (const button of $("exertion-save").querySelectorAll("button")) button.disabled = Boolean(told.problem);
    $("exertion-copied").textContent = "";
    if (told.problem) {
      this.facts = null;
      this.#veil.textContent = told.problem.text;
      this.#veil.hidden = false;
      $("exertion-notes").replaceChildren();
      return this.#page.changed();
    }
    this.#drawing = told.drawing;
    this.#pictures.put(told.drawing);
    if (told.face) await this.#face(told.face);
    else {
      this.facts = null;
      this.#veil.textContent = say("exertion.no-avatar");
      this.#veil.hidden = false;
    }
    this.#page.changed();
    this.#page.player.seek(this.#page.player.timeMs);
    this.#tell(told, performance.now() - started);
  }

  async #face(face) {
    const key = this.#page.avatarKey();
    if (this.#pack.key !== key) this.#pack = { key, bytes: await callWorker("slotPack", SLOT) };
    const weights = await callWorker("weights", SLOT);
    await putClip({
      clip: CLIP, avatarHash: `${key}-bank`, avatarPack: this.#pack.bytes, weights,
      frames: face.frames, shapes: face.shapes.length, rate_hz: face.rate_hz,
    });
    this.#opening ??= openStage(this.#canvas, LOOK);
    this.#stage = await this.#opening;
    this.facts = face;
    this.turn();
        this.#veil.hidden = true;
  }

  #tell({ name, person, end, warnings, notes, remarks, face }, took) {
    const [open, stretched, eyes, brows] = end.curves.map((curve) => curve.toFixed(0));
    const rows = [
      [say("body.person"), say("body.facts-person", { rest: person.heartRest.toFixed(0), most: person.heartMost.toFixed(0), vo2: numeral(person.vo2Max, 1) })],
      [say("body.after", end), say("body.facts-heart", { rate: end.heartRate.toFixed(0), share: (100 * end.rcn).toFixed(0), breaths: end.breaths.toFixed(0) })],
      ["", say("body.facts-epoc", { epoc: numeral(end.epoc, 1), borg: numeral(end.borg, 1) })],
      [say("body.face"), say("body.facts-face", { open, stretched, eyes, brows })],
      [say("body.computed"), say("body.computed-of", { name, ms: took.toFixed(0) })],
    ];
    $("exertion-facts").replaceChildren(...rows.map(([term, words]) => made("div", {}, made("dt", {}, term), made("dd", { className: "number" }, words))));
    const said = (className) => (text) => made("p", { className }, text);
    const all = [...warnings.map(findingWords).map(said("notice warn")), ...[...notes, ...remarks.map(findingWords), ...(face?.warnings ?? []).map(warningWords)].map(said("soft"))];
    // What is the same is not said anew to those who hear the page.
    const text = all.map((line) => line.textContent).join("\n");
    if ($("exertion-notes").dataset.text === text && $("exertion-notes").childElementCount > 0) return;
    $("exertion-notes").dataset.text = text;
    $("exertion-notes").replaceChildren(...all);
  }
}
