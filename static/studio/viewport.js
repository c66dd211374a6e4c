// One face: its canvas with what lies over it, in a frame that turns, moves and zooms it.
import { openStage, preparedClip, putClip } from "../stage/host.js";
import { made } from "../stage/player.js";
import { layLens } from "./camera.js";
import { say } from "./texts.js";

const LOOK = { background: "#808080", width: 640, height: 640 };

export class Viewport {
  #slot;
  #page;
  #stage = null;
  #opening = null;
  #lens;
  #name = made("strong", { className: "studio-name" });
  #veil = made("div", { className: "veil" }, say("nothing-yet"));
  #choose;
  canvas = made("canvas", { role: "img" });
  heat = made("canvas", { className: "studio-overlay", hidden: true });
  overlay = made("canvas", { className: "studio-overlay" });
  element;
  frame;
  /// Frames drawn, ever.
  drawn = 0;

  /// `page`: {camera, player, report(error), choose(slot), remove(slot)}; `removable`: whether it can be taken away.
  constructor(slot, page, removable) {
    [this.#slot, this.#page] = [slot, page];
    const letter = slot.toUpperCase();
    this.#choose = made("button", { type: "button", className: "studio-choose" }, made("span", { className: "studio-letter" }, letter), this.#name);
    this.#choose.addEventListener("click", () => page.choose(slot));
    const head = made("header", {}, this.#choose);
    if (removable) {
      const remove = made("button", { type: "button", ariaLabel: say("panel.remove", { letter }) }, "✕");
      remove.addEventListener("click", () => page.remove(slot));
      head.append(remove);
    }
    this.#lens = made("div", { className: "studio-lens" }, this.canvas, this.heat, this.overlay);
    this.frame = made("div", { className: "stage", tabIndex: 0, role: "group", ariaLabel: `${say("panel.view", { letter })}. ${say("view.orbit")}` }, this.#lens, this.#veil);
    this.element = made("section", { className: "studio-viewport", ariaLabel: say("panel.view", { letter }) }, head, this.frame);
    this.element.dataset.slot = slot;
    this.frame.addEventListener("pointerdown", () => page.choose(slot));
    page.camera.wire(this.frame, slot);
    // The picture follows the size of its frame.
    new ResizeObserver(() => page.player.playing || page.player.draw()).observe(this.frame);
  }

  get clipId() {
    return `studio-${this.#slot}`;
  }

  clip() {
    return preparedClip(this.clipId);
  }

  /// Takes a clip: `own` is {avatarHash, avatarPack, weights, frames, shapes, rate_hz}.
  async put(own) {
    await putClip({ clip: this.clipId, ...own });
    this.#opening ??= openStage(this.canvas, LOOK);
    this.#stage = await this.#opening;
    this.turn();
  }

  /// Says what is shown, on the picture and to those who hear it.
  entitle(name) {
    this.#name.textContent = name;
    this.#choose.title = name;
    this.canvas.setAttribute("aria-label", say("panel.face", { name }));
  }

  chosen(isChosen) {
    this.element.classList.toggle("chosen", isChosen);
    this.#choose.setAttribute("aria-pressed", String(isChosen));
  }

  /// Words in the place of the picture; null takes them away.
  say(words) {
    this.#veil.hidden = words === null;
    this.#veil.textContent = words ?? "";
  }

  turn() {
    const view = this.#page.camera.of(this.#slot);
    const { yaw, pitch } = view;
    this.#stage?.setView({ yaw, pitch, zoom: layLens(this.#lens, view) });
  }

  isThere() {
    return this.#stage !== null && this.frame.getClientRects().length > 0;
  }

  /// The clip-from-world matrix of the picture.
  matrix() {
    return this.#stage.camera(this.clipId);
  }

  /// The same of the portrait that is turned, but neither moved nor zoomed.
  portrait() {
    const { yaw, pitch } = this.#page.camera.of(this.#slot);
    layLens(this.#lens, { zoom: 1, x: 0, y: 0 });
    this.#stage.setView({ yaw, pitch, zoom: 1 });
    const matrix = this.matrix();
    this.turn();
    return matrix;
  }

  /// Whether the frame of a time was drawn.
  draw(timeMs) {
    try {
      const drawn = this.#stage.drawNow(this.clipId, timeMs);
      this.drawn += drawn;
      return drawn;
    } catch {
      this.#stage.reopen().then(() => this.#page.player.draw(), this.#page.report);
      return null;
    }
  }

  close() {
    this.#opening?.then((stage) => stage.close(), () => {});
    this.element.remove();
  }
}
