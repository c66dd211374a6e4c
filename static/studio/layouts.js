// A marker layout: made or opened, drawn on the head, dragged by mouse and keys, with its error beside it; which
// of its markers may go.
import { made } from "../stage/player.js";
import { draw, swatch } from "../drawing/lines.js";
import { HeadPicture, WAYS } from "./head-picture.js";
import { drawLayout, facesCamera } from "./overlay.js";
import { callWorker } from "./worker-calls.js";

const $ = (id) => document.getElementById(id);
/// How near to a marker's place it is taken hold of, CSS pixels.
const REACH = 14;
/// The plot begins where so many markers are on the face: fewer tell none, and hide what the others do.
const FIRST = 4;
/// The lines of the plot.
const LINES = ["now", "as it was"];
const EMPTY = { markers: [], head: [], steps: 0 };
const mm = (value) => `${value.toFixed(Math.abs(value) < 1 ? 3 : 2)} mm`;

export class Layouts {
  #page;
  #picture;
  #state = EMPTY;
  #chosen = -1;
  // {index, begun, next: a place that the pointer has reached, busy: whether one is on its way}
  #drag = null;

  /// `page`: {avatarKey(), avatarShapes(), mapIsThere(), busy(words, work), save(name, text), report(error)}
  constructor(page) {
    this.#page = page;
    const overlay = $("layout-overlay");
    this.#picture = new HeadPicture({
      clip: "studio-layout", section: $("layouts"), canvas: $("layout-canvas"), overlay, view: $("layout-view"), zoom: 1.4,
      draw: (canvas, camera) => drawLayout(canvas, camera, this.#state, this.#chosen),
    }, page);
    overlay.tabIndex = 0;
    overlay.setAttribute("role", "application");
    overlay.setAttribute("aria-label", "The markers on the head: Page Up and Page Down choose one, arrow keys move it, Delete drops it, Shift with an arrow key turns the head");
    overlay.addEventListener("pointerdown", (event) => this.#take(event));
    // A finger on a marker drags it, beside markers it scrolls the page.
    overlay.addEventListener("touchstart", (event) => this.#markerAt(this.#picture.at(event.touches[0])) >= 0 && event.preventDefault(), { passive: false });
    overlay.addEventListener("pointermove", (event) => this.#follow(event).catch(page.report));
    for (const end of ["pointerup", "pointercancel"]) overlay.addEventListener(end, () => (this.#drag = null));
    $("layout-legend").replaceChildren(...LINES.map(swatch));
    const on = (id, act) => $(id).addEventListener("click", () => act().catch(page.report));
    overlay.addEventListener("keydown", (event) => this.#keyed(event)?.catch(page.report));
    on("layout-make", () => this.#make());
    on("layout-from-map", () => this.#opened("Taking the marker map", () => callWorker("layoutFromMap")));
    on("layout-undo", () => this.#change("undoLayout"));
    on("layout-rehearse", () => this.#rehearse());
    on("layout-save", async () => page.save("layout.json", await callWorker("layoutJson")));
    $("layout-file").addEventListener("change", async ({ target }) => {
      const [file] = target.files;
      target.value = "";
      if (file) await this.#opened(`Reading ${file.name}`, async () => callWorker("layoutFile", file.name, await file.text()));
    });
    $("layouts").addEventListener("toggle", () => this.#plot());
    $("layouts").addEventListener("keydown", (event) => this.#undoKey(event)?.catch(page.report));
    addEventListener("resize", () => this.#plot());
  }

  /// Another avatar, or other motion to judge by.
  async sourcesChanged() {
    $("layouts").hidden = this.#page.avatarKey() === null;
    $("layout-from-map").disabled = !this.#page.mapIsThere();
    if (this.#page.avatarKey() === null) return;
    this.#put(await callWorker("layoutState"));
    await this.#picture.show();
  }

  /// The marker map of the page has changed.
  mapChanged() {
    $("layout-from-map").disabled = !this.#page.mapIsThere();
  }

  async #make() {
    const [count, heads] = [$("layout-count"), $("layout-heads")].map((input) => Number(input.value));
    const method = $("layout-method").value;
    const words = method === "rehearse" ? "Rehearsing layouts: ten seconds, or some minutes on a dense head" : "Choosing places";
    await this.#opened(words, () => callWorker("makeLayout", method, count, heads, $("layout-symmetric").checked));
  }

  async #opened(words, work) {
    const state = await this.#page.busy(words, work);
    if (!state) return;
    this.#chosen = -1;
    this.#put(state);
    await this.#picture.show();
  }

  async #rehearse() {
    const state = await this.#page.busy("Rehearsing without each marker", () => callWorker("rehearseLayout"));
    if (state) this.#put(state);
  }

  async #change(call, ...args) {
    this.#put(await callWorker(call, ...args));
  }

  #put(state) {
    this.#state = { ...EMPTY, ...state };
    if (this.#chosen >= this.#state.markers.length) this.#chosen = -1;
    const none = this.#state.markers.length === 0;
    $("layout-there").hidden = none;
    $("layout-save").disabled = none;
    $("layout-undo").disabled = this.#state.steps === 0;
    this.#tell();
    this.#rows();
    this.#picture.redraw();
    this.#plot();
  }

  #tell() {
    const { markers, curveMm, firstCurveMm, motion, near = [], headMarkers, isRehearsed, rehearsedMm, distanceMm } = this.#state;
    if (markers.length === 0) return void ($("layout-note").textContent = "None yet: make one, or open a marker map.");
    const last = (curve) => curve[curve.length - 1];
    const words = [`${markers.length} markers on the face, ${headMarkers} for the head; expected error ${mm(last(curveMm))} a vertex`];
    if (last(curveMm) !== last(firstCurveMm)) words[0] += ` (${mm(last(firstCurveMm))} as it was)`;
    if (isRehearsed && rehearsedMm !== null) words.push(`rehearsed error ${mm(rehearsedMm)}`);
    words.push(motion.source === "takes" ? `judged by the motion of ${motion.name}` : "no motion is known, every shape counts by itself: open weights, or a training take's");
    if (near.length > 0) words.push(`nearer than ${distanceMm} mm: ${near.slice(0, 4).map(({ labels, mm: apart }) => `${labels.join(" and ")} (${apart.toFixed(1)} mm)`).join(", ")}${near.length > 4 ? ` and ${near.length - 4} more pairs` : ""}`);
    const outside = markers.filter(({ allowed }) => !allowed).map(({ label }) => label);
    if (outside.length > 0) words.push(`on lids, inner lips, nostrils, ears, neck, hair, or where nothing moves: ${outside.join(", ")}`);
    $("layout-note").textContent = words.join("; ");
  }

  // The cheapest first: by rehearsal once there is one, else by what is expected.
  #rows() {
    const { markers, isRehearsed } = this.#state;
    const cost = ({ rehearsedMm, expectedMm }) => (isRehearsed ? rehearsedMm ?? Infinity : expectedMm);
    const order = [...markers.keys()].sort((a, b) => cost(markers[a]) - cost(markers[b]));
    const held = document.activeElement?.closest("#layout-rows tr");
    const [row, cell] = held ? [held.rowIndex - 1, document.activeElement.dataset.act] : [-1, ""];
    $("layout-rows").replaceChildren(...order.map((index) => this.#row(markers[index], index)));
    if (held) $("layout-rows").rows[Math.min(row, order.length - 1)]?.querySelector(`[data-act="${cell}"]`)?.focus();
  }

  #row({ label, expectedMm, rehearsedMm }, index) {
    const name = made("button", { type: "button" }, `${index + 1} ${label}`);
    name.addEventListener("click", () => this.#choose(index));
    const drop = made("button", { type: "button", ariaLabel: `Drop ${label}` }, "Drop");
    drop.addEventListener("click", () => this.#drop(index).catch(this.#page.report));
    [name.dataset.act, drop.dataset.act] = ["choose", "drop"];
    const number = (value) => made("td", { className: "number" }, value === null ? "–" : value.toFixed(3));
    const row = made("tr", {}, made("td", {}, name), number(expectedMm), number(rehearsedMm), made("td", {}, drop));
    row.dataset.index = index;
    row.setAttribute("aria-selected", String(index === this.#chosen));
    return row;
  }

  #choose(index) {
    this.#chosen = index;
    for (const row of $("layout-rows").rows) row.setAttribute("aria-selected", String(Number(row.dataset.index) === index));
    const own = this.#state.markers[index];
    $("layout-chosen").textContent = own ? `${index + 1} ${own.label}` : "none";
    this.#picture.redraw();
    this.#plot();
  }

  // A dropped marker was the chosen one, or those behind it move up.
  async #drop(index) {
    const wasRehearsed = this.#state.isRehearsed;
    const state = await callWorker("dropLayoutMarker", index);
    if (this.#chosen >= index) this.#chosen -= this.#chosen === index ? this.#chosen + 1 : 1;
    this.#put(state);
    if (wasRehearsed) await this.#rehearse();
  }

  // Expected error over the markers: as they are, and as they were made or opened.
  #plot() {
    const { curveMm, firstCurveMm, markers } = this.#state;
    if (!$("layouts").open || markers.length === 0) return;
    const plot = $("layout-plot");
    const lines = [curveMm, firstCurveMm].map((values, i) => ({ name: LINES[i], values: values.slice(FIRST) }));
    draw(plot, { lines, unit: "mm", low: 0 }, this.#chosen < 0 ? 1 : Math.max(0, (this.#chosen + 1.5 - FIRST) / (curveMm.length - FIRST)));
    plot.setAttribute("aria-label", `Expected error: ${mm(curveMm[FIRST])} with the first ${FIRST} markers, ${mm(curveMm[curveMm.length - 1])} with all ${markers.length}; as it was ${mm(firstCurveMm[firstCurveMm.length - 1])}`);
  }

  // The marker at a place of the picture: the nearest that faces the camera.
  #markerAt([x, y]) {
    const camera = this.#picture.camera();
    if (!camera) return -1;
    let [best, least] = [-1, REACH];
    this.#state.markers.forEach(({ position, normal }, index) => {
      if (normal && !facesCamera(camera, normal)) return;
      const [left, top] = this.#picture.placeOf(position);
      const apart = Math.hypot(left - x, top - y);
      if (apart < least) [best, least] = [index, apart];
    });
    return best;
  }

  #take(event) {
    const index = this.#markerAt(this.#picture.at(event));
    this.#choose(index);
    if (index < 0) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    this.#drag = { index, begun: false, next: null, busy: false };
  }

  // One question to the worker at a time; of the places that the pointer reaches meanwhile the last one counts.
  async #follow(event) {
    const drag = this.#drag;
    if (!drag) return;
    drag.next = this.#picture.at(event);
    if (drag.busy) return;
    drag.busy = true;
    try {
      while (drag.next) {
        const place = drag.next;
        drag.next = null;
        await this.#move(drag, await this.#picture.vertexAt(place));
      }
    } finally {
      drag.busy = false;
    }
  }

  async #move(drag, vertex) {
    if (vertex === undefined || vertex === this.#state.markers[drag.index]?.vertex) return;
    const { steps } = this.#state;
    const state = await callWorker("moveLayoutMarker", drag.index, vertex, $("layout-partner").checked, !drag.begun);
    drag.begun ||= state.steps > steps;
    this.#put(state);
  }

  #keyed(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return null;
    const way = WAYS[event.key];
    const turn = { PageUp: -1, PageDown: 1 }[event.key];
    const own = this.#state.markers[this.#chosen];
    const acts = {
      Delete: () => (own ? this.#drop(this.#chosen) : null),
      Escape: () => this.#choose(-1),
    };
    const act = turn ? () => this.#next(turn) : way ? () => this.#arrow(way, event.shiftKey, own) : acts[event.key];
    if (!act) return null;
    event.preventDefault();
    event.stopPropagation();
    return act();
  }

  #arrow(way, turns, own) {
    if (turns || !own) return void this.#picture.turnBy(way);
    return this.#nudge(this.#chosen, own, way);
  }

  async #nudge(index, own, way) {
    await this.#move({ index, begun: false }, await this.#picture.vertexBeside(own, way));
  }

  #next(turn) {
    const count = this.#state.markers.length;
    if (count > 0) this.#choose(this.#chosen < 0 ? (turn > 0 ? 0 : count - 1) : (this.#chosen + turn + count) % count);
  }

  #undoKey(event) {
    const isUndo = (event.ctrlKey || event.metaKey) && !event.shiftKey && event.key.toLowerCase() === "z";
    if (!isUndo || this.#state.steps === 0 || event.target.closest("input")) return null;
    event.preventDefault();
    return this.#change("undoLayout");
  }
}
