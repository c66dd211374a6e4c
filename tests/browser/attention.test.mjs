// What the log says of attention: the page hidden and back, the window left and entered, the full screen
// left by Escape; each once, in order.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { go, leave, phase, place, storedEvents } from "./lib/participant.mjs";
import { serve } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

const study = small("attention", {
  device: { fullscreen: "required" },
  questions: [{ id: "rating", type: "likert", prompt: text("How strong?"), numItems: 7, leftLabel: text("weak"), rightLabel: text("strong") }],
  components: { faces: trials(["joy2.box"], ["rating"]) },
  sequence: { order: "fixed", components: ["faces"] },
  stimuli: stimuli({ head: { builtin: { seed: 1, vertices: 2000 } } }, { box: { method: "box" } }, [["head", "box"]]),
});

test("attention: hidden pages, the window's focus and the full screen are in the log", { skip: unable, timeout: 180_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-attention-"));
  writeFileSync(join(folder, "attention.json"), JSON.stringify(study));
  const server = await serve([join(folder, "attention.json")]);
  const browser = await open("undrawn", { viewport: { width: 900, height: 800 } });
  const { page } = browser;
  const log = async () => {
    const events = await storedEvents(page, server, "attention");
    const said = { focus_lost: "lost", focus_gained: "gained", fullscreen: "full" };
    return events.filter(({ type }) => type in said).map(({ type, on }) => said[type] + (on === false ? " no more" : ""));
  };
  const logged = async (wanted) => {
    for (const deadline = Date.now() + 15_000; (await log()).length < wanted.length && Date.now() < deadline; ) await page.waitForTimeout(200);
    assert.deepEqual(await log(), wanted);
  };
  // Another tab before this one: the window keeps the focus, the page is hidden.
  const hide = (hidden) =>
    page.evaluate((hidden) => {
      Object.defineProperty(document, "hidden", { configurable: true, get: () => hidden });
      document.dispatchEvent(new Event("visibilitychange"));
    }, hidden);
  try {
    await page.goto(`${server.url}/s/attention/?backend=webgl2`);
    await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
    const here = await place(page);
    await go(page, "mouse");
    assert.equal((await leave(page, here)).view, "device");
    await hide(true);
    // Some browsers take the focus away, too: that is the same absence.
    await page.evaluate(() => window.dispatchEvent(new Event("blur")));
    await hide(false);
    await page.evaluate(() => window.dispatchEvent(new Event("blur")));
    await page.evaluate(() => window.dispatchEvent(new Event("focus")));
    const focus = ["lost", "gained", "lost", "gained"];
    // Before the session nothing is kept, here or on the server; it begins with what happened before.
    const kept = () => page.evaluate(async () => [localStorage.length, (await indexedDB.databases()).length]);
    assert.deepEqual(await kept(), [0, 0]);

    await page.waitForSelector("main[data-fine=true]");
    await page.locator("[data-action=next]").click();
    await phase(page, "ready", 120_000);
    await logged([...focus, "full"]);
    await page.evaluate(() => document.exitFullscreen());
    await logged([...focus, "full", "full no more"]);
    // The clip waits until the page fills the screen again.
    assert.match(await page.locator(".trial-message").innerText(), /full screen/);
    await page.locator("[data-action=play]").click();
    await logged([...focus, "full", "full no more", "full"]);
  } finally {
    await browser.close();
    await server.stop();
  }
});
