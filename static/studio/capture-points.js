// The capture's own markers in space, beside the head that they are placed on: seen from the same side, the chosen one
// stands out, a click chooses.
import { fitted } from "../drawing/lines.js";

const REACH = 12;
/// What is left free at the border, of the canvas.
const BORDER = 0.1;

export class CapturePoints {
  #canvas;
  #markers = [];
  #points = [];
  #view = { yaw: 0, pitch: 0 };
  #chosen = null;
  #turned;

  /// `choose(label)` hears which marker is clicked, `turned([right, down])` how far the points are dragged, in pixels.
  constructor(canvas, { choose, turned }) {
    [this.#canvas, this.#turned] = [canvas, turned];
    let from = null;
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      from = { x: event.clientX, y: event.clientY, moved: false };
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!from) return;
      const by = [event.clientX - from.x, event.clientY - from.y];
      if (!from.moved && Math.hypot(...by) < 4) return;
      from = { x: event.clientX, y: event.clientY, moved: true };
      this.#turned(by);
    });
    canvas.addEventListener("pointerup", (event) => {
      const label = from && !from.moved ? this.#at(event) : null;
      from = null;
      if (label) choose(label);
    });
    canvas.addEventListener("pointercancel", () => (from = null));
  }

  /// The markers of the map's state, and the place of each in the capture, null where it is never seen.
  put(markers, points) {
    [this.#markers, this.#points] = [markers, points];
    this.draw();
  }

  turn({ yaw, pitch }) {
    this.#view = { yaw, pitch };
    this.draw();
  }

  choose(label) {
    this.#chosen = label;
    this.draw();
  }

  // Places on the canvas, [x, y, depth towards the viewer] of each that is seen.
  #places(width, height) {
    const seen = this.#points.map((point, i) => [point, this.#markers[i]]).filter(([point, marker]) => point && marker);
    if (seen.length === 0) return [];
    const middle = [0, 1, 2].map((axis) => seen.reduce((sum, [point]) => sum + point[axis], 0) / seen.length);
    const { yaw, pitch } = this.#view;
    const turned = seen.map(([point, marker]) => {
      const [x, y, z] = point.map((value, axis) => value - middle[axis]);
      const [right, near] = [x * Math.cos(yaw) - z * Math.sin(yaw), x * Math.sin(yaw) + z * Math.cos(yaw)];
      return { marker, at: [right, y * Math.cos(pitch) - near * Math.sin(pitch), y * Math.sin(pitch) + near * Math.cos(pitch)] };
    });
    const reach = Math.max(1e-9, ...seen.map(([point]) => Math.hypot(...point.map((value, axis) => value - middle[axis]))));
    const scale = ((1 - BORDER) * Math.min(width, height)) / 2 / reach;
    return turned.map(({ marker, at: [x, y, near] }) => ({ marker, x: width / 2 + x * scale, y: height / 2 - y * scale, near: near / reach }));
  }

  #at(event) {
    const { left, top, width, height } = this.#canvas.getBoundingClientRect();
    const apart = ({ x, y }) => Math.hypot(left + x - event.clientX, top + y - event.clientY);
    const [nearest] = this.#places(width, height).sort((a, b) => apart(a) - apart(b));
    return nearest && apart(nearest) < REACH ? nearest.marker.label : null;
  }

  draw() {
    if (this.#canvas.getClientRects().length === 0) return;
    const { context, width, height } = fitted(this.#canvas);
    // Those in front are drawn last.
    for (const { marker, x, y, near } of this.#places(width, height).sort((a, b) => a.near - b.near)) {
      const own = marker.label === this.#chosen;
      context.globalAlpha = own ? 1 : 0.6 + 0.4 * near;
      context.fillStyle = own ? "#ff5a5f" : marker.head ? "#6fd3ff" : "#ffd34d";
      context.strokeStyle = context.fillStyle;
      context.beginPath();
      context.arc(x, y, own ? 6 : 3 + near, 0, 2 * Math.PI);
      // What has no place on the head yet is hollow.
      if (marker.vertex === null) context.stroke();
      else context.fill();
    }
    context.globalAlpha = 1;
  }
}
