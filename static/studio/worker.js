// The studio's worker: calls of the module's `Studio`, in order. Speaks with worker-calls.js:
//   in   {id, call, args}
//   out  {id, result} or {id, error, problem, panicked}: `problem` is the JSON of a problem of the workspace; after a panic the worker is of no more use
//   and  {panic}, a report (panics.js), before the error of a call that panicked
import init, { Studio, methods } from "../studio.js";

let studio = null;
let panicked = false;
const ready = init().then(() => (studio = new Studio()));

self.onmessage = async ({ data: { id, call, args } }) => {
  try {
    await ready;
    const result = call === "methods" ? methods() : studio[call](...args);
    self.postMessage({ id, result }, ArrayBuffer.isView(result) ? [result.buffer] : []);
  } catch (error) {
    panicked ||= error instanceof WebAssembly.RuntimeError;
    self.postMessage({ id, error: String(error?.message ?? error), problem: error?.problem ?? null, panicked });
  }
};
