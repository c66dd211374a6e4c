// The report of each case by the browsers' module under node, held against the native one: node report_bytes.mjs DIST CASES
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [dist, cases] = process.argv.slice(2);
const module = await import(pathToFileURL(join(resolve(dist), "report.js")));
await module.default({ module_or_path: readFileSync(join(dist, "report_bg.wasm")) });

// What has numbers with all their digits: the mathematical functions of the module and of the machine's own library differ
// in the last bit. Every other file is the same byte for byte.
const UNROUNDED = ["results.json", "data/numbers.csv"];
const MOST_APART = 1e-12;
const NUMBER = /-?\d+(?:\.\d+)?(?:e[-+]?\d+)?/g;

/// The largest relative difference of two numbers at one place; infinity where the text around them differs.
function farthest(found, text) {
  if (found.replace(NUMBER, "#") !== text.replace(NUMBER, "#")) return Infinity;
  const [numbers, others] = [found, text].map((each) => each.match(NUMBER).map(Number));
  return Math.max(...numbers.map((one, k) => (one === others[k] ? 0 : Math.abs(one - others[k]) / Math.max(Math.abs(one), Math.abs(others[k])))));
}

let differing = 0;
let worst = 0;
for (const { name, csv, study, language, files, summary } of JSON.parse(readFileSync(cases, "utf8"))) {
  const begun = performance.now();
  const report = module.analyze(csv, study, "", "", "../index.html", language);
  const ms = performance.now() - begun;
  assert.deepEqual(report.files().sort(), Object.keys(files).sort(), `${name}: the same files`);
  assert.deepEqual(JSON.parse(report.summary()), summary, name);
  for (const [path, text] of Object.entries(files)) {
    const found = report.file(path);
    if (found === text) continue;
    if (UNROUNDED.includes(path)) {
      const apart = farthest(found, text);
      worst = Math.max(worst, apart);
      if (apart <= MOST_APART) continue;
    }
    differing += 1;
    const at = [...text].findIndex((letter, k) => found[k] !== letter);
    console.log(`${name}: ${path} differs at ${at}: ${JSON.stringify(text.slice(at - 60, at + 40))} natively, ${JSON.stringify(found.slice(at - 60, at + 40))} here`);
  }
  console.log(`${name} (${language}): ${Object.keys(files).length} files, ${csv.length} bytes of answers, ${ms.toFixed(0)} ms`);
}
console.log(`unrounded numbers are at most ${worst.toExponential(1)} apart`);
// A table that is none is refused in words.
assert.throws(() => module.analyze("a,b\n1\n", "{}", "", "", "", "en"), /./);
assert.equal(differing, 0, `${differing} files differ`);
