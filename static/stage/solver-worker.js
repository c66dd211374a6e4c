// The solver's worker: packs in, weights out. Speaks with stage/clips.js:
//   in   {id, operators: Uint8Array, take: Uint8Array, method: object (a MethodSpec)}
//   out  {id, weights: Float32Array (frames x shapes), frames, shapes, rate_hz, weights_hash, report, solve_ms}
//   or   {id, error: string, panicked: boolean}: after a panic the worker is of no more use
//   and  {panic}, a report (panics.js), before the error of a solve that panicked
import { inflated } from "./inflated.js";
import init, { solve } from "../solver.js";

const ready = init();

self.onmessage = async ({ data }) => {
  const { id, operators, take, method } = data;
  try {
    await ready;
    const started = performance.now();
    const solved = solve(await inflated(operators), take, JSON.stringify(method));
    const weights = solved.weights();
    const answer = {
      id,
      weights,
      frames: solved.frames(),
      shapes: solved.shapes(),
      rate_hz: solved.rate_hz(),
      weights_hash: solved.weights_hash(),
      report: JSON.parse(solved.report()),
      solve_ms: performance.now() - started,
    };
    solved.free();
    self.postMessage(answer, [weights.buffer]);
  } catch (error) {
    const panicked = error instanceof WebAssembly.RuntimeError;
    self.postMessage({ id, error: String(error?.message ?? error), panicked });
  }
};
