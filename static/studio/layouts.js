// A marker layout: made or opened, drawn on the head, dragged by mouse and keys, with its error beside it; which
// of its markers may go.
import { made } from "../stage/player.js";
import { draw, swatch } from "../drawing/lines.js";
import { HeadPicture, WAYS } from "./head-picture.js";
import { drawLayout, facesCamera } from "./overlay.js";
import { isShown, whenShown } from "./tabs.js";
import { numeral, say } from "./texts.js";
import { callWorker } from "./worker-calls.js";

const $ = (id) => document.getElementById(id);
/// How near to a marker's place it is taken hold of, CSS pixels.
const REACH = 14;
/// The plot begins where so many markers are on the face: fewer tell none, and hide what the others do.
const FIRST = 4;
/// The lines of the plot.
const LINES = [say("layouts.now"), say("layouts.as-it-was")];
const EMPTY = { markers: [], head: [], steps: 0 };
const mm = (value) => `${numeral(value, Math.abs(value) < 1 ? 3 : 2)} mm`;

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
      clip: "studio-layout", section: "layouts", canvas: $("layout-canvas"), overlay, view: $("layout-view"), zoom: 1.4,
      draw: (canvas, camera) => drawLayout(canvas, camera, this.#state, this.#chosen),
    }, page);
    overlay.tabIndex = 0;
    overlay.setAttribute("role", "application");
    overlay.setAttribute("aria-label", say("layouts.keys"));
    overlay.addEventListener("pointerdown", (event) => this.#take(event));
    // A finger on a marker drags it, beside markers it scrolls the page.
    overlay.addEventListener("touchstart", (event) => this.#markerAt(this.#picture.at(event.touches[0])) >= 0 && event.preventDefault(), { passive: false });
    overlay.addEventListener("pointermove", (event) => this.#follow(event).catch(page.report));
    for (const end of ["pointerup", "pointercancel"]) overlay.addEventListener(end, () => (this.#drag = null));
    $("layout-legend").replaceChildren(...LINES.map(swatch));
    const on = (id, act) => $(id).addEventListener("click", () => act().catch(page.report));
    overlay.addEventListener("keydown", (event) => this.#keyed(event)?.catch(page.report));
    on("layout-make", () => this.#make());
    on("layout-from-map", () => this.#opened(say("layouts.taking"), () => callWorker("layoutFromMap")));
    on("layout-rehearse", () => this.#rehearse());
    on("layout-save", async () => page.save("layout.json", await callWorker("layoutJson")));
    $("layout-file").addEventListener("change", async ({ target }) => {
      const [file] = target.files;
      target.value = "";
      if (file) await this.#opened(say("files.reading", { name: file.name }), async () => callWorker("layoutFile", file.name, await file.text()));
    });
    whenShown("layouts", () => this.#plot());
    addEventListener("resize", () => this.#plot());
  }

  /// Another avatar, or other motion to judge by.
  async sourcesChanged() {
    this.#page.tabs.can("layouts", this.#page.avatarKey() !== null);
    $("layout-from-map").disabled = !this.#page.mapIsThere();
    if (this.#page.avatarKey() === null) return;
    const state = await callWorker("layoutState");
    if ((state.steps ?? 0) === 0) this.#page.history.forget("layout");
    this.#put(state);
    await this.#picture.show();
  }

  /// The marker map of the page has changed.
  mapChanged() {
    $("layout-from-map").disabled = !this.#page.mapIsThere();
  }

  async #make() {
    const [count, heads] = [$("layout-count"), $("layout-heads")].map((input) => Number(input.value));
    const method = $("layout-method").value;
    const words = say(method === "rehearse" ? "layouts.rehearsing" : "layouts.choosing");
    await this.#opened(words, () => callWorker("makeLayout", method, count, heads, $("layout-symmetric").checked));
  }

  async #opened(words, work) {
    const state = await this.#page.busy(words, work);
    if (!state) return;
    this.#chosen = -1;
    // The steps of another layout lead nowhere here.
    this.#page.history.forget("layout");
    this.#put(state);
    await this.#picture.show();
  }

  async #rehearse() {
    const state = await this.#page.busy(say("layouts.rehearsing-each"), () => callWorker("rehearseLayout"));
    if (state) this.#put(state);
  }

  // A step that the worker can take back; `again` does it anew.
  #step(what, again) {
    this.#page.history.put({ what, about: "layout", undo: async () => this.#put(await callWorker("undoLayout")), redo: async () => this.#put(await again()) });
  }

  #put(state) {
    this.#state = { ...EMPTY, ...state };
    if (this.#chosen >= this.#state.markers.length) this.#chosen = -1;
    const none = this.#state.markers.length === 0;
    $("layout-there").hidden = none;
    $("layout-save").disabled = none;
    this.#tell();
    this.#rows();
    this.#picture.redraw();
    this.#plot();
  }

  #tell() {
    const { markers, curveMm, firstCurveMm, motion, near = [], headMarkers, isRehearsed, rehearsedMm, distanceMm } = this.#state;
    if (markers.length === 0) return void ($("layout-note").textContent = say("layouts.none"));
    const last = (curve) => curve[curve.length - 1];
    const words = [say("layouts.facts", { markers: markers.length, heads: headMarkers, error: mm(last(curveMm)) })];
    if (last(curveMm) !== last(firstCurveMm)) words[0] += say("layouts.was", { error: mm(last(firstCurveMm)) });
    if (isRehearsed && rehearsedMm !== null) words.push(say("layouts.rehearsed-error", { error: mm(rehearsedMm) }));
    words.push(motion.source === "takes" ? say("layouts.judged", { name: motion.name }) : say("layouts.no-motion"));
    if (near.length > 0) {
      const pairs = near.slice(0, 4).map(({ labels: [one, other], mm: apart }) => say("layouts.pair", { one, other, mm: numeral(apart, 1) })).join(", ");
      const more = near.length > 4 ? say("layouts.more-pairs", { count: near.length - 4 }) : "";
      words.push(say("layouts.near", { distance: distanceMm, pairs, more }));
    }
    const outside = markers.filter(({ allowed }) => !allowed).map(({ label }) => label);
    if (outside.length > 0) words.push(say("layouts.outside", { labels: outside.join(", ") }));
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
    const drop = made("button", { type: "button", ariaLabel: say("layouts.drop-one", { name: label }) }, say("layouts.drop"));
    drop.addEventListener("click", () => this.#drop(index).catch(this.#page.report));
    [name.dataset.act, drop.dataset.act] = ["choose", "drop"];
    const number = (value) => made("td", { className: "number" }, value === null ? "–" : numeral(value, 3));
    const row = made("tr", {}, made("td", {}, name), number(expectedMm), number(rehearsedMm), made("td", {}, drop));
    row.dataset.index = index;
    row.setAttribute("aria-selected", String(index === this.#chosen));
    return row;
  }

  #choose(index) {
    this.#chosen = index;
    for (const row of $("layout-rows").rows) row.setAttribute("aria-selected", String(Number(row.dataset.index) === index));
    const own = this.#state.markers[index];
    $("layout-chosen").textContent = own ? `${index + 1} ${own.label}` : say("none");
    this.#picture.redraw();
    this.#plot();
  }

  // A dropped marker was the chosen one, or those behind it move up.
  async #drop(index) {
    const wasRehearsed = this.#state.isRehearsed;
    const { label } = this.#state.markers[index];
    const state = await callWorker("dropLayoutMarker", index);
    this.#step(say("layouts.drop-one", { name: label }), () => callWorker("dropLayoutMarker", index));
    if (this.#chosen >= index) this.#chosen -= this.#chosen === index ? this.#chosen + 1 : 1;
    this.#put(state);
    if (wasRehearsed) await this.#rehearse();
  }

  // Expected error over the markers: as they are, and as they were made or opened.
  #plot() {
    const { curveMm, firstCurveMm, markers } = this.#state;
    if (!isShown("layouts") || markers.length === 0) return;
    const plot = $("layout-plot");
    const lines = [curveMm, firstCurveMm].map((values, i) => ({ name: LINES[i], values: values.slice(FIRST) }));
    draw(plot, { lines, unit: "mm", low: 0 }, this.#chosen < 0 ? 1 : Math.max(0, (this.#chosen + 1.5 - FIRST) / (curveMm.length - FIRST)));
    plot.setAttribute("aria-label", say("layouts.plot", { first: mm(curveMm[FIRST]), from: FIRST, last: mm(curveMm[curveMm.length - 1]), all: markers.length, before: mm(firstCurveMm[firstCurveMm.length - 1]) }));
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
    const partner = $("layout-partner").checked;
    const { label } = this.#state.markers[drag.index];
    const state = await callWorker("moveLayoutMarker", drag.index, vertex, partner, !drag.begun);
    if (!drag.begun && state.steps > steps) {
      drag.begun = true;
      drag.again = { vertex };
      this.#step(say("layouts.moved", { name: label }), () => callWorker("moveLayoutMarker", drag.index, drag.again.vertex, partner, true));
    }
    // A drag is one step: done again, the marker goes where the drag ended.
    if (drag.again) drag.again.vertex = vertex;
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

}
