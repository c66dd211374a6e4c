// What happens to a participant in the middle when the server is killed, when it comes back with a
// changed study, and when the participant withdraws.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { answer, go, leave, phase, place } from "./lib/participant.mjs";
import { mimique, root, serve } from "./lib/server.mjs";

const unable = skip(executable ? false : "Chromium not found");

test("changes: the server is killed and comes back with a changed study", { skip: unable, timeout: 300_000 }, async () => {
  let server = await serve(["study-config/demo.json"]);
  const { folder, port } = server;
  const browser = await open("undrawn");
  const { page } = browser;
  try {
    await page.goto(`${server.url}/s/demo/?backend=webgl2`);
    await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
    let here = await place(page);
    await go(page, "mouse");
    here = await leave(page, here);
    assert.equal(here.view, "questions");

    // The answers of this page are given while nobody is there to take them.
    await server.kill();
    const given = await answer(page, "mouse", here.step);
    await go(page, "mouse");
    here = await leave(page, here);

    const changed = join(folder, "demo.json");
    const text = readFileSync(join(root, "study-config/demo.json"), "utf8");
    writeFileSync(changed, text.replace('"version": "1.0.0"', '"version": "1.0.1"'));
    server = await serve([changed], { folder, port });
    await page.reload();
    await page.waitForSelector("main[data-step]", { timeout: 30_000 });
    const again = await place(page);
    assert.equal(again.step, here.step, "the session goes on where it was");
    await go(page, "mouse");
    here = await leave(page, here);
    await phase(page, "ready");

    const rows = parse(mimique(["export", "--database", server.database, "--format", "csv", "--study", "demo"]));
    const stored = rows.filter((row) => row.response_id !== "").map((row) => `${row.response_id} = ${row.answer}`);
    assert.deepEqual(stored.sort(), given.map((one) => `${one.question} = ${one.value}`).sort());
    const today = (await (await fetch(`${server.url}/api/studies/demo`)).json()).config_hash;
    assert.ok(rows.every((row) => row.config_hash !== today), "the rows belong to the version before");
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("changes: a participant withdraws and nothing is left", { skip: unable, timeout: 300_000 }, async () => {
  const server = await serve(["study-config/demo.json"]);
  const browser = await open("undrawn", { locale: "fr-FR" });
  const { page } = browser;
  try {
    await page.goto(`${server.url}/s/demo/`);
    await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
    let here = await place(page);
    await go(page, "keyboard");
    here = await leave(page, here);
    await answer(page, "keyboard", here.step);
    await page.locator("[data-action=withdraw]").click();
    await page.locator("[data-action=withdraw-confirm]").click();
    await page.waitForSelector("main[data-view=withdrawn][data-confirmed=true]", { timeout: 30_000 });
    const rows = parse(mimique(["export", "--database", server.database, "--format", "csv"]));
    assert.deepEqual(rows.filter((row) => row.response_id !== ""), [], "no answer is left");
    assert.equal(await page.evaluate(() => localStorage.getItem("mimique/demo")), null);
  } finally {
    await browser.close();
    await server.stop();
  }
});
