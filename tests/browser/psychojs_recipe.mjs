// The recipe of docs/guide/experiment-tools.md for PsychoJS, word by word: `node psychojs_recipe.mjs PSYCHOJS PRELOADJS` with its
// library, one file as its releases have it (psychojs-2024.2.0.js), which npm does not have, and PreloadJS, which it asks for.
// Run by hand.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { open, screenshotFolder } from "./lib/browser.mjs";
import { exportedClips } from "./lib/exported_clips.mjs";
import { packageHost, unpacked } from "./lib/package_host.mjs";
import { root } from "./lib/server.mjs";

const guide = readFileSync(join(root, "docs/guide/experiment-tools.md"), "utf8");
const recipe = /\n## PsychoJS\n[^]*?\n```js\n([^]*?)```/.exec(guide)[1];
const page = `<!doctype html><html lang="en"><head><meta charset="utf-8"><title>PsychoJS</title>
<script src="/preloadjs.js"></script>
<script type="module" src="/node_modules/@mimique/stage/element.js"></script></head><body><div id="root"></div>
<script type="module">
import { core, util } from "/psychojs.js";
const { PsychoJS } = core, { Scheduler } = util;
await customElements.whenDefined("mimique-stage");
${recipe}
const psychoJS = new PsychoJS({ debug: true, collectIP: false });
psychoJS.openWindow({ fullscr: false, color: new util.Color("black"), units: "height" });
const flowScheduler = new Scheduler(psychoJS);
psychoJS.schedule(flowScheduler);
for (const part of faceRoutine(psychoJS, "joy2.box", ["f", "j"])) flowScheduler.add(part);
for (const part of faceRoutine(psychoJS, "joy2.soft", ["f", "j"])) flowScheduler.add(part);
flowScheduler.add(() => ((window.rows = psychoJS.experiment._trialsData), Scheduler.Event.FLIP_REPEAT));
psychoJS.start({ expName: "faces", expInfo: {}, resources: [] });
</script></body></html>`;

const { folder, clips } = exportedClips();
const host = await packageHost({ "/site/": folder, ...unpacked }, { "/": page, "/psychojs.js": readFileSync(process.argv[2]), "/preloadjs.js": readFileSync(process.argv[3]) });
const browser = await open("webgl2");
try {
  const { page } = browser;
  await page.addInitScript(() => {
    window.answeredAt = [];
    addEventListener("keydown", (event) => answeredAt.push(event.timeStamp), true);
  });
  await page.goto(`${host.url}/?backend=webgl2`);
  // Its own dialogue stands until resources are there.
  await page.waitForSelector("mimique-stage[clip='joy2.box'][state=playing]", { timeout: 60_000 });
  await page.waitForTimeout(500);
  await page.screenshot({ path: join(screenshotFolder("psychojs"), "face.png") });
  await page.keyboard.press("f");
  await page.waitForSelector("mimique-stage[clip='joy2.soft'][state=playing]", { timeout: 60_000 });
  await page.waitForSelector("mimique-stage[clip='joy2.soft'][state=ready]", { timeout: 60_000 });
  await page.keyboard.press("j");
  await page.waitForFunction(() => window.rows?.length === 2, null, { timeout: 30_000 });
  const [rows, answeredAt] = await page.evaluate(() => [rows, answeredAt]);
  assert.deepEqual(rows.map(({ clip, response, aborted, error }) => [clip, response, aborted, error]), [["joy2.box", "f", "answered", ""], ["joy2.soft", "j", "", ""]]);
  for (const [k, row] of rows.entries()) {
    assert.equal(row.provenance, clips[row.clip].provenance);
    assert.ok(Math.abs(row.rt + row.onset_ms - answeredAt[k]) < 0.5);
    assert.ok(JSON.parse(row.frames).length > 3);
  }
  console.log(`PsychoJS: ${rows.map(({ clip, response, rt }) => `${clip} ${response} after ${rt.toFixed(1)} ms`).join(", ")}`);
} finally {
  if (browser.errors.length > 0) console.error(browser.errors);
  await browser.close();
  await host.close();
}
