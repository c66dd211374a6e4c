// Difference scaling: three levels of a parameter in step, and which two differ more; what the browser solved is what was
// solved beforehand.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { violations } from "./lib/access.mjs";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { go, phase, through } from "./lib/participant.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { small, stimuli, text } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

const LEVELS = [0, 0.2, 0.4, 0.7, 1];
const TRIALS = 3;

const study = small("scale", {
  seed: 5,
  questions: [{ id: "larger", type: "singleChoice", prompt: text("Which two differ more?"), options: [{ value: "first", label: text("A and B") }, { value: "second", label: text("B and C") }] }],
  components: { scale: { type: "scaling", parameter: "alpha", levels: LEVELS, method: "lsts", trials: TRIALS, question: "larger" } },
  sequence: { order: "fixed", components: ["scale"] },
  stimuli: stimuli({ head: { builtin: { seed: 1 } } }, { lsts: { method: "lsts" } }, [["head", "lsts"]]),
});

test("scaling: three levels in step, and which two differ more", { skip: unable, timeout: 400_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-scale-"));
  writeFileSync(join(folder, "scale.json"), JSON.stringify(study));
  const server = await serve([join(folder, "scale.json")]);
  const browser = await open("undrawn", { viewport: { width: 1280, height: 800 }, locale: "fr-FR" });
  const shots = screenshotFolder("scaling");
  const { page } = browser;
  try {
    const trials = await through(page, `${server.url}/s/scale/?backend=webgl2`, async (_, number) => {
      const captions = await page.locator(".stage-frame.panel figcaption").allTextContents();
      assert.deepEqual(captions, ["A", "B", "C"]);
      await go(page, "keyboard");
      await phase(page, "playing");
      await page.screenshot({ path: join(shots, `trial-${number}.png`) });
      await phase(page, "answering", 120_000);
      assert.equal(await page.locator(".panel-row, .play-alone").count(), 0, "nothing is rated one by one");
      if (number === 1) assert.deepEqual(await violations(page), [], "axe");
      await page.locator(`fieldset[data-question=larger] label:has(input[value=${number % 2 ? "second" : "first"}])`).click();
    });
    assert.equal(trials, TRIALS);
    assert.deepEqual(browser.errors, [], "the console is clean");
    const rows = parse(mimique(["export", "--database", server.database, "--format", "csv"])).filter((row) => row.trial_type === "trial");
    assert.equal(rows.length, TRIALS);
    for (const [at, row] of rows.entries()) {
      const levels = JSON.parse(row.scaled_levels);
      const ascends = levels[0] < levels[1];
      assert.ok(levels.length === 3 && levels.every((level) => LEVELS.includes(level)) && ascends === levels[1] < levels[2], row.scaled_levels);
      assert.equal(row.second_differs_more, String(at % 2 === 0));
      assert.equal(row.weights_expected, "true", `${row.trial_id}: the browser solved what was solved beforehand`);
      assert.equal(row.stimulus, `joy2.lsts@alpha=${levels[0]}`);
    }
    assert.equal(new Set(rows.map((row) => [...JSON.parse(row.scaled_levels)].sort().join())).size, TRIALS, "no set comes twice");
  } finally {
    await browser.close();
    await server.stop();
  }
});
