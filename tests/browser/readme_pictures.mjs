// Makes the pictures of README.md in docs/: the animation of a trial (trial.webp) and the beginning of a report.
//
//   MIMIQUE_BINARY=target/release/mimique node readme_pictures.mjs        (needs img2webp of Debian's package webp)
//
// Look at them before you commit them.

import { execFileSync } from "node:child_process";
import { mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { open } from "./lib/browser.mjs";
import { answer, go, leave, phase, place, settled } from "./lib/participant.mjs";
import { mimique, root, serve } from "./lib/server.mjs";

const folder = mkdtempSync(join(tmpdir(), "mimique-readme-"));
const docs = join(root, "docs");
const only = process.argv.slice(2);
const wanted = (name) => only.length === 0 || only.includes(name);
const STEP_MS = 100;

/** A trial, first the clip and then the answers, in steps of the page's own clock: the machine's speed does not show. */
async function trial(page, server) {
  await page.goto(`${server.url}/s/demo/?backend=webgl2`);
  await page.waitForSelector("main[data-view]", { timeout: 60_000 });
  let here = await place(page);
  while (here.view !== "trial") {
    if (here.view === "questions") await answer(page, "mouse", here.step);
    await go(page, "mouse");
    here = await leave(page, here, 60_000);
  }
  await phase(page, "ready", 120_000);
  const frames = [];
  const frame = async (ms) => {
    const path = join(folder, `frame-${String(frames.length).padStart(3, "0")}.png`);
    await page.screenshot({ path });
    frames.push("-d", String(ms), path);
  };
  await frame(600);
  await page.clock.install();
  await page.clock.pauseAt(new Date(Date.now() + 60_000));
  await page.locator("button.primary:not([disabled])").first().click();
  for (let step = 0; step < 120; step++) {
    await page.clock.runFor(STEP_MS);
    await frame(STEP_MS);
    if ((await place(page)).phase === "answering") break;
  }
  await page.clock.resume();
  await settled(page);
  await frame(800);
  const questions = page.locator("fieldset[data-question]");
  for (let at = 0; at < (await questions.count()); at++) {
    await questions.nth(at).locator("label:has(input)").nth(1 + at).click();
    await frame(700);
  }
  await frame(1500);
  execFileSync("img2webp", ["-loop", "0", "-lossy", "-q", "60", "-m", "6", ...frames, "-o", join(docs, "trial.webp")]);
}

async function shot(page, name) {
  await settled(page);
  await page.screenshot({ path: join(docs, name), type: "jpeg", quality: 80 });
}

if (wanted("trial")) {
  const server = await serve(["study-config/demo.json"]);
  const browser = await open("webgl2", { viewport: { width: 880, height: 620 } });
  await trial(browser.page, server);
  await browser.close();
  await server.stop();
}
if (wanted("report")) {
  mimique(["simulate", "study-config/demo.json", "--participants", "40", "--out", join(folder, "simulated")]);
  mimique(["analyze", join(folder, "simulated/demo_responses.csv"), "--study", "study-config/demo.json", "--out", join(folder, "report")]);
  const browser = await open("webgl2", { viewport: { width: 1100, height: 760 } });
  await browser.page.goto(pathToFileURL(join(folder, "report/report.html")).href);
  await shot(browser.page, "report.jpg");
  await browser.close();
}
