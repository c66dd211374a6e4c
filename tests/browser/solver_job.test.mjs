// The worker that solves clips says nothing for minutes: the clip fails with a code that the page words, and the next try gets
// another worker. Without a browser: `static/stage/clips.js` itself, with a worker of the test's own.

import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { mock, test } from "node:test";

test("solver job: a silent worker is given up, and the next one solves", async () => {
  const packs = ["avatar", "operators", "take"].map((name) => Buffer.from(`${name} of a clip\0\0\0\0`));
  const hashes = packs.map((pack) => createHash("sha256").update(pack).digest("hex"));
  const workers = [];
  globalThis.document = { querySelector: () => null, createElement: () => ({ getContext: () => null }) };
  globalThis.fetch = async (address) => new Response(packs[hashes.indexOf(address.split("/").pop())]);
  globalThis.Worker = class {
    constructor() {
      this.jobs = [];
      this.ended = false;
      workers.push(this);
    }
    postMessage(job) {
      this.jobs.push(job);
    }
    terminate() {
      this.ended = true;
    }
  };
  const { prepareClip } = await import("../../static/stage/clips.js");
  const [avatar, operators, take] = hashes;
  const source = { avatar, operators, take, method: {}, duration_ms: 100, bytes: 0, provenance: "p", weights_hash: "" };
  const asked = async (count) => {
    while (workers.length < count || workers[count - 1].jobs.length === 0) await new Promise(setImmediate);
    return workers[count - 1];
  };

  mock.timers.enable({ apis: ["setTimeout"] });
  try {
    const first = prepareClip("joy", source);
    const silent = await asked(1);
    mock.timers.tick(179_000);
    assert.equal(silent.ended, false);
    mock.timers.tick(1_000);
    // A code with its value, which the page words.
    await assert.rejects(first, { code: "solver_silent", values: { seconds: "180" }, message: "solver: no answer for 180 s" });
    assert.equal(silent.ended, true);

    const second = prepareClip("joy", source);
    const worker = await asked(2);
    const [{ id }] = worker.jobs;
    worker.onmessage({ data: { id, weights: new Float32Array(4), frames: 2, shapes: 2, rate_hz: 20, weights_hash: "w", solve_ms: 5 } });
    assert.deepEqual((await second).weights_hash, "w");
    // Its time does not run on.
    mock.timers.tick(600_000);
    assert.equal(worker.ended, false);
  } finally {
    mock.timers.reset();
  }
});
