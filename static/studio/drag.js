// A box on a line of time: its edges and itself are dragged, arrow keys move it.
const EDGE_PX = 8;
/// A finger covers more than a mouse points at.
const EDGE_TOUCH_PX = 22;

/// Lays `box` over the frames `range` of `frames` and lets it be moved.
/// `line`: {element, frames, rate, least}; `moved(range)` hears where it was put.
export function movable(box, range, line, moved) {
  const percent = (frame) => (100 * frame) / line.frames;
  const lay = ([from, to]) => {
    box.style.insetInlineStart = `${percent(from)}%`;
    box.style.width = `${percent(to - from)}%`;
  };
  lay(range);
  let drag = null;
  box.addEventListener("pointerdown", (event) => {
    const { left, right } = box.getBoundingClientRect();
    const edge = Math.min(event.pointerType === "touch" ? EDGE_TOUCH_PX : EDGE_PX, (right - left) / 3);
    const part = event.clientX - left < edge ? "start" : right - event.clientX < edge ? "end" : "whole";
    drag = { part, from: event.clientX, now: range };
    box.setPointerCapture(event.pointerId);
  });
  box.addEventListener("pointermove", (event) => {
    if (!drag) return;
    const by = Math.round(((event.clientX - drag.from) / line.element.clientWidth) * line.frames);
    let [from, to] = range;
    if (drag.part !== "end") from += by;
    if (drag.part !== "start") to += by;
    if (from < 0 || to > line.frames || to - from < line.least) return;
    drag.now = [from, to];
    lay(drag.now);
  });
  box.addEventListener("pointerup", () => {
    const now = drag?.now ?? range;
    drag = null;
    if (now.some((frame, i) => frame !== range[i])) moved(now);
  });
  box.addEventListener("pointercancel", () => ((drag = null), lay(range)));
  box.addEventListener("keydown", (event) => {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!by) return;
    event.preventDefault();
    event.stopPropagation();
    const step = by * Math.max(1, Math.round(line.rate / 20));
    const [from, to] = range;
    moved(event.shiftKey ? [from, to + step] : event.altKey ? [from + step, to] : [from + step, to + step]);
  });
}
