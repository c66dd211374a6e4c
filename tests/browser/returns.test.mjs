// A participant comes back: by the back button, after the lid was closed, in a second tab.

import assert from "node:assert/strict";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { answer, go, leave, place } from "./lib/participant.mjs";
import { serve } from "./lib/server.mjs";

const unable = skip(executable ? false : "Chromium not found");

/** On the page of questions about the participant, one of them answered. */
async function begun(server, browser) {
  const { page } = browser;
  await page.goto(`${server.url}/s/demo/?backend=webgl2`);
  await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
  const here = await place(page);
  await go(page, "mouse");
  return leave(page, here);
}

const age = "fieldset[data-question=age] input";

test("returns: back button, closed lid and second tab lose nothing", { skip: unable, timeout: 180_000 }, async () => {
  const server = await serve(["study-config/demo.json"]);
  const browser = await open("undrawn");
  const { page, context } = browser;
  try {
    const here = await begun(server, browser);
    assert.equal(here.view, "questions");
    await page.locator(age).fill("41");
    await page.locator(age).blur();

    // Away to another page, and back.
    await page.goto(`${server.url}/`);
    await page.goBack();
    await page.waitForSelector("main[data-view=questions]", { timeout: 30_000 });
    assert.equal((await place(page)).step, here.step, "back at the same page");
    assert.equal(await page.locator(age).inputValue(), "41", "with what was written");

    // The lid: the page stands still, and goes on.
    const cdp = await context.newCDPSession(page);
    await cdp.send("Page.setWebLifecycleState", { state: "frozen" });
    await new Promise((done) => setTimeout(done, 1_000));
    await cdp.send("Page.setWebLifecycleState", { state: "active" });
    assert.equal(await page.locator(age).inputValue(), "41");

    // A second tab is told that the study is open elsewhere, and can go on once the first is closed.
    const second = await context.newPage();
    await second.goto(`${server.url}/s/demo/?backend=webgl2`);
    await second.waitForSelector("main[data-view=failure]", { timeout: 30_000 });
    assert.match(await second.locator("h1").innerText(), /another tab/);
    await page.close();
    // The browser takes a moment to give back what a closed tab held: a person presses again.
    for (let tries = 0; tries < 10 && (await place(second)).view !== "questions"; tries++) {
      if ((await place(second)).view === "failure") await second.locator("button.primary").click();
      await second.waitForSelector("main[data-view=questions]", { timeout: 1_500 }).catch(() => {});
    }
    await second.waitForSelector("main[data-view=questions]", { timeout: 30_000 });
    assert.equal(await second.locator(age).inputValue(), "41");
    await second.locator(age).fill("");
    await answer(second, "mouse", here.step);
    await go(second, "mouse");
    assert.notEqual((await leave(second, here)).step, here.step);
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});
