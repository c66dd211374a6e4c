// Which marker sits where: the list, the neutral head, a click or keys.
import { made } from "../stage/player.js";
import { HeadPicture, WAYS } from "./head-picture.js";
import { drawMap } from "./overlay.js";
import { callWorker } from "./worker-calls.js";

const $ = (id) => document.getElementById(id);

export class Matching {
  #page;
  #picture;
  #state = { markers: [] };
  #chosen = null;

  /// `page`: {avatarKey(), avatarShapes(), mapChanged(state), report(error)}
  constructor(page) {
    this.#page = page;
    const overlay = $("match-overlay");
    const draw = (canvas, camera) => drawMap(canvas, camera, this.#state.markers, this.#chosen);
    this.#picture = new HeadPicture({ clip: "studio-neutral", section: $("matching"), canvas: $("match-canvas"), overlay, view: $("match-view"), draw }, page);
    overlay.tabIndex = 0;
    overlay.setAttribute("aria-label", "Click where the chosen marker sits, or Enter puts it in the middle and Shift with an arrow key moves it; arrow keys turn the head");
    overlay.setAttribute("role", "application");
    overlay.addEventListener("click", (event) => this.#put(this.#picture.vertexAt(this.#picture.at(event))).catch(page.report));
    overlay.addEventListener("keydown", (event) => this.#keyed(event)?.catch(page.report));
    for (const id of ["neutral-first", "neutral-end"]) $(id).addEventListener("change", () => this.#neutral());
  }

  /// Shows a map as the worker tells it.
  put(state) {
    this.#state = state;
    if (!state.markers.some(({ label }) => label === this.#chosen)) this.#chosen = null;
    this.#chosen ??= state.markers.find(({ position }) => !position)?.label ?? state.markers[0]?.label ?? null;
    const [first, end] = state.neutral ?? ["", ""];
    $("neutral-first").value = first;
    $("neutral-end").value = end;
    $("markers").replaceChildren(...state.markers.map((marker) => this.#row(marker)));
    this.#picture.redraw();
  }

  #row({ label, vertex, head }) {
    const name = made("button", { type: "button" }, label);
    name.addEventListener("click", () => this.#choose(label));
    const rigid = made("input", { type: "checkbox", checked: head, ariaLabel: `${label} moves with the head` });
    rigid.addEventListener("change", () => this.#place(label, vertex, rigid.checked));
    const off = made("button", { type: "button", disabled: vertex === null, ariaLabel: `Take ${label} off` }, "Off");
    off.addEventListener("click", () => this.#place(label, null, rigid.checked));
    const place = made("td", { className: vertex === null ? "unplaced" : "" }, vertex === null ? "–" : String(vertex));
    const row = made("tr", {}, made("td", {}, name), place, made("td", {}, rigid), made("td", {}, off));
    row.dataset.label = label;
    row.setAttribute("aria-selected", String(label === this.#chosen));
    return row;
  }

  #choose(label) {
    this.#chosen = label;
    for (const row of $("markers").children) row.setAttribute("aria-selected", String(row.dataset.label === label));
    this.#picture.redraw();
  }

  #place(label, vertex, head) {
    return callWorker("place", label, vertex ?? undefined, head)
      .then((state) => (this.put(state), this.#page.mapChanged(state)))
      .catch(this.#page.report);
  }

  #neutral() {
    const [first, end] = [Number($("neutral-first").value), Number($("neutral-end").value)];
    callWorker("setNeutral", first, end)
      .then((state) => (this.put(state), this.#page.mapChanged(state)))
      .catch(this.#page.report);
  }

  /// The neutral head, once the section is open.
  show() {
    return this.#picture.show();
  }

  /// Puts the marker that is chosen now on a vertex, once it is known.
  async #put(met) {
    const label = this.#chosen;
    const vertex = await met;
    const marker = this.#state.markers.find((each) => each.label === label);
    if (vertex !== undefined && marker) await this.#place(label, vertex, marker.head);
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
