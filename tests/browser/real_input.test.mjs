// Real motion capture on a real head: two trials of the AnimFace study, screenshots kept to be
// looked at.

import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { answer, go, leave, phase, place, until } from "./lib/participant.mjs";
import { mimique, root, serve } from "./lib/server.mjs";
import { withSmallClips } from "./lib/small_study.mjs";

const study = withSmallClips("study-config/animface.json");
const data = process.env.MIMIQUE_DATA ?? join(root, "../shared/data");
const head = join(data, "ict-facekit/ict-facekit.glb");
const unable = skip(!executable ? "Chromium not found" : !existsSync(head) && `real data not found: ${head}`);

for (const backend of ["webgl2", "webgpu"]) {
  test(`real input: two trials on ICT-FaceKit, ${backend}`, { skip: unable, timeout: 600_000 }, async () => {
    const server = await serve([study]);
    const browser = await open(backend);
    const shots = screenshotFolder(`real-input-${backend}`);
    const { page } = browser;
    try {
      const { id } = (await (await fetch(`${server.url}/api/studies`)).json())[0];
      await page.goto(`${server.url}/s/${id}/?backend=${backend}`);
      await page.waitForSelector("main[data-view]", { timeout: 30_000 });
      let here = await place(page);
      for (let trials = 0; trials < 2; ) {
        if (here.view === "trial") {
          trials += 1;
          await phase(page, "ready", 120_000);
          await page.locator(".stage canvas").screenshot({ path: join(shots, `${trials}-neutral.png`) });
          await go(page, "mouse");
          await phase(page, "playing");
          for (const at of [800, 1600, 2400]) {
            await page.waitForTimeout(800);
            await page.locator(".stage canvas").screenshot({ path: join(shots, `${trials}-${at}.png`) });
          }
          await phase(page, "answering", 120_000);
          here = await place(page);
        }
        if (here.view === "trial" || here.view === "questions") await answer(page, "mouse", here.step);
        await go(page, "mouse");
        here = await leave(page, here, 60_000);
      }
      assert.deepEqual(browser.errors, [], "the console is clean");
      // The page goes on while its answers are on their way.
      let csvRows = [];
      await until("two trials are stored", () => {
        csvRows = parse(mimique(["export", "--database", server.database, "--format", "csv"])).filter((row) => row.stimulus);
        return new Set(csvRows.map((row) => row.stimulus)).size === 2;
      });
      assert.ok(csvRows.every((row) => /^[0-9a-f]{64}$/.test(row.weights_hash)));
    } finally {
      await browser.close();
      await server.stop();
    }
  });
}
