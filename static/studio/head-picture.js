// The neutral head of the avatar with something drawn over it: turned, and asked for the vertex at a place.
import { openStage, putClip } from "../stage/host.js";
import { isShown, whenShown } from "./tabs.js";
import { callWorker } from "./worker-calls.js";
import { project } from "./overlay.js";

const STEP = 0.12;
/// How far a key moves a marker, CSS pixels, and how often it goes on until another vertex is met.
const NUDGE = 3;
const NUDGES = 20;

export class HeadPicture {
  #parts;
  #page;
  #stage = null;
  #view = { yaw: 0, pitch: 0 };
  #key = null;

  /// `parts`: {clip, section, canvas, overlay, view (a select of "yaw,pitch"), zoom (1 where it is left out),
  /// draw(overlay, camera), turned(view) where somebody follows};
  /// `page`: {avatarKey(), avatarShapes(), report(error)}
  constructor(parts, page) {
    [this.#parts, this.#page] = [parts, page];
    whenShown(parts.section, () => this.show().catch(page.report));
    parts.view.addEventListener("change", () => {
      const [yaw, pitch] = parts.view.value.split(",").map(Number);
      this.#turn({ yaw, pitch });
    });
    addEventListener("resize", () => this.#turn(this.#view));
  }

  #isShown() {
    return isShown(this.#parts.section);
  }

  /// The avatar as it is, once the section is shown.
  async show() {
    const { clip, canvas } = this.#parts;
    const key = this.#page.avatarKey();
    if (!this.#isShown() || key === null) return;
    if (this.#key !== key) {
      this.#key = key;
      const pack = await callWorker("avatarPack");
      const shapes = this.#page.avatarShapes();
      await putClip({ clip, avatarHash: `${key}-bank`, avatarPack: pack, weights: new Float32Array(shapes), frames: 1, shapes, rate_hz: 1 });
    }
    this.#stage ??= await openStage(canvas, { background: "#808080", width: 520, height: 520 });
    this.#turn(this.#view);
  }

  /// Turns the head by steps: [right, down].
  turnBy([right, down]) {
    const pitch = Math.min(1.2, Math.max(-1.2, this.#view.pitch - down * STEP));
    this.#turn({ yaw: this.#view.yaw + right * STEP, pitch });
  }

  #turn(view) {
    this.#view = view;
    this.#parts.turned?.(view);
    this.#stage?.setView({ ...view, zoom: this.#parts.zoom ?? 1 });
    if (!this.#isShown() || this.#key === null) return;
    this.#stage?.show(this.#parts.clip, 0).then(() => this.redraw(), this.#page.report);
  }

  /// Draws what lies over the head anew.
  redraw() {
    const camera = this.camera();
    if (camera) this.#parts.draw(this.#parts.overlay, camera);
  }

  /// The picture's camera, or null while there is no picture.
  camera() {
    return this.#stage && this.#isShown() ? this.#stage.camera(this.#parts.clip) : null;
  }

  /// Where a point (metres) is in the picture: [x, y, depth].
  placeOf(position) {
    const { width, height } = this.#parts.overlay.getBoundingClientRect();
    return project(this.camera(), position, width, height);
  }

  /// The place of an event in the picture.
  at(event) {
    const { left, top } = this.#parts.overlay.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  }

  middle() {
    const { width, height } = this.#parts.overlay.getBoundingClientRect();
    return [width / 2, height / 2];
  }

  /// The vertex at a place of the picture; undefined beside the head.
  async vertexAt([x, y]) {
    const camera = this.camera();
    if (!camera) return undefined;
    const { width, height } = this.#parts.overlay.getBoundingClientRect();
    return callWorker("pick", camera, Math.round(width), Math.round(height), x, y);
  }

  /// The next vertex that is met from a vertex and its position on a way; undefined where there is none.
  async vertexBeside({ vertex, position }, [right, down]) {
    if (!this.camera()) return undefined;
    const [x, y] = this.placeOf(position);
    for (let step = 1; step <= NUDGES; step++) {
      const met = await this.vertexAt([x + right * NUDGE * step, y + down * NUDGE * step]);
      if (met !== undefined && met !== vertex) return met;
    }
    return undefined;
  }
}

/// Ways of the arrow keys: [right, down].
export const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
