// Which marker sits where: the list, the neutral head, a click or keys.
import { openStage, putClip } from "../stage/host.js";
import { made } from "../stage/player.js";
import { callWorker } from "./worker-calls.js";
import { drawMap, project } from "./overlay.js";

const $ = (id) => document.getElementById(id);
const CLIP = "studio-neutral";
const STEP = 0.12;
/// How far a key moves a marker, CSS pixels, and how often it goes on until another vertex is met.
const NUDGE = 3;
const NUDGES = 20;
const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class Matching {
  #page;
  #stage = null;
  #view = { yaw: 0, pitch: 0 };
  #state = { markers: [] };
  #chosen = null;
  #key = null;

  /// `page`: {avatarKey(), mapChanged(state), report(error)}
  constructor(page) {
    this.#page = page;
    $("matching").addEventListener("toggle", () => this.show().catch(page.report));
    $("match-view").addEventListener("change", () => {
      const [yaw, pitch] = $("match-view").value.split(",").map(Number);
      this.#turn({ yaw, pitch });
    });
    const overlay = $("match-overlay");
    overlay.tabIndex = 0;
    overlay.setAttribute("aria-label", "Click where the chosen marker sits, or Enter puts it in the middle and Shift with an arrow key moves it; arrow keys turn the head");
    overlay.setAttribute("role", "application");
    overlay.addEventListener("click", (event) => this.#click(event).catch(page.report));
    overlay.addEventListener("keydown", (event) => this.#keyed(event)?.catch(page.report));
    for (const id of ["neutral-first", "neutral-end"]) $(id).addEventListener("change", () => this.#neutral());
    addEventListener("resize", () => this.#turn(this.#view));
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
    this.#overlay();
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
    this.#overlay();
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
  async show() {
    const key = this.#page.avatarKey();
    if (!$("matching").open || key === null) return;
    if (this.#key !== key) {
      this.#key = key;
      const pack = await callWorker("avatarPack");
      const shapes = this.#page.avatarShapes();
      await putClip({
        clip: CLIP, avatarHash: `${key}-bank`, avatarPack: pack, weights: new Float32Array(shapes), frames: 1, shapes,
        rate_hz: 1,
      });
    }
    this.#stage ??= await openStage($("match-canvas"), { background: "#808080", width: 520, height: 520 });
    this.#turn(this.#view);
  }

  #turn(view) {
    this.#view = view;
    this.#stage?.setView(view);
    if (!$("matching").open || this.#key === null) return;
    this.#stage?.show(CLIP, 0).then(() => this.#overlay(), this.#page.report);
  }

  #overlay() {
    if (!this.#stage || !$("matching").open) return;
    drawMap($("match-overlay"), this.#stage.camera(CLIP), this.#state.markers, this.#chosen);
  }

  async #click(event) {
    const { left, top } = $("match-overlay").getBoundingClientRect();
    await this.#put([event.clientX - left, event.clientY - top], () => true);
  }

  /// Puts the chosen marker on the vertex under a place of the picture, if `wanted`; whether it did.
  async #put([x, y], wanted) {
    if (!this.#stage || this.#chosen === null) return false;
    const { width, height } = $("match-overlay").getBoundingClientRect();
    const label = this.#chosen;
    const vertex = await callWorker("pick", this.#stage.camera(CLIP), Math.round(width), Math.round(height), x, y);
    if (vertex === undefined || !wanted(vertex)) return false;
    await this.#place(label, vertex, this.#marker(label).head);
    return true;
  }

  #marker(label) {
    return this.#state.markers.find((marker) => marker.label === label);
  }

  #keyed(event) {
    const way = WAYS[event.key];
    if (!way && event.key !== "Enter") return null;
    event.preventDefault();
    if (!way) return this.#middle();
    if (event.shiftKey) return this.#nudge(way);
    const pitch = Math.min(1.2, Math.max(-1.2, this.#view.pitch - way[1] * STEP));
    this.#turn({ yaw: this.#view.yaw + way[0] * STEP, pitch });
    return null;
  }

  async #middle() {
    const { width, height } = $("match-overlay").getBoundingClientRect();
    await this.#put([width / 2, height / 2], () => true);
  }

  /// Moves the chosen marker to the next vertex on the way.
  async #nudge([right, down]) {
    const { position, vertex } = (this.#stage && this.#chosen !== null && this.#marker(this.#chosen)) || {};
    if (!position) return;
    const { width, height } = $("match-overlay").getBoundingClientRect();
    const [x, y] = project(this.#stage.camera(CLIP), position, width, height);
    for (let step = 1; step <= NUDGES; step++) {
      const at = [x + right * NUDGE * step, y + down * NUDGE * step];
      if (await this.#put(at, (met) => met !== vertex)) return;
    }
  }
}
