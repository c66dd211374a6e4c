// Solves clips with the browser's module in node and compares the hashes of the weights with those
// that the native program has written beside them.
//
//   node tests/wasm/solver_bits.mjs FOLDER_OF_SOLVER_JS FOLDER_OF_CASES
//
// FOLDER_OF_CASES/cases.json: [{"name", "operators", "take", "method", "weightsHash", "frames"}]
import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [modules, cases] = process.argv.slice(2).map((folder) => resolve(folder));
const { inflated } = await import("../../static/stage/inflated.js");
const solver = await import(pathToFileURL(join(modules, "solver.js")));
await solver.default({ module_or_path: readFileSync(join(modules, "solver_bg.wasm")) });

let failed = 0;
for (const clip of JSON.parse(readFileSync(join(cases, "cases.json"), "utf8"))) {
  const bytes = (name) => new Uint8Array(readFileSync(join(cases, name)));
  const [operators, take] = [await inflated(bytes(clip.operators)), bytes(clip.take)];
  const start = performance.now();
  const solved = solver.solve(operators, take, JSON.stringify(clip.method));
  const milliseconds = performance.now() - start;
  const weights = solved.weights();
  const right =
    solved.weights_hash() === clip.weightsHash &&
    solved.frames() === clip.frames &&
    weights.length === clip.frames * solved.shapes() &&
    weights.every(Number.isFinite);
  if (!right) failed += 1;
  const rate = Math.round((1000 * clip.frames) / milliseconds);
  console.log(`${right ? "same" : "DIFFERENT"} ${clip.name}: ${clip.frames} frames, ${rate} frames/s`);
  solved.free();
}

// What is damaged is an Error with a message, not a trap.
for (const wrong of [new Uint8Array(0), new Uint8Array([77, 77, 79, 80, 9, 9, 9, 9, 9, 9, 9, 9])]) {
  try {
    solver.solve(wrong, wrong, '{"method": "lsts"}');
    console.log("DIFFERENT: a damaged pack was solved");
    failed += 1;
  } catch (error) {
    if (!(error instanceof Error) || !/pack: /.test(error.message)) {
      console.log(`DIFFERENT: a damaged pack says ${error}`);
      failed += 1;
    }
  }
}

// So is what cannot be inflated.
const [first] = JSON.parse(readFileSync(join(cases, "cases.json"), "utf8"));
const whole = readFileSync(join(cases, first.operators));
const flipped = Uint8Array.from(whole, (byte, at) => (at === whole.length >> 1 ? byte ^ 255 : byte));
for (const wrong of [whole.subarray(0, whole.length - 9), flipped]) {
  const said = await inflated(new Uint8Array(wrong)).then(() => "nothing", (error) => error.message);
  if (!/^MMOP pack: .*inflated/.test(said)) {
    console.log(`DIFFERENT: damaged operators say ${said}`);
    failed += 1;
  }
}
// A clip of recorded weights names another pack; the solver does not look at it.
const other = new Uint8Array([77, 77, 65, 86, ...new Uint8Array(40)]);
if ((await inflated(other)) !== other) {
  console.log("DIFFERENT: a pack that is none of operators was changed");
  failed += 1;
}
process.exit(failed === 0 ? 0 : 1);
