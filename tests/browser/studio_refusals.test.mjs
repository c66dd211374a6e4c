// What the studio cannot read is refused by name, and what was there before stays.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { preview, root } from "./lib/server.mjs";

const unable = skip(!executable && "Chromium not found");

test("studio: a compression that only native builds read is named, and the head stays", { skip: unable, timeout: 240_000 }, async () => {
  // Native builds read this one: a seed of the fuzzer, whose corpus is read in `crates/avatar-files/tests`.
  const glb = readFileSync(join(root, "fuzz/corpus/avatar_file/seed-glb"));
  assert.ok(glb.includes("EXT_meshopt_compression"));
  const file = join(mkdtempSync(join(tmpdir(), "mimique-refused-")), "packed.glb");
  writeFileSync(file, glb);
  const server = await preview([]);
  const browser = await open("undrawn");
  try {
    const { page } = browser;
    await page.goto(`${server.url}?backend=webgl2`);
    await page.click("#avatar-built-in");
    const facts = () => page.locator("#avatar-facts").textContent();
    await page.waitForFunction(() => document.querySelector("#avatar-facts").textContent.includes("57 shapes"));
    await page.setInputFiles("#avatar-file", file);
    await page.waitForFunction(() => document.querySelector("#problem").checkVisibility(), undefined, { timeout: 60_000 });
    const said = await page.locator("#problem").textContent();
    for (const word of ["packed.glb", "EXT_meshopt_compression", "; "]) assert.ok(said.includes(word), said);
    assert.match(await facts(), /57 shapes/);
    assert.deepEqual(browser.errors, []);
  } finally {
    await browser.close();
    await server.stop();
  }
});
