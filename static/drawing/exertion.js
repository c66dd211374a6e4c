// An exertion in pictures: the body, courses over all of it, breath and weights of the window. The studio draws it
// beside its inputs, the preview beside a clip.
import { made } from "../stage/player.js";
import { drawFigure } from "./figure.js";
import { draw, partAt, swatch } from "./lines.js";
import { lineName, numeral, say } from "./words.js";

/// Shapes whose weights are drawn: those that move most.
const SHAPES = 6;
const MINUTES = 120;

export class ExertionPictures {
  #drawing = null;
  #timeMs = 0;
  #moved;
  #body = made("canvas", { className: "exertion-body", role: "img" });
  #noBody = made("p", { className: "soft", hidden: true }, say("no-body"));
  #about = made("p", { className: "soft" }, say("about-body"));
  #courses = [];
  #breath = plot();
  #weights = plot();
  /// The body; the courses over all of it; breath and weights of the window.
  body = made("figure", { className: "exertion-figure" }, this.#body, this.#noBody, this.#about);
  courses = made("div", { className: "exertion-plots" });
  clip = made("div", { className: "exertion-plots" }, picture(say("breath"), this.#breath), picture(say("weights"), this.#weights));

  /// `moved`: hears where the window was dragged to, [from, to] s; null where it stays.
  constructor(moved = null) {
    this.#moved = moved;
    addEventListener("resize", () => this.#draw());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.#draw());
  }

  /// Takes an `ExertionDrawing`, or null where there is none.
  put(drawing) {
    this.#drawing = drawing;
    if (drawing && this.#courses.length !== drawing.courses.length) {
      this.#courses = drawing.courses.map(() => plot());
      this.courses.replaceChildren(...drawing.courses.map(({ course }, i) => picture(say(`course.${course}`), this.#courses[i])));
      if (this.#moved) for (const { canvas } of this.#courses) this.#draggable(canvas);
    }
    this.#draw();
  }

  /// The playhead, ms from the window's beginning.
  at(timeMs) {
    this.#timeMs = timeMs;
    this.#draw();
  }

  redraw() {
    this.#draw();
  }

  #draw() {
    const drawing = this.#drawing;
    if (!drawing || this.courses.getClientRects().length === 0) return;
    const [from, to] = drawing.windowS;
    const seconds = Math.min(this.#timeMs / 1000, to - from);
    const part = to > from ? seconds / (to - from) : 0;
    this.#figure(seconds);
    const long = drawing.spanS > MINUTES;
    const time = { from: 0, to: drawing.spanS / (long ? 60 : 1), unit: long ? "min" : "s" };
    const marked = [from, to].map((s) => s / drawing.spanS);
    drawing.courses.forEach(({ course, lines }, i) => {
      this.#courses[i].draw(lines.map((line) => ({ ...line, name: lineName(line.name) || say(`course.${course}`) })), { time, marked }, (from + seconds) / drawing.spanS);
    });
    const window = { time: { from, to, unit: "s" } };
    this.#breath.canvas.parentElement.hidden = drawing.breath.length === 0;
    this.#breath.draw(drawing.breath.map((line) => ({ ...line, name: lineName(line.name) })), { ...window, low: -1, high: 1 }, part);
    this.#weights.draw(this.#moving(), { ...window, high: 1 }, part);
  }

  #figure(seconds) {
    const { figure, breath, rateHz, windowS } = this.#drawing;
    this.#body.hidden = this.#about.hidden = !figure;
    this.#noBody.hidden = Boolean(figure);
    if (!figure) return;
    const lungs = breath[0]?.values ?? [0];
    drawFigure(this.#body, figure, seconds, lungs[Math.min(Math.round(seconds * rateHz), lungs.length - 1)]);
    this.#body.setAttribute("aria-label", say("body", { seconds: numeral(windowS[0] + seconds, 1) }));
  }

  // The shapes that move most, in one order for as long as the drawing is the same.
  #moving() {
    const most = ({ values }) => values.reduce((high, value) => Math.max(high, Math.abs(value)), 0);
    this.#drawing.moving ??= bothSides(this.#drawing.weights).map((line) => [most(line), line]).filter(([high]) => high > 0).sort(([a], [b]) => b - a).slice(0, SHAPES).map(([, line]) => line);
    return this.#drawing.moving;
  }

  // The window follows the pointer: by its middle where it was pressed beside it. Its inputs do the same by keyboard.
  #draggable(canvas) {
    canvas.classList.add("draggable");
    let held = null;
    const follow = (event) => {
      const { spanS, windowS: [from, to] } = this.#drawing;
      const at = partAt(canvas, event) * spanS;
      held ??= at >= from && at <= to ? at - from : (to - from) / 2;
      const first = Math.min(Math.max(Math.round((at - held) * 2) / 2, 0), Math.max(spanS - (to - from), 0));
      if (first !== from) this.#moved([first, Math.min(first + to - from, spanS)]);
    };
    canvas.addEventListener("pointerdown", (event) => {
      if (!this.#drawing) return;
      canvas.setPointerCapture(event.pointerId);
      held = null;
      follow(event);
    });
    canvas.addEventListener("pointermove", (event) => held !== null && follow(event));
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => (held = null));
  }
}

// Left and right as one line where they move alike.
function bothSides(lines) {
  const named = new Map(lines.map((line) => [line.name, line]));
  const alike = ({ values }, other) => other !== undefined && values.every((value, i) => value === other.values[i]);
  return lines.flatMap((line) => {
    const [stem, side] = [line.name.replace(/(Left|Right)$/, ""), /(Left|Right)$/.exec(line.name)?.[0]];
    if (!side || !alike(line, named.get(`${stem}${side === "Left" ? "Right" : "Left"}`))) return [line];
    return side === "Left" ? [{ ...line, name: say("both-sides", { name: stem }) }] : [];
  });
}

// A canvas with the keys of its lines.
function plot() {
  const canvas = made("canvas", { className: "exertion-plot", role: "img" });
  const legend = made("p", { className: "line-keys" });
  let names = "";
  const drawLines = (lines, options, part) => {
    const now = lines.map(({ name }) => name).join();
    if (now !== names) {
      names = now;
      legend.hidden = lines.length < 2;
      legend.replaceChildren(...lines.map(({ name }, i) => swatch(name, i)));
    }
    if (lines.length > 0) draw(canvas, { lines, unit: "", ...options }, part);
  };
  return { canvas, legend, draw: drawLines };
}

function picture(title, { canvas, legend }) {
  return made("div", {}, made("h3", {}, title), canvas, legend);
}
