// Somebody who has taken part follows the last page to where its withdrawal code deletes the answers.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { answer, go, leave, phase, place } from "./lib/participant.mjs";
import { serve } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(executable ? false : "Chromium not found");

const study = small("leaving", {
  questions: [{ id: "rating", type: "likert", prompt: text("How strong?"), numItems: 7, leftLabel: text("weak"), rightLabel: text("strong") }],
  components: { faces: trials(["joy2.box"], ["rating"]) },
  sequence: { order: "fixed", components: ["faces"] },
  stimuli: stimuli({ head: { builtin: { seed: 1, vertices: 2000 } } }, { box: { method: "box" } }, [["head", "box"]]),
});

test("withdrawal: the last page's code deletes the answers, in French", { skip: unable, timeout: 120_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-withdrawal-"));
  writeFileSync(join(folder, "leaving.json"), JSON.stringify(study));
  const server = await serve([join(folder, "leaving.json")]);
  const browser = await open("undrawn", { locale: "fr-FR" });
  const { page } = browser;
  try {
    await page.goto(`${server.url}/s/leaving/?backend=webgl2`);
    await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
    let here = await place(page);
    await go(page, "mouse");
    here = await leave(page, here);
    await phase(page, "ready");
    await go(page, "mouse");
    await phase(page, "answering");
    await answer(page, "mouse", here.step);
    await go(page, "mouse");
    await page.waitForSelector("main[data-view=end]", { timeout: 30_000 });
    const code = await page.locator("[data-code=withdrawal]").textContent();
    const number = await page.locator("[data-code=participant]").textContent();
    await page.getByRole("link", { name: "Faire effacer mes réponses avec ce code" }).click();
    await page.getByLabel("Code de retrait").fill(code);
    await page.getByRole("button", { name: "Effacer mes réponses" }).click();
    const said = page.locator("[role=status]");
    await said.waitFor();
    assert.equal(await said.innerText(), `Vos réponses (participant ${number}) ont été effacées.`);
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});
