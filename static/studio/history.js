// What was done, so that it can be taken back and done again: one list of steps for the whole window.

/// Changes of one thing within this time are one step: a slider that is dragged, a number that is typed.
const MERGE_MS = 1200;
const MOST = 200;

export class History {
  #done = [];
  #undone = [];
  #isWorking = false;
  #changed;

  /// `changed` hears that another step can be taken back or done again; `report(error)` that one could not be.
  constructor(changed, report) {
    [this.#changed, this.report] = [changed, report];
  }

  /// Whether a step is being taken back or done again: what changes then is no step of its own.
  get isWorking() {
    return this.#isWorking;
  }

  /// What would be taken back, and done again; null where there is nothing.
  get next() {
    return { undo: this.#done.at(-1)?.what ?? null, redo: this.#undone.at(-1)?.what ?? null };
  }

  /// Something was done. `step`: {what: words, undo(), redo(), about: whose steps these are, same: changes of the same
  /// thing have the same text here, else left out}.
  put(step) {
    if (this.#isWorking) return;
    const last = this.#done.at(-1);
    const now = performance.now();
    if (step.same !== undefined && last?.same === step.same && now - last.at < MERGE_MS) {
      Object.assign(last, { redo: step.redo, what: step.what, at: now });
    } else {
      this.#done.push({ ...step, at: now });
      if (this.#done.length > MOST) this.#done.shift();
    }
    this.#undone = [];
    this.#changed();
  }

  /// Steps that can no longer be taken back, since what they were about is gone.
  forget(about) {
    if (this.#isWorking) return;
    const others = (step) => step.about !== about;
    [this.#done, this.#undone] = [this.#done.filter(others), this.#undone.filter(others)];
    this.#changed();
  }

  undo() {
    return this.#go(this.#done, this.#undone, "undo");
  }

  redo() {
    return this.#go(this.#undone, this.#done, "redo");
  }

  async #go(from, to, way) {
    if (this.#isWorking || from.length === 0) return;
    this.#isWorking = true;
    const step = from.pop();
    try {
      await step[way]();
      to.push({ ...step, at: 0 });
    } catch (error) {
      this.report(error);
    } finally {
      this.#isWorking = false;
      this.#changed();
    }
  }
}
