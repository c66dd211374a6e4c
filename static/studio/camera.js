// Where the faces are seen from: turned, moved and zoomed by mouse, fingers and keys, all of them together or
// each for itself. A move is made by the lens: a canvas that is larger than what is seen of it, so that the
// renderer need not know of it.
import { recall, remember } from "./memory.js";

const FRONT = { yaw: 0, pitch: 0, zoom: 1, x: 0, y: 0 };
/// Radians per width of the picture that is dragged over, and per key.
const TURN = 3.2;
const KEY_TURN = 0.12;
const KEY_MOVE = 0.05;
const KEY_ZOOM = 1.15;
const MOST_PITCH = 1.5;
const ZOOMS = [0.3, 8];
/// How far the picture may be moved, in its own widths and heights.
const FARTHEST = 0.75;

const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

/// Lays a lens (the element that canvases lie in) for a view; answers the zoom that its canvas is drawn with.
export function layLens(lens, { zoom, x, y }) {
  const large = 1 + 2 * Math.max(Math.abs(x), Math.abs(y));
  const percent = (value) => `${(100 * value).toFixed(3)}%`;
  Object.assign(lens.style, { width: percent(large), height: percent(large), left: percent(x - (large - 1) / 2), top: percent(y - (large - 1) / 2) });
  return zoom / large;
}

export class Camera {
  #shared = { ...FRONT, ...recall("camera", {}) };
  #own = new Map();
  #linked = recall("linked", true);
  #changed;

  /// `changed(slot)` hears that faces are seen from elsewhere: one of them, or all (null).
  constructor(changed) {
    this.#changed = changed;
  }

  get linked() {
    return this.#linked;
  }

  /// Whether all faces are seen from the same place; from then on each begins where it is.
  link(linked, slots, chosen) {
    if (linked && this.#own.has(chosen)) this.#shared = { ...this.#own.get(chosen) };
    this.#own = new Map(linked ? [] : slots.map((slot) => [slot, { ...this.#shared }]));
    this.#linked = linked;
    remember("linked", linked);
    this.#changed(null);
  }

  /// The view of a face: {yaw, pitch, zoom, x, y}.
  of(slot) {
    return this.#own.get(slot) ?? this.#shared;
  }

  /// Sees a face, or all, from elsewhere.
  set(slot, change) {
    const view = { ...this.of(slot), ...change };
    view.pitch = clamp(view.pitch, -MOST_PITCH, MOST_PITCH);
    view.zoom = clamp(view.zoom, ...ZOOMS);
    view.x = clamp(view.x, -FARTHEST, FARTHEST);
    view.y = clamp(view.y, -FARTHEST, FARTHEST);
    if (this.#linked) this.#shared = view;
    else this.#own.set(slot, view);
    if (this.#linked) remember("camera", view);
    this.#changed(this.#linked ? null : slot);
  }

  reset(slot) {
    this.set(slot, FRONT);
  }

  turn(slot, right, down) {
    const { yaw, pitch } = this.of(slot);
    this.set(slot, { yaw: yaw - right * TURN, pitch: pitch + down * TURN });
  }

  move(slot, right, down) {
    const { x, y } = this.of(slot);
    this.set(slot, { x: x + right, y: y + down });
  }

  // What is under the pointer stays there: `x`, `y` from the middle, in widths and heights.
  #zoom(slot, by, x = 0, y = 0) {
    const view = this.of(slot);
    const zoom = clamp(view.zoom * by, ...ZOOMS);
    const part = zoom / view.zoom;
    this.set(slot, { zoom, x: x + (view.x - x) * part, y: y + (view.y - y) * part });
  }

  /// Lets the frame of a face be dragged, pinched, turned by the wheel and moved by keys.
  wire(frame, slot) {
    const pointers = new Map();
    const place = ({ clientX, clientY }) => {
      const { left, top, width, height } = frame.getBoundingClientRect();
      return [(clientX - left) / width - 0.5, (clientY - top) / height - 0.5];
    };
    frame.addEventListener("pointerdown", (event) => {
      if (event.target.closest("button")) return;
      frame.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, place(event));
    });
    frame.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
      const now = place(event);
      const [right, down] = [now[0] - before[0], now[1] - before[1]];
      const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
      pointers.set(event.pointerId, now);
      if (other) {
        const apart = ([x, y]) => Math.hypot(x - other[0], y - other[1]);
        this.move(slot, right / 2, down / 2);
        this.#zoom(slot, apart(now) / Math.max(apart(before), 1e-3), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
      } else if (event.shiftKey || event.buttons & 6) this.move(slot, right, down);
      else this.turn(slot, right, down);
    });
    for (const end of ["pointerup", "pointercancel"]) frame.addEventListener(end, ({ pointerId }) => pointers.delete(pointerId));
    frame.addEventListener("contextmenu", (event) => event.preventDefault());
    frame.addEventListener("dblclick", () => this.reset(slot));
    frame.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.#zoom(slot, Math.exp(-clamp(event.deltaY, -100, 100) / 300), ...place(event));
    }, { passive: false });
    frame.addEventListener("keydown", (event) => this.#keyed(event, slot));
  }

  #keyed(event, slot) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const [right, down] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key] ?? [0, 0];
    const zoom = { "+": KEY_ZOOM, "=": KEY_ZOOM, "-": 1 / KEY_ZOOM }[event.key];
    if (zoom) this.#zoom(slot, zoom);
    else if (right === 0 && down === 0) return;
    else if (event.shiftKey) this.move(slot, right * KEY_MOVE, down * KEY_MOVE);
    else this.turn(slot, (right * KEY_TURN) / TURN, (down * KEY_TURN) / TURN);
    event.preventDefault();
    event.stopPropagation();
  }
}

/// The view at which a box, [[x, y, z], [x, y, z]] in metres, fills the picture; `camera` is that of the portrait (zoom
/// 1, not moved) with the view's own turn.
export function fitted(camera, [low, high]) {
  const ends = [[Infinity, -Infinity], [Infinity, -Infinity]];
  for (let corner = 0; corner < 8; corner++) {
    const [x, y, z] = [0, 1, 2].map((axis) => (corner >> axis & 1 ? high : low)[axis]);
    const row = (r) => camera[r] * x + camera[4 + r] * y + camera[8 + r] * z + camera[12 + r];
    [row(0) / row(3), row(1) / row(3)].forEach((at, axis) => (ends[axis] = [Math.min(ends[axis][0], at), Math.max(ends[axis][1], at)]));
  }
  const [across, up] = ends;
  const zoom = 1.9 / Math.max(across[1] - across[0], up[1] - up[0]);
  return { zoom, x: (-zoom * (across[0] + across[1])) / 4, y: (zoom * (up[0] + up[1])) / 4 };
}
