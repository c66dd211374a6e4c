// What `regression` learns from: a capture and the weights that were played in it.
import { takeName } from "./built-in.js";
import { say } from "./texts.js";
import { problemWords } from "./words-engine.js";
import { callWorker } from "./worker-calls.js";

const $ = (id) => document.getElementById(id);
const bytes = async (file) => new Uint8Array(await file.arrayBuffer());

export class TrainingFiles {
  #page;
  // The neutral frames as they are, [first, end]; null without a capture.
  #neutral = null;
  /// The files that were opened: {training, "training-weights"}.
  files = {};

  /// `page`: {history, busy(words, work), captureOptions() -> [unit, rate], trainingChanged(state), report(error)}
  constructor(page) {
    this.#page = page;
    this.#file("training-file", "training", async (file) => callWorker("trainingTake", file.name, await bytes(file), ...page.captureOptions()));
    this.#file("training-weights-file", "training-weights", async (file) => callWorker("trainingWeights", file.name, await bytes(file)));
    $("training-built-in").addEventListener("click", () => {
      page.history.forget("training");
      this.#put(say("training.playing"), () => callWorker("builtInTraining", 1));
    });
    for (const id of ["training-first", "training-end"]) {
      $(id).addEventListener("change", () => {
        const [before, after] = [this.#neutral, [Number($("training-first").value), Number($("training-end").value)]];
        const put = (ends) => this.#put(say("training.setting"), () => callWorker("setTrainingNeutral", ...ends));
        put(after).then((state) => {
          if (state && before) page.history.put({ what: say("training.first"), about: "training", undo: () => put(before), redo: () => put(after) });
        });
      });
    }
  }

  #file(id, what, read) {
    $(id).addEventListener("change", async ({ target }) => {
      const [file] = target.files;
      this.#page.history.forget("training");
      if (file && (await this.#put(say("files.reading", { name: file.name }), () => read(file)))) this.files[what] = file;
      target.value = "";
    });
  }

  async #put(words, work) {
    const state = await this.#page.busy(words, work);
    if (!state) return null;
    const { take, weights, neutral, missing } = state;
    const facts = [];
    if (take) facts.push(say("training.take", { ...take, file: takeName(take), rate: take.rate_hz }));
    if (weights) facts.push(say("training.weights-facts", { ...weights, file: take?.builtIn ? takeName(take) : weights.file }));
    if (missing !== null) facts.push(problemWords(missing));
    $("training-facts").textContent = facts.join("; ");
    $("training-neutral").hidden = neutral === null;
    [$("training-first").value, $("training-end").value] = neutral ?? ["", ""];
    this.#neutral = neutral;
    this.#page.trainingChanged(state);
    return state;
  }
}
