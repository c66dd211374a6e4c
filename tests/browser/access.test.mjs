// Every page for everybody: axe finds nothing against WCAG 2.2 AA, in light and dark, on screens of 320,
// 768 and 1280 px, with text of 200 %; every type of question among them, signed. Nothing is cut off or
// beyond the window. What a screen reader finds there is what the snapshots say.

import assert from "node:assert/strict";
import { test } from "node:test";
import { looker } from "./lib/access.mjs";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { study, written } from "./lib/every_question.mjs";
import { go, leave, phase, place } from "./lib/participant.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { heard } from "./lib/snapshot.mjs";

const unable = skip(!executable && "Chromium not found");

/** Waits until as many sign-language videos as here can be played in each question, and so many pictures are seen. */
function signs(page, videos, pictures) {
  const there = ([videos, pictures]) => {
    const all = document.querySelectorAll("video");
    const every = (list, seen) => [...list].every(seen);
    const images = document.querySelectorAll(".question img");
    return (
      every(Object.entries(videos), ([id, count]) => document.querySelectorAll(`[data-question=${id}] video`).length === count) &&
      all.length === Object.values(videos).reduce((sum, count) => sum + count, 0) &&
      every(all, (video) => video.readyState >= 1 && video.videoWidth > 0) &&
      images.length === pictures &&
      every(images, (image) => image.naturalWidth > 0)
    );
  };
  return page.waitForFunction(there, [videos, pictures], { timeout: 30_000 });
}

/** One answer of each question, by the controls that people use. */
async function answerAll(page) {
  for (const question of await page.locator("fieldset[data-question]").all()) {
    const id = await question.getAttribute("data-question");
    if (id === "several") await question.locator("label").first().click();
    else if (id === "slider") await question.locator("input[type=range]").press("ArrowRight");
    else if (id === "matrix") for (const row of await question.locator("[role=radiogroup], tr:has(input)").all()) await row.locator("label, input").first().click();
    else if (id === "extremes") for (const pick of [0, 1]) await question.locator("[role=radiogroup]").nth(pick).locator("label").nth(pick).click();
    else if (id === "number") await question.locator("input").fill("30");
    else if (id === "short") await question.locator("input").fill("word");
    else if (id === "long") await question.locator("textarea").fill("some words");
    else if (id === "ranking") await question.locator("button").last().click();
    else await question.locator("label").first().click();
  }
}

for (const [scheme, width, zoom, locale] of [
  ["light", 1280, 1, "en-GB"],
  ["dark", 320, 1, "fr-FR"],
  ["dark", 768, 1, "en-GB"],
  ["light", 1280, 2, "fr-FR"],
  ["light", 320, 2, "fr-FR"],
]) {
  test(`access: every page, ${scheme}, ${width} px, text ${zoom * 100} %`, { skip: unable, timeout: 300_000 }, async () => {
    const browser = await open("undrawn", { viewport: { width, height: 900 }, colorScheme: scheme, locale });
    const server = await serve([await written(browser.page, study)]);
    const shots = screenshotFolder(`access-${scheme}-${width}-${zoom}`);
    const { page } = browser;
    const { seen, look: looked } = looker(page, shots, zoom);
    // And what a screen reader finds there.
    const look = async (name) => {
      await looked(name);
      const again = seen.filter((each) => each === name).length;
      await heard(page, `${locale.slice(0, 2)}-${name}${again > 1 ? again : ""}`);
    };
    try {
      await page.goto(`${server.url}/s/access/?backend=webgl2`);
      await page.waitForSelector('main[data-view="consent"]', { timeout: 30_000 });
      let here = await place(page);
      for (let guard = 0; here.view !== "end" && guard < 20; guard++) {
        if (here.view === "receipt") {
          here = await leave(page, here, 60_000);
          continue;
        }
        if (here.view === "questions") {
          // What is signed can be played, and a picture is there.
          await signs(page, { single: 2, likert: 2, slider: 1, matrix: 3, ranking: 1, grid: 1, extremes: 2 }, 2);
          const slider = page.locator("fieldset[data-question=slider] input");
          const untouched = { "en-GB": "not answered yet", "fr-FR": "pas encore de réponse" }[locale];
          assert.equal(await slider.getAttribute("aria-valuetext"), untouched, "nothing is pre-selected");
          // Without answers the page says what is missing, and stays.
          await go(page, "mouse");
          await page.waitForSelector(".problem");
          await look("questions-missing");
          await answerAll(page);
          assert.equal(await slider.getAttribute("aria-valuetext"), null);
        }
        if (here.view === "trial") {
          await phase(page, "ready", 120_000);
          await look("trial-ready");
          await go(page, "mouse");
          await phase(page, "answering", 120_000);
          await signs(page, { nearer: 2 }, 0);
          await answerAll(page);
        }
        await look(here.view);
        await go(page, "mouse");
        here = await leave(page, here, 60_000);
      }
      await look("end");
      assert.deepEqual(seen, ["consent", "questions-missing", "questions", "page", "trial-ready", "trial", "page", "end"]);
      assert.deepEqual(browser.errors, [], "the console is clean");
    } finally {
      await browser.close();
      await server.stop();
    }
  });
}

/** The study with every text in this language as well: the English words. */
function alsoIn(language, study) {
  const copy = structuredClone(study);
  const walk = (part) => {
    if (part === null || typeof part !== "object") return;
    if (typeof part.en === "string") part[language] = part.en;
    Object.values(part).forEach(walk);
  };
  walk(copy);
  const { translations } = JSON.parse(mimique(["check", "--words", language]));
  return { ...copy, languages: ["en", "fr", language], translations };
}

test("access: a language written from right to left, 320 px", { skip: unable, timeout: 300_000 }, async () => {
  const browser = await open("undrawn", { viewport: { width: 320, height: 900 }, locale: "he-IL" });
  const server = await serve([await written(browser.page, alsoIn("he", study))]);
  const { page } = browser;
  const { look } = looker(page, screenshotFolder("access-rtl"));
  const direction = (selector) => page.locator(selector).first().evaluate((element) => getComputedStyle(element).direction);
  try {
    await page.goto(`${server.url}/s/access/?backend=webgl2`);
    await page.waitForSelector('main[data-view="consent"]', { timeout: 30_000 });
    assert.deepEqual(await page.evaluate(() => [document.documentElement.lang, document.documentElement.dir]), ["he", "rtl"]);
    await look("consent");
    let here = await place(page);
    await go(page, "mouse");
    here = await leave(page, here);
    assert.equal(here.view, "questions");
    assert.equal(await direction("fieldset"), "rtl");
    assert.equal(await direction(".affect"), "ltr", "valence grows to the right");
    await answerAll(page);
    await look("questions");
    while (here.view !== "trial") {
      await go(page, "mouse");
      here = await leave(page, here, 60_000);
    }
    assert.equal(await direction(".stage-frame"), "ltr", "the left clip stands left");
    // What is saved and loaded before that is shown by a progress bar that comes and goes.
    await phase(page, "ready", 120_000);
    await look("trial");
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});
