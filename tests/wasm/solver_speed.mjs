// The browser's module in node, for `cargo xtask bench`: each line of standard input (a method) is
// answered with {"units": frames, "seconds": processor time, "memory": bytes of the module}.
//
//   node tests/wasm/solver_speed.mjs FOLDER_OF_SOLVER_JS PROBLEM_FOLDER
import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { createInterface } from "node:readline";
import { pathToFileURL } from "node:url";

const [modules, folder] = process.argv.slice(2).map((path) => resolve(path));
const { inflated } = await import("../../static/stage/inflated.js");
const solver = await import(pathToFileURL(join(modules, "solver.js")));
const { memory } = await solver.default({ module_or_path: readFileSync(join(modules, "solver_bg.wasm")) });
const bytes = (name) => new Uint8Array(readFileSync(join(folder, name)));
const [operators, take] = [await inflated(bytes("operators.mmop")), bytes("take.mmtk")];

function solve(method) {
  const spec = readFileSync(join(folder, `${method}.json`), "utf8");
  const before = process.cpuUsage();
  const solved = solver.solve(operators, take, spec);
  const { user, system } = process.cpuUsage(before);
  const answer = { units: solved.frames(), seconds: (user + system) / 1e6, hash: solved.weights_hash() };
  solved.free();
  return { ...answer, memory: memory.buffer.byteLength };
}

// The engine compiles again while it runs for the first time.
solve("lsts");
solve("lsts-norm");
console.log("{}");
for await (const line of createInterface({ input: process.stdin })) {
  console.log(JSON.stringify(solve(line.trim())));
}
