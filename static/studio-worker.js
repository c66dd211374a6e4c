// The studio's worker: one desk, calls in order. Speaks with studio-desk.js:
//   in   {id, call, args}
//   out  {id, result} or {id, error}
import init, { Studio, methods } from "./desk.js";

let studio = null;
const ready = init().then(() => (studio = new Studio()));

self.onmessage = async ({ data: { id, call, args } }) => {
  try {
    await ready;
    const result = call === "methods" ? methods() : studio[call](...args);
    self.postMessage({ id, result }, ArrayBuffer.isView(result) ? [result.buffer] : []);
  } catch (error) {
    self.postMessage({ id, error: String(error?.message ?? error) });
  }
};
