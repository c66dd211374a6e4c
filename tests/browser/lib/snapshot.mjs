// What a screen reader finds on a page, as a file: roles, names and states of everything that it is told.

import assert from "node:assert/strict";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { root } from "./server.mjs";

const folder = join(root, "tests/browser/snapshots");

/** Receipts, hashes of packs and withdrawal codes, which differ from run to run. */
const drawn = /\b(?:[0-9a-f]{12,}|[0-9A-Z]{4}(?:-[0-9A-Z]{4}){3})\b/g;

/**
 * Compares the accessibility tree with `snapshots/{name}.yml`. `MIMIQUE_UPDATE_GOLDEN=1` writes the file
 * anew; look at the difference before you keep it.
 */
export async function heard(page, name) {
  const tree = await page.locator("body").ariaSnapshot();
  const found = `${tree.replaceAll(drawn, "(drawn)")}\n`;
  const file = join(folder, `${name}.yml`);
  if (process.env.MIMIQUE_UPDATE_GOLDEN === "1") {
    mkdirSync(folder, { recursive: true });
    writeFileSync(file, found);
  }
  assert.ok(existsSync(file), `${file} is not there; MIMIQUE_UPDATE_GOLDEN=1 writes it`);
  assert.equal(found, readFileSync(file, "utf8"), `${name}: what a screen reader finds has changed`);
}
