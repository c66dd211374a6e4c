// A smoke run of the built-in study in Debian's Firefox: from consent through two trials, answers
// stored, weights of the same bits. Safari is untested.

import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { screenshotFolder, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { firefox, openFirefox } from "./lib/firefox.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { withSmallClips } from "./lib/small_study.mjs";

const unable = skip(!firefox && "Firefox not found");
const here = `(() => { const main = document.querySelector("main[data-view]"); return main && { ...main.dataset }; })()`;

test("firefox: the demo from consent through two trials", { skip: unable, timeout: 300_000 }, async (context) => {
  const server = await serve([withSmallClips("study-config/demo.json")]);
  const browser = await openFirefox();
  const shots = screenshotFolder("firefox");
  const until = async (what, holds, ms = 120_000) => {
    const deadline = Date.now() + ms;
    for (;;) {
      const now = await browser.evaluate(here);
      if (now && holds(now)) return now;
      if (now?.phase === "failed" || Date.now() > deadline) {
        const said = await browser.evaluate(`[...document.querySelectorAll(".notice")].map((each) => each.textContent).join("; ")`);
        throw new Error(`${what}: ${JSON.stringify(now)}; ${said}; ${browser.errors.join("; ")}`);
      }
      await new Promise((done) => setTimeout(done, 200));
    }
  };
  const press = (selector) => browser.evaluate(`document.querySelector(${JSON.stringify(selector)}).click()`);
  const answers = `(async () => {
    for (const question of document.querySelectorAll("fieldset[data-question]")) {
      const radio = question.querySelector("input[type=radio]");
      if (radio) radio.click();
      for (const field of question.querySelectorAll("input[type=number]")) {
        field.value = "30";
        field.dispatchEvent(new Event("input", { bubbles: true }));
        field.dispatchEvent(new Event("change", { bubbles: true }));
      }
      await new Promise(requestAnimationFrame);
    }
  })()`;
  try {
    await browser.goto(`${server.url}/s/demo/`);
    await until("consent", (page) => page.view === "consent");
    await browser.screenshot(join(shots, "consent.png"));
    await press("[data-action=agree]");
    const draws = await browser.evaluate(`document.createElement("canvas").getContext("webgl2") !== null`);
    if (!draws) {
      // Of this machine's Firefox the device gate can only say why not.
      await until("the gate", (now) => now.view === "device");
      assert.match(await browser.evaluate("document.querySelector('main').textContent"), /cannot draw the animations/);
      assert.deepEqual(browser.errors, [], "the console is clean");
      if (process.env.MIMIQUE_NO_SKIP === "1") throw new Error("may not skip: Firefox has no WebGL2 here; install Xvfb and Mesa");
      return context.skip("SKIPPED from the gate on: Firefox has no WebGL2 here");
    }
    let trials = 0;
    for (let guard = 0; trials < 2 && guard < 12; guard++) {
      let page = await until("a page", (now) => now.view && !["consent", "opening", "device"].includes(now.view));
      if (page.view === "trial") {
        page = await until("ready", (now) => now.phase === "ready");
        await press("[data-action=play]");
        await until("answering", (now) => now.phase === "answering");
        await browser.screenshot(join(shots, `trial-${++trials}.png`));
      }
      await browser.evaluate(answers);
      await press("[data-action=next]");
      await until("the next page", (now) => now.step !== page.step);
    }
    assert.equal(trials, 2);
    const bundle = await (await fetch(`${server.url}/api/studies/demo`)).json();
    const deadline = Date.now() + 20_000;
    let rows = [];
    while (rows.length < 6 && Date.now() < deadline) {
      rows = parse(mimique(["export", "--database", server.database, "--format", "csv"])).filter((row) => row.trial_type === "trial");
      await new Promise((done) => setTimeout(done, 500));
    }
    assert.equal(rows.length, 6, "two trials, three questions");
    for (const row of rows) {
      assert.match(row.browser, /Firefox/);
      assert.equal(row.weights_hash, bundle.clips[row.stimulus].weights_hash, "the same bits as the server's");
      assert.ok(Number(row.frames) > 1, "frames are logged");
    }
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});
