// A block of pairs: every two methods, the left one first and then the right one, and what the export says.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { answer, go, phase, through } from "./lib/participant.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { small, stimuli, text } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

const study = small("duels", {
  questions: [
    { id: "better", type: "comparison", prompt: text("Which is better?"), allowSame: true },
    { id: "why", type: "shortText", prompt: text("Why?"), required: false },
  ],
  training: { clips: ["joy2.recorded"], beside: { "joy2.recorded": "joy2.box" }, show: "inTurn", questions: ["better"], answers: { "joy2.recorded": { better: "left" } }, feedback: true },
  components: { duels: { type: "pairs", question: "better", reasons: "why", show: "inTurn" } },
  sequence: { order: "random", components: ["duels"] },
  stimuli: stimuli(
    { head: { builtin: { seed: 1 } } },
    { box: { method: "box" }, lsts: { method: "lsts" }, recorded: { method: "recorded" } },
    [["head", "box"], ["head", "lsts"], ["head", "recorded"]],
  ),
});

// Which of the two pictures waits: [left, right].
const waiting = (page) => page.evaluate(() =>
  [...document.querySelectorAll(".stage-frame.pair canvas")].map((canvas) => canvas.hasAttribute("data-waiting")));

test("pair blocks: each two methods in turn, left and right, in the export", { skip: unable, timeout: 400_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-duels-"));
  writeFileSync(join(folder, "duels.json"), JSON.stringify(study));
  const server = await serve([join(folder, "duels.json")]);
  const browser = await open("undrawn", { viewport: { width: 412, height: 900 } });
  const shots = screenshotFolder("pair-blocks");
  const { page } = browser;
  try {
    const trials = await through(page, `${server.url}/s/duels/?backend=webgl2`, async (here, trials) => {
      assert.deepEqual(await waiting(page), [false, false], "both stand there before the play");
      // Every state of the play that the page comes through.
      await page.evaluate(() => {
        window.turns = [];
        const note = () => {
          const now = [...document.querySelectorAll(".stage-frame.pair canvas")].map((canvas) => canvas.hasAttribute("data-waiting"));
          const last = window.turns.at(-1);
          if (!last || String(last) !== String(now)) window.turns.push(now);
        };
        const seen = new MutationObserver(note);
        for (const canvas of document.querySelectorAll(".stage-frame.pair canvas")) {
          seen.observe(canvas, { attributes: true, attributeFilter: ["data-waiting"] });
        }
      });
      await go(page, "keyboard");
      await phase(page, "playing");
      if (trials === 1) await page.screenshot({ path: join(shots, "first.png") });
      await phase(page, "answering", 120_000);
      assert.deepEqual(await waiting(page), [false, false], "both stand there after it");
      const turns = (await page.evaluate(() => window.turns)).map(String);
      assert.ok(turns.indexOf("false,true") >= 0, `the right one waits: ${turns}`);
      assert.ok(turns.indexOf("true,false") > turns.indexOf("false,true"), `then the left one: ${turns}`);
      await answer(page, "keyboard", here.step);
    });
    assert.equal(trials, 4, "one for practice");
    assert.deepEqual(browser.errors, [], "the console is clean");

    const all = parse(mimique(["export", "--database", server.database, "--format", "csv"]));
    const [practised] = all.filter((row) => row.trial_type === "training");
    assert.deepEqual([practised.stimulus, practised.beside, practised.beside_side], ["joy2.recorded", "joy2.box", "right"]);
    assert.ok(Number(practised.rt) > 7_500, `in turn as well: ${practised.rt} ms`);
    const rows = all.filter((row) => row.trial_type === "trial" && row.response_id === "better");
    assert.equal(rows.length, 3);
    const pairs = rows.map((row) => [row.item_left, row.item_right].sort().join(" "));
    assert.deepEqual(pairs.sort(), ["box lsts", "box recorded", "lsts recorded"]);
    for (const row of rows) {
      assert.deepEqual([row.stimulus, row.beside, row.beside_side], [`joy2.${row.item_left}`, `joy2.${row.item_right}`, "right"]);
      assert.equal(row.cell, "joy2|head");
      const chosen = { left: row.item_left, right: row.item_right, same: "" }[row.answer];
      assert.equal(row.item_chosen, chosen);
      // One clip lasts 4 s.
      assert.ok(Number(row.rt) > 7_500, `both were played whole before the answer: ${row.rt} ms`);
    }
  } finally {
    await browser.close();
    await server.stop();
  }
});
