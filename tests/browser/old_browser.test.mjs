// A browser that lacks what the solver needs is told so by the device gate, before it loads a clip: without a
// browser, `static/stage/backend.js` itself.
import assert from "node:assert/strict";
import test from "node:test";

test("old browser: without an inflater there is no back end", async () => {
  const { DecompressionStream } = globalThis;
  delete globalThis.DecompressionStream;
  try {
    const { backend } = await import("../../static/stage/backend.js");
    await assert.rejects(backend(), /cannot draw the stimuli \(too old: no DecompressionStream\).*current Chrome/s);
  } finally {
    globalThis.DecompressionStream = DecompressionStream;
  }
});
