// Every type of question, sign-language videos and a pair of clips by keyboard alone: nothing is clicked, nothing is
// focused by a script, and what was pressed is what is stored.

import assert from "node:assert/strict";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { study, written } from "./lib/every_question.mjs";
import { go, leave, phase, place, storedEvents, tabTo, until } from "./lib/participant.mjs";
import { serve } from "./lib/server.mjs";

const unable = skip(!executable && "Chromium not found");

test("keyboard: every type of question, videos and a comparison", { skip: unable, timeout: 300_000 }, async () => {
  const browser = await open("undrawn", { viewport: { width: 1000, height: 900 } });
  const server = await serve([await written(browser.page, study)]);
  const { page } = browser;
  const press = async (...keys) => {
    for (const key of keys) await page.keyboard.press(key);
  };
  const to = (question, field) => tabTo(page, `fieldset[data-question=${question}] ${field}`);
  const finished = async () => (await storedEvents(page, server, "access")).filter(({ type }) => /^(page|trial)_finished$/.test(type));
  try {
    await page.goto(`${server.url}/s/access/?backend=webgl2`);
    await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
    let here = await place(page);
    await go(page, "keyboard");
    here = await leave(page, here);
    assert.equal(here.view, "questions");
    await page.waitForFunction(() => [...document.querySelectorAll("video")].every((video) => video.readyState >= 1), undefined, { timeout: 30_000 });

    await to("single", "video");
    await press("Space");
    await page.waitForFunction(() => !document.querySelector("video").paused || document.querySelector("video").currentTime > 0, undefined, { timeout: 10_000 });
    await to("single", "input[type=radio]");
    await press("Space", "ArrowDown");
    await to("several", "input[value=a]");
    await press("Space");
    await to("several", "input[value=b]");
    await press("Space", "Space");
    await to("several", "input[value=c]");
    await press("Space");
    await to("likert", "input");
    await press("Space", "ArrowRight", "ArrowRight");
    await to("slider", "input[type=range]");
    await press("ArrowRight", "ArrowRight", "ArrowLeft");
    await to("matrix", "[role=radiogroup]:nth-of-type(1) input");
    await press("Space");
    await to("matrix", "[role=radiogroup]:nth-of-type(2) input");
    await press("Space", "ArrowRight");
    await to("number", "input");
    await page.keyboard.type("30");
    await to("short", "input");
    await page.keyboard.type("word");
    await to("long", "textarea");
    await page.keyboard.type("some words");
    // The first button that does something: the first goes down.
    await to("ranking", "li:nth-child(1) button:not(:disabled)");
    await press("Enter");
    await to("ranking", "[data-action=confirm-order]");
    await press("Enter");
    await to("grid", "input");
    await press("Space", "ArrowRight");
    await to("extremes", "[role=radiogroup]:nth-of-type(1) input");
    await press("Space", "ArrowRight");
    await to("extremes", "[role=radiogroup]:nth-of-type(2) input");
    await press("Space");
    await go(page, "keyboard");
    here = await leave(page, here);

    assert.equal(here.view, "page");
    await go(page, "keyboard");
    here = await leave(page, here);
    assert.equal(here.view, "trial");
    await phase(page, "ready", 120_000);
    await go(page, "keyboard");
    await phase(page, "answering", 120_000);
    await to("nearer", "input");
    await press("Space", "ArrowDown");
    await to("rating", "input");
    await press("Space");
    await go(page, "keyboard");
    here = await leave(page, here, 60_000);
    assert.equal(here.view, "page");

    await until("the trial's answers are stored", async () => (await finished()).length >= 3);
    const [about, , trial] = await finished();
    assert.deepEqual(about.answers, {
      single: "b",
      several: ["a", "c"],
      likert: 3,
      slider: 51,
      matrix: { play: "never", call: "sometimes" },
      number: 30,
      short: "word",
      long: "some words",
      ranking: ["mouth", "eyes", "skin"],
      grid: { valence: 2, arousal: 9 },
      extremes: { best: "mouth", worst: "eyes" },
    });
    assert.deepEqual(trial.answers, { nearer: "same", rating: 1 });
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});
