// An active schedule of pairs: the first half is dealt, the second follows from all answers so far, those of others among
// them; a reload keeps the batch.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { go, phase, place, storedEvents, through } from "./lib/participant.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { small, stimuli, text } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

const PAIRS = 6;

const study = small("active", {
  seed: 3,
  questions: [{ id: "better", type: "comparison", prompt: text("Which is better?") }],
  components: { duels: { type: "pairs", question: "better", schedule: { rule: "active", perParticipant: PAIRS } } },
  sequence: { order: "fixed", components: ["duels"] },
  stimuli: stimuli(
    { head: { builtin: { seed: 1 } } },
    { box: { method: "box" }, lsts: { method: "lsts" }, recorded: { method: "recorded" } },
    [["head", "box"], ["head", "lsts"], ["head", "recorded"]],
  ),
});

// Somebody goes through the study and always chooses the left clip.
async function takePart(server, reloads) {
  const browser = await open("undrawn", { viewport: { width: 1000, height: 800 } });
  const { page } = browser;
  const asked = [];
  page.on("request", (request) => asked.push(new URL(request.url()).pathname));
  try {
    let drawn = [];
    const trials = await through(page, `${server.url}/s/active/?backend=webgl2`, async (here, number) => {
      if (reloads && number === PAIRS) {
        await page.reload();
        await page.waitForSelector("main[data-view=trial]", { timeout: 30_000 });
        assert.equal((await place(page)).step, here.step, "the same trial");
        await phase(page, "ready", 120_000);
      }
      await go(page, "keyboard");
      await phase(page, "answering", 120_000);
      await page.locator("fieldset[data-question=better] label:has(input[value=left])").click();
      drawn = (await storedEvents(page, server, "active")).filter(({ type }) => type === "pairs_drawn");
    });
    assert.equal(trials, PAIRS);
    assert.deepEqual(browser.errors, [], "the console is clean");
    assert.equal(asked.filter((path) => path.endsWith("/pairs/duels")).length, drawn.length, "the server is asked once a batch");
    return drawn;
  } finally {
    await browser.close();
  }
}

test("active pairs: batches follow from one's own answers and those of others", { skip: unable, timeout: 600_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-active-"));
  writeFileSync(join(folder, "active.json"), JSON.stringify(study));
  const server = await serve([join(folder, "active.json")]);
  try {
    const first = await takePart(server, true);
    const second = await takePart(server, false);
    // Three levels make trees of two pairs: three pairs that follow from answers are two batches.
    assert.deepEqual(first.map(({ batch, pairs, answers }) => [batch, pairs.length, answers]), [[1, 2, 3], [2, 1, 5]]);
    assert.deepEqual(second.map(({ batch, answers }) => [batch, answers]), [[1, PAIRS + 3], [2, PAIRS + 5]], "the first person's answers count");
    assert.equal(new Set([...first, ...second].map(({ hash }) => hash)).size, 4);
    const rows = parse(mimique(["export", "--database", server.database, "--format", "csv"])).filter((row) => row.trial_type === "trial");
    assert.equal(rows.length, 2 * PAIRS);
    for (const [at, drawn] of [first, second].entries()) {
      const own = rows.slice(at * PAIRS, (at + 1) * PAIRS);
      assert.deepEqual(own.map((row) => row.batch), ["", "", "", "1", "1", "2"]);
      const shown = own.slice(3).map((row) => [row.stimulus, row.beside]);
      assert.deepEqual(shown, drawn.flatMap(({ pairs }) => pairs));
      for (const row of own) {
        assert.equal(row.item_chosen, row.item_left, "the left one is always chosen");
        assert.equal(row.beside_side, "right");
        assert.notEqual(row.item_left, row.item_right);
      }
    }
  } finally {
    await server.stop();
  }
});
