// The recipe of docs/guide/experiment-tools.md for lab.js, word by word, with lab.js itself.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { exportedClips } from "./lib/exported_clips.mjs";
import { packageHost, unpacked } from "./lib/package_host.mjs";
import { root } from "./lib/server.mjs";

const unable = skip(executable ? false : "Chromium not found");
const guide = readFileSync(join(root, "docs/guide/experiment-tools.md"), "utf8");
const recipe = /\n## lab\.js\n[^]*?\n```js\n([^]*?)```/.exec(guide)[1];
const page = `<!doctype html><html lang="en"><head><meta charset="utf-8"><title>lab.js</title>
<link rel="stylesheet" href="/node_modules/lab.js/dist/lab.css"><script src="/node_modules/lab.js/dist/lab.js"></script>
<script type="module" src="/node_modules/@mimique/stage/element.js"></script></head>
<body><div class="container fullscreen" data-labjs-section="main"></div>
<script type="module">${recipe}
window.rows = study.options.datastore.data;</script></body></html>`;

test("lab.js: the guide's recipe keeps response, time and frames of each clip", { skip: unable, timeout: 240_000 }, async () => {
  const { folder, clips } = exportedClips();
  const host = await packageHost({ "/site/": folder, ...unpacked }, { "/": page });
  const browser = await open("undrawn");
  try {
    const { page } = browser;
    await page.addInitScript(() => {
      window.answeredAt = [];
      addEventListener("keypress", (event) => answeredAt.push(event.timeStamp), true);
    });
    await page.goto(`${host.url}/?backend=webgl2`);
    await page.waitForSelector("mimique-stage[state=playing]", { timeout: 60_000 });
    await page.waitForTimeout(400);
    await page.keyboard.press("f");
    await page.waitForSelector("mimique-stage[clip='joy2.soft'][state=playing]", { timeout: 60_000 });
    await page.screenshot({ path: join(screenshotFolder("labjs"), "face.png") });
    await page.waitForSelector("mimique-stage[clip='joy2.soft'][state=ready]", { timeout: 60_000 });
    await page.keyboard.press("j");
    await page.waitForFunction(() => window.rows?.filter((row) => row.sender === "face").length === 2, null, { timeout: 30_000 });
    const [rows, answeredAt] = await page.evaluate(() => [rows.filter((row) => row.sender === "face"), answeredAt]);
    assert.deepEqual(rows.map(({ clip, response, aborted }) => [clip, response, aborted]), [["joy2.box", "joy", "answered"], ["joy2.soft", "anger", null]]);
    for (const [k, row] of rows.entries()) {
      assert.equal(row.provenance, clips[row.clip].provenance);
      assert.ok(Math.abs(row.rt + row.onset_ms - answeredAt[k]) < 0.5, `${row.rt} from ${row.onset_ms}, pressed at ${answeredAt[k]}`);
      const frames = JSON.parse(row.frames);
      assert.ok(frames.length > 3 && frames[0][0] === row.onset_ms);
    }
    assert.equal(rows[1].weights_hash, clips["joy2.soft"].weights_hash);
    assert.deepEqual(browser.errors, []);
  } finally {
    await browser.close();
    await host.close();
  }
});
