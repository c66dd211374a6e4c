// The studio's module in node, for `cargo xtask bench --layout`: each line of standard input is answered with
// {"seconds": processor time from the pointer's place to the new state of the layout, "answer": its expected error}.
//
//   node tests/wasm/layout_speed.mjs FOLDER_OF_STUDIO_JS
import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { createInterface } from "node:readline";
import { pathToFileURL } from "node:url";

const modules = resolve(process.argv[2]);
const studio = await import(pathToFileURL(join(modules, "studio.js")));
await studio.default({ module_or_path: readFileSync(join(modules, "studio_bg.wasm")) });
const worker = new studio.Studio();
worker.builtInAvatar(1, 10_000);
let { markers } = JSON.parse(worker.makeLayout("greedy", 40, 6, true));
// Looks along -z; 0.3 m fill the picture. What it costs to find a vertex does not depend on where it is.
const camera = new Float32Array([6.7, 0, 0, 0, 0, 6.7, 0, 0, 0, 0, -0.5, 0, 0, 0, 0.5, 1]);

// The first marker and its partner are moved to and fro: every other one is judged anew.
const places = [markers[0].vertex, null];
function dragged() {
  const before = process.cpuUsage();
  worker.pick(camera, 520, 520, 260, 260);
  const index = markers[0].vertex === places[0] ? 1 : 0;
  places[1] ??= worker.pick(camera, 520, 520, 200, 260) ?? places[0] + 1;
  const state = JSON.parse(worker.moveLayoutMarker(0, places[index], true, true));
  const { user, system } = process.cpuUsage(before);
  ({ markers } = state);
  return { seconds: (user + system) / 1e6, answer: state.curveMm.at(-1) };
}

// The engine compiles again while it runs for the first time.
for (let i = 0; i < 10; i++) dragged();
console.log('{"ready": true}');
for await (const _ of createInterface({ input: process.stdin })) {
  console.log(JSON.stringify(dragged()));
}
