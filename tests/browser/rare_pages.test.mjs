// The pages that few people see, for everybody: the study that cannot be reached, a second tab, the question
// before a withdrawal, a clip that loads, fails and plays, the last answers on their way, and what stands
// there after declining and withdrawing. axe, and what a screen reader finds.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { looker } from "./lib/access.mjs";
import { badProxy } from "./lib/bad_proxy.mjs";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { go, leave, phase, place, steady } from "./lib/participant.mjs";
import { serve } from "./lib/server.mjs";
import { heard } from "./lib/snapshot.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

const scale = { type: "likert", numItems: 7, leftLabel: text("weak"), rightLabel: text("strong") };
const study = small("rare", {
  demographics: { title: text("About you"), questions: [{ id: "mood", prompt: text("How are you?"), ...scale }] },
  questions: [{ id: "rating", prompt: text("How strong?"), ...scale }],
  components: { faces: trials(["joy2.box"], ["rating"]) },
  sequence: { order: "fixed", components: ["faces"] },
  stimuli: stimuli({ head: { builtin: { seed: 1, vertices: 2000 } } }, { box: { method: "box" } }, [["head", "box"]]),
});

for (const [scheme, width, locale, forcedColors] of [
  ["light", 1280, "en-GB", "none"],
  ["dark", 320, "fr-FR", "none"],
  ["dark", 800, "en-GB", "active"],
]) {
  const colours = forcedColors === "active" ? `forced ${scheme}` : scheme;
  test(`access: pages that few see, ${colours}, ${width} px`, { skip: unable, timeout: 300_000 }, async () => {
    const folder = mkdtempSync(join(tmpdir(), "mimique-rare-"));
    writeFileSync(join(folder, "rare.json"), JSON.stringify(study));
    const server = await serve([join(folder, "rare.json")]);
    const proxy = await badProxy(server.url);
    const browser = await open("undrawn", { viewport: { width, height: 900 }, colorScheme: scheme, locale, forcedColors });
    const { page, context } = browser;
    const shots = screenshotFolder(`rare-${colours.replace(" ", "-")}-${width}`);
    const seen = [];
    const lookAt = async (where, name) => {
      await looker(where, shots).look(name);
      await heard(where, `${locale.slice(0, 2)}-${name}`);
      seen.push(name);
    };
    const look = (name) => lookAt(page, name);
    const address = `${proxy.url}/s/rare/?backend=webgl2`;
    const at = (view) => page.waitForSelector(`main[data-view=${view}]`, { timeout: 60_000 });
    const choose = () => page.locator("fieldset[data-question] label").first().click();
    const rule = (path, fate) => proxy.rule((_, url) => (url.includes(path) ? fate : undefined));
    try {
      rule("/api/studies/", "foreign 403");
      await page.goto(address);
      await at("failure");
      await look("failure");
      // Nothing of the clip comes as it was sent.
      const { clips } = await (await fetch(`${server.url}/api/studies/rare`)).json();
      const take = `/packs/${clips["joy2.box"].take}`;
      rule(take, "damaged");
      await page.locator("button.primary").click();

      await at("consent");
      await page.locator("[data-action=decline]").click();
      await at("declined");
      await look("declined");
      // Who has pressed the wrong button goes back.
      await page.locator("[data-action=back-to-consent]").click();
      await at("consent");
      await go(page, "mouse");

      await at("questions");
      await page.locator("[data-action=withdraw]").click();
      await page.waitForSelector("dialog[open]");
      await look("withdraw-dialog");
      // It stands in the middle of the window, whole.
      const box = await page.locator("dialog").boundingBox();
      const window = page.viewportSize();
      assert.ok(box.x >= 0 && box.y >= 0 && box.x + box.width <= window.width && box.y + box.height <= window.height, JSON.stringify(box));
      for (const [from, size, whole] of [[box.x, box.width, window.width], [box.y, box.height, window.height]])
        assert.ok(Math.abs(from + size / 2 - whole / 2) <= 2, `${JSON.stringify(box)} in ${JSON.stringify(window)}`);
      await page.locator("dialog button").first().click();
      assert.equal(await page.locator("dialog[open]").count(), 0);
      const second = await context.newPage();
      await second.goto(address);
      await second.waitForSelector("main[data-view=failure]", { timeout: 60_000 });
      await lookAt(second, "second-tab");
      await second.close();
      await choose();
      await go(page, "mouse");

      await at("trial");
      await phase(page, "failed", 60_000);
      // The longest pause between two tries is 4 s.
      await steady(() => proxy.counts.damaged, 5_000);
      await look("trial-failed");
      rule(take, "silent");
      await page.locator("[data-action=retry]").click();
      await phase(page, "loading");
      await page.waitForFunction(() => document.querySelector(".veil progress")?.value > 0);
      await page.locator(".veil progress").evaluate(async (bar) => {
        // Until no more of it comes.
        for (let before = -1; before < bar.value; await new Promise((done) => setTimeout(done, 1000))) before = bar.value;
      });
      await look("trial-loading");
      rule("/", undefined);
      await phase(page, "ready", 60_000);
      await go(page, "mouse");
      await phase(page, "playing");
      // The clip stands still, for as long as it is looked at.
      await page.evaluate(() => (window.requestAnimationFrame = () => 0));
      await look("trial-playing");
      await page.reload();
      await phase(page, "ready", 60_000);
      await go(page, "mouse");
      await phase(page, "answering", 60_000);
      await choose();

      // The receipt never comes.
      rule("/complete", "silent");
      const here = await place(page);
      await go(page, "mouse");
      assert.equal((await leave(page, here)).view, "receipt");
      await page.waitForFunction(() => document.querySelector("main progress").value === document.querySelector("main progress").max, undefined, { timeout: 30_000 });
      await look("receipt");
      await page.locator("[data-action=withdraw]").click();
      await page.locator("[data-action=withdraw-confirm]").click();
      await page.waitForSelector("main[data-confirmed=true]", { timeout: 60_000 });
      await look("withdrawn");
      assert.equal(seen.length, 9);
    } finally {
      await browser.close();
      await proxy.close();
      await server.stop();
    }
  });
}
