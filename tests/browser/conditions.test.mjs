// Conditions between participants: an address puts people into one, for good; one that the study does not have
// is refused on the first page. On the server and on a plain web host.

import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join } from "node:path";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { answer, go, leave, phase, place } from "./lib/participant.mjs";
import { savedBytes } from "./lib/saved.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");
const types = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm", ".json": "application/json" };
const condition = (id, ...components) => ({ id, conditional: true, order: "fixed", components });

/** A study of two conditions: one reads a hint first. Its file. */
function study() {
  const folder = mkdtempSync(join(tmpdir(), "mimique-conditions-"));
  const file = join(folder, "arms.json");
  const parts = {
    questions: [{ id: "rating", type: "likert", prompt: text("How strong?"), numItems: 7, leftLabel: text("weak"), rightLabel: text("strong") }],
    components: { hint: { type: "page", heading: text("A hint"), text: text("Look at the mouth.") }, faces: trials(["joy2.box"], ["rating"]) },
    sequence: { order: "fixed", components: [condition("hinted", "hint", "faces"), condition("plain", "faces")] },
    staticHosting: { download: true },
    stimuli: stimuli({ head: { builtin: { seed: 1, vertices: 2000 } } }, { box: { method: "box" } }, [["head", "box"]]),
  };
  writeFileSync(file, JSON.stringify(small("arms", parts)));
  return { folder, file };
}

/** Where somebody stands who has agreed. */
async function begin(page, address) {
  await page.goto(address);
  await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
  const here = await place(page);
  await go(page, "mouse");
  return (await leave(page, here)).view;
}

async function here(page, address) {
  await (address ? page.goto(address) : page.reload());
  await page.waitForSelector("main[data-step]", { timeout: 30_000 });
  return (await place(page)).view;
}

/** Goes on to the end. */
async function finish(page) {
  let at = await place(page);
  for (let guard = 0; at.view !== "end" && guard < 8; guard++) {
    if (at.view === "trial") {
      await phase(page, "ready", 120_000);
      await go(page, "mouse");
      await phase(page, "answering", 120_000);
      await answer(page, "mouse", at.step);
    }
    if (at.view !== "receipt") await go(page, "mouse");
    at = await leave(page, at, 60_000);
  }
}

const words = (page) => page.locator("main[data-view=failure]").innerText();

/** An address that names what there is not; then one that is right, in the same browser. */
async function refused(base) {
  const browser = await open("undrawn", {});
  try {
    for (const [language, sentence] of [
      ["en", "The address asks for the condition “Plain”; the study has: hinted, plain. Please write to whoever sent you the link."],
      ["fr", "L’adresse demande la condition «\u{a0}Plain\u{a0}»\u{a0}; l’étude a\u{a0}: hinted, plain. Écrivez à qui vous a envoyé le lien."],
    ]) {
      await browser.page.goto(`${base}?lang=${language}&condition=Plain`);
      await browser.page.waitForSelector("main[data-view=failure]", { timeout: 30_000 });
      const said = (await words(browser.page)).replaceAll(/[\u{a0}\u{202f}]/gu, "\u{a0}");
      assert.ok(said.includes(sentence), said);
    }
    assert.equal(await begin(browser.page, `${base}?backend=webgl2&condition=plain`), "trial");
  } finally {
    await browser.close();
  }
}

/** Somebody in each condition; nothing that the address says later changes it. */
async function both(base) {
  for (const [name, other, step] of [
    ["hinted", "plain", "page"],
    ["plain", "hinted", "trial"],
  ]) {
    const browser = await open("undrawn", {});
    const { page } = browser;
    try {
      const address = `${base}?backend=webgl2&condition=`;
      assert.equal(await begin(page, `${address}${name}`), step);
      assert.equal(await here(page), step, "after a reload");
      assert.equal(await here(page, `${address}${other}`), step, "under another address");
      assert.equal(await here(page, `${address}nonsense`), step, "under one of nothing");
      assert.equal(await here(page, base), step, "under one without");
      await finish(page);
      if (base.includes("/s/")) continue;
      const [download] = await Promise.all([page.waitForEvent("download"), page.locator("[data-action=download]").click()]);
      const head = JSON.parse(String(await savedBytes(download)).split("\n")[0]);
      assert.equal(head.started.condition, name);
    } finally {
      await browser.close();
    }
  }
}

test("conditions: two links, two conditions, each for good", { skip: unable, timeout: 240_000 }, async () => {
  const { file } = study();
  const server = await serve([file]);
  const base = `${server.url}/s/arms/`;
  try {
    await refused(base);
    await both(base);
    const ends = parse(mimique(["export", "--database", server.database])).filter((row) => row.status === "completed");
    assert.deepEqual([...new Set(ends.map((row) => row.assigned_condition))], ["hinted", "plain"]);
    assert.ok(ends.every((row) => row.trial_type !== "trial" || row.condition === row.assigned_condition));
    // Two are in "plain" (one on the way), one in "hinted": who comes by no condition's link goes there.
    const browser = await open("undrawn", {});
    try {
      assert.equal(await begin(browser.page, `${base}?backend=webgl2`), "page");
    } finally {
      await browser.close();
    }
  } finally {
    await server.stop();
  }
});

test("conditions: the same on a plain web host", { skip: unable, timeout: 240_000 }, async () => {
  const { folder, file } = study();
  const site = join(folder, "site");
  const pages = process.env.MIMIQUE_WEB_DIR ? ["--web-dir", process.env.MIMIQUE_WEB_DIR] : [];
  mimique(["export-site", file, "--out", site, "--packs", join(folder, "packs"), ...pages]);
  const host = createServer((request, answer) => {
    const path = new URL(request.url, "http://x").pathname;
    const found = join(site, path.endsWith("/") ? `${path}index.html` : path);
    if (!found.startsWith(site) || !existsSync(found)) return answer.writeHead(404).end();
    answer.writeHead(200, { "content-type": types[extname(found)] ?? "application/octet-stream" }).end(readFileSync(found));
  });
  await new Promise((done) => host.listen(0, "127.0.0.1", done));
  const base = `http://127.0.0.1:${host.address().port}/`;
  try {
    await refused(base);
    await both(base);
    // Nobody counts here: without a condition in the address one is drawn, and it stays.
    const browser = await open("undrawn", {});
    try {
      const step = await begin(browser.page, `${base}?backend=webgl2`);
      assert.ok(["page", "trial"].includes(step), step);
      assert.equal(await here(browser.page), step);
    } finally {
      await browser.close();
    }
  } finally {
    host.closeAllConnections();
    host.close();
  }
});
