// The borders between the parts of the window: dragged, or moved by arrow keys; kept over reloads.
import { recall, remember } from "./memory.js";

const $ = (id) => document.getElementById(id);
/// Of each border: the property that it sets, the way in which its part grows, least, most and usual size (px).
const SPLITS = {
  "split-left": { property: "--left", across: true, way: 1, least: 200, most: 560, usual: 290 },
  "split-right": { property: "--right", across: true, way: -1, least: 240, most: 620, usual: 330 },
  "split-bottom": { property: "--bottom", across: false, way: -1, least: 120, most: 640, usual: 280 },
};
const STEP = 16;

function put(id, size) {
  const { property, least, most } = SPLITS[id];
  const own = Math.round(Math.min(Math.max(size, least), most));
  document.querySelector("main").style.setProperty(property, `${own}px`);
  $(id).setAttribute("aria-valuenow", own);
  remember(id, own);
}

/// Wires the borders.
export function wireSplits() {
  for (const [id, { across, way, least, most, usual }] of Object.entries(SPLITS)) {
    const border = $(id);
    border.setAttribute("aria-valuemin", least);
    border.setAttribute("aria-valuemax", most);
    let size = recall(id, Math.min(usual, across ? usual : Math.max(200, innerHeight * 0.33)));
    const to = (value) => ((size = Math.min(Math.max(value, least), most)), put(id, size));
    to(size);
    let from = null;
    const place = (event) => (across ? event.clientX : event.clientY);
    border.addEventListener("pointerdown", (event) => {
      border.setPointerCapture(event.pointerId);
      from = { at: place(event), size };
      event.preventDefault();
    });
    border.addEventListener("pointermove", (event) => from && to(from.size + way * (place(event) - from.at)));
    for (const end of ["pointerup", "pointercancel"]) border.addEventListener(end, () => (from = null));
    border.addEventListener("dblclick", () => to(usual));
    border.addEventListener("keydown", (event) => {
      const by = (across ? { ArrowLeft: -1, ArrowRight: 1 } : { ArrowUp: -1, ArrowDown: 1 })[event.key];
      if (!by) return;
      event.preventDefault();
      event.stopPropagation();
      to(size + way * by * STEP);
    });
  }
}
