// The studio's module in node: suggests labels, learns again from what is confirmed, and compares every
// text with what the native program has written beside it. Numbers in them are whole doubles.
//
//   node tests/wasm/label_bits.mjs FOLDER_OF_STUDIO_JS FOLDER_OF_CASES
//
// FOLDER_OF_CASES/cases.json: [{"name", "model", "take", "suggested", "learnt", "state", "csv", "timeline"}]
import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [modules, cases] = process.argv.slice(2).map((folder) => resolve(folder));
const studio = await import(pathToFileURL(join(modules, "studio.js")));
await studio.default({ module_or_path: readFileSync(join(modules, "studio_bg.wasm")) });

let failed = 0;
for (const own of JSON.parse(readFileSync(join(cases, "cases.json"), "utf8"))) {
  const text = (name) => readFileSync(join(cases, name), "utf8");
  const worker = new studio.Studio();
  worker.labelModel(own.model, text(own.model));
  worker.takeFile(own.take, readFileSync(join(cases, own.take)), undefined, undefined);
  const suggested = worker.suggestLabels("");
  const { boxes } = JSON.parse(suggested);
  boxes.forEach((box, index) => index % 2 === 0 && worker.confirmLabel(index));
  const state = worker.learnLabels("");
  const said = { suggested, state, learnt: worker.labelModelJson(), csv: worker.labelsCsv(), timeline: worker.suggestExpressions("", "", 1) };
  const different = Object.keys(said).filter((key) => said[key] !== own[key]);
  failed += different.length;
  console.log(`${different.length === 0 ? "same" : `DIFFERENT (${different.join(", ")})`} ${own.name}: ${boxes.length} boxes`);
  worker.free();
}
process.exit(failed === 0 ? 0 : 1);
