// One take by every method, solved natively by the server and in Chromium by the page's worker: the
// hashes of the weights (SHA-256 over every bit of every double) are the same.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { root, serve } from "./lib/server.mjs";
import { small, text, trials } from "./lib/small_study.mjs";

const unable = skip(executable ? false : "Chromium not found");
// Every method but those that need more than a take: a surface, a training take, recorded weights.
const schema = JSON.parse(readFileSync(join(root, "study-config/schema/study.schema.json"), "utf8"));
const more = ["thin-shell-surface", "regression", "recorded"];
const methods = schema.$defs.Method.properties.method.enum.filter((method) => !more.includes(method));

/** A weak and a strong expression by every method. */
function studyOfEveryMethod() {
  const ids = ["joy2", "fear3"].flatMap((segment) => methods.map((method) => `${segment}.${method}`));
  const study = small("methods", {
    questions: [{ id: "real", type: "singleChoice", prompt: text("Is it real?"), options: [{ value: "y", label: text("yes") }, { value: "n", label: text("no") }] }],
    components: { faces: trials(ids, ["real"]) },
    sequence: { order: "fixed", components: ["faces"] },
    stimuli: {
      avatars: { head: { builtin: { seed: 1 } } },
      captures: { actor: { builtin: { actor: 7 }, rateHz: 60 } },
      segments: [
        { id: "joy2", capture: "actor", performance: { expression: "joy", intensity: 2 } },
        { id: "fear3", capture: "actor", performance: { expression: "fear", intensity: 3 } },
      ],
      methods: Object.fromEntries(methods.map((method) => [method, { method }])),
    },
  });
  const file = join(mkdtempSync(join(tmpdir(), "mimique-methods-")), "study.json");
  writeFileSync(file, JSON.stringify(study));
  return file;
}

test("solver: every method has the same bits natively and in Chromium", { skip: unable, timeout: 600_000 }, async () => {
  const server = await serve([studyOfEveryMethod()]);
  const browser = await open("undrawn");
  try {
    const { page } = browser;
    await page.goto(`${server.url}/preview/methods`);
    const { clips } = await (await fetch(`${server.url}/api/studies/methods`)).json();
    const solved = await page.evaluate(async (clips) => {
      const page = document.querySelector('script[type="module"][src*="preview.js"]').src;
      const { prepareClip } = await import(new URL("../stage/host.js", page).href);
      const found = {};
      for (const [id, source] of Object.entries(clips)) found[id] = await prepareClip(id, source);
      return found;
    }, clips);
    for (const method of methods) {
      const own = Object.entries(clips).filter(([, clip]) => clip.method.method === method);
      assert.equal(own.length, 2, method);
      for (const [id, clip] of own) {
        assert.match(clip.weights_hash, /^[0-9a-f]{64}$/);
        assert.equal(solved[id].weights_hash, clip.weights_hash, id);
      }
    }
    // Where no weight reaches its upper bound, `nnls` is `box`: the same problem, the same bits. No other two
    // clips are one.
    const others = Object.entries(clips).filter(([id, { method, weights_hash }]) => {
      const box = clips[id.replace(/nnls$/, "box")];
      return method.method !== "nnls" || box.weights_hash !== weights_hash;
    });
    assert.ok(others.some(([, { method }]) => method.method === "nnls"), "a bound is reached in a clip");
    const different = new Set(others.map(([, clip]) => clip.weights_hash));
    assert.equal(different.size, others.length, "no two clips are one");
  } finally {
    await browser.close();
    await server.stop();
  }
});
