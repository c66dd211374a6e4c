// What the studio works on: avatar, capture, marker map; opened, dropped, built in, or given by the command line.
import { avatarName, takeName } from "./built-in.js";
import { save } from "./export.js";
import { numeral, say } from "./texts.js";
import { callWorker } from "./worker-calls.js";

const $ = (id) => document.getElementById(id);

export class Sources {
  #page;
  #avatars = 0;
  #map = null;
  /// Facts of the avatar and of the take, null until they are there.
  avatar = null;
  take = null;
  /// The files that they were opened from: {avatar, settings, take}.
  files = {};

  /// `page`: {history, busy(words, work), report(error), changed() (another avatar or take), takeChanged(frames, rate), mapRead(state),
  /// mapChanged(state), mapPut(), gaze, training}
  constructor(page) {
    this.#page = page;
    const files = (id, as) =>
      $(id).addEventListener("change", async ({ target }) => {
        const chosen = [...target.files];
        target.value = "";
        await this.open(chosen, as).catch(page.report);
      });
    files("avatar-file", "avatar");
    files("take-file", "take");
    files("map-file", "map");
    files("start-files");
    const on = (id, act) => $(id).addEventListener("click", () => act().catch(page.report));
    on("avatar-built-in", () => this.builtInAvatar());
    on("take-built-in", () => this.builtInTake());
    on("start-built-in", () => this.builtIn());
    on("map-suggest", () => this.suggest());
    on("map-save", async () => save("markers.json", await callWorker("mapJson")));
    const main = document.querySelector("main");
    addEventListener("dragover", (event) => (event.preventDefault(), main.classList.add("dropping")));
    addEventListener("dragleave", (event) => event.relatedTarget === null && main.classList.remove("dropping"));
    addEventListener("drop", (event) => {
      event.preventDefault();
      main.classList.remove("dropping");
      this.open([...event.dataTransfer.files]).catch(page.report);
    });
    this.#brief();
  }

  /// Tells one avatar from the one before; null while there is none.
  get avatarKey() {
    return this.avatar ? `studio-avatar-${this.#avatars}` : null;
  }

  get map() {
    return this.#map;
  }

  /// The map as it is now.
  putMap(state) {
    this.#map = state;
    this.#mapFacts();
  }

  async builtIn() {
    if (!this.avatar) await this.builtInAvatar();
    await this.builtInTake();
  }

  async builtInAvatar() {
    this.files.avatar = this.files.settings = undefined;
    await this.#avatarHere(await this.#page.busy(say("built-in.building"), () => callWorker("builtInAvatar", 1, 10_000)));
  }

  async builtInTake() {
    this.files.take = undefined;
    await this.#takeHere(await this.#page.busy(say("built-in.playing"), () => callWorker("builtInTake", 1)));
  }

  /// Files by what they are: .json beside an avatar is its settings, else a map.
  async open(files, as) {
    const bytes = async (file) => new Uint8Array(await file.arrayBuffer());
    const named = (pattern) => files.find((file) => pattern.test(file.name));
    const reading = (file, work) => this.#page.busy(say("files.reading", { name: file.name }), work);
    const settings = named(/\.avatar\.json$/i);
    const avatar = as === "avatar" ? files.find((file) => file !== settings) : named(/\.(glb|gltf|zip|tar|gz|xz)$/i);
    if (avatar) {
      const facts = await reading(avatar, async () => callWorker("avatarFile", avatar.name, await bytes(avatar), await settings?.text()));
      if (facts) Object.assign(this.files, { avatar, settings });
      await this.#avatarHere(facts);
    }
    const rest = files.filter((file) => file !== avatar && file !== settings);
    for (const file of rest) {
      const isMap = as === "map" || (as !== "take" && (/\.json$/i.test(file.name) || (/\.csv$/i.test(file.name) && (await file.slice(0, 40).text()).startsWith("marker,role"))));
      if (isMap) await this.#openMap(file);
      else if (/\.eaf$/i.test(file.name)) this.#page.report(new Error(say("files.eaf", { name: file.name })));
      else {
        const facts = await reading(file, async () => callWorker("takeFile", file.name, await bytes(file), ...this.captureOptions()));
        if (facts) this.files.take = file;
        await this.#takeHere(facts);
      }
    }
  }

  captureOptions() {
    return [$("take-unit").value || undefined, Number($("take-rate").value) || undefined];
  }

  async #openMap(file) {
    await this.#replaced(file.name, async () => {
      const state = await this.#page.busy(say("files.reading", { name: file.name }), async () => callWorker("mapFile", file.name, await file.text()));
      if (state) this.#page.mapPut(state);
      return state;
    });
  }

  // Another map in the place of the one that is there: a step that can be taken back.
  async #replaced(what, work) {
    const before = this.#placed() > 0 ? await callWorker("mapJson") : null;
    const state = await work();
    if (!state) return;
    this.#page.mapChanged(state);
    if (before === null) return;
    const after = await callWorker("mapJson");
    const put = async (text) => {
      const own = await callWorker("mapFile", "markers.json", text);
      this.#page.mapPut(own);
      this.#page.mapChanged(own);
    };
    this.#page.history.put({ what, about: "map", undo: () => put(before), redo: () => put(after) });
  }

  #placed() {
    return (this.#map?.markers ?? []).filter(({ vertex }) => vertex !== null).length;
  }

  /// Asks where the markers probably sit.
  async suggest() {
    await this.#replaced(say("command.suggest-map"), () => this.#suggested());
  }

  async #suggested() {
    const state = await this.#page.busy(say("map.looking"), () => callWorker("suggestMap"));
    if (!state) return null;
    this.#page.mapPut(state);
    this.putMap(state);
    return state;
  }

  async #avatarHere(facts) {
    if (!facts) return;
    this.avatar = facts;
    this.#avatars += 1;
    const notes = facts.notes.map((note) => `; ${note}`).join("");
    $("avatar-facts").textContent = say("avatar.facts", { file: avatarName(facts), vertices: facts.vertices, shapes: facts.shapes.length, notes });
    await this.#here();
  }

  async #takeHere(facts) {
    if (!facts) return;
    this.take = facts;
    if (facts.kind === "weights") {
      $("take-facts").textContent = say("capture.weights", { file: facts.file, frames: facts.frames, columns: facts.columns.length });
      await this.#page.takeChanged(facts.frames, facts.rate_hz ?? 1);
    } else {
      const { frames, rate_hz: rate, duration_s: seconds, markers, system, warnings, notes } = facts.facts;
      const words = [say("capture.markers", { file: takeName(facts), markers, frames, rate, seconds: numeral(seconds, 1) })];
      if (system) words.push(system);
      $("take-facts").textContent = [...words, ...notes, ...warnings].join("; ");
      await this.#page.takeChanged(frames, rate);
    }
    await this.#here();
  }

  // The map as the worker has it, a suggestion where there is none; then all that follows. Once everything is there the
  // files fold into one row.
  async #here() {
    this.#page.history.forget("map");
    if (this.avatar && this.take?.kind === "markers") {
      this.#map = await callWorker("mapState");
      if (this.#map.markers.every(({ vertex }) => vertex === null)) await this.#suggested();
      this.#page.mapPut(this.#map);
    } else this.#map = null;
    this.#mapFacts();
    this.#brief();
    if (this.avatar && this.take) $("sources").open = false;
    await this.#page.changed();
  }

  #brief() {
    const next = this.avatar ? (this.take ? null : "files.next-capture") : this.take ? "files.next-avatar" : "files.next-both";
    $("next").hidden = next === null;
    if (next) $("next").textContent = say(next);
    $("files-brief").textContent = [this.avatar && avatarName(this.avatar), this.take && takeName(this.take)].filter(Boolean).join(", ");
    $("start").hidden = Boolean(this.avatar && this.take);
  }

  #mapFacts() {
    const { markers = [], absent = [], suggestion } = this.#map ?? {};
    const placed = markers.filter(({ vertex }) => vertex !== null).length;
    const words = [say("map.facts", { placed, heads: markers.filter(({ head }) => head).length })];
    if (absent.length > 0) words.push(say("map.absent", { labels: absent.join(", ") }));
    if (suggestion) words.push(say("map.suggested", { mm: numeral(suggestion.distance_rms_mm, 1) }), ...suggestion.notes);
    $("map-facts").textContent = placed === 0 ? say("none") : words.join("; ");
    $("map-save").disabled = placed === 0;
  }

  /// What `mimique preview` was given.
  async given() {
    const names = JSON.parse(document.body.dataset.files || "{}");
    const file = async (role) => {
      if (!names[role]) return null;
      const answer = await fetch(`/studio/files/${role}`);
      if (!answer.ok) throw new Error(say("files.unserved", { name: names[role], status: answer.status }));
      return new File([await answer.blob()], names[role]);
    };
    const [avatar, settings, take, map] = await Promise.all(["avatar", "settings", "take", "map"].map(file));
    if (avatar) await this.open([avatar, settings].filter(Boolean), "avatar");
    if (take && !avatar) await this.builtInAvatar();
    if (take) await this.open([take], "take");
    if (map) await this.#openMap(map);
  }
}
