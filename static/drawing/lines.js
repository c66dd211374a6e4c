// Lines over the width of a canvas, with their keys; over time with an axis, a playhead and a stretch that is marked.

import { numeral, say } from "./words.js";

// Told apart by colour-blind people and by their dashes.
const COLOURS = ["#3b82c4", "#d9822b", "#3a9a6e", "#b0508c", "#8a6d3b", "#5b5bd6", "#c4453b", "#2a9d9d"];
const DASHES = [[], [7, 3], [2, 3], [9, 3, 2, 3]];

/// Colour and dash of the line of a number.
export const style = (index) => ({ colour: COLOURS[index % COLOURS.length], dash: DASHES[Math.floor(index / 2) % DASHES.length] });

/// Fits a canvas's pixels to its size on the page; answers its context and size in CSS pixels.
export function fitted(canvas) {
  const { width, height } = canvas.getBoundingClientRect();
  const ratio = devicePixelRatio || 1;
  const [w, h] = [Math.max(1, Math.round(width * ratio)), Math.max(1, Math.round(height * ratio))];
  if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  return { context, width, height };
}

// The dashes of a line as a picture that repeats itself, for its key.
function dashes(dash) {
  if (dash.length === 0) return "linear-gradient(var(--swatch) 0 0)";
  let at = 0;
  const parts = dash.map((length, i) => `${i % 2 === 0 ? "var(--swatch)" : "transparent"} ${at}px ${(at += length)}px`);
  return `repeating-linear-gradient(90deg, ${parts.join(", ")})`;
}

/// A name with the colour and the dashes of its line.
export function swatch(name, index) {
  const item = document.createElement("span");
  item.textContent = name;
  const { colour, dash } = style(index);
  item.style.setProperty("--swatch", colour);
  item.style.setProperty("--dashes", dashes(dash));
  return item;
}

/// Left edge of the lines, CSS pixels: before it stand the values.
export const LEFT = 46;

/// Lines over the width of a canvas, the highest of each pixel's values; a playhead at `part` of it, if not null.
/// `time`: {from, to, unit} of an axis below; `marked`: the parts between which a stretch is marked; `marks`: values
/// with a dashed line across. A line that is `faint` stands back.
export function draw(canvas, { lines, log = false, unit, low, high, time, marked, marks = [] }, part) {
  const { context, width, height } = fitted(canvas);
  const css = getComputedStyle(canvas);
  const [ink, soft] = [css.getPropertyValue("--ink"), css.getPropertyValue("--line")];
  const value = log ? (x) => Math.log10(Math.max(x, 1e-18)) : (x) => x;
  let [from, to] = [Infinity, -Infinity];
  for (const { values } of lines) for (const x of values) if (Number.isFinite(x)) [from, to] = [Math.min(from, value(x)), Math.max(to, value(x))];
  if (from > to) return;
  if (log) [from, to] = [Math.floor(from), Math.max(Math.ceil(to), Math.floor(from) + 1)];
  else from = Math.min(from, low ?? 0);
  to = Math.max(to, high ?? -Infinity, from + 1e-9);
  const [left, top, bottom] = [LEFT, 8, time ? 24 : 6];
  const y = (x) => height - bottom - ((value(x) - from) / (to - from)) * (height - top - bottom);
  const x = (share) => left + share * (width - left);
  context.font = "12px system-ui, sans-serif";
  context.textBaseline = "middle";
  if (marked) {
    context.fillStyle = css.getPropertyValue("--accent-soft");
    context.fillRect(x(marked[0]), 0, Math.max(2, x(marked[1]) - x(marked[0])), height - bottom);
    context.strokeStyle = css.getPropertyValue("--accent");
    context.strokeRect(x(marked[0]), 0.5, Math.max(2, x(marked[1]) - x(marked[0])), height - bottom - 1);
  }
  if (time) timeAxis(context, time, x, height, ink);
  for (const at of ticks(from, to, log)) {
    const row = height - bottom - ((at - from) / (to - from)) * (height - top - bottom);
    context.strokeStyle = soft;
    context.beginPath();
    context.moveTo(left, row);
    context.lineTo(width, row);
    context.stroke();
    context.fillStyle = ink;
    context.fillText(log ? `1e${at.toFixed(0)}` : `${numeral(at, 0, 2)} ${at === to ? unit : ""}`, 2, Math.max(row, 8));
  }
  for (const mark of marks) {
    context.strokeStyle = css.getPropertyValue("--bad");
    context.setLineDash([4, 4]);
    context.beginPath();
    context.moveTo(left, y(mark));
    context.lineTo(width, y(mark));
    context.stroke();
  }
  lines.forEach(({ values, faint }, index) => {
    const { colour, dash } = style(index);
    context.globalAlpha = faint ? 0.15 : 1;
    context.strokeStyle = colour;
    context.setLineDash(dash);
    context.lineWidth = 1.6;
    context.beginPath();
    const columns = Math.max(1, Math.floor(width - left));
    let pen = false;
    for (let c = 0; c < columns; c++) {
      const begin = Math.floor((c * values.length) / columns);
      const end = Math.max(begin + 1, Math.floor(((c + 1) * values.length) / columns));
      let highest = -Infinity;
      for (let f = begin; f < end && f < values.length; f++) if (values[f] > highest) highest = values[f];
      if (!Number.isFinite(highest)) {
        pen = false;
        continue;
      }
      if (pen) context.lineTo(left + c, y(highest));
      else context.moveTo(left + c, y(highest));
      pen = true;
    }
    context.stroke();
  });
  context.globalAlpha = 1;
  context.setLineDash([]);
  context.lineWidth = 1;
  if (part !== null) {
    context.strokeStyle = ink;
    context.beginPath();
    context.moveTo(x(part), 0);
    context.lineTo(x(part), height - (time ? bottom : 0));
    context.stroke();
  }
  const words = lines.map(({ name, values }) => say("highest", { name, value: `${numeral(Math.max(...sampled(values)), 0, 3)} ${unit}` }));
  canvas.setAttribute("aria-label", words.join("; "));
}

/// Which part of the axis of time a pointer is over, 0 to 1.
export function partAt(canvas, { clientX }) {
  const { left, width } = canvas.getBoundingClientRect();
  return Math.min(Math.max((clientX - left - LEFT) / Math.max(1, width - LEFT), 0), 1);
}

/// Round times below the lines, as many as there is room for: `x` is the place of a part of the time.
export function timeAxis(context, { from, to, unit }, x, height, ink) {
  const length = Math.max(to - from, 1e-9);
  const rough = length / Math.max(2, Math.floor((x(1) - x(0)) / 90));
  const ten = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((n) => n * ten).find((each) => each >= rough * 0.999);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  context.fillStyle = ink;
  context.textAlign = "center";
  const end = context.measureText(`${numeral(to, digits)} ${unit}`).width;
  for (let at = Math.ceil(from / step - 1e-6) * step; at <= to + 1e-6 * step; at += step) {
    const place = x((at - from) / length);
    if (place < x(1) - end - 20) context.fillText(numeral(at, digits), Math.max(place, x(0) + 4), height - 9);
  }
  context.textAlign = "end";
  context.fillText(`${numeral(to, digits)} ${unit}`, x(1), height - 9);
  context.textAlign = "start";
}

// Four parts of the way; of a logarithmic axis whole powers of ten, five of them at most.
function ticks(from, to, log) {
  if (!log) return [0, 1, 2, 3, 4].map((i) => (i === 4 ? to : from + ((to - from) * i) / 4));
  const step = Math.ceil((to - from) / 4);
  return Array.from({ length: Math.floor((to - from) / step) + 1 }, (_, i) => from + i * step);
}

// Math.max takes no more arguments than the stack holds.
function sampled(values) {
  const step = Math.max(1, Math.floor(values.length / 5000));
  const out = [];
  for (let i = 0; i < values.length; i += step) if (Number.isFinite(values[i])) out.push(values[i]);
  return out.length > 0 ? out : [0];
}
