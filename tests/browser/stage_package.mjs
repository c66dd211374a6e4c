// The npm packages as pages of somebody else embed them: `node stage_package.mjs NODE_MODULES` (`cargo xtask package --check`
// runs it). The pages lie on a host of their own: a clip of `mimique serve` is solved and drawn, and the packages' own examples
// are opened and used.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { open, screenshotFolder } from "./lib/browser.mjs";
import { packageHost } from "./lib/package_host.mjs";
import { serve } from "./lib/server.mjs";

const page = `<!doctype html><html lang="en"><meta charset="utf-8"><title>Embedding</title>
<script type="importmap">{ "imports": { "@mimique/stage": "/node_modules/@mimique/stage/index.js" } }</script>
<canvas id="face"></canvas></html>`;
const shots = screenshotFolder("package");

const server = await serve(["study-config/demo.json"]);
const packs = mkdtempSync(join(tmpdir(), "mimique-packs-"));
const host = await packageHost({ "/packs/": packs, "/node_modules/": process.argv[2] }, { "/": page });
const browser = await open("webgl2");
try {
  await drawn();
  await exampleOfElement();
  await exampleOfPlugin();
  assert.deepEqual(browser.errors, [], "the console is clean");
} finally {
  await browser.close();
  await host.close();
  await server.stop();
}

/** A clip by the modules alone. */
async function drawn() {
  const { clips } = await (await fetch(`${server.url}/api/studies/demo`)).json();
  const [id, source] = Object.entries(clips)[0];
  for (const hash of [source.avatar, source.operators, source.take].filter(Boolean)) {
    writeFileSync(join(packs, hash), Buffer.from(await (await fetch(`${server.url}/packs/${hash}`)).arrayBuffer()));
  }
  await browser.page.goto(`${host.url}/`);
  const found = await browser.page.evaluate(
    async ([id, source]) => {
      const { openStage, prepareClip } = await import("@mimique/stage");
      const solved = await prepareClip(id, source);
      const stage = await openStage(document.getElementById("face"), { width: 320, height: 320, background: "#202020" });
      await stage.show(id, solved.duration_ms / 2);
      const log = await stage.play(id);
      return { solved, state: stage.state(), frames: log.frames.length, aborted: log.aborted };
    },
    [id, source],
  );
  assert.equal(found.solved.weights_hash, source.weights_hash, "the package's solver has other bits than the server");
  assert.deepEqual([found.state.backend, found.state.lost, found.aborted], ["webgl2", null, null]);
  assert.ok(found.frames > 3, `${found.frames} frames`);
  await browser.page.locator("#face").screenshot({ path: join(shots, "embedding.png") });
  console.log(`drawn in another page: clip ${id}, ${found.solved.frames} frames solved, ${found.frames} shown, ${found.solved.warnings.length} warnings`);
}

/** Two elements, solved of files and played in step. */
async function exampleOfElement() {
  const { page } = browser;
  await page.goto(`${host.url}/node_modules/@mimique/stage/example/index.html`);
  await page.getByRole("button", { name: "Play" }).click({ timeout: 120_000 });
  await page.waitForFunction(() => /^\d+ frames: [^]*"aborted": null/.test(document.getElementById("log").textContent), null, { timeout: 60_000 });
  await page.screenshot({ path: join(shots, "element.png") });
  console.log("example of the element: solved and played in step");
}

/** A timeline of jsPsych: the first trial is answered, the second one comes. */
async function exampleOfPlugin() {
  const { page } = browser;
  await page.goto(`${host.url}/node_modules/@mimique/jspsych-plugin/example/index.html`);
  await page.waitForSelector("button:enabled:text-is('joy')", { timeout: 120_000 });
  await page.getByRole("button", { name: "joy" }).click();
  await page.waitForFunction(() => document.querySelectorAll("#jspsych-content mimique-stage").length === 2, null, { timeout: 60_000 });
  await page.screenshot({ path: join(shots, "plugin.png") });
  console.log("example of the plugin: one trial answered, the next one shown");
}
