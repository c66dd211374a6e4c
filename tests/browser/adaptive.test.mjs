// An adaptive block: levels follow the answers, a reload goes on in the same track, and what the browser solved is what
// was solved beforehand.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { go, leave, phase, place, storedEvents, until } from "./lib/participant.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { small, stimuli, text } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

// This person tells every level from here on.
const SEEN_FROM = 0.55;
const RELOADED_AT = 4;

const study = small("levels", {
  seed: 7,
  questions: [{ id: "smoother", type: "comparison", prompt: text("Which one is smoother?") }],
  components: {
    limit: {
      type: "adaptive",
      vary: { parameter: "alpha", from: 0, to: 1, levels: 11 },
      method: "lsts",
      against: "none",
      rule: { questPlus: { threshold: [0.1, 0.9, 9], spread: [0.05, 0.1] } },
      trials: 8,
      question: "smoother",
    },
  },
  sequence: { order: "fixed", components: ["limit"] },
  stimuli: stimuli(
    { head: { builtin: { seed: 1 } } },
    { lsts: { method: "lsts" }, none: { method: "lsts", alpha: 0 } },
    [["head", "none"]],
  ),
});

// The levels that were chosen so far, one a trial.
const chosen = async (page, server) => (await storedEvents(page, server, "levels")).filter(({ type }) => type === "level_chosen");

test("adaptive: levels follow the answers, and a reload goes on at the same level", { skip: unable, timeout: 600_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-levels-"));
  writeFileSync(join(folder, "levels.json"), JSON.stringify(study));
  const server = await serve([join(folder, "levels.json")]);
  const browser = await open("webgl2");
  const { page } = browser;
  const asked = [];
  page.on("request", (request) => asked.push(new URL(request.url()).pathname));
  try {
    await page.goto(`${server.url}/s/levels/?backend=webgl2`);
    await page.waitForSelector("main[data-view]", { timeout: 30_000 });
    let here = await place(page);
    let trials = 0;
    while (here.view !== "end") {
      if (here.view === "receipt") {
        here = await leave(page, here, 60_000);
        continue;
      }
      if (here.view === "trial") {
        trials += 1;
        await phase(page, "ready", 120_000);
        await until("the level is stored", async () => (await chosen(page, server)).length >= trials);
        const { level, left } = (await chosen(page, server))[trials - 1];
        assert.equal(await page.locator(".stage-frame.pair figure").count(), 2);
        await go(page, "mouse");
        if (trials === RELOADED_AT) {
          await phase(page, "playing");
          await page.reload();
          await page.waitForSelector("main[data-view=trial]", { timeout: 30_000 });
          assert.equal((await place(page)).step, here.step, "the same trial");
          await phase(page, "ready", 120_000);
          assert.equal((await chosen(page, server)).length, trials, "its level is chosen once");
          await go(page, "mouse");
        }
        await phase(page, "answering", 120_000);
        // Where the other clip stands left, the varied one stands right.
        const side = level >= SEEN_FROM === left ? "right" : "left";
        await page.locator(`fieldset[data-question=smoother] label:has(input[value=${side}])`).click();
      }
      await go(page, "mouse");
      here = await leave(page, here, 60_000);
    }
    assert.equal(trials, 8);
    assert.deepEqual(browser.errors, [], "the console is clean");
    assert.ok(asked.some((path) => path.endsWith("/adaptive_bg.wasm")), "the module of levels is loaded");

    const rows = parse(mimique(["export", "--database", server.database, "--format", "csv"])).filter((row) => row.trial_type === "trial");
    assert.equal(rows.length, 8);
    for (const row of rows) {
      assert.equal(row.level_replayed, "true", `${row.trial_id}: seed and answers give the level`);
      assert.equal(row.weights_expected, "true", `${row.trial_id}: the browser solved what was solved beforehand`);
      assert.equal(row.stimulus, `joy2.lsts@alpha=${row.level}`);
      assert.equal(row.beside, "joy2.none");
      assert.equal(row.correct, String(Number(row.level) >= SEEN_FROM));
    }
    const levels = rows.map((row) => Number(row.level));
    assert.ok(new Set(levels).size >= 3, `levels move: ${levels}`);
    const sds = rows.map((row) => Number(row.posterior_sd));
    assert.ok(sds[7] < 0.8 * sds[0], `the posterior narrows: ${sds}`);
    assert.ok(Math.abs(Number(rows[7].posterior_mean) - SEEN_FROM) < 0.2, rows[7].posterior_mean);
  } finally {
    await browser.close();
    await server.stop();
  }
});
