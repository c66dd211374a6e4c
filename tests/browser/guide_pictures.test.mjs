// The pictures of the guide: of docs/guide/first-study.md, whose own command makes its study, of the public head and take,
// which is served and looked at; of docs/guide/deposit.md, whose own commands make the folder. MIMIQUE_UPDATE_GOLDEN=1 writes the pictures anew; look at them before you keep them.

import assert from "node:assert/strict";
import { copyFileSync, cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { taken } from "./lib/guide_picture.mjs";
import { answer, go, leave, phase, place, settled } from "./lib/participant.mjs";
import { mimique, root, serve } from "./lib/server.mjs";

const data = process.env.MIMIQUE_DATA ?? join(root, "../shared/data");
const files = ["ict-facekit/ict-facekit.glb", "animface/JawMoCap.c3d", "animface/markers-ict-facekit.json"];
const absent = files.map((file) => join(data, file)).find((file) => !existsSync(file));
const unable = skip(!executable ? "Chromium not found" : absent && `real data not found: ${absent}`);

/** The study of the page, made by the page's command: its file. */
function pageStudy() {
  const folder = mkdtempSync(join(tmpdir(), "mimique-guide-"));
  mkdirSync(join(folder, "public"));
  for (const file of files) copyFileSync(join(data, file), join(folder, "public", basename(file)));
  const page = readFileSync(join(root, "docs/guide/first-study.md"), "utf8");
  const command = /^\$ mimique (new jaw .*)$/m.exec(page)[1];
  mimique(command.split(" "), { cwd: folder });
  return join(folder, "jaw/study.json");
}

test("guide: the pictures of the first study", { skip: unable, timeout: 600_000 }, async () => {
  const server = await serve([pageStudy()]);
  const browser = await open("webgl2", { viewport: { width: 960, height: 960 } });
  const { page } = browser;
  try {
    await page.goto(`${server.url}/preview/jaw?backend=webgl2`);
    await page.waitForFunction(() => document.querySelector("canvas")?.width > 0, null, { timeout: 120_000 });
    await page.waitForFunction(() => document.querySelector(".preview-clip")?.textContent.includes("frames"), null, { timeout: 120_000 });
    await settled(page);
    await taken(page, "first-study-preview.jpg");
    await page.goto(`${server.url}/s/jaw/?backend=webgl2`);
    await page.waitForSelector("main[data-view]", { timeout: 30_000 });
    let here = await place(page);
    while (here.view !== "trial") {
      if (here.view === "questions") await answer(page, "mouse", here.step);
      await go(page, "mouse");
      here = await leave(page, here, 60_000);
    }
    await phase(page, "ready", 120_000);
    await go(page, "mouse");
    await phase(page, "answering", 120_000);
    await settled(page);
    await taken(page, "first-study-trial.jpg");
    here = await place(page);
    await answer(page, "mouse", here.step);
    await go(page, "mouse");
    await leave(page, here, 60_000);
    assert.deepEqual(browser.errors, [], "the console is clean");
    const out = join(server.folder, "answers.csv");
    mimique(["export", "--database", server.database, "--format", "csv", "--out", out]);
    const rows = parse(readFileSync(out, "utf8")).filter((row) => row.stimulus);
    assert.equal(new Set(rows.map((row) => row.stimulus)).size, 1, "one trial is exported");
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("guide: the page of a deposit, on a wide screen, a phone, and in the dark", { skip: skip(!executable && "Chromium not found"), timeout: 300_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-deposit-"));
  cpSync(join(root, "study-config"), join(folder, "study-config"), { recursive: true });
  const text = readFileSync(join(root, "docs/guide/deposit.md"), "utf8");
  const [, simulate] = /^\$ mimique (simulate .*)$/m.exec(text);
  const [, deposit] = /^\$ mimique (deposit .* --drop start_time,end_time)$/m.exec(text);
  for (const command of [simulate, deposit]) {
    const words = [...command.matchAll(/"([^"]*)"|(\S+)/g)].map(([, quoted, word]) => quoted ?? word);
    mimique(words, { cwd: folder });
  }
  const address = pathToFileURL(join(folder, "deposit/ro-crate-preview.html")).href;
  const browser = await open("webgl2", { viewport: { width: 960, height: 800 } });
  const { page } = browser;
  try {
    await page.goto(address);
    await taken(page, "deposit-page.jpg");
    const links = await page.$$eval("main a:not([href^=https])", (all) => all.map((link) => link.getAttribute("href")));
    assert.ok(links.length > 30, `${links.length} files`);
    for (const link of links) assert.ok(existsSync(join(folder, "deposit", decodeURIComponent(link))), link);
    await page.setViewportSize({ width: 360, height: 740 });
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= 360, `${wide} px on a phone`);
    const shots = screenshotFolder("guide");
    await page.screenshot({ path: join(shots, "deposit-phone.png") });
    await page.emulateMedia({ colorScheme: "dark" });
    await page.screenshot({ path: join(shots, "deposit-dark.png") });
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
  }
});
