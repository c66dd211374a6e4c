// Clip, button and answers are seen together: on twelve screens, with text of 200 % and 400 %, in French and in the
// dark; two clips stand side by side everywhere. What was not wholly in view does not count as seen.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { looker } from "./lib/access.mjs";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { answer, go, leave, phase, place, settled, storedEvents, tabTo, until } from "./lib/participant.mjs";
import { serve } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

const emotions = ["anger", "disgust", "fear", "joy", "sadness", "surprise"];
const scale = { type: "likert", numItems: 7, leftLabel: text("not at all"), rightLabel: text("very") };
const study = small("together", {
  questions: [
    { id: "emotion", type: "singleChoice", prompt: text("Which emotion do you see?"), options: emotions.map((value) => ({ value, label: text(value) })) },
    { id: "strength", prompt: text("How strong is it?"), ...scale },
    { id: "nearer", type: "comparison", prompt: text("Which is nearer?"), allowSame: true },
  ],
  components: {
    faces: { ...trials(["joy2.box.head"], ["emotion", "strength"]), repetitions: 2 },
    pairs: { ...trials(["joy2.box.head"], ["nearer", "strength"]), beside: { avatar: "actor", method: "real", side: "left", caption: text("The person"), clipCaption: text("The face") } },
  },
  sequence: { order: "fixed", components: ["faces", "pairs"] },
  stimuli: stimuli(
    { head: { builtin: { seed: 1, vertices: 2000 } }, actor: { builtin: { actor: 7 } } },
    { box: { method: "box" }, real: { method: "recorded" } },
    [["head", "box"], ["actor", "real"]],
  ),
});

// Width, height, and where the answers belong: beside the clip on wide windows, below it elsewhere.
const screens = [
  [1920, 969], [1536, 730], [1440, 780], [1366, 657], [1280, 593], [1024, 700],
  [768, 1024], [640, 328], [390, 844], [360, 640], [844, 390], [320, 164],
];

/** What of the page is wholly in the window as it is scrolled now. */
function seen(page) {
  return page.evaluate(() => {
    const whole = (element) => {
      const { top, left, bottom, right } = element.getBoundingClientRect();
      return top >= -1 && left >= -1 && bottom <= innerHeight + 1 && right <= innerWidth + 1;
    };
    const all = (selector) => [...document.querySelectorAll(selector)];
    const stages = all(".stage");
    return {
      stages: stages.map(whole),
      sizes: stages.map((stage) => [stage.clientWidth, stage.clientHeight]),
      play: all(".play button").map(whole),
      questions: all("fieldset[data-question]").map(whole),
      submit: all(".answers [data-action=next]").map(whole),
      lefts: stages.map((stage) => Math.round(stage.getBoundingClientRect().left)),
      tops: stages.map((stage) => Math.round(stage.getBoundingClientRect().top)),
      form: document.querySelector(".answers > form")?.getBoundingClientRect().top,
    };
  });
}

async function begin(browser, server) {
  const { page } = browser;
  await page.goto(`${server.url}/s/together/?backend=webgl2`);
  await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
  const here = await place(page);
  await go(page, "mouse");
  await leave(page, here);
  await phase(page, "ready", 120_000);
}

async function host() {
  const folder = mkdtempSync(join(tmpdir(), "mimique-together-"));
  writeFileSync(join(folder, "together.json"), JSON.stringify(study));
  return serve([join(folder, "together.json")]);
}

test("together: twelve screens, one clip and two", { skip: unable, timeout: 600_000 }, async () => {
  const server = await host();
  const shots = screenshotFolder("together");
  const browser = await open("undrawn", { viewport: { width: 1280, height: 900 }, locale: "fr-FR", colorScheme: "dark" });
  const { page } = browser;
  // Every screen is looked at in one phase; a person who turns a phone sees the same.
  const everywhere = async (name, check) => {
    for (const [width, height] of screens) {
      await page.setViewportSize({ width, height });
      await page.evaluate((selector) => document.querySelector(selector).scrollIntoView({ block: "nearest" }), name === "answering" && width < 960 ? ".answers > form" : ".stage-frame");
      await settled(page);
      const found = await seen(page);
      await page.screenshot({ path: join(shots, `${name}-${width}x${height}.png`) });
      const sideways = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
      assert.ok(sideways <= 0, `${name} ${width} x ${height} scrolls sideways by ${sideways} px`);
      check(found, width, height);
    }
    await page.setViewportSize({ width: 1280, height: 593 });
  };
  const clipAndButton = (found, width, height) => {
    const where = `${width} x ${height}: ${JSON.stringify(found)}`;
    assert.ok(found.stages.every(Boolean), `the whole picture is in view, ${where}`);
    assert.ok(found.play.every(Boolean), `and the button, ${where}`);
    for (const [across, down] of found.sizes) assert.ok(Math.abs(across / down - found.sizes[0][0] / found.sizes[0][1]) < 0.02 && down >= Math.min(90, 0.5 * height), `its size, ${where}`);
  };
  try {
    await begin(browser, server);
    await everywhere("ready", clipAndButton);
    await go(page, "mouse");
    await phase(page, "answering", 120_000);
    await everywhere("answering", (found, width, height) => {
      const where = `${width} x ${height}: ${JSON.stringify(found)}`;
      if (width >= 960) {
        assert.ok(found.stages.every(Boolean) && found.play.every(Boolean), where);
        assert.ok(found.questions.every(Boolean) && found.submit.every(Boolean), `all answers beside the clip, ${where}`);
      } else {
        assert.ok(found.form < height / 2 || found.submit.every(Boolean), `the questions are come to, ${where}`);
      }
    });
    for (const _ of [1, 2]) {
      await answer(page, "mouse", "faces");
      const here = await place(page);
      await go(page, "mouse");
      await leave(page, here);
      await phase(page, "ready", 120_000);
      if (await page.locator(".stage-frame.pair").count()) break;
      await go(page, "mouse");
      await phase(page, "answering", 120_000);
    }
    await everywhere("pair", (found, width, height) => {
      clipAndButton(found, width, height);
      const where = `${width} x ${height}: ${JSON.stringify(found)}`;
      assert.equal(found.stages.length, 2);
      assert.ok(Math.abs(found.tops[0] - found.tops[1]) <= 1, `side by side, ${where}`);
      assert.ok(found.lefts[1] < found.lefts[0], `the companion is left, as the study has it, ${where}`);
    });
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("together: the page goes to the stage, then to the questions, by keyboard on a phone; axe at 200 % and 400 %", { skip: unable, timeout: 400_000 }, async () => {
  const server = await host();
  const browser = await open("undrawn", { viewport: { width: 390, height: 700 } });
  const { page } = browser;
  try {
    await begin(browser, server);
    assert.ok((await seen(page)).stages[0], "the stage is there without scrolling");
    await page.evaluate(() => scrollTo(0, 1e6));
    await tabTo(page, "[data-action=play]");
    await page.keyboard.press("Enter");
    await phase(page, "playing");
    assert.ok((await seen(page)).stages[0]);
    await phase(page, "answering", 120_000);
    await page.waitForFunction(() => document.querySelector(".answers > form").getBoundingClientRect().top < innerHeight / 2, undefined, { timeout: 5_000 });
    for (const [width, height, zoom] of [[640, 390, 1], [320, 195, 1], [1280, 780, 2]]) {
      await page.setViewportSize({ width, height });
      await looker(page, screenshotFolder(`together-${width}-${zoom}`), zoom).look("answering");
    }
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("together: a play that was not wholly in view does not count", { skip: unable, timeout: 240_000 }, async () => {
  const server = await host();
  const browser = await open("undrawn", { viewport: { width: 390, height: 600 } });
  const { page } = browser;
  try {
    await begin(browser, server);
    await go(page, "mouse");
    await phase(page, "playing");
    await page.waitForTimeout(300);
    await page.evaluate(() => {
      document.body.style.paddingBottom = "100vh";
      scrollTo(0, document.querySelector(".stage").getBoundingClientRect().top + scrollY + 80);
    });
    await phase(page, "ready", 30_000);
    assert.match(await page.locator(".trial-message").innerText(), /A part of the clip was not in view/);
    assert.equal(await page.locator(".answers form").count(), 0, "nothing is asked");
    // The next one is brought into view by the press itself.
    await page.locator("[data-action=play]").press("Enter");
    await phase(page, "answering", 60_000);
    const plays = async () => (await storedEvents(page, server, "together")).filter(({ type }) => type === "trial_played");
    await until("both plays are stored", async () => (await plays()).length === 2);
    assert.deepEqual((await plays()).map(({ log }) => log.aborted), ["out of view", null]);
  } finally {
    await browser.close();
    await server.stop();
  }
});
