// The faces side by side: each a method on the avatar, one of them chosen, named by what differs.
import { remember, recall } from "./memory.js";
import { namesOf } from "./names.js";
import { MethodPanel } from "./panel.js";
import { say } from "./texts.js";
import { callWorker } from "./worker-calls.js";

const $ = (id) => document.getElementById(id);
const SLOTS = ["a", "b", "c", "d"];
const SECOND_METHODS = ["box", "lsts-norm", "kouadio"];

export class Faces {
  #page;
  #changed;
  #chosen = SLOTS[0];
  panels = [];
  methods = [];

  /// `page`: what panels need, and history; `changed` hears that there are others, or another one is chosen.
  constructor(page, changed) {
    [this.#page, this.#changed] = [page, changed];
    this.ready = callWorker("methods").then((all) => (this.methods = all));
  }

  at(slot) {
    return this.panels.find((panel) => panel.slot === slot);
  }

  get chosen() {
    return this.at(this.#chosen) ?? this.panels[0];
  }

  choose(slot) {
    if (!this.at(slot)) return;
    const isOther = slot !== this.#chosen || $("inspectors").querySelector("section:not([hidden])")?.dataset.slot !== slot;
    this.#chosen = slot;
    for (const panel of this.panels) panel.chosen(panel === this.chosen);
    if (isOther) this.#changed();
  }

  /// Names anew: somebody's method or parameters are others.
  rename() {
    const names = namesOf(this.panels.map((panel) => panel.named()));
    this.panels.forEach((panel, i) => panel.rename(names[i]));
  }

  canAdd() {
    return this.panels.length > 0 && this.panels.length < SLOTS.length;
  }

  /// One more face, as a person asks for it.
  add() {
    if (!this.canAdd()) return;
    const method = this.panels[0].isRecorded() ? "recorded" : (SECOND_METHODS[this.panels.length - 1] ?? "lsts");
    const { slot } = this.#add(null, method, this.panels.length);
    this.choose(slot);
    this.at(slot).solve();
    this.#page.history.put({ what: say("panel.add"), undo: () => this.#take(slot), redo: () => this.#back(slot, { method }) });
  }

  remove(slot) {
    const panel = this.at(slot);
    if (!panel || this.panels.length < 2) return;
    const [state, at] = [panel.state(), this.panels.indexOf(panel)];
    this.#take(slot);
    this.#page.history.put({ what: say("panel.remove", { letter: panel.letter }), undo: () => this.#back(slot, state, at), redo: () => this.#take(slot) });
  }

  // A face that was there comes back as it was.
  async #back(slot, state, at = this.panels.length) {
    const panel = this.#add(slot, state.method, at);
    this.choose(slot);
    await panel.restore(state);
  }

  #take(slot) {
    this.at(slot)?.close();
    this.panels = this.panels.filter((panel) => panel.slot !== slot);
    this.#placed();
    this.choose(this.chosen?.slot);
    this.keep();
    this.#changed();
  }

  #add(slot, method, at) {
    slot ??= SLOTS.find((each) => !this.at(each));
    const panel = new MethodPanel(slot, this.#page, method, slot !== SLOTS[0]);
    this.panels = this.panels.toSpliced(at, 0, panel);
    $("inspectors").append(panel.inspector);
    this.#placed();
    this.#changed();
    return panel;
  }

  #placed() {
    $("panels").replaceChildren(...this.panels.map((panel) => panel.element));
    $("panels").dataset.count = this.panels.length;
    $("add-panel").hidden = !this.canAdd();
    $("method-none").hidden = this.panels.length > 0;
    this.rename();
  }

  /// Keeps how many faces there are, and by which methods.
  keep() {
    if (this.panels.length > 0 && !this.panels[0].isRecorded()) remember("faces", this.panels.map((panel) => panel.state()));
  }

  /// An avatar and a take are there: the faces of the last visit, else one; all solved anew.
  async sourcesChanged(isRecorded) {
    await this.ready;
    if (this.panels.length === 0) {
      const usual = [{ method: isRecorded ? "recorded" : "lsts" }];
      const known = recall("faces", usual).filter(({ method }) => this.methods.some(({ name }) => name === method));
      const wanted = isRecorded || known.length === 0 ? usual : known.slice(0, SLOTS.length);
      for (const [i, state] of wanted.entries()) {
        const panel = this.#add(SLOTS[i], state.method, i);
        panel.sourcesChanged();
        panel.put(state);
      }
      this.choose(SLOTS[0]);
    }
    for (const panel of this.panels) {
      if (isRecorded !== panel.isRecorded()) panel.choose(isRecorded ? "recorded" : "lsts");
      panel.sourcesChanged();
    }
    await Promise.all(this.panels.map((panel) => panel.solve()));
  }
}
