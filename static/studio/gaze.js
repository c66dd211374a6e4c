// Where the eyes look in every panel: at rest, held, at a marker, or as a file tells.
import { say } from "./texts.js";
import { callWorker } from "./worker-calls.js";

const $ = (id) => document.getElementById(id);
const ANGLES = ["gaze-azimuth", "gaze-elevation", "gaze-vergence"];

export class GivenGaze {
  #page;
  #kind = "rest";
  // How the eyes were set last, to be taken back.
  #known = null;
  // What the file holds that the eyes follow: {name, bytes}.
  #file = null;

  /// Where the eyes look, as a study file has it; null while they rest.
  ofStudy() {
    const { kind, angles, marker, file } = this.#known;
    if (kind === "held") return { held: Object.fromEntries(ANGLES.map((id, i) => [id.replace("gaze-", ""), Number(angles[i])])) };
    if (kind === "marker" && marker !== "") return { target: marker };
    return kind === "file" && file ? { file: file.name } : null;
  }

  /// The file that the eyes follow, if they do.
  get file() {
    return this.#file && new File([this.#file.bytes], this.#file.name);
  }

  /// `page`: {history, busy(words, work), gazeChanged()}
  constructor(page) {
    this.#page = page;
    this.#known = this.#state();
    $("gaze-kind").addEventListener("change", ({ target }) => this.#edited(this.#choose(target.value)));
    for (const id of ANGLES) $(id).addEventListener("change", () => this.#edited(this.#hold()));
    $("gaze-marker").addEventListener("change", ({ target }) => this.#edited(this.#put(() => callWorker("gazeAtMarker", target.value))));
    $("gaze-file").addEventListener("change", async ({ target }) => {
      const [file] = target.files;
      if (file) {
        const own = { name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) };
        await this.#edited(this.#follow(own));
      }
      target.value = "";
    });
  }

  async #follow(file) {
    if (!(await this.#put(() => callWorker("gazeFile", file.name, file.bytes)))) return false;
    this.#file = file;
    $("gaze-facts").textContent = file.name;
    return true;
  }

  #state() {
    return { kind: $("gaze-kind").value, angles: ANGLES.map((id) => $(id).value), marker: $("gaze-marker").value, file: this.#file };
  }

  // A person has set the eyes; a setting that was refused is no step.
  async #edited(done) {
    if (!(await done)) return;
    const [before, after] = [this.#known, this.#state()];
    this.#known = after;
    this.#page.history.put({ what: say("gaze"), about: "gaze", undo: () => this.#restore(before), redo: () => this.#restore(after) });
  }

  async #restore(state) {
    ANGLES.forEach((id, i) => ($(id).value = state.angles[i]));
    await this.#choose(state.kind);
    if (state.kind === "marker" && state.marker !== "") {
      await this.#put(() => callWorker("gazeAtMarker", state.marker));
      $("gaze-marker").value = state.marker;
    }
    if (state.kind === "file" && state.file) await this.#follow(state.file);
    this.#known = state;
  }

  /// Another capture has other markers, and its eyes rest.
  async takeChanged() {
    this.#page.history.forget("gaze");
    await this.#choose("rest");
    this.#known = this.#state();
  }

  #choose(kind) {
    this.#kind = kind;
    this.#file = null;
    $("gaze-kind").value = kind;
    $("gaze-held").hidden = kind !== "held";
    $("gaze-at").hidden = kind !== "marker";
    $("gaze-from").hidden = kind !== "file";
    $("gaze-facts").textContent = "";
    if (kind === "held") return this.#hold();
    // A marker or a file is still to be chosen: until then the eyes rest.
    return this.#put(() => callWorker("restGaze"));
  }

  #hold() {
    return this.#put(() => callWorker("holdGaze", ...ANGLES.map((id) => Number($(id).value))));
  }

  async #put(work) {
    const state = await this.#page.busy(say("eyes.turning"), work);
    if (!state) return false;
    const chosen = $("gaze-marker").value;
    $("gaze-marker").replaceChildren(new Option(say("gaze.choose"), ""), ...state.markers.map((label) => new Option(label)));
    $("gaze-marker").value = state.kind === "marker" && this.#kind === "marker" ? chosen : "";
    this.#page.gazeChanged();
    return true;
  }
}
