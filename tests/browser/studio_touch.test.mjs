// The studio by fingers on a tablet: a face is turned by one and zoomed and moved by two, a segment is dragged by its
// edge, the time is scrubbed; nothing scrolls away underneath.

import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { preview } from "./lib/server.mjs";

const noBrowser = skip(!executable && "Chromium not found");

/** Fingers on the screen, as the browser gets them from it: `paths`, one per finger, of as many places each. */
async function draw(page, paths) {
  const session = await page.context().newCDPSession(page);
  const at = (step) => paths.map((path, id) => ({ x: path[step][0], y: path[step][1], id }));
  const send = (type, touchPoints) => session.send("Input.dispatchTouchEvent", { type, touchPoints });
  await send("touchStart", at(0));
  for (let step = 1; step < paths[0].length; step++) await send("touchMove", at(step));
  await send("touchEnd", []);
  await session.detach();
}

/** A straight way in some steps. */
const way = ([x, y], [right, down], steps = 8) => Array.from({ length: steps + 1 }, (_, k) => [x + (right * k) / steps, y + (down * k) / steps]);

test("studio: a face is turned, zoomed and moved by fingers, and time by one", { skip: noBrowser, timeout: 300_000 }, async () => {
  const server = await preview([]);
  const browser = await open("undrawn", { viewport: { width: 820, height: 1180 }, touch: true });
  const { page } = browser;
  const shots = screenshotFolder("studio");
  const view = () => page.evaluate(() => JSON.parse(localStorage.getItem("mimique-studio") ?? "{}").camera ?? { yaw: 0, pitch: 0, zoom: 1, x: 0, y: 0 });
  try {
    await page.goto(`${server.url}?backend=webgl2`);
    await page.tap("#start-built-in");
    await page.waitForFunction(() => document.querySelector(".studio-inspector .preview-clip div"), null, { timeout: 120_000 });
    const stage = page.locator('section[aria-label="View A"] .stage');
    await stage.scrollIntoViewIfNeeded();
    const box = await stage.boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const scrolled = await page.evaluate(() => scrollY);
    const front = await view();

    // One finger to the right by a fifth of the picture: the face turns by a fifth of the turn, and does not nod.
    await draw(page, [way([x, y], [box.width / 5, 0])]);
    const turned = await view();
    assert.ok(Math.abs(turned.yaw - front.yaw + 3.2 / 5) < 0.15, `turned by ${turned.yaw - front.yaw}`);
    assert.ok(Math.abs(turned.pitch - front.pitch) < 0.02 && turned.zoom === front.zoom, JSON.stringify(turned));
    await draw(page, [way([x, y], [0, box.height / 8])]);
    assert.ok((await view()).pitch > turned.pitch + 0.2, "down: it nods");

    // Two fingers apart: larger; both to one side: moved, and no larger.
    await draw(page, [way([x - 40, y], [-60, 0]), way([x + 40, y], [60, 0])]);
    const zoomed = await view();
    assert.ok(Math.abs(zoomed.zoom / front.zoom - 2.5) < 0.4, `zoomed by ${zoomed.zoom}`);
    await draw(page, [way([x - 40, y], [80, 0]), way([x + 40, y], [80, 0])]);
    const moved = await view();
    assert.ok(Math.abs(moved.x - zoomed.x - 80 / box.width) < 0.05 && Math.abs(moved.zoom / zoomed.zoom - 1) < 0.1, JSON.stringify([zoomed, moved]));
    assert.equal(await page.evaluate(() => scrollY), scrolled, "the page stays where it is");
    await page.screenshot({ path: join(shots, "touch-820.png") });

    // The time, by one finger on its line.
    const scrub = page.locator("#scrub");
    await scrub.scrollIntoViewIfNeeded();
    const line = await scrub.boundingBox();
    await draw(page, [way([line.x + line.width * 0.1, line.y + line.height / 2], [line.width * 0.5, 0])]);
    const part = await scrub.evaluate((each) => Number(each.value) / Number(each.max));
    assert.ok(part > 0.4 && part < 0.8, `${part}`);
    assert.deepEqual(browser.errors, []);
  } finally {
    await browser.close();
    await server.stop();
  }
});
