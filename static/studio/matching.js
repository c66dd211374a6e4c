// Which marker sits where: the list, the neutral head; markers are chosen, dragged along the skin, or moved by keys.
import { made } from "../stage/player.js";
import { CapturePoints } from "./capture-points.js";
import { HeadPicture, WAYS } from "./head-picture.js";
import { drawMap, sureColour } from "./overlay.js";
import { say } from "./texts.js";
import { callWorker } from "./worker-calls.js";

const $ = (id) => document.getElementById(id);
/// How near to a marker's place it is taken hold of, and how far the pointer moves before that is a drag, CSS pixels.
const REACH = 10;
const DRAG = 4;
/// Pixels that are dragged for one step of the head.
const PIXELS = 15;

/// What a marker of one side is called on the other; itself where its name tells no side.
const SIDES = [["left", "right"], ["gauche", "droite"], ["gauche", "droit"]];
function mirrored(label) {
  for (const pair of SIDES) {
    for (const [own, other] of [pair, pair.toReversed()]) {
      const at = label.toLowerCase().indexOf(own);
      if (at < 0) continue;
      const capital = label[at] === label[at].toUpperCase();
      return label.slice(0, at) + (capital ? other[0].toUpperCase() + other.slice(1) : other) + label.slice(at + own.length);
    }
  }
  // Leyebrow, brow_L, mouth_Lend
  return label.replace(/(^|_)([LR])(?=[a-z]|_|$)/, (_, before, side) => before + (side === "L" ? "R" : "L"));
}

export class Matching {
  #page;
  #picture;
  #points;
  #state = { markers: [] };
  #chosen = null;
  /// How sure a suggestion is of each marker that nobody has placed since, 0 to 1.
  #confidences = new Map();
  // {from: where it began, last, label: the marker that is dragged or null, before: its vertex, moved, next, busy}
  #drag = null;

  /// `page`: {history, avatarKey(), avatarShapes(), mapChanged(state), report(error)}
  constructor(page) {
    this.#page = page;
    const overlay = $("match-overlay");
    const draw = (canvas, camera) => drawMap(canvas, camera, this.#state.markers, this.#chosen, this.#confidences);
    this.#points = new CapturePoints($("match-points"), {
      choose: (label) => this.#choose(label),
      turned: ([right, down]) => this.#picture.turnBy([-right / PIXELS, -down / PIXELS]),
    });
    const turned = (view) => this.#points.turn(view);
    this.#picture = new HeadPicture({ clip: "studio-neutral", section: "matching", canvas: $("match-canvas"), overlay, view: $("match-view"), draw, turned }, page);
    overlay.tabIndex = 0;
    overlay.setAttribute("aria-label", say("matching.keys"));
    overlay.setAttribute("role", "application");
    overlay.addEventListener("pointerdown", (event) => this.#take(event));
    overlay.addEventListener("pointermove", (event) => this.#follow(event).catch(page.report));
    overlay.addEventListener("pointerup", (event) => this.#leave(event).catch(page.report));
    overlay.addEventListener("pointercancel", () => (this.#drag = null));
    overlay.addEventListener("keydown", (event) => this.#keyed(event)?.catch(page.report));
    for (const id of ["neutral-first", "neutral-end"]) $(id).addEventListener("change", () => this.#neutral());
  }

  /// Shows a map as the worker tells it: suggested, or read from a file.
  put(state) {
    this.#confidences = new Map((state.suggestion?.markers ?? []).map(({ label, confidence }) => [label, confidence]));
    this.#list(state);
  }

  /// Shows a map that was corrected here.
  #list(state) {
    this.#state = state;
    if (!state.markers.some(({ label }) => label === this.#chosen)) this.#chosen = null;
    this.#chosen ??= state.markers.find(({ position }) => !position)?.label ?? state.markers[0]?.label ?? null;
    const [first, end] = state.neutral ?? ["", ""];
    $("neutral-first").value = first;
    $("neutral-end").value = end;
    $("markers").replaceChildren(...state.markers.map((marker) => this.#row(marker)));
    this.#points.choose(this.#chosen);
    this.#picture.redraw();
    callWorker("capturePoints").then((points) => this.#points.put(this.#state.markers, points), this.#page.report);
  }

  #row({ label, vertex, head }) {
    const name = made("button", { type: "button" }, label);
    name.addEventListener("click", () => this.#choose(label));
    const rigid = made("input", { type: "checkbox", checked: head, ariaLabel: say("matching.rigid", { name: label }) });
    rigid.addEventListener("change", () => this.#set(label, vertex, rigid.checked));
    const off = made("button", { type: "button", disabled: vertex === null, ariaLabel: say("matching.off", { name: label }) }, say("off"));
    off.addEventListener("click", () => this.#set(label, null, rigid.checked));
    const place = made("td", { className: vertex === null ? "unplaced" : "" }, vertex === null ? "–" : String(vertex));
    const sure = this.#confidences.get(label);
    const confidence = made("td", { className: "studio-sure" }, vertex === null || sure === undefined ? "" : `${Math.round(100 * sure)} %`);
    const row = made("tr", {}, made("td", {}, name), place, confidence, made("td", {}, rigid), made("td", {}, off));
    if (sure !== undefined && vertex !== null) confidence.style.setProperty("--sure", sureColour(sure));
    row.dataset.label = label;
    row.setAttribute("aria-selected", String(label === this.#chosen));
    return row;
  }

  #choose(label) {
    this.#chosen = label;
    for (const row of $("markers").children) row.setAttribute("aria-selected", String(row.dataset.label === label));
    $("markers").querySelector('[aria-selected="true"]')?.scrollIntoView({ block: "nearest" });
    this.#points.choose(label);
    this.#picture.redraw();
  }

  // Puts a marker on a vertex, or takes it off (null); a step that can be taken back.
  async #set(label, vertex, head, before = this.#of(label)) {
    const moves = [{ label, before: { vertex: before.vertex, head: before.head }, after: { vertex, head } }];
    const other = mirrored(label);
    const partner = vertex !== null && other !== label && $("match-mirror").checked ? this.#of(other) : undefined;
    if (partner) {
      const after = { vertex: await callWorker("mirroredVertex", vertex), head: partner.head };
      moves.push({ label: partner.label, before: { vertex: partner.vertex, head: partner.head }, after });
    }
    const all = async (which) => {
      for (const move of moves) if (!(await this.#place(move.label, move[which].vertex, move[which].head))) return false;
      return true;
    };
    if (!(await all("after"))) return;
    this.#page.history.put({ what: say("matching.moved", { name: label }), about: "map", undo: () => all("before"), redo: () => all("after") });
  }

  #of(label) {
    return this.#state.markers.find((each) => each.label === label);
  }

  #place(label, vertex, head) {
    if (vertex !== this.#of(label)?.vertex) this.#confidences.delete(label);
    return this.#map(() => callWorker("place", label, vertex ?? undefined, head));
  }

  // Another map by the worker; whether it took it.
  async #map(work) {
    try {
      const state = await work();
      this.#list(state);
      this.#page.mapChanged(state);
      return true;
    } catch (error) {
      this.#page.report(error);
      return false;
    }
  }

  async #neutral() {
    const before = this.#state.neutral;
    const after = [Number($("neutral-first").value), Number($("neutral-end").value)];
    const put = (ends) => this.#map(() => callWorker("setNeutral", ...ends));
    if ((await put(after)) && before) {
      this.#page.history.put({ what: say("neutral-frames"), about: "map", undo: () => put(before), redo: () => put(after) });
    }
  }

  // The marker at a place of the picture.
  #markerAt([x, y]) {
    let [best, least] = [null, REACH];
    for (const { label, position } of this.#state.markers) {
      if (!position) continue;
      const [left, top] = this.#picture.placeOf(position);
      const apart = Math.hypot(left - x, top - y);
      if (apart < least) [best, least] = [label, apart];
    }
    return best;
  }

  #take(event) {
    if (!this.#picture.camera()) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    const from = this.#picture.at(event);
    const label = this.#markerAt(from);
    if (label) this.#choose(label);
    this.#drag = { from, last: from, label, before: label && { ...this.#of(label) }, moved: false, next: null, busy: false };
  }

  // A marker goes along the skin; beside markers the head is turned.
  async #follow(event) {
    const drag = this.#drag;
    if (!drag) return;
    const now = this.#picture.at(event);
    if (!drag.moved && Math.hypot(now[0] - drag.from[0], now[1] - drag.from[1]) < DRAG) return;
    drag.moved = true;
    if (!drag.label) {
      this.#picture.turnBy([-(now[0] - drag.last[0]) / PIXELS, -(now[1] - drag.last[1]) / PIXELS]);
      drag.last = now;
      return;
    }
    drag.next = now;
    if (drag.busy) return;
    drag.busy = true;
    try {
      // One question to the worker at a time; of the places that the pointer reaches meanwhile the last one counts.
      while (drag.next) {
        const place = drag.next;
        drag.next = null;
        const vertex = await this.#picture.vertexAt(place);
        const { vertex: old, head } = this.#of(drag.label);
        if (vertex !== undefined && vertex !== old) await this.#place(drag.label, vertex, head);
      }
    } finally {
      drag.busy = false;
    }
  }

  // A click beside markers puts the chosen one there; a drag ends as one step.
  async #leave(event) {
    const drag = this.#drag;
    this.#drag = null;
    if (!drag) return;
    if (!drag.label && !drag.moved) return this.#put(this.#picture.vertexAt(this.#picture.at(event)));
    if (!drag.label || !drag.moved) return;
    while (drag.busy || drag.next) await new Promise((done) => setTimeout(done, 20));
    const { vertex, head } = this.#of(drag.label);
    if (vertex !== drag.before.vertex) await this.#set(drag.label, vertex, head, drag.before);
  }

  /// The neutral head, once the section is open.
  show() {
    return this.#picture.show();
  }

  /// Puts the marker that is chosen now on a vertex, once it is known.
  async #put(met) {
    const label = this.#chosen;
    const vertex = await met;
    const marker = this.#of(label);
    if (vertex !== undefined && marker) await this.#set(label, vertex, marker.head);
  }

  #keyed(event) {
    const way = WAYS[event.key];
    if (!way && event.key !== "Enter") return null;
    event.preventDefault();
    if (!way) return this.#put(this.#picture.vertexAt(this.#picture.middle()));
    if (!event.shiftKey) return this.#picture.turnBy(way) ?? null;
    const marker = this.#state.markers.find(({ label }) => label === this.#chosen);
    return marker?.position ? this.#put(this.#picture.vertexBeside(marker, way)) : null;
  }
}
