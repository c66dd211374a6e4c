// Keys while the clip plays: the first press is the answer, its time that of the press on the frames' clock; a mouse
// presses the buttons; what comes after the clip's end counts too.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { violations } from "./lib/access.mjs";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { go, leave, phase, place, storedEvents, toFirstTrial, until } from "./lib/participant.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

const option = (value, words) => ({ value, label: text(words) });
const study = small("speeded", {
  questions: [{
    id: "felt", type: "singleChoice", prompt: text("Joy or anger?"), truth: "expression",
    options: [option("joy", "Joy"), option("anger", "Anger")], keys: { joy: "F", anger: "J" },
  }],
  components: { faces: trials(["joy2.lsts", "joy2.recorded", "joy2.box"], ["felt"]) },
  sequence: { order: "fixed", components: ["faces"] },
  stimuli: stimuli(
    { head: { builtin: { seed: 1 } } },
    { lsts: { method: "lsts" }, recorded: { method: "recorded" }, box: { method: "box" } },
    [["head", "lsts"], ["head", "recorded"], ["head", "box"]],
  ),
});

test("keys: pressed while the clip plays, by key and by mouse, and after it", { skip: unable, timeout: 300_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-keys-"));
  writeFileSync(join(folder, "speeded.json"), JSON.stringify(study));
  const server = await serve([join(folder, "speeded.json")]);
  const browser = await open("undrawn", { viewport: { width: 390, height: 844 } });
  const shots = screenshotFolder("keys");
  const { page } = browser;
  const pressed = (value) => page.locator(`button[data-action=press][value=${value}]`).getAttribute("aria-pressed");
  try {
    await page.goto(`${server.url}/s/speeded/?backend=webgl2`);
    await page.waitForSelector("main[data-view]", { timeout: 30_000 });
    let here = await place(page);
    while (here.view !== "trial") {
      await go(page, "keyboard");
      here = await leave(page, here, 60_000);
    }
    for (const how of ["key", "mouse", "late"]) {
      await phase(page, "ready", 120_000);
      await page.keyboard.press("j");
      assert.equal(await pressed("anger"), "false", "nothing before the clip plays");
      await go(page, "keyboard");
      await phase(page, "playing");
      if (how === "key") {
        await page.evaluate(() => {
          addEventListener("keydown", (event) => (window.pressedAt ??= performance.timeOrigin + event.timeStamp), { capture: true });
          // Which buttons are pressed, at every change.
          window.states = [];
          const buttons = [...document.querySelectorAll("button[data-action=press]")];
          const note = () => window.states.push(buttons.filter((button) => button.getAttribute("aria-pressed") === "true").map((button) => button.value).join());
          for (const button of buttons) new MutationObserver(note).observe(button, { attributes: true, attributeFilter: ["aria-pressed"] });
        });
        await page.waitForTimeout(700);
        await page.keyboard.press("f");
        await page.keyboard.press("j");
        await page.screenshot({ path: join(shots, "pressed.png") });
        assert.equal(await page.evaluate(() => window.states[0]), "joy", "the first one");
        assert.ok(!(await page.evaluate(() => window.states)).includes("anger"), "the second one is none");
      } else if (how === "mouse") {
        await page.waitForTimeout(500);
        await page.locator("button[value=anger]").click();
      } else {
        await phase(page, "answering", 60_000);
        assert.deepEqual(await violations(page), [], "axe");
        await page.keyboard.press("F");
      }
      here = await leave(page, here, 60_000);
      if (how === "key") {
        const answered = async () => (await storedEvents(page, server, "speeded")).find(({ type }) => type === "answered");
        await until("the answer is stored", async () => (await answered()) !== undefined);
        const late = (await answered()).at_ms - (await page.evaluate(() => window.pressedAt));
        assert.ok(Math.abs(late) < 1, `the time of the press itself, not ${late} ms later`);
      }
    }
    while (here.view !== "end") {
      if (here.view !== "receipt") await go(page, "keyboard");
      here = await leave(page, here, 60_000);
    }
    assert.deepEqual(browser.errors, [], "the console is clean");
    const rows = parse(mimique(["export", "--database", server.database, "--format", "csv"])).filter((row) => row.response_id === "felt");
    assert.deepEqual(rows.map(({ answer, correct }) => [answer, correct]), [["joy", "true"], ["anger", "false"], ["joy", "true"]]);
    const [first, second, third] = rows.map((row) => Number(row.rt));
    // A clip lasts 4 s, on a busy machine half a second more.
    for (const rt of [first, second]) assert.ok(rt > 100 && rt < 4600, `while it played: ${rt} ms`);
    assert.ok(third > 3800, `after a clip of 4 s: ${third} ms`);
    for (const row of rows) assert.equal(row.rt, row.rt_open);
  } finally {
    await browser.close();
    await server.stop();
  }
});

const line = small("followed", {
  questions: [{ id: "strength", type: "slider", whilePlaying: true, prompt: text("How intense?"), minimum: 0, maximum: 100, leftLabel: text("not"), rightLabel: text("very") }],
  components: { faces: trials(["joy2.lsts"], ["strength"]) },
  sequence: { order: "fixed", components: ["faces"] },
  stimuli: stimuli({ head: { builtin: { seed: 1 } } }, { lsts: { method: "lsts" } }, [["head", "lsts"]]),
});

test("keys: a line moved while the clip plays, 60 values a second", { skip: unable, timeout: 200_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-line-"));
  writeFileSync(join(folder, "followed.json"), JSON.stringify(line));
  const server = await serve([join(folder, "followed.json")]);
  const browser = await open("undrawn", { viewport: { width: 1280, height: 800 } });
  const shots = screenshotFolder("keys");
  const { page } = browser;
  try {
    let here = await toFirstTrial(page, `${server.url}/s/followed/?backend=webgl2`);
    assert.deepEqual(await violations(page), [], "axe");
    await go(page, "keyboard");
    await phase(page, "playing");
    await page.waitForFunction(() => document.activeElement?.matches("input[data-trace]"), null, { timeout: 10_000 });
    await page.waitForTimeout(1000);
    for (let presses = 0; presses < 20; presses++) await page.keyboard.press("ArrowRight");
    await page.screenshot({ path: join(shots, "line.png") });
    here = await leave(page, here, 60_000);
    while (here.view !== "end") {
      if (here.view !== "receipt") await go(page, "keyboard");
      here = await leave(page, here, 60_000);
    }
    assert.deepEqual(browser.errors, [], "the console is clean");
    const [row] = parse(mimique(["export", "--database", server.database, "--format", "csv"])).filter((each) => each.response_id === "strength");
    const course = JSON.parse(row.trace);
    // A clip of 4 s, the first and the last instant among them; the last frame may be late by half a second.
    assert.ok(course.length >= 240 && course.length <= 272, `${course.length} values`);
    // Of twenty presses those count that come before the last frame.
    assert.ok(course[0] === 50 && course.at(-1) > 50 && course.at(-1) <= 70, `from ${course[0]} to ${course.at(-1)}`);
    assert.ok(course.every((value, k) => k === 0 || value >= course[k - 1]), "it only rises");
    const mean = course.reduce((sum, value) => sum + value, 0) / course.length;
    assert.ok(Math.abs(Number(row.answer) - mean) < 1e-3);
  } finally {
    await browser.close();
    await server.stop();
  }
});
