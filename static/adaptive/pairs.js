// The pairs of active schedules: studies with such a schedule alone load this, and the module that draws them.
import init, { nextPairs as next } from "../adaptive.js";

const ready = init();

/** The event with the next batch (JSON); `request`: JSON as the module has it. */
export async function nextPairs(request) {
  await ready;
  return next(request);
}
