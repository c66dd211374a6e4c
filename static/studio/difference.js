// How far a face is from that of another method: a heat map over it with its scale, a table of the parts of the face
// over the whole take, and the frame of the largest difference. Millimetres.
import { made } from "../stage/player.js";
import { numeral, say } from "./texts.js";
import { callWorker } from "./worker-calls.js";

const SIZE = 480;

export class Difference {
  #slot;
  #page;
  #busy = false;
  // The weights that the table is of.
  #told = "";
  #table = made("div", { className: "studio-table", tabIndex: 0, role: "region", hidden: true });
  #go = made("button", { type: "button", hidden: true }, say("difference.go"));
  #compare = made("input", { type: "checkbox" });
  #with = made("span", {});
  #scale = made("input", { type: "number", min: 0.1, step: 0.1, value: 1, ariaLabel: say("difference.scale") });
  element;

  /// `page`: {first(), panel(slot), player, seekFrame(slot, frame), report(error)}; `told(name, words)` hears what is measured.
  constructor(slot, page, told) {
    [this.#slot, this.#page, this.told] = [slot, page, told];
    this.#compare.addEventListener("change", () => (page.player.draw(), this.look()));
    this.#go.addEventListener("click", () => page.seekFrame(slot, Number(this.#go.dataset.frame)));
    this.#scale.addEventListener("change", () => page.player.draw());
    this.element = made(
      "div", { className: "studio-difference" },
      made("label", { className: "preview-check" }, this.#compare, " ", this.#with),
      made("div", { className: "studio-heat-scale" }, "0", made("i", {}), this.#scale, "mm"),
      this.#go, this.#table,
    );
  }

  /// The face that this one is held against has another name.
  rename() {
    const first = this.#page.first();
    this.element.hidden = !first || first.slot === this.#slot;
    if (first) this.#with.textContent = say("difference.from", { name: first.letter });
  }

  #isWanted() {
    const first = this.#page.first();
    return this.#compare.checked && Boolean(first?.facts) && first.slot !== this.#slot;
  }

  /// The table anew, where it is asked for and the weights are others.
  async look() {
    const [first, own] = [this.#page.first(), this.#page.panel(this.#slot)];
    const wanted = this.#isWanted() && own?.facts;
    this.#table.hidden = this.#go.hidden = !wanted;
    if (!wanted) return;
    const key = `${first.facts.weights_hash} ${own.facts.weights_hash}`;
    if (key === this.#told) return;
    this.#told = key;
    try {
      this.#fill(await callWorker("differenceOver", this.#slot, first.slot), own);
    } catch (error) {
      this.#table.hidden = this.#go.hidden = true;
      this.#page.report(error);
    }
  }

  #fill(rows, own) {
    const seconds = (frame) => numeral(frame / own.facts.rate_hz, 2);
    const head = ["difference.part", "difference.rms", "difference.largest", "difference.at"].map((key) => made("th", { scope: "col" }, say(key)));
    const body = rows.map(({ part, rmsMm, largestMm, largestFrame }) => {
      const at = made("button", { type: "button", ariaLabel: say("difference.to", { part: say(`part.${part}`), seconds: seconds(largestFrame) }) }, seconds(largestFrame));
      at.addEventListener("click", () => this.#page.seekFrame(this.#slot, largestFrame));
      const cells = [numeral(rmsMm, 2), numeral(largestMm, 2), at].map((content) => made("td", {}, content));
      return made("tr", {}, made("th", { scope: "row" }, say(`part.${part}`)), ...cells);
    });
    this.#table.setAttribute("aria-label", say("difference.table"));
    this.#table.replaceChildren(made("table", {}, made("thead", {}, made("tr", {}, ...head)), made("tbody", {}, ...body)));
    this.#go.dataset.frame = rows.at(-1).largestFrame;
  }

  /// Paints the difference in a frame over a picture; one at a time, the newest wish.
  paint(canvas, matrix, frame) {
    const first = this.#page.first();
    const isWanted = this.#isWanted();
    canvas.hidden = !isWanted;
    if (!isWanted || this.#busy) return;
    this.#busy = true;
    this.#paint(canvas, matrix(), first, frame).catch(this.#page.report).finally(() => (this.#busy = false));
  }

  async #paint(canvas, matrix, first, frame) {
    const [rgba, { rms_mm: rms, worst_mm: worst }] = await Promise.all([
      callWorker("heatMap", this.#slot, first.slot, frame, matrix, SIZE, SIZE, Number(this.#scale.value) || 1),
      callWorker("difference", this.#slot, first.slot, frame),
    ]);
    canvas.width = canvas.height = SIZE;
    canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(rgba), SIZE, SIZE), 0, 0);
    const name = say("difference.from", { name: first.letter });
    const words = say("facts.rms-worst", { rms: numeral(rms, 2), worst: numeral(worst, 2) });
    canvas.setAttribute("aria-label", `${name}: ${words}`);
    canvas.setAttribute("role", "img");
    this.told(name, words);
  }
}
