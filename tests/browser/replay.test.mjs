// The replay of a session: somebody takes part, one frame comes late; a researcher goes through what was seen, and the
// clips are drawn again on the frames of their logs.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { lost, violations } from "./lib/access.mjs";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { answer, go, leave, phase, place, storedEvents, until } from "./lib/participant.mjs";
import { serve } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");
const LATE_MS = 300;

const study = small("seen", {
  components: {
    how: { type: "questionnaire", questions: [{ id: "mood", type: "likert", prompt: text("How are you?"), numItems: 7, leftLabel: text("bad"), rightLabel: text("good") }] },
    faces: trials(["joy2.box.head"], ["real"]),
    pairs: { ...trials(["joy2.box.head"], ["nearer"]), beside: { avatar: "actor", method: "real", side: "right" } },
  },
  questions: [
    { id: "real", type: "singleChoice", prompt: text("Is it real?"), options: [{ value: "y", label: text("surely") }, { value: "n", label: text("hardly") }] },
    { id: "nearer", type: "comparison", prompt: text("Which is more natural?"), allowSame: true },
  ],
  sequence: { order: "fixed", components: ["how", "faces", "pairs"] },
  stimuli: stimuli(
    { head: { builtin: { seed: 1 } }, actor: { builtin: { actor: 7 }, look: "reference" } },
    { box: { method: "box" }, real: { method: "recorded" } },
    [["head", "box"], ["actor", "real"]],
  ),
});

/** Takes part; while the first clip plays, the page does something else for a while. */
async function takePart(page, address) {
  await page.goto(address);
  await page.waitForSelector("main[data-view]", { timeout: 30_000 });
  let here = await place(page);
  let trial = 0;
  while (here.view !== "end") {
    if (here.view === "trial") {
      trial += 1;
      await phase(page, "ready", 120_000);
      await go(page, "keyboard");
      await phase(page, "playing");
      if (trial === 1) {
        await page.waitForTimeout(300);
        await page.evaluate((ms) => {
          for (const end = performance.now() + ms; performance.now() < end; );
        }, LATE_MS);
      }
      await phase(page, "answering");
    }
    await answer(page, "keyboard", here.step);
    if (here.view !== "receipt") await go(page, "keyboard");
    here = await leave(page, here, 60_000);
  }
}

/** What the canvas draws until the clip has ended: [when, time of the clip]. */
async function drawnWhilePlaying(page) {
  await page.evaluate(() => {
    const canvas = document.querySelector("#stages canvas");
    window.drawn = [];
    new MutationObserver(() => window.drawn.push([performance.now(), Number(canvas.dataset.clipMs)])).observe(canvas, { attributeFilter: ["data-clip-ms"] });
  });
  await page.keyboard.press("Space");
  await page.waitForFunction(() => document.getElementById("play").textContent === "Pause");
  await page.waitForFunction(() => document.getElementById("play").textContent === "Play", undefined, { timeout: 60_000 });
  return page.evaluate(() => window.drawn);
}

test("replay: what somebody saw is drawn again, a late frame late", { skip: unable, timeout: 400_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-replay-"));
  writeFileSync(join(folder, "seen.json"), JSON.stringify(study));
  const server = await serve([join(folder, "seen.json")]);
  const browser = await open("undrawn", { viewport: { width: 1280, height: 900 } });
  const { page } = browser;
  const shots = screenshotFolder("replay");
  const look = async (name, width, colorScheme) => {
    await page.setViewportSize({ width, height: 900 });
    await page.emulateMedia({ colorScheme });
    await page.screenshot({ path: join(shots, `${name}-${width}-${colorScheme}.png`), fullPage: true });
    const sideways = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
    assert.ok(sideways <= 0, `${name} scrolls sideways by ${sideways} px at ${width} px`);
    assert.deepEqual(await violations(page), [], `${name}, ${width} px: axe`);
    assert.deepEqual(await lost(page), [], `${name}, ${width} px: no room for it`);
    assert.equal(await page.locator("h1:visible").count(), 1);
  };
  try {
    await takePart(page, `${server.url}/s/seen/?backend=webgl2`);
    const stored = () => storedEvents(page, server, "seen");
    await until("the end is stored", async () => (await stored()).some(({ type }) => type === "finished"));
    const events = await stored();
    const plays = events.filter(({ type, log }) => type === "trial_played" && !log.aborted);
    assert.equal(plays.length, 2);
    const { frames } = plays[0].log;
    const gap = (at) => frames[at][0] - frames[at - 1][0];
    const late = frames.map((_, at) => at).filter((at) => frames[at][2]).reduce((one, other) => (gap(one) >= gap(other) ? one : other));
    assert.ok(gap(late) > 0.6 * LATE_MS, `a frame came late: ${gap(late)} ms`);

    // From the participant's page.
    await page.goto(server.researcher());
    await page.getByLabel("E-mail").fill("ada@example.org");
    await page.getByLabel("Password").fill("four words are good");
    await page.keyboard.press("Enter");
    await page.waitForURL("**/researcher");
    await page.goto(`${server.url}/researcher/studies/seen/participants/1`);
    await page.getByRole("link", { name: /^Replay/ }).click();
    await page.waitForURL("**/participants/1/replay**");
    await page.goto(`${server.url}/researcher/studies/seen/participants/1/replay?backend=webgl2`);
    await page.waitForSelector("#pages:not([hidden])");
    const shown = page.locator(".seen:visible");
    assert.equal(await shown.count(), 1, "one page at a time");
    const headings = await page.locator("#page option").allTextContents();
    const visited = events.filter(({ type }) => ["page_finished", "trial_finished", "consented"].includes(type));
    assert.equal(headings.length, visited.length, headings.join(" | "));

    // By keys, page after page; what was answered stands there in the words that were read.
    const words = { how: /1 bad – 7 good/, faces: /surely|hardly/ };
    let trial = 0;
    const seen = new Set();
    for (let number = 1; number <= headings.length; number++) {
      await page.waitForFunction((at) => document.getElementById("page").value === String(at), number);
      const step = visited[number - 1].step;
      const said = await shown.innerText();
      for (const [name, expected] of Object.entries(words)) {
        if (step?.startsWith(name)) {
          assert.match(said, expected, step);
          seen.add(name);
        }
      }
      // When it was answered: of a trial after its first frame, else after the page was shown.
      const answered = events.filter((event) => event.type === "answered" && event.step === step).at(-1);
      if (answered) {
        const [, after] = /(?:after the first frame|after): (\d+\.\d\d) s/.exec(said) ?? [];
        const from = plays.find((play) => play.step === step)?.log.onset_ms ?? events.find((event) => event.type === "page_shown" && event.step === step).at_ms;
        assert.ok(Math.abs(Number(after) - (answered.at_ms - from) / 1000) < 0.006, `${step}: ${after} s, by the log ${(answered.at_ms - from) / 1000} s`);
      }
      if (step?.startsWith("faces")) {
        await page.waitForFunction(() => document.getElementById("same").textContent, undefined, { timeout: 120_000 });
        const equal = await page.locator("#same").textContent();
        assert.ok(equal.startsWith("joy2.box.head: the weights are those that were shown then") && equal.includes("equals what was shown"), equal);
        const strip = page.locator("#strip svg");
        assert.match(await strip.getAttribute("aria-label"), new RegExp(`^${frames.length} frames in .*, ${frames.filter((frame) => frame[2]).length} late`));
        const marks = (await page.locator("#strip path.late").getAttribute("d")).split("M").length - 1;
        assert.equal(marks, frames.filter((frame) => frame[2]).length);

        const drawn = await drawnWhilePlaying(page);
        const places = drawn.map(([, ms]) => frames.findIndex((frame) => Math.abs(frame[1] - ms) < 1e-6));
        assert.ok(places.every((at) => at >= 0), "nothing but what was shown is drawn");
        assert.ok(places.every((at, k) => k === 0 || at >= places[k - 1]), `in its order: ${places}`);
        assert.equal(places.at(-1), frames.length - 1, "to the end");
        assert.ok(places.length > frames.length / 4, `${places.length} of ${frames.length} frames are drawn`);
        // The frame before the late one stands as long as it did.
        const before = places.indexOf(late - 1);
        assert.ok(before >= 0 && before + 1 < places.length, "the frame before the late one is drawn");
        const stood = drawn[before + 1][0] - drawn[before][0];
        assert.ok(stood > gap(late) - 60, `the late frame is late: ${stood} ms, as it was by ${gap(late)} ms`);

        // Frame by frame, and to the late frame.
        const clipMs = () => page.locator("#stages canvas").getAttribute("data-clip-ms").then(Number);
        const nth = frames.map((_, at) => at).filter((at) => frames[at][2]).indexOf(late);
        await page.locator("#late button").nth(nth).click();
        await until("the late frame is drawn", async () => (await clipMs()) === frames[late][1], 5000);
        await page.locator("#scrub").focus();
        await page.keyboard.press(",");
        await until("the frame before it", async () => (await clipMs()) === frames[late - 1][1], 5000);
        await page.keyboard.press(".");
        await until("and on", async () => (await clipMs()) === frames[late][1], 5000);
        await look("clip", 1280, "light");
        await look("clip", 360, "dark");
        await page.setViewportSize({ width: 1280, height: 900 });
      }
      if (step?.startsWith("pairs")) {
        await page.waitForFunction(() => document.querySelectorAll("#stages canvas[data-clip-ms]").length === 2, undefined, { timeout: 120_000 });
        await page.waitForFunction(() => document.querySelectorAll("#same span").length === 2);
        assert.match(await page.locator("#same").textContent(), /joy2\.real\.actor: the log holds no weights of it; the clip was prepared alike/);
      }
      if (await page.locator("#player:visible").count()) trial += 1;
      await page.locator("h1").click();
      if (number < headings.length) await page.keyboard.press("n");
    }
    assert.equal(trial, 2);
    assert.deepEqual([...seen].sort(), Object.keys(words).sort());
    assert.ok(await page.locator("#after").isDisabled());

    // In French, on a phone, dark.
    await page.getByRole("link", { name: "Français" }).click();
    await page.waitForSelector("html[lang=fr]");
    const faces = visited.findIndex(({ step }) => step?.startsWith("faces")) + 1;
    await page.goto(`${server.url}/researcher/studies/seen/participants/1/replay?backend=webgl2#page-${faces}`);
    await page.waitForFunction(() => document.getElementById("same").textContent, undefined, { timeout: 120_000 });
    assert.match(await page.locator("#same").textContent(), /ce qui est dessiné est ce qui a été montré/);
    assert.match(await page.locator("#clock").textContent(), /^0,00 \/ \d+,\d\d s$/);
    await look("french", 360, "dark");
    await look("french", 1280, "light");
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});
