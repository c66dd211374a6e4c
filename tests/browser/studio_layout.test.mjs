// Marker layouts in the studio: made, dragged by mouse and moved by keys with the error beside, thinned and taken
// back, a map of one's own opened, all of it saved as a map that solve reads.

import assert from "node:assert/strict";
import { writeFileSync, mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { mimique, preview } from "./lib/server.mjs";
import { builtIn, download, unfold, violations } from "./lib/studio.mjs";

const noBrowser = skip(!executable && "Chromium not found");

/// What the page shows of the layout.
function shown(page) {
  return page.evaluate(() => {
    const rows = [...document.querySelectorAll("#layout-rows tr")].map((row) => ({
      index: Number(row.dataset.index), name: row.cells[0].textContent,
      expected: Number(row.cells[1].textContent), rehearsed: Number(row.cells[2].textContent),
    }));
    return { rows, note: document.querySelector("#layout-note").textContent, plot: document.querySelector("#layout-plot").ariaLabel ?? document.querySelector("#layout-plot").getAttribute("aria-label") };
  });
}

/// The picture of the plot, to see whether it moves.
const plotted = (page) => page.locator("#layout-plot").evaluate((canvas) => canvas.toDataURL());

/// Where the chosen marker's dot is drawn, once that is where it should be: pictures come with the display's next frame.
async function chosenDot(page, isThere = () => true) {
  let dot = null;
  for (let tries = 0; tries < 100; tries += 1) {
    dot = await dotNow(page);
    if (dot && isThere(dot)) break;
    await page.waitForTimeout(100);
  }
  return dot;
}

/// Where it is drawn now, found by its colour: CSS pixels of the window.
function dotNow(page) {
  return page.locator("#layout-overlay").evaluate((canvas) => {
    const { data, width, height } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let [x, y, count] = [0, 0, 0];
    for (let i = 0; i < data.length; i += 4) {
      if (data[i] !== 0xb3 || data[i + 1] !== 0 || data[i + 2] !== 0x1b || data[i + 3] !== 255) continue;
      x += (i / 4) % width;
      y += Math.floor(i / 4 / width);
      count += 1;
    }
    const { left, top, width: wide } = canvas.getBoundingClientRect();
    return count === 0 ? null : { x: left + (x / count) * (wide / width), y: top + (y / count) * (wide / width), count, height };
  });
}

const changed = (page, selector, before) =>
  page.waitForFunction(([selector, before]) => document.querySelector(selector).textContent !== before, [selector, before], { timeout: 60_000 });

async function make(page, count) {
  await page.fill("#layout-count", String(count));
  await page.click("#layout-make");
  await page.waitForFunction((count) => document.querySelectorAll("#layout-rows tr").length === count, count, { timeout: 120_000 });
  await page.waitForFunction(() => document.querySelector("#busy").hidden);
}

test("studio: a layout is made, dragged, moved by keys, thinned, taken back and saved", { skip: noBrowser, timeout: 600_000 }, async () => {
  const server = await preview([]);
  const browser = await open("webgl2");
  const { page } = browser;
  const folder = mkdtempSync(join(tmpdir(), "mimique-layout-"));
  try {
    await page.goto(`${server.url}?backend=webgl2`);
    assert.ok(await page.locator("#layouts").isHidden(), "nothing to lay out yet");
    await page.click("#avatar-built-in");
    await page.waitForFunction(() => document.querySelector("#avatar-facts").textContent.includes("57 shapes"));
    await unfold(page, "layouts");
    await make(page, 30);
    const first = await shown(page);
    assert.match(first.note, /^30 markers on the face, 6 for the head; expected error 0\.\d+ mm a vertex; no motion is known/);
    const costs = first.rows.map(({ expected }) => expected);
    assert.ok(costs.every((cost, i) => cost > 0 && (i === 0 || cost >= costs[i - 1])), `cheapest first: ${costs}`);

    // By mouse: a marker on the skin, a way along it; the curve moves with it, and it is one step.
    await page.locator('#layout-rows [data-act="choose"]').last().click();
    await page.locator("#layout-overlay").scrollIntoViewIfNeeded();
    await page.waitForFunction(() => document.querySelector("#layout-chosen").textContent !== "none");
    const chosen = await page.textContent("#layout-chosen");
    const from = await chosenDot(page);
    assert.ok(from, "the chosen marker is drawn");
    const plotBefore = await plotted(page);
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    for (let step = 1; step <= 6; step++) {
      await page.mouse.move(from.x + 5 * step, from.y - 3 * step);
      await page.waitForTimeout(60);
    }
    await changed(page, "#layout-note", first.note);
    await page.mouse.up();
    const isThere = (dot) => Math.hypot(dot.x - from.x - 30, dot.y - from.y + 18) < 12;
    const to = await chosenDot(page, isThere);
    assert.ok(isThere(to), `it went along with the pointer: ${JSON.stringify([from, to])}`);
    const dragged = await shown(page);
    assert.match(dragged.note, /expected error 0\.\d+ mm a vertex \(0\.\d+ mm as it was\)/);
    assert.notEqual(await plotted(page), plotBefore);
    assert.notEqual(dragged.plot, first.plot);

    // By keys: chosen, moved to neighbouring vertices, undone to where it was.
    await page.locator("#layout-overlay").focus();
    assert.equal(await page.textContent("#layout-chosen"), chosen);
    await page.keyboard.press("ArrowLeft");
    await changed(page, "#layout-note", dragged.note);
    const nudged = await shown(page);
    const left = await chosenDot(page, (dot) => dot.x < to.x - 1);
    assert.ok(left.x < to.x - 1, `to the left: ${to.x} to ${left.x}`);
    await page.keyboard.press("Control+z");
    await changed(page, "#layout-note", nudged.note);
    assert.deepEqual(await shown(page), dragged);
    await page.keyboard.press("Control+z");
    await changed(page, "#layout-note", dragged.note);
    assert.deepEqual(await shown(page), first, "the whole drag was one step");
    assert.ok(await page.locator("#undo").isDisabled());
    await page.keyboard.press("PageDown");
    assert.notEqual(await page.textContent("#layout-chosen"), chosen);

    // Which may go: what is said of the cheapest is what dropping it costs.
    await page.click("#layout-rehearse");
    await page.waitForFunction(() => document.querySelector("#layout-note").textContent.includes("rehearsed error"), null, { timeout: 120_000 });
    const rehearsed = await shown(page);
    const order = rehearsed.rows.map(({ rehearsed }) => rehearsed);
    assert.ok(order.every((cost, i) => i === 0 || cost >= order[i - 1]), `cheapest first: ${order}`);
    const all = (note) => Number(/rehearsed error ([\d.]+) mm/.exec(note)[1]);
    await page.locator('#layout-rows [data-act="drop"]').first().click();
    await page.waitForFunction(() => document.querySelectorAll("#layout-rows tr").length === 29);
    await page.waitForFunction(() => document.querySelector("#layout-note").textContent.includes("rehearsed error"), null, { timeout: 120_000 });
    const dropped = await shown(page);
    assert.ok(Math.abs(all(dropped.note) - all(rehearsed.note) - order[0]) < 0.011, `${rehearsed.note} ${dropped.note} ${order[0]}`);
    assert.ok(!dropped.rows.some(({ name }) => name.replace(/^\d+ /, "") === rehearsed.rows[0].name.replace(/^\d+ /, "")));
    await page.screenshot({ path: join(screenshotFolder("studio"), "layout.png"), fullPage: true });

    // Saved, it is a map: solve's reader takes it.
    const saved = await download(page, () => page.click("#layout-save"));
    const map = JSON.parse(String(saved));
    assert.equal(Object.keys(map.markers).length, 29);
    assert.equal(map.layout.method, "greedy");
    assert.equal(Object.keys(map.layout.head).length, 6);
    mimique(["sample", "--out", join(folder, "sample")]);
    writeFileSync(join(folder, "layout.json"), saved);
    const said = mimique(["layout", "check", join(folder, "layout.json"), "--avatar", join(folder, "sample/head.glb")]);
    assert.match(said, /29 face markers, 6 head markers/);

    await page.click("#undo");
    await page.waitForFunction(() => document.querySelectorAll("#layout-rows tr").length === 30);

    // What does not fit is said, and what is there stays.
    await page.selectOption("#layout-method", "farthest");
    await page.fill("#layout-count", "900");
    await page.click("#layout-make");
    await page.waitForFunction(() => document.querySelector("#problem").textContent.includes("ask for fewer"), null, { timeout: 60_000 });
    assert.equal((await shown(page)).rows.length, 30);
    assert.deepEqual(await violations(page), []);
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("studio: an existing map is thinned, on a phone and in the dark", { skip: noBrowser, timeout: 600_000 }, async () => {
  const server = await preview([]);
  const browser = await open("webgl2", { viewport: { width: 390, height: 844 }, colorScheme: "dark" });
  const { page } = browser;
  try {
    await builtIn(page, server);
    await unfold(page, "layouts");
    await page.click("#layout-from-map");
    await page.waitForFunction(() => document.querySelectorAll("#layout-rows tr").length === 40);
    await page.waitForFunction(() => document.querySelector("#busy").hidden);
    const before = await shown(page);
    const cheapest = before.rows[0];
    // By keyboard: the focus stays in its column.
    await page.locator('#layout-rows [data-act="drop"]').first().focus();
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => document.querySelectorAll("#layout-rows tr").length === 39);
    assert.equal(await page.evaluate(() => document.activeElement.dataset.act), "drop");
    const last = (words) => Number(/expected error ([\d.]+) mm/.exec(words)[1]);
    assert.ok(Math.abs(last((await shown(page)).note) - last(before.note) - cheapest.expected) < 0.011);
    const map = JSON.parse(String(await download(page, () => page.click("#layout-save"))));
    assert.equal(Object.keys(map.markers).length, 39);
    assert.ok(!(cheapest.name.replace(/^\d+ /, "") in map.markers));

    // A range of motion changes what markers are judged by.
    await unfold(page, "sources");
    await page.click("#training-built-in");
    await page.waitForFunction(() => document.querySelector("#layout-note").textContent.includes("judged by the motion of built-in actor"), null, { timeout: 60_000 });
    assert.equal((await shown(page)).rows.length, 39);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "nothing sticks out");
    assert.deepEqual(await violations(page), []);
    await page.locator("#layouts").screenshot({ path: join(screenshotFolder("studio"), "layout-phone-dark.png") });

    // A map of a file; what is wrong with one is said with its name.
    await page.setInputFiles("#layout-file", { name: "broken.json", mimeType: "application/json", buffer: Buffer.from("{") });
    await page.waitForFunction(() => document.querySelector("#problem").textContent.includes("broken.json"));
    await page.setInputFiles("#layout-file", { name: "thinned.json", mimeType: "application/json", buffer: Buffer.from(JSON.stringify(map)) });
    await page.waitForFunction(() => document.querySelector("#problem").hidden);
    await page.waitForFunction(() => document.querySelector("#undo").disabled);
    assert.equal((await shown(page)).rows.length, 39);
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});
