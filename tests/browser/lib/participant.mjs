// A person taking part: reads what the page shows, answers, and remembers what was answered.

import assert from "node:assert/strict";

/** Where the page that is seen stands: its place among the steps, view, and on a trial the phase. Which clip it
    is, the page does not show; `storedEvents` tell. */
export async function place(page) {
  return page.locator("main[data-view]:visible").evaluate((main) => ({
    step: main.dataset.step,
    view: main.dataset.view,
    phase: main.dataset.phase,
    heading: main.querySelector("h1")?.textContent,
  }));
}

/** Waits until the page stands elsewhere than `from`; a session that is being begun, or a device that is being
    looked at, is nowhere. */
export async function leave(page, from, timeout = 30_000) {
  await page.waitForFunction(
    ([step, view]) => {
      const main = document.querySelector("main[data-view]");
      const passing = !main || main.dataset.view === "opening" || main.dataset.measuring === "true";
      return !passing && (main.dataset.step !== step || main.dataset.view !== view);
    },
    [from.step, from.view],
    { timeout },
  );
  return place(page);
}

/** A choice that depends on step and question alone: the same run gives the same answers. */
function pick(text, count) {
  let hash = 2166136261;
  for (const c of text) hash = Math.imul(hash ^ c.charCodeAt(0), 16777619) >>> 0;
  return hash % count;
}

/**
 * Answers every question on the page and returns [{question, value}].
 * `hands`: "mouse" clicks; "keyboard" only presses keys.
 */
export async function answer(page, hands, step) {
  const given = [];
  const questions = page.locator("fieldset[data-question]");
  for (let i = 0; i < (await questions.count()); i++) {
    const question = questions.nth(i);
    const id = await question.getAttribute("data-question");
    const radios = question.locator("input[type=radio]");
    const count = await radios.count();
    if (count > 0) {
      assert.equal(await question.locator("input:checked").count(), 0, `${id}: nothing is pre-selected`);
      const radio = radios.nth(pick(`${step}/${id}`, count));
      const value = await radio.getAttribute("value");
      if (hands === "mouse") {
        // As a person does: on the tile, which is the label.
        await question.locator("label", { has: page.locator(`input[value="${value}"]`) }).click();
      } else {
        await tabTo(page, `fieldset[data-question="${id}"] input[type=radio]`);
        await page.keyboard.press("Space");
        for (let steps = 0; steps < count && !(await radio.isChecked()); steps++) await page.keyboard.press("ArrowDown");
      }
      assert.ok(await radio.isChecked(), `${id}: ${value} is chosen`);
      given.push({ question: id, value });
      continue;
    }
    const field = question.locator("input, textarea").first();
    const type = (await field.getAttribute("type")) ?? "text";
    const value = type === "number" ? String(20 + pick(`${step}/${id}`, 40)) : `answer to ${id}`;
    if (hands === "mouse") {
      await field.click();
    } else {
      await tabTo(page, `fieldset[data-question="${id}"] :is(input, textarea)`);
    }
    await page.keyboard.type(value);
    given.push({ question: id, value });
  }
  return given;
}

/** Presses Tab until the focus is on something that matches. */
export async function tabTo(page, selector) {
  for (let presses = 0; presses < 200; presses++) {
    if (await page.evaluate((s) => document.activeElement?.matches(s) ?? false, selector)) return;
    await page.keyboard.press("Tab");
  }
  throw new Error(`the keyboard does not reach ${selector}`);
}

/** Presses the page's primary button. */
export async function go(page, hands) {
  if (hands === "mouse") {
    await page.locator("button.primary:not([disabled])").first().click();
  } else {
    await tabTo(page, "button.primary:not([disabled])");
    await page.keyboard.press("Enter");
  }
}

/** Waits for a phase of the trial on screen; on a busy machine a short clip may have been played between two looks. */
export async function phase(page, wanted, timeout = 90_000) {
  const phases = [wanted].flat();
  if (phases.includes("playing")) phases.push("answering");
  await page.waitForFunction(
    (phases) => phases.includes(document.querySelector("main[data-view]")?.dataset.phase),
    phases,
    { timeout, polling: 20 },
  );
}

/** The clip of the `number`-th trial (from 1) that this page's session has begun. */
export async function clipOf(page, server, study, number) {
  const begun = async () => (await storedEvents(page, server, study)).filter(({ type }) => type === "trial_started").map(({ step, clip }) => [step, clip]);
  const trials = async () => [...new Map(await begun()).values()];
  await until(`trial ${number} is stored`, async () => (await trials()).length >= number);
  return (await trials())[number - 1];
}

/** Waits until nothing moves on the page: no transition runs, and it stays scrolled where it is for some frames. */
export function settled(page) {
  return page.evaluate(async () => {
    for (let place; place !== `${scrollX} ${scrollY}`; ) {
      place = `${scrollX} ${scrollY}`;
      const changing = document.getAnimations().filter((animation) => animation instanceof CSSTransition);
      await Promise.allSettled(changing.map((animation) => animation.finished));
      for (let frames = 0; frames < 6; frames++) await new Promise(requestAnimationFrame);
    }
  });
}

/** Waits until a count has stayed the same for so long. */
export async function steady(count, ms) {
  for (let [before, since] = [count(), Date.now()]; Date.now() - since < ms; await new Promise((done) => setTimeout(done, 100))) {
    if (count() !== before) [before, since] = [count(), Date.now()];
  }
}

/** Waits until it holds. */
export async function until(what, holds, ms = 90_000) {
  for (const deadline = Date.now() + ms; !(await holds()); await new Promise((done) => setTimeout(done, 100))) {
    assert.ok(Date.now() < deadline, `${what}: not within ${ms / 1000} s`);
  }
}

/**
 * The events that the server has of this page's session in a study. Pages go on while what was
 * answered is on its way, so that who looks for an event waits for it (`until`).
 */
export async function storedEvents(page, server, study) {
  const session = await page.evaluate((key) => JSON.parse(localStorage.getItem(key)).started.session, `mimique/${study}`);
  const { events } = await (await fetch(`${server.url}/api/sessions/${session}`)).json();
  return events.map(({ at_ms, body }) => ({ at_ms, ...body }));
}

/** Goes to a study and on to its first trial, by the keyboard; resolves with the trial's place once it can be played. */
export async function toFirstTrial(page, address) {
  await page.goto(address);
  await page.waitForSelector("main[data-view]", { timeout: 30_000 });
  let here = await place(page);
  while (here.view !== "trial") {
    await go(page, "keyboard");
    here = await leave(page, here, 60_000);
  }
  await phase(page, "ready", 120_000);
  return here;
}

/** Goes through a study from its first page to its last; `trial(here, number)` takes each trial, from 1, from where it can
    be played to where its answers can be sent. `hands` are those of `answer`; `questions` answers the pages between
    trials, too. Resolves with how many trials there were. */
export async function through(page, address, trial, { hands = "keyboard", questions = false } = {}) {
  await page.goto(address);
  await page.waitForSelector("main[data-view]", { timeout: 30_000 });
  let here = await place(page);
  let trials = 0;
  while (here.view !== "end") {
    if (here.view === "trial") {
      trials += 1;
      await phase(page, "ready", 120_000);
      await trial(here, trials);
    }
    if (questions && here.view === "questions") await answer(page, hands, here.step);
    if (here.view !== "receipt") await go(page, hands);
    here = await leave(page, here, 60_000);
  }
  return trials;
}
