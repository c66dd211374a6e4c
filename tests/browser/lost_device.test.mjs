// The graphics device is lost while a clip of a study plays: the page says so, the clip is played again,
// whole, and the export counts the interruption.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { go, phase } from "./lib/participant.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { SMALL_LOOK, small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

const study = small("lost", {
  questions: [{ id: "rating", type: "likert", prompt: text("How strong?"), numItems: 7, leftLabel: text("weak"), rightLabel: text("strong") }],
  components: { faces: trials(["joy2.box"], ["rating"]) },
  sequence: { order: "fixed", components: ["faces"] },
  stimuli: { ...stimuli({ head: { builtin: { seed: 1, vertices: 2000 } } }, { box: { method: "box" } }, [["head", "box"]]), look: SMALL_LOOK },
});

/** As a driver that crashes: the context goes, and comes back a moment later. */
const lose = {
  webgl2: () => {
    const context = document.querySelector(".stage canvas").getContext("webgl2");
    const extension = context.getExtension("WEBGL_lose_context");
    extension.loseContext();
    setTimeout(() => extension.restoreContext(), 300);
  },
  webgpu: () => window.devices.forEach((device) => device.destroy()),
};

for (const backend of ["webgl2", "webgpu"]) {
  test(`lost device: in the middle of a clip, ${backend}`, { skip: unable, timeout: 240_000 }, async () => {
    const folder = mkdtempSync(join(tmpdir(), "mimique-lost-"));
    writeFileSync(join(folder, "lost.json"), JSON.stringify(study));
    const server = await serve([join(folder, "lost.json")]);
    const browser = await open(backend, { viewport: { width: 700, height: 800 } });
    const { page } = browser;
    try {
      // The devices that the page asks for, so that the one that draws can be taken from it.
      await page.addInitScript(() => {
        window.devices = [];
        const ask = globalThis.GPUAdapter?.prototype.requestDevice;
        if (!ask) return;
        GPUAdapter.prototype.requestDevice = async function (...wish) {
          const device = await ask.apply(this, wish);
          window.devices.push(device);
          return device;
        };
      });
      await page.goto(`${server.url}/s/lost/?backend=${backend}`);
      await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
      await go(page, "mouse");
      await phase(page, "ready", 120_000);
      assert.equal(/interrupted/.test(await page.locator(".trial-message").innerText()), false);
      await go(page, "mouse");
      await phase(page, "playing");
      await page.waitForTimeout(400);
      await page.evaluate(lose[backend]);

      await phase(page, "ready", 60_000);
      assert.match(await page.locator(".trial-message").innerText(), /The clip was interrupted\. Please play it again\./);
      assert.equal(await page.locator("fieldset[data-question]").count(), 0, "nothing is asked of half a clip");
      await go(page, "mouse");
      await phase(page, "answering", 60_000);
      await page.locator("fieldset[data-question] label").nth(3).click();
      await go(page, "mouse");
      await page.waitForSelector("main[data-view=end]", { timeout: 60_000 });

      const csv = join(server.folder, "export.csv");
      mimique(["export", "--database", server.database, "--out", csv]);
      const [row, ...more] = parse(readFileSync(csv, "utf8")).filter(({ trial_type }) => trial_type === "trial");
      assert.deepEqual(more, []);
      assert.deepEqual([row.interruptions, row.answer, row.status, row.backend], ["1", "4", "completed", backend]);
    } finally {
      await browser.close();
      await server.stop();
    }
  });
}
