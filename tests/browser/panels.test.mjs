// A panel: a reference and three clips in step on one page, each rated by a slider, one of them played again alone; what
// the export says of each. Clips in turn come one after the other.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { violations } from "./lib/access.mjs";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { go, leave, phase, storedEvents, tabTo, toFirstTrial, until } from "./lib/participant.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { small, stimuli, text } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

const study = (id, show) => small(id, {
  questions: [{ id: "faithful", type: "slider", prompt: text("How faithful?"), minimum: 0, maximum: 100, leftLabel: text("not"), rightLabel: text("exactly") }],
  components: { quality: { type: "panel", question: "faithful", reference: "recorded", anchor: "slow", maximumReplays: 1, show } },
  sequence: { order: "random", components: ["quality"] },
  stimuli: stimuli(
    { head: { builtin: { seed: 1 } } },
    { lsts: { method: "lsts" }, recorded: { method: "recorded" }, slow: { method: "recorded", lowpassHz: 2, factors: { method: "slow" } } },
    [["head", "lsts"], ["head", "recorded"], ["head", "slow"]],
  ),
});

const SIZES = { inStep: { width: 1280, height: 800 }, inTurn: { width: 390, height: 844 } };

for (const show of ["inStep", "inTurn"]) {
  test(`panels: a reference and its clips, ${show}`, { skip: unable, timeout: 400_000 }, async () => {
    const folder = mkdtempSync(join(tmpdir(), "mimique-panel-"));
    writeFileSync(join(folder, "quality.json"), JSON.stringify(study("quality", show)));
    const server = await serve([join(folder, "quality.json")]);
    const browser = await open("undrawn", { viewport: SIZES[show], colorScheme: show === "inTurn" ? "dark" : "light", locale: show === "inTurn" ? "fr-FR" : "en-GB" });
    const shots = screenshotFolder("panels");
    const { page } = browser;
    try {
      let here = await toFirstTrial(page, `${server.url}/s/quality/?backend=webgl2`);
      const captions = await page.locator(".stage-frame.panel figcaption").allTextContents();
      assert.deepEqual(captions, [show === "inTurn" ? "Référence" : "Reference", "A", "B", "C"]);
      assert.equal(await page.locator("input[type=range]").count(), 0, "nothing can be rated before the play");
      await page.evaluate(() => {
        // Which clips wait, at every change.
        window.turns = [];
        const canvases = [...document.querySelectorAll(".stage-frame.panel canvas")];
        const note = () => window.turns.push(canvases.map((canvas) => (canvas.hasAttribute("data-waiting") ? "-" : "x")).join(""));
        const seen = new MutationObserver(note);
        for (const canvas of canvases) seen.observe(canvas, { attributes: true, attributeFilter: ["data-waiting"] });
      });
      await go(page, "keyboard");
      await phase(page, "playing");
      await page.screenshot({ path: join(shots, `${show}-playing.png`) });
      await phase(page, "answering", 120_000);
      const turns = await page.evaluate(() => [...new Set(window.turns)]);
      if (show === "inTurn") {
        const alone = turns.filter((turn) => turn.replaceAll("-", "") === "x");
        assert.deepEqual(alone, ["x---", "-x--", "--x-", "---x"], "one after the other");
      } else {
        assert.deepEqual(turns, [], "none waits");
      }

      // Sending is refused until each is rated.
      await go(page, "keyboard");
      assert.equal(await page.locator("fieldset[data-invalid]").count(), 3);
      // B alone, once: then no replay is left.
      const second = page.locator(".panel-row").nth(1).locator("button");
      await tabTo(page, ".panel-row:nth-of-type(3) button");
      await page.keyboard.press("Enter");
      await phase(page, "playing");
      assert.ok(await page.locator("input[type=range]").first().isDisabled(), "nothing is rated while a clip plays");
      await phase(page, "answering", 60_000);
      assert.equal(await second.getAttribute("aria-disabled"), "true");

      const questions = page.locator("fieldset[data-question]");
      assert.equal(await questions.count(), 3);
      const rated = [];
      for (let at = 0; at < 3; at++) {
        const slider = questions.nth(at).locator("input[type=range]");
        await slider.focus();
        for (let presses = 0; presses <= at; presses++) await page.keyboard.press("ArrowRight");
        rated.push(Number(await slider.inputValue()));
      }
      assert.deepEqual(rated, [51, 52, 53]);
      await page.screenshot({ path: join(shots, `${show}-rated.png`), fullPage: true });
      assert.deepEqual(await violations(page), [], "axe");
      await until("the ratings are stored", async () =>
        (await storedEvents(page, server, "quality")).filter(({ type }) => type === "answered").length === 6);
      await go(page, "keyboard");
      here = await leave(page, here, 60_000);
      while (here.view !== "end") {
        if (here.view !== "receipt") await go(page, "keyboard");
        here = await leave(page, here, 60_000);
      }
      assert.deepEqual(browser.errors, [], "the console is clean");

      const rows = parse(mimique(["export", "--database", server.database, "--format", "csv"])).filter((row) => row.trial_type === "trial");
      assert.equal(rows.length, 3);
      const { panel } = (await storedEvents(page, server, "quality").catch(() => [])).find(({ type }) => type === "trial_started") ?? {};
      if (panel) assert.deepEqual(rows.map((row) => row.stimulus), panel);
      assert.deepEqual(rows.map((row) => row.panel_condition).sort(), ["lsts", "recorded", "slow"]);
      const roles = { lsts: "condition", recorded: "reference", slow: "anchor" };
      const hashes = new Set(rows.map((row) => row.weights_hash));
      assert.equal(hashes.size, 3, "three clips, three faces");
      rows.forEach((row, at) => {
        assert.equal(row.trial_id, "quality/joy2|head");
        assert.equal(row.stimulus, `joy2.${row.panel_condition}`);
        assert.equal(row.panel_role, roles[row.panel_condition]);
        assert.deepEqual([row.panel_place, row.response_id, row.answer], [String(at + 1), "faithful", String(rated[at])]);
        assert.equal(row.panel_replays, at === 1 ? "1" : "0");
        assert.ok(row.provenance.length === 64 && row.weights_hash.length === 64);
        // One clip lasts 4 s; four of them in turn 16 s.
        assert.ok(Number(row.rt) > (show === "inTurn" ? 15_500 : 3_800), `seen whole before: ${row.rt} ms`);
      });
    } finally {
      await browser.close();
      await server.stop();
    }
  });
}
