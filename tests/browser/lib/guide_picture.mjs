// Pictures of the guide: MIMIQUE_UPDATE_GOLDEN=1 writes them anew; look at them before you keep them.

import assert from "node:assert/strict";
import { mkdirSync, readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { screenshotFolder } from "./browser.mjs";
import { root } from "./server.mjs";

const pictures = join(root, "docs/guide/pictures");
const MOST_BYTES = 150_000;

/** Takes a picture, and sees that the page's is of the same size and small. */
export async function taken(page, name) {
  const update = process.env.MIMIQUE_UPDATE_GOLDEN === "1";
  const there = join(update ? pictures : screenshotFolder("guide"), name);
  if (update) mkdirSync(pictures, { recursive: true });
  await page.screenshot({ path: there, type: "jpeg", quality: 80 });
  const kept = join(pictures, name);
  assert.ok(statSync(kept).size < MOST_BYTES, `${name} has ${statSync(kept).size} bytes`);
  assert.deepEqual(size(readFileSync(kept)), size(readFileSync(there)), name);
}

/** Height and width of a JPEG: those of its frame header. */
function size(bytes) {
  for (let at = 2; at < bytes.length; at += 2 + bytes.readUInt16BE(at + 2)) {
    if ([0xc0, 0xc1, 0xc2].includes(bytes[at + 1])) return [bytes.readUInt16BE(at + 5), bytes.readUInt16BE(at + 7)];
  }
  throw new Error("no JPEG");
}
