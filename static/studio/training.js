// What `regression` learns from: a capture and the weights that were played in it.
import { callWorker } from "./worker-calls.js";

const $ = (id) => document.getElementById(id);
const bytes = async (file) => new Uint8Array(await file.arrayBuffer());

export class TrainingFiles {
  #page;

  /// `page`: {busy(words, work), captureOptions() -> [unit, rate], trainingChanged(state), report(error)}
  constructor(page) {
    this.#page = page;
    this.#file("training-file", async (file) => callWorker("trainingTake", file.name, await bytes(file), ...page.captureOptions()));
    this.#file("training-weights-file", async (file) => callWorker("trainingWeights", file.name, await bytes(file)));
    $("training-built-in").addEventListener("click", () => this.#put("Playing the range of motion", () => callWorker("builtInTraining", 1)));
    for (const id of ["training-first", "training-end"]) {
      $(id).addEventListener("change", () => {
        const [first, end] = [Number($("training-first").value), Number($("training-end").value)];
        this.#put("Setting the neutral frames", () => callWorker("setTrainingNeutral", first, end));
      });
    }
  }

  #file(id, read) {
    $(id).addEventListener("change", async ({ target }) => {
      const [file] = target.files;
      if (file) await this.#put(`Reading ${file.name}`, () => read(file));
      target.value = "";
    });
  }

  async #put(words, work) {
    const state = await this.#page.busy(words, work);
    if (!state) return;
    const { take, weights, neutral, missing } = state;
    const facts = [];
    if (take) facts.push(`${take.file}: ${take.markers} markers, ${take.frames} frames at ${take.rate_hz} Hz`);
    if (weights) facts.push(`${weights.file}: weights, ${weights.frames} frames, ${weights.columns} columns`);
    if (missing !== null) facts.push(missing);
    $("training-facts").textContent = facts.join("; ");
    $("training-neutral").hidden = neutral === null;
    [$("training-first").value, $("training-end").value] = neutral ?? ["", ""];
    this.#page.trainingChanged(state);
  }
}
