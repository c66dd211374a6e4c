// The levels of adaptive blocks: studies with such a block alone load this, and the module that chooses.
import init, { Levels } from "../adaptive.js";

const ready = init();
// The block of the last call, and the answers that it has taken in.
let known = null;

/** The next level of a block: what the session's effect asks for in (JSON), its event out (JSON). */
export async function nextLevel(text) {
  await ready;
  const { step, answers, ...request } = JSON.parse(text);
  const block = JSON.stringify(request);
  if (known?.block !== block || known.answers.some((answer, at) => answer !== answers[at])) {
    known?.levels.free();
    known = { block, answers: [], levels: new Levels(block) };
  }
  for (const answer of answers.slice(known.answers.length)) {
    known.levels.answer(answer ?? undefined);
    known.answers.push(answer);
  }
  return known.levels.next(step);
}

/** The clips that may come after either answer to that level. */
export function levelsAhead() {
  return known?.levels.ahead() ?? [];
}
