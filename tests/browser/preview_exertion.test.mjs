// The preview of a study whose captures are exertions: the body and its courses beside the clip; participants get
// nothing of it.

import assert from "node:assert/strict";
import { writeFileSync, mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { looker } from "./lib/access.mjs";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { small, text, trials } from "./lib/small_study.mjs";

const noBrowser = skip(!executable && "Chromium not found");

/// A built-in run and a walk of a file, and a performance that is no exertion.
function study(folder) {
  mimique(["sample", "--out", join(folder, "sample")]);
  const stimuli = {
    avatars: { head: { builtin: { seed: 1 } } },
    captures: {
      run: { exertion: { builtin: "run", for: 60, person: { level: 2 } } },
      walk: { exertion: { motion: "sample/walk.bvh", for: 60 } },
      actor: { builtin: { actor: 7 } },
    },
    segments: [
      { id: "run", capture: "run", first: 3240, end: 3601 },
      { id: "walk", capture: "walk", first: 3240, end: 3601 },
      { id: "joy2", capture: "actor", performance: { expression: "joy", intensity: 2 } },
    ],
    methods: { recorded: { method: "recorded" } },
    clips: { list: ["run", "walk", "joy2"].map((segment) => ({ avatar: "head", segment, method: "recorded" })) },
  };
  const file = join(folder, "exertions.json");
  const parts = {
    stimuli,
    questions: [{ id: "effort", type: "likert", prompt: text("How hard?"), numItems: 7, leftLabel: text("not at all"), rightLabel: text("very hard") }],
    components: { clips: trials(["run.recorded", "walk.recorded", "joy2.recorded"], ["effort"]) },
    sequence: { order: "fixed", components: ["clips"] },
  };
  writeFileSync(file, JSON.stringify(small("exertions", parts)));
  return file;
}

test("preview: the body of an exertion beside its face", { skip: noBrowser, timeout: 600_000 }, async () => {
  const file = study(mkdtempSync(join(tmpdir(), "mimique-preview-")));
  const server = await serve([file]);
  const browser = await open("undrawn", { viewport: { width: 1440, height: 900 } });
  const { page } = browser;
  try {
    const address = `${server.url}/preview/exertions?backend=webgl2`;
    await page.goto(address);
    await page.waitForSelector("#clip-a");
    await page.selectOption("#clip-a", "run.recorded");
    await page.waitForFunction(() => document.querySelector("#exertion-clip").textContent === "run.recorded", null, { timeout: 120_000 });
    await page.waitForFunction(() => document.querySelector(".preview-clip").textContent.includes("361 frames"), null, { timeout: 120_000 });
    assert.equal(await page.locator("#exertion canvas").count(), 8);
    const label = () => page.locator(".exertion-body").getAttribute("aria-label");
    assert.match(await label(), /54\.0 s after the beginning/);
    await page.locator("#scrub").focus();
    for (let i = 0; i < 12; i++) await page.keyboard.press("ArrowRight");
    await page.evaluate(() => {
      const scrub = document.querySelector("#scrub");
      scrub.value = 2000;
      scrub.dispatchEvent(new Event("input"));
    });
    assert.match(await label(), /56\.0 s after the beginning/);
    // The weights drawn are those of the clip.
    const { drawing, hash } = await page.evaluate(async () => {
      const answer = await fetch("/preview/exertions/exertion?clip=run.recorded");
      return { drawing: await answer.json(), hash: document.querySelector(".preview-clip").textContent };
    });
    assert.match(hash, /[0-9a-f]{16}/);
    assert.deepEqual([drawing.spanS, drawing.rateHz, drawing.weights[0].values.length], [60, 60, 361]);
    const shots = screenshotFolder("preview-exertion");
    const { look } = looker(page, shots);
    await look("run");

    // A motion of the study's own file; what is no exertion shows none.
    await page.selectOption("#clip-a", "walk.recorded");
    await page.selectOption("#clip-b", "");
    await page.waitForFunction(() => document.querySelector("#exertion-clip").textContent === "walk.recorded", null, { timeout: 60_000 });
    await page.selectOption("#clip-a", "joy2.recorded");
    await page.waitForFunction(() => document.querySelector("#exertion").hidden, null, { timeout: 60_000 });
    await page.waitForFunction(() => document.querySelector(".preview-clip").textContent.includes("frames"), null, { timeout: 60_000 });
    assert.equal(await page.evaluate(async () => (await fetch("/preview/exertions/exertion?clip=joy2.recorded")).text()), "null");

    await page.setViewportSize({ width: 360, height: 780 });
    await page.emulateMedia({ colorScheme: "dark" });
    await page.selectOption("#clip-a", "run.recorded");
    await page.waitForFunction(() => !document.querySelector("#exertion").hidden, null, { timeout: 60_000 });
    await look("run-phone-dark");
    // What participants load has nothing of it.
    const bundle = await (await fetch(`${server.url}/api/studies/exertions`)).text();
    assert.ok(!bundle.includes("breath") && !bundle.includes("builtin"), "no exertion in the bundle");
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});
