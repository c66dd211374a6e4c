// Computes exertion's numbers with a browser's module in node and compares their bits with those that are
// kept in the repository, which the native program computes too.
//
//   node tests/wasm/exertion_bits.mjs FOLDER_OF_BITS_JS FILE_OF_STORED_BITS
import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [folder, kept] = process.argv.slice(2).map((path) => resolve(path));
const module = await import(pathToFileURL(join(folder, "bits.js")));
await module.default({ module_or_path: readFileSync(join(folder, "bits_bg.wasm")) });

const own = module.exertion_lines().split("\n");
const expected = readFileSync(kept, "utf8").split("\n");
let failed = own.length === expected.length ? 0 : 1;
for (const [row, line] of expected.entries()) {
  if (own[row] !== line) {
    console.log(`DIFFERENT ${own[row]}, natively ${line}`);
    failed += 1;
  }
}
console.log(`${expected.length - 1} lists, ${failed} different`);
process.exit(failed === 0 ? 0 : 1);
