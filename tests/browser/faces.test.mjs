// Reverse correlation: every trial shows a face that the browser draws from the seed, nothing but the head is loaded, a
// reload shows the same face again, and the export draws what was shown.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { violations } from "./lib/access.mjs";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { go, phase, place, through } from "./lib/participant.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { small, text } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

const OPTIONS = ["joy", "surprise", "other"];
const TRIALS = 4;
const RELOADED_AT = 2;

const study = small("faces", {
  seed: 11,
  questions: [
    { id: "emotion", type: "singleChoice", prompt: text("Which emotion?"), options: OPTIONS.map((value) => ({ value, label: text(value) })) },
    { id: "strength", type: "likert", prompt: text("How strong?"), numItems: 5, leftLabel: text("weak"), rightLabel: text("strong") },
  ],
  components: {
    faces: {
      type: "reverseCorrelation", units: ["AU01", "AU04", "AU06", "AU12", "AU26"], trials: TRIALS, durationSeconds: 2,
      amplitude: [0.6, 1], meanUnits: 3, mostUnits: 5, question: "emotion", intensity: "strength",
    },
  },
  sequence: { order: "fixed", components: ["faces"] },
  stimuli: { avatars: { head: { builtin: { seed: 1 } } }, captures: {}, segments: [], methods: {} },
});

test("reverse correlation: faces are drawn in the browser, and drawn again by the export", { skip: unable, timeout: 400_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-faces-"));
  writeFileSync(join(folder, "faces.json"), JSON.stringify(study));
  const server = await serve([join(folder, "faces.json")]);
  const browser = await open("undrawn", { viewport: { width: 390, height: 844 }, colorScheme: "dark" });
  const shots = screenshotFolder("faces");
  const { page } = browser;
  const asked = [];
  page.on("request", (request) => asked.push(new URL(request.url()).pathname));
  try {
    const trials = await through(page, `${server.url}/s/faces/?backend=webgl2`, async (here, number) => {
      await go(page, "keyboard");
      await phase(page, "playing");
      if (number === RELOADED_AT) {
        await page.reload();
        await page.waitForSelector("main[data-view=trial]", { timeout: 30_000 });
        assert.equal((await place(page)).step, here.step, "the same trial");
        await phase(page, "ready", 120_000);
        await go(page, "keyboard");
        await phase(page, "playing");
      }
      await page.screenshot({ path: join(shots, `trial-${number}.png`) });
      await phase(page, "answering", 60_000);
      if (number === 1) assert.deepEqual(await violations(page), [], "axe");
      await page.locator(`fieldset[data-question=emotion] label:has(input[value=${OPTIONS[number % 3]}])`).click();
      await page.locator("fieldset[data-question=strength] label").nth(number % 5).click();
    });
    assert.equal(trials, TRIALS);
    assert.deepEqual(browser.errors, [], "the console is clean");
    const loaded = (end) => asked.filter((path) => path.endsWith(end)).length;
    assert.equal(loaded("/adaptive_bg.wasm"), 2, "the module that draws, once a load of the page");
    assert.equal(loaded("/solver_bg.wasm"), 0, "nothing is solved");
    const packs = new Set(asked.filter((path) => path.startsWith("/packs/")));
    assert.equal(packs.size, 1, `the head alone is loaded: ${[...packs]}`);

    const rows = parse(mimique(["export", "--database", server.database, "--format", "csv"])).filter((row) => row.response_id === "emotion");
    assert.equal(rows.length, TRIALS);
    for (const [at, row] of rows.entries()) {
      assert.equal(row.trial_id, `faces/${at + 1}`);
      assert.equal(row.stimulus, "faces@drawn");
      assert.equal(row.weights_expected, "true", `${row.trial_id}: the browser showed what the seed gives again`);
      assert.equal(row.answer, OPTIONS[(at + 1) % 3]);
      const courses = JSON.parse(row.trajectories);
      assert.ok(courses.length >= 1 && courses.length <= 5, row.trajectories);
      for (const { unit, onset_s: onset, peak_s: peak, offset_s: offset, amplitude } of courses) {
        assert.ok(study.components.faces.units.includes(unit) && onset < peak && peak < offset && offset <= 2 && amplitude >= 0.6);
      }
      assert.ok(Number(row.rt) > 1900, `seen whole before: ${row.rt} ms`);
    }
    assert.equal(new Set(rows.map((row) => row.trajectories)).size, TRIALS, "every face is another");
    assert.equal(rows[RELOADED_AT - 1].interruptions, "1");

    await page.goto(`${server.url}/preview/faces?backend=webgl2`);
    const drawn = (panel) => page.locator(`[data-panel=${panel}] .preview-clip`);
    for (const panel of ["a", "b"]) {
      if (panel === "b") await page.selectOption("#clip-b", "faces/2");
      await drawn(panel).getByText("action units drawn at random").waitFor({ timeout: 60_000 });
    }
    assert.deepEqual(await page.locator("#clip-a option").allTextContents(), [1, 2, 3, 4, 5].map((trial) => `faces/${trial}`));
    assert.notEqual(await drawn("a").innerText(), await drawn("b").innerText(), "two faces, two hashes");
    await page.evaluate(() => {
      const scrub = document.querySelector("#scrub");
      scrub.value = 900;
      scrub.dispatchEvent(new Event("input"));
    });
    await page.screenshot({ path: join(shots, "preview.png"), fullPage: true });
    assert.equal(await page.locator("main .notice:visible").count(), 0, "nothing to complain of");
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});
