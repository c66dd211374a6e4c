// What a page saves, as a file of this machine: a browser that several test files share has no path for it.

import { mkdtempSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

/** The bytes of a download. */
export async function savedBytes(download) {
  const file = join(mkdtempSync(join(tmpdir(), "mimique-saved-")), "file");
  await download.saveAs(file);
  return readFileSync(file);
}
