// Exertion in the studio: a built-in run whose heart and mouth follow the level of training, a window that moves, a
// body beside the face, files that are those of the command, what is refused; on a phone, in the dark, by keyboard.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { mimique, preview, root } from "./lib/server.mjs";
import { download, unfold, violations } from "./lib/studio.mjs";

const noBrowser = skip(!executable && "Chromium not found");
const sample = () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-exertion-"));
  mimique(["sample", "--out", join(folder, "sample")]);
  return folder;
};

/// What the page says of the window's end: its words, once they are others than `old`.
async function facts(page, old = "") {
  const shown = await page.waitForFunction(
    (old) => {
      const own = document.querySelector("#exertion-facts").textContent.replace(/, in \d+ ms/, "");
      return own !== "" && own !== old ? own : null;
    },
    old,
    { timeout: 60_000 },
  );
  return shown.jsonValue();
}
const heart = (words) => Number(/After \d+ s\s*heart (\d+) per minute/.exec(words)[1]);
const took = (page) => page.evaluate(() => Number(/in (\d+) ms/.exec(document.querySelector("#exertion-facts").textContent)[1]));

/// Sets an input as a person does.
const set = (page, id, value) =>
  page.locator(`#exertion-${id}`).evaluate((input, value) => {
    input.value = value;
    input.dispatchEvent(new Event("input", { bubbles: true }));
  }, String(value));

/// A shape's mean in a CSV of weights.
function mean(csv, shape) {
  const [head, ...rows] = csv.trim().split("\n").map((line) => line.split(","));
  const column = head.indexOf(shape);
  return rows.reduce((sum, row) => sum + Number(row[column]), 0) / rows.length;
}

/// How dark the middle of a canvas is drawn: the number of pixels with ink.
const inked = (page, selector) =>
  page.locator(selector).first().evaluate((canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return data.reduce((sum, value, i) => sum + (i % 4 === 3 && value > 100 ? 1 : 0), 0);
  });

test("studio: a run whose heart and mouth follow training, its window, its files", { skip: noBrowser, timeout: 600_000 }, async () => {
  const folder = sample();
  const server = await preview([]);
  const browser = await open("undrawn", { viewport: { width: 1440, height: 900 } });
  const { page } = browser;
  try {
    await page.goto(`${server.url}?backend=webgl2`);
    await unfold(page, "exertion");
    let words = await facts(page);
    assert.match(words, /built-in run/);
    assert.match(await page.locator("#exertion-veil").textContent(), /avatar/, "the face needs one, the body none");
    await page.click("#avatar-built-in");
    await page.waitForFunction(() => document.querySelector("#exertion-veil").hidden, null, { timeout: 60_000 });
    assert.ok((await inked(page, ".exertion-body")) > 500, "the body is drawn");
    assert.equal(await page.locator("#exertion-courses canvas").count(), 7);

    // From level 0 to 10 the heart calms, and the mouth closes.
    await set(page, "person-level", 0);
    words = await facts(page, words);
    const untrained = heart(words);
    assert.match(await page.locator("#exertion-notes").textContent(), /nine tenths.*steady settles/s);
    const weights = async () => String(await download(page, () => page.click("#exertion-weights")));
    const open0 = mean(await weights(), "jawOpen");
    await set(page, "person-level", 10);
    words = await facts(page, words);
    assert.ok(heart(words) < untrained - 20, `${heart(words)} ${untrained}`);
    const open10 = mean(await weights(), "jawOpen");
    assert.ok(open10 < 0.8 * open0, `${open10} ${open0}`);

    // The files are the command's, byte for byte.
    await set(page, "person-loads-back", 5);
    words = await facts(page, words);
    await set(page, "seed", 7);
    await page.waitForTimeout(500);
    const paths = ["w.csv", "s.csv"].map((name) => join(folder, name));
    mimique(["exertion", join(folder, "sample/run.bvh"), "--for", "5min", "--level", "10", "--loads", "back=5", "--seed", "7", "--heart", "thesis", "--window", "290:300", "--out", paths[0], "--series", paths[1]]);
    assert.equal(await weights(), readFileSync(paths[0], "utf8"));
    assert.equal(String(await download(page, () => page.click("#exertion-series"))), readFileSync(paths[1], "utf8"));
    assert.match(String(await download(page, () => page.click("#exertion-plot"))), /^<svg .*EPOC/s);
    const parts = JSON.parse(await download(page, () => page.click("#exertion-study")));
    assert.deepEqual(parts.captures.run.exertion.person.loads, { leftHand: 0, rightHand: 0, back: 5 });
    assert.deepEqual(parts.segments, [{ id: "run", capture: "run", first: 17400, end: 18001 }]);

    // A click on a course moves the window there; a drag goes on.
    const course = page.locator("#exertion-courses canvas").first();
    await course.scrollIntoViewIfNeeded();
    const box = await course.boundingBox();
    const x = (seconds) => box.x + 46 + ((box.width - 46) * seconds) / 300;
    await page.mouse.move(x(60), box.y + 30);
    await page.mouse.down();
    words = await facts(page, words);
    await page.mouse.move(x(120), box.y + 30, { steps: 4 });
    await page.mouse.up();
    await page.waitForFunction(() => /After 12[3-7] s/.test(document.querySelector("#exertion-facts").textContent));
    const ends = await page.evaluate(() => ["from", "to"].map((end) => Number(document.querySelector(`#exertion-${end}`).value)));
    assert.ok(Math.abs(ends[0] - 115) <= 1.5 && ends[1] - ends[0] === 10, `${ends}`);
    const moved = heart(await facts(page));
    assert.ok(moved < heart(words) + 60 && moved > 60, `${moved}`);

    // Played, body and face go on in step.
    const before = await page.locator(".exertion-body").evaluate((canvas) => canvas.toDataURL());
    await page.keyboard.press("Escape");
    await page.click("#play");
    await page.waitForFunction(() => parseFloat(document.querySelector("#clock").textContent) > 0.6, null, { timeout: 30_000 });
    await page.click("#play");
    assert.notEqual(await page.locator(".exertion-body").evaluate((canvas) => canvas.toDataURL()), before);
    assert.match(await page.locator("#clock").textContent(), /\/ 10\.00 s/);

    // What is wrong is said at its input, and nothing is saved of it.
    await set(page, "to", 400);
    await page.waitForFunction(() => document.querySelector("#exertion-problem").textContent.includes("of 300 s"));
    assert.equal(await page.locator("#exertion-to").getAttribute("aria-invalid"), "true");
    assert.ok(await page.locator("#exertion-weights").isDisabled());
    await set(page, "to", 125);
    await page.waitForFunction(() => document.querySelector("#exertion-problem").hidden);

    // Five minutes of running at every step of a slider.
    const times = [];
    for (let level = 1; level <= 9; level += 1) {
      words = await facts(page);
      await set(page, "person-level", level);
      await facts(page, words);
      times.push(await took(page));
    }
    console.log(`five minutes of running, computed and shown: ${times.join(", ")} ms`);
    assert.deepEqual(await violations(page), []);
    await page.screenshot({ path: join(screenshotFolder("studio"), "exertion.png"), fullPage: true });
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("studio: exertion of files, and a motion without joints", { skip: noBrowser, timeout: 600_000 }, async () => {
  const folder = sample();
  const server = await preview([]);
  const browser = await open("undrawn", {});
  const { page } = browser;
  try {
    await page.goto(`${server.url}?backend=webgl2`);
    await unfold(page, "exertion");
    let words = await facts(page);
    const openMotion = (file) => page.setInputFiles('#exertion-settings input[accept*=".fit"]', file);
    await openMotion(join(folder, "sample/walk.bvh"));
    words = await facts(page, words);
    assert.match(words, /walk\.bvh/);
    // A recording has a heart of its own and no body.
    await openMotion(join(root, "docs/guide/data/exertion/ride.csv"));
    words = await facts(page, words);
    assert.match(words, /ride\.csv/);
    assert.equal(await page.locator("#exertion-heart").inputValue(), "recorded");
    assert.ok(await page.locator(".exertion-body").isHidden());
    const study = JSON.parse(String(await download(page, () => page.click("#exertion-study"))));
    assert.deepEqual([study.captures.ride.exertion.activity, study.captures.ride.exertion.heart], ["ride.csv", "recorded"]);
    // A face's markers are no body's.
    await page.click("#avatar-built-in");
    await page.click("#take-built-in");
    await page.waitForFunction(() => !document.querySelector("#exertion-source option[value=take]").disabled, null, { timeout: 120_000 });
    await page.selectOption("#exertion-source", "take");
    await page.waitForFunction(() => /no joints of a body.*CMU, Mixamo or Xsens/.test(document.querySelector("#exertion-problem").textContent), null, { timeout: 120_000 });
    assert.equal(await page.locator("#exertion-source").getAttribute("aria-invalid"), "true");
    await page.selectOption("#exertion-source", "walk");
    await page.waitForFunction(() => document.querySelector("#exertion-problem").hidden);
    // The take and the window are played in step; the window can be played alone, and be exported.
    await unfold(page, "exports");
    await page.selectOption("#range", "exertion");
    await page.selectOption("#export-slot", "exertion");
    assert.equal(String((await download(page, () => page.click("#export-glb"))).subarray(0, 4)), "glTF");
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("studio: exertion on a phone, in the dark, by keyboard", { skip: noBrowser, timeout: 600_000 }, async () => {
  const server = await preview([]);
  const browser = await open("undrawn", { viewport: { width: 360, height: 780 }, colorScheme: "dark" });
  const { page } = browser;
  try {
    await page.goto(`${server.url}?backend=webgl2`);
    await page.click("#avatar-built-in");
    await page.locator("#tab-exertion").focus();
    await page.keyboard.press("Enter");
    let words = await facts(page);
    await page.waitForFunction(() => document.querySelector("#exertion-veil").hidden, null, { timeout: 60_000 });
    // The level by arrow keys; the value is read beside it.
    await page.locator("#exertion-person-level").focus();
    await page.keyboard.press("End");
    words = await facts(page, words);
    assert.equal(await page.locator("#exertion-person-level + output").textContent(), "10");
    await page.keyboard.press("Home");
    const trained = heart(words);
    words = await facts(page, words);
    assert.ok(heart(words) > trained);
    // The window by keys.
    await page.locator("#exertion-from").fill("5");
    await page.locator("#exertion-to").fill("12");
    await page.waitForFunction(() => /After 12 s/.test(document.querySelector("#exertion-facts").textContent));
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "nothing sticks out");
    assert.deepEqual(await violations(page), []);
    await page.screenshot({ path: join(screenshotFolder("studio"), "exertion-phone-dark.png"), fullPage: true });
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});
