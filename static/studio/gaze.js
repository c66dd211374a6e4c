// Where the eyes look in every panel: at rest, held, at a marker, or as a file tells.
import { callWorker } from "./worker-calls.js";

const $ = (id) => document.getElementById(id);
const ANGLES = ["gaze-azimuth", "gaze-elevation", "gaze-vergence"];

export class GivenGaze {
  #page;
  #kind = "rest";

  /// `page`: {busy(words, work), gazeChanged()}
  constructor(page) {
    this.#page = page;
    $("gaze-kind").addEventListener("change", ({ target }) => this.#choose(target.value));
    for (const id of ANGLES) $(id).addEventListener("change", () => this.#hold());
    $("gaze-marker").addEventListener("change", ({ target }) => this.#put(() => callWorker("gazeAtMarker", target.value)));
    $("gaze-file").addEventListener("change", async ({ target }) => {
      const [file] = target.files;
      if (file) {
        const bytes = new Uint8Array(await file.arrayBuffer());
        if (await this.#put(() => callWorker("gazeFile", file.name, bytes))) $("gaze-facts").textContent = file.name;
      }
      target.value = "";
    });
  }

  /// Another capture has other markers, and its eyes rest.
  async takeChanged() {
    await this.#choose("rest");
  }

  #choose(kind) {
    this.#kind = kind;
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
    const state = await this.#page.busy("Turning the eyes", work);
    if (!state) return false;
    const chosen = $("gaze-marker").value;
    $("gaze-marker").replaceChildren(new Option("choose one", ""), ...state.markers.map((label) => new Option(label)));
    $("gaze-marker").value = state.kind === "marker" && this.#kind === "marker" ? chosen : "";
    this.#page.gazeChanged();
    return true;
  }
}
