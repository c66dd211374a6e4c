// The canvas module of the pages without a picture, for tests that are not about one: the exports of web/stage in
// JavaScript. `open("undrawn")` of browser.mjs gives it to pages in place of stage_webgl.js. The host script, the player,
// the display's clock, the log and the solver are the product's own. Only decoding the geometry and drawing it are not
// done: the canvas shows its background.

/** The name of the graphics adapter in logs: no log of this stage can be mistaken for one of a stage that draws. */
const ADAPTER = "none: the stage of tests that draws nothing";

/** As the wasm module's initialization. */
export default async function initialize() {}

export class Canvas {
  #gl;
  #background;
  #shapes = new Map();
  #lost = null;

  static async open(canvas, width, height, background, variant) {
    const opened = new Canvas();
    opened.#gl = canvas.getContext("webgl2");
    if (!opened.#gl) throw new Error("canvas: no WebGL2 context");
    opened.setLook(background, variant);
    opened.resize(width, height);
    return opened;
  }

  /** Keeps a head under `key`; returns its number of blendshapes, as the pack names them. */
  loadAvatar(key, pack, widths, pixels) {
    if (widths.length !== pixels.length) throw new Error(`avatar ${key}: ${pixels.length} pictures, ${widths.length} widths`);
    const count = blendshapes(pack);
    this.#shapes.set(key, count);
    return count;
  }

  hasAvatar(key) {
    return this.#shapes.has(key);
  }

  /** Checks what would be drawn; every frame goes to the display at once. */
  draw(key, weights, yaw, pitch, zoom) {
    if (this.#lost !== null) throw new Error(this.#lost);
    const count = this.#shapes.get(key);
    if (count === undefined) throw new Error(`avatar ${key}: not loaded; load it first`);
    if (weights.length > count) throw new Error(`avatar ${key}: ${weights.length} weights for ${count} blendshapes`);
    if (![...weights, yaw, pitch, zoom].every(Number.isFinite)) throw new Error(`avatar ${key}: a weight or the view is not a number`);
    return true;
  }

  camera() {
    throw new Error("the stage that draws nothing has no camera; open a browser that draws");
  }

  dropAvatar(key) {
    this.#shapes.delete(key);
  }

  resize(width, height) {
    this.#gl.viewport(0, 0, width, height);
    this.#clear();
  }

  setLook(background, variant) {
    if (!["stimulus", "reference"].includes(variant)) throw new Error(`look ${variant}: unknown; use stimulus or reference`);
    if (!/^(#[0-9a-f]{6})?$/i.test(background)) throw new Error(`background ${background}: not a colour; write #rrggbb`);
    this.#background = background || "#808080";
    this.#clear();
  }

  lost() {
    return this.#lost ?? undefined;
  }

  adapter() {
    return ADAPTER;
  }

  lose() {
    this.#lost ??= "graphics device: destroyed";
  }

  free() {
    this.#shapes.clear();
  }

  #clear() {
    const [red, green, blue] = [1, 3, 5].map((at) => parseInt(this.#background.slice(at, at + 2), 16) / 255);
    this.#gl.clearColor(red, green, blue, 1);
    this.#gl.clear(this.#gl.COLOR_BUFFER_BIT);
  }
}

/** The number of blendshapes in the head of an avatar pack (crates/avatar/src/pack): after kind, version and length, the
    avatar's name and the count of the names that follow. */
function blendshapes(pack) {
  const kind = new TextDecoder().decode(pack.subarray(0, 4));
  if (kind !== "MMAV") throw new Error(`avatar pack: it begins with '${kind}'`);
  let at = 12;
  const varint = () => {
    for (let value = 0, shift = 0; ; shift += 7) {
      const byte = pack[at++];
      value += (byte & 127) * 2 ** shift;
      if (byte < 128) return value;
    }
  };
  const name = varint();
  at += name;
  return varint();
}
