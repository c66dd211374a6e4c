// The studio saves its workspace as a study: one archive that check and serve take as it is; its preview opens and
// plays the clips.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { mimique, preview, serve } from "./lib/server.mjs";
import { builtIn, download, fact, unfold, violations } from "./lib/studio.mjs";

const noBrowser = skip(!executable && "Chromium not found");

test("studio: saved as a study, previewed, checked and served", { skip: noBrowser }, async () => {
  const shown = await preview([]);
  const browser = await open("undrawn", { viewport: { width: 1440, height: 900 } });
  const { page, context, errors } = browser;
  const shots = screenshotFolder("studio-study");
  try {
    await builtIn(page, { url: shown.url });
    await page.click("#add-panel");
    await fact(page, "B", "Residual");

    // Nothing is marked: it is said, and nothing is saved nor opened.
    await unfold(page, "study");
    await page.click("#study-save");
    await page.locator("#problem", { hasText: "expressions: none is marked" }).waitFor();
    await page.click("#problem-away");

    await unfold(page, "expressions");
    await page.fill("#labels", "weak,strong");
    await page.click("#expressions-suggest");
    await page.waitForFunction(() => document.querySelectorAll("#segments tr").length > 3);
    // Three are enough.
    for (let rows = await page.locator("#segments tr").count(); rows > 3; rows--) await page.locator("#segments tr").last().locator("button").last().click();

    await page.fill("#study-name", "Faces of mine");
    await page.selectOption("#study-design", "identify-emotion");
    await page.check("#study-instrument-sus");
    assert.deepEqual(await violations(page), []);
    await page.screenshot({ path: join(shots, "pane.png") });
    const opened = context.waitForEvent("page");
    const archive = await download(page, () => page.click("#study-save"));
    const tab = await opened;
    await tab.waitForURL(/\/preview\/faces-of-mine$/, { timeout: 120_000 });
    assert.equal(await page.locator("#study-state a").getAttribute("href"), "/preview/faces-of-mine");
    await tab.locator("canvas").first().waitFor({ timeout: 60_000 });
    await tab.waitForTimeout(2000);
    await tab.screenshot({ path: join(shots, "preview.png") });

    // The archive is what check and serve take.
    const file = join(mkdtempSync(join(tmpdir(), "mimique-")), "faces.zip");
    writeFileSync(file, archive);
    const told = JSON.parse(mimique(["check", file, "--json"]));
    assert.deepEqual([told.ok, told.errors], [true, 0], JSON.stringify(told.issues));
    const server = await serve([file]);
    try {
      assert.match(server.said(), /"faces-of-mine"/);
      assert.equal((await fetch(`${server.url}/s/faces-of-mine/`)).status, 200);
      const bundle = await (await fetch(`${server.url}/api/studies/faces-of-mine`)).json();
      assert.equal(Object.keys(bundle.clips).length, 6, "three segments by two methods");
    } finally {
      await server.stop();
    }
    assert.deepEqual(errors, []);

    // In French and on a tablet.
    await page.setViewportSize({ width: 768, height: 1024 });
    await page.goto(`${shown.url}?lang=fr`);
    await page.click("#start-built-in");
    await page.waitForFunction(() => !document.querySelector("#tab-study").disabled, null, { timeout: 120_000 });
    await unfold(page, "study");
    await page.getByRole("button", { name: "Enregistrer comme étude (ZIP)" }).waitFor();
    assert.deepEqual(await violations(page), []);
  } finally {
    await browser.close();
    await shown.stop();
  }
});
