// An adaptive block: levels follow the answers, a reload goes on in the same track, and what the browser solved is what
// was solved beforehand.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { go, phase, place, storedEvents, through, until } from "./lib/participant.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { small, stimuli, text } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

// This person tells every level from here on.
const SEEN_FROM = 0.55;

// Which of the two clips is the varied one; or whether they differ, and some trials show no difference.
const ASKED = {
  "left or right": {
    question: { id: "smoother", type: "comparison", prompt: text("Which one is smoother?") },
    block: { trials: 8 },
    trials: 8,
    // Where the other clip stands left, the varied one stands right.
    answer: ({ level, left }) => (level >= SEEN_FROM === left ? "right" : "left"),
    right: ({ level }) => level >= SEEN_FROM,
    reloadedAt: 4,
  },
  "yes or no": {
    question: { id: "differ", type: "singleChoice", prompt: text("Do they differ?"), options: [{ value: "no", label: text("No") }, { value: "yes", label: text("Yes") }] },
    block: { trials: 5, yes: "yes", catch: 0.2 },
    trials: 6,
    answer: ({ level }) => (level >= SEEN_FROM ? "yes" : "no"),
    right: ({ level, isCatch }) => isCatch || level >= SEEN_FROM,
  },
};

const study = ({ question, block }) => small("levels", {
  seed: 7,
  questions: [question],
  components: {
    limit: {
      type: "adaptive",
      vary: { parameter: "alpha", from: 0, to: 1, levels: 11 },
      method: "lsts",
      against: "none",
      rule: { questPlus: { threshold: [0.1, 0.9, 9], spread: [0.05, 0.1] } },
      question: question.id,
      ...block,
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

for (const [name, asked] of Object.entries(ASKED)) test(`adaptive: levels follow the answers, ${name}`, { skip: unable, timeout: 600_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-levels-"));
  writeFileSync(join(folder, "levels.json"), JSON.stringify(study(asked)));
  const server = await serve([join(folder, "levels.json")]);
  const browser = await open("undrawn");
  const { page } = browser;
  const fetched = [];
  page.on("request", (request) => fetched.push(new URL(request.url()).pathname));
  try {
    const trials = await through(page, `${server.url}/s/levels/?backend=webgl2`, async (here, trials) => {
      await until("the level is stored", async () => (await chosen(page, server)).length >= trials);
      const shown = (await chosen(page, server))[trials - 1];
      assert.equal(await page.locator(".stage-frame.pair figure").count(), 2);
      await go(page, "mouse");
      if (trials === asked.reloadedAt) {
        await phase(page, "playing");
        await page.reload();
        await page.waitForSelector("main[data-view=trial]", { timeout: 30_000 });
        assert.equal((await place(page)).step, here.step, "the same trial");
        await phase(page, "ready", 120_000);
        assert.equal((await chosen(page, server)).length, trials, "its level is chosen once");
        await go(page, "mouse");
      }
      await phase(page, "answering", 120_000);
      await page.locator(`fieldset[data-question=${asked.question.id}] label:has(input[value=${asked.answer(shown)}])`).click();
    }, { hands: "mouse" });
    assert.equal(trials, asked.trials);
    assert.deepEqual(browser.errors, [], "the console is clean");
    assert.ok(fetched.some((path) => path.endsWith("/adaptive_bg.wasm")), "the module of levels is loaded");

    const rows = parse(mimique(["export", "--database", server.database, "--format", "csv"])).filter((row) => row.trial_type === "trial");
    assert.equal(rows.length, asked.trials);
    for (const row of rows) {
      assert.equal(row.level_replayed, "true", `${row.trial_id}: seed and answers give the level`);
      assert.equal(row.weights_expected, "true", `${row.trial_id}: the browser solved what was solved beforehand`);
      assert.equal(row.stimulus, `joy2.lsts@alpha=${row.level}`);
      assert.equal(row.beside, "joy2.none");
      const isCatch = row.level_catch === "true";
      if (isCatch) assert.equal(row.level, "0", "a trial without a difference");
      assert.equal(row.correct, String(asked.right({ level: Number(row.level), isCatch })));
    }
    const counted = rows.filter((row) => row.level_catch !== "true");
    assert.equal(counted.length, asked.block.trials);
    const levels = counted.map((row) => Number(row.level));
    assert.ok(new Set(levels).size >= 3, `levels move: ${levels}`);
    const sds = counted.map((row) => Number(row.posterior_sd));
    assert.ok(sds.at(-1) < 0.8 * sds[0], `the posterior narrows: ${sds}`);
    const mean = counted.at(-1).posterior_mean;
    assert.ok(Math.abs(Number(mean) - SEEN_FROM) < 0.2, mean);
  } finally {
    await browser.close();
    await server.stop();
  }
});
