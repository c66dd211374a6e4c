// Who has asked for less motion gets none but the stimuli's: no transition, no animation, no smooth scrolling
// on any page, while the clip itself plays from its first frame to its last.

import assert from "node:assert/strict";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { study, written } from "./lib/every_question.mjs";
import { go, leave, phase, place, storedEvents, until } from "./lib/participant.mjs";
import { serve } from "./lib/server.mjs";

const unable = skip(!executable && "Chromium not found");

/** What moves by itself on the page as it stands: running animations, and what would begin to. */
function moving(page) {
  return page.evaluate(() => {
    const found = document.getAnimations().map((animation) => `${animation.constructor.name} runs`);
    for (const element of document.querySelectorAll("*")) {
      for (const part of [null, "::before", "::after"]) {
        const style = getComputedStyle(element, part);
        const name = `${element.tagName.toLowerCase()}.${element.className}${part ?? ""}`;
        const takes = style.transitionDuration.split(", ").some((duration) => parseFloat(duration) > 0);
        if (takes && style.transitionProperty !== "none") found.push(`${name} changes in ${style.transitionDuration}`);
        if (style.animationName !== "none") found.push(`${name} is animated: ${style.animationName}`);
        if (part === null && style.scrollBehavior === "smooth") found.push(`${name} scrolls smoothly`);
      }
    }
    return found;
  });
}

for (const reducedMotion of ["reduce", "no-preference"]) {
  test(`motion: ${reducedMotion}`, { skip: unable, timeout: 300_000 }, async () => {
    const browser = await open("undrawn", { reducedMotion });
    const server = await serve([await written(browser.page, study)]);
    const { page } = browser;
    const seen = {};
    const look = async (name) => (seen[name] = await moving(page));
    try {
      await page.goto(`${server.url}/s/access/?backend=webgl2`);
      await page.waitForSelector('main[data-view="consent"]', { timeout: 30_000 });
      let here = await place(page);
      await look("consent");
      await go(page, "mouse");
      here = await leave(page, here);
      assert.equal(here.view, "questions");
      // A tile that is chosen, a tile that is pointed at.
      await page.locator("fieldset[data-question=single] label").nth(1).click();
      await page.locator("fieldset[data-question=likert] label").nth(1).hover();
      await look("questions");
      if (reducedMotion === "no-preference") {
        // The look finds motion where there is some.
        assert.ok(seen.questions.some((each) => /label\.choice changes in 0\.12s/.test(each)), JSON.stringify(seen.questions.slice(0, 5)));
        return;
      }
      // On to the trial.
      for (const question of await page.locator("fieldset[data-question]").all()) {
        const id = await question.getAttribute("data-question");
        if (id === "slider") await question.locator("input[type=range]").press("ArrowRight");
        else if (id === "matrix") for (const row of await question.locator("[role=radiogroup]").all()) await row.locator("label").first().click();
        else if (id === "extremes") for (const pick of [0, 1]) await question.locator("[role=radiogroup]").nth(pick).locator("label").nth(pick).click();
        else if (id === "number") await question.locator("input").fill("30");
        else if (id === "short") await question.locator("input").fill("word");
        else if (id === "ranking") await question.locator("[data-action=confirm-order]").click();
        else if (id !== "long") await question.locator("label").first().click();
      }
      while (here.view !== "trial") {
        await go(page, "mouse");
        here = await leave(page, here, 60_000);
      }
      await phase(page, "ready", 120_000);
      await look("ready");
      await go(page, "mouse");
      await phase(page, "playing");
      await look("playing");
      await phase(page, "answering", 120_000);
      await look("answering");
      for (const [name, found] of Object.entries(seen)) assert.deepEqual(found, [], name);
      assert.deepEqual(Object.keys(seen), ["consent", "questions", "ready", "playing", "answering"]);

      // The clip has moved: frame upon frame to its end.
      const played = async () => (await storedEvents(page, server, "access")).find(({ type }) => type === "trial_played");
      await until("the log of the clip is stored", played, 15_000);
      const { log } = await played();
      assert.ok(!log.aborted, log.aborted);
      const times = log.frames.map(([, clip]) => clip);
      assert.ok(new Set(times).size > 2 && times.at(-1) > 1000, `${times}`);
    } finally {
      await browser.close();
      await server.stop();
    }
  });
}
