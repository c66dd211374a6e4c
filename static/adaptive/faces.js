// The faces of reverse correlation: studies with such a block alone load this, and the module that draws them.
import init, { Face } from "../adaptive.js";

const ready = init();

/** The weights of the face of one trial; `request` as the module's Face has it. */
export async function drawFace(request) {
  await ready;
  const face = new Face(JSON.stringify(request));
  const drawn = { weights: face.weights(), frames: face.frames(), rate_hz: face.rate_hz(), weights_hash: face.weights_hash() };
  face.free();
  return drawn;
}
