// The studio's module in node, for `cargo xtask bench --annotate`: each line of standard input is answered
// with {"seconds": processor time of the suggestion of a take's labels, "answer": how many there are}.
//
//   node tests/wasm/label_speed.mjs FOLDER_OF_STUDIO_JS PROBLEM_FOLDER
import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { createInterface } from "node:readline";
import { pathToFileURL } from "node:url";

const [modules, folder] = process.argv.slice(2).map((path) => resolve(path));
const studio = await import(pathToFileURL(join(modules, "studio.js")));
await studio.default({ module_or_path: readFileSync(join(modules, "studio_bg.wasm")) });
const worker = new studio.Studio();
worker.labelModel("model.json", readFileSync(join(folder, "model.json"), "utf8"));
worker.takeFile("ten-minutes.csv", readFileSync(join(folder, "ten-minutes.csv")), undefined, undefined);

function suggested() {
  const before = process.cpuUsage();
  const state = JSON.parse(worker.suggestLabels(""));
  const { user, system } = process.cpuUsage(before);
  return { seconds: (user + system) / 1e6, answer: state.boxes.length };
}

// The engine compiles again while it runs for the first time.
suggested();
console.log('{"ready": true}');
for await (const _ of createInterface({ input: process.stdin })) {
  console.log(JSON.stringify(suggested()));
}
