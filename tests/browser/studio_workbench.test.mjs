// The studio as a workbench: one window without scrolling, one click to a face, names by what differs, the camera by
// mouse and keys, a layout that survives a reload, undo for everything, the palette, French.

import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { savedBytes } from "./lib/saved.mjs";
import { preview } from "./lib/server.mjs";
import { choose, fact, unfold, violations, weightsHash } from "./lib/studio.mjs";

const noBrowser = skip(!executable && "Chromium not found");
const PANEL = (letter) => `section[aria-label="Method ${letter}"]`;
const name = (page, letter) => page.locator(`section[aria-label="View ${letter}"] .studio-name`).textContent();

/** The built-in head and actor by the one button of the first screen. */
async function start(page, server, query = "") {
  await page.goto(`${server.url}?backend=webgl2${query}`);
  await page.click("#start-built-in");
  await page.waitForFunction(() => document.querySelector(".studio-inspector .preview-clip div"), null, { timeout: 120_000 });
}

/** What scrolls of the page itself, and the size of the window. */
const overflow = (page) => page.evaluate(() => [document.documentElement.scrollWidth - innerWidth, document.documentElement.scrollHeight - innerHeight]);

/** The picture of a face, small: for whether it is another. */
const picture = (page, letter) =>
  page.locator(`section[aria-label="View ${letter}"] .stage`).screenshot({ scale: "css" }).then((bytes) => bytes.toString("base64"));

const blur = (page) => page.evaluate(() => document.activeElement?.blur());
const settled = (page) => page.waitForTimeout(1500);

test("studio workbench: one window, one click to a face, names, undo, palette, a reload", { skip: noBrowser, timeout: 900_000 }, async () => {
  const server = await preview([]);
  const browser = await open("webgl2", { viewport: { width: 1280, height: 720 } });
  const { page } = browser;
  const shots = screenshotFolder("studio");
  try {
    await start(page, server);
    for (const [width, height] of [[1440, 900], [1280, 720]]) {
      await page.setViewportSize({ width, height });
      await settled(page);
      assert.deepEqual(await overflow(page), [0, 0], `${width} x ${height}`);
      const face = await page.locator('section[aria-label="View A"] .stage').boundingBox();
      assert.ok(face.y + face.height <= height && face.width > 400 && face.height > 250, JSON.stringify(face));
      // The curves stand below the face, in line with the time.
      const curve = await page.locator("#tracks canvas").first().boundingBox();
      assert.ok(curve.y > face.y + face.height && curve.y < height, JSON.stringify(curve));
      await page.screenshot({ path: join(shots, `workbench-${width}.png`) });
    }
    // The play head stands over the curves where it stands over the seconds.
    const end = await page.locator("#scrub").evaluate((scrub) => Number(scrub.max));
    await page.locator("#scrub").fill(String(Math.round(0.75 * end)));
    const [ruler, line] = [await page.locator("#ruler").boundingBox(), await page.locator("#playline").evaluate((head) => head.getBoundingClientRect().left)];
    assert.ok(Math.abs(line - (ruler.x + 46 + 0.75 * (ruler.width - 46))) < 3, `${line} ${JSON.stringify(ruler)}`);
    assert.ok(!(await page.locator("#sources").evaluate((files) => files.open)), "the files are one row");
    assert.match(await page.textContent("#files-brief"), /built-in head, built-in actor/);
    assert.deepEqual(await violations(page), []);
    assert.equal(await name(page, "A"), "lsts");

    // A parameter: named, solved, taken back and done again by keys.
    const first = await weightsHash(page, "A");
    await page.locator(`${PANEL("A")} summary`, { hasText: "Parameters" }).click();
    await page.locator(`${PANEL("A")} input[name=alpha]`).fill("0.9");
    const second = await weightsHash(page, "A", first);
    assert.equal(await name(page, "A"), "lsts, alpha 0.9");
    await page.keyboard.press("Control+z");
    assert.equal(await weightsHash(page, "A", second), first);
    assert.equal(await page.locator(`${PANEL("A")} input[name=alpha]`).inputValue(), "0.3");
    await page.keyboard.press("Control+Shift+z");
    assert.equal(await weightsHash(page, "A", first), second);

    // A method, and a face that is added, removed and brought back with what it was.
    await page.click("#add-panel");
    await fact(page, "B", "Residual");
    await page.locator(PANEL("B")).getByLabel("Method B", { exact: true }).selectOption("lsts");
    await page.waitForFunction(() => document.querySelector('section[aria-label="View B"] .studio-name').textContent === "lsts, alpha 0.3");
    assert.equal(await name(page, "A"), "lsts, alpha 0.9", "two of one method are told apart");
    const box = await weightsHash(page, "B");
    await page.click('button[aria-label="Remove method B"]');
    await page.waitForFunction(() => !document.querySelector('section[aria-label="View B"]'));
    await page.click("#undo");
    await page.waitForFunction((hash) => [...document.querySelectorAll('section[aria-label="Method B"] dd')].some((each) => each.textContent === hash), box, { timeout: 60_000 });
    assert.equal(await name(page, "B"), "lsts, alpha 0.3");

    // A locked shape and a segment.
    await choose(page, "A");
    await page.locator(`${PANEL("A")} summary`, { hasText: "Blendshapes" }).click();
    const lock = page.locator(PANEL("A")).getByLabel("jawOpen locked at 0", { exact: true });
    await lock.check();
    const locked = await weightsHash(page, "A", second);
    await unfold(page, "expressions");
    await page.click("#expression-add");
    await page.waitForFunction(() => document.querySelectorAll("#segments tr").length === 1);
    await blur(page);
    await page.keyboard.press("Control+z");
    await page.waitForFunction(() => document.querySelectorAll("#segments tr").length === 0);
    await page.keyboard.press("Control+z");
    assert.equal(await weightsHash(page, "A", locked), second);
    assert.ok(!(await lock.isChecked()));
    await page.keyboard.press("Control+y");
    await weightsHash(page, "A", second);
    await page.keyboard.press("Control+z");
    await weightsHash(page, "A", locked);

    // A marker is dragged along the skin: one step.
    await unfold(page, "matching");
    const chin = page.locator('#markers tr[data-label="chin"] td').nth(1);
    const before = await chin.textContent();
    await page.waitForTimeout(3000);
    const overlay = await page.locator("#match-overlay").boundingBox();
    await page.locator('#markers tr[data-label="chin"] button', { hasText: "chin" }).click();
    const dot = await page.locator("#match-overlay").evaluate((canvas) => {
      const { data, width, height } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      let [x, y, count] = [0, 0, 0];
      for (let i = 0; i < data.length; i += 4) {
        if (data[i] !== 0xff || data[i + 1] !== 0x5a || data[i + 2] !== 0x5f) continue;
        x += (i / 4) % width;
        y += Math.floor(i / 4 / width);
        count += 1;
      }
      return { x: x / count / width, y: y / count / height };
    });
    const at = { x: overlay.x + dot.x * overlay.width, y: overlay.y + dot.y * overlay.height };
    await page.mouse.move(at.x, at.y);
    await page.mouse.down();
    for (let step = 1; step <= 5; step++) {
      await page.mouse.move(at.x + 4 * step, at.y - 4 * step);
      await page.waitForTimeout(80);
    }
    await page.mouse.up();
    await page.waitForFunction((old) => document.querySelector('#markers tr[data-label="chin"]').cells[1].textContent !== old, before, { timeout: 30_000 });
    await page.waitForFunction(() => document.querySelector("#undo").title.includes("chin"));
    await page.click("#undo");
    await page.waitForFunction((old) => document.querySelector('#markers tr[data-label="chin"]').cells[1].textContent === old, before, { timeout: 30_000 });

    // The palette: found by letters, done by Enter, with the keys beside.
    await blur(page);
    await page.keyboard.press("Control+k");
    await page.locator("#palette").waitFor();
    assert.match(await page.textContent("#palette-list"), /Play or pause.*Space/s);
    assert.deepEqual(await violations(page), []);
    await page.screenshot({ path: join(shots, "workbench-palette.png") });
    await page.keyboard.type("show cur");
    assert.equal(await page.locator("#palette-list li").count(), 1);
    await page.keyboard.press("Enter");
    assert.ok(await page.locator("#palette").isHidden());
    assert.ok(await page.locator("#curves").isVisible());

    // Sizes, tabs and faces are there after a reload.
    await unfold(page, "exports");
    await unfold(page, "expressions");
    const width = () => page.locator("#dock-left").evaluate((dock) => dock.getBoundingClientRect().width);
    const narrow = await width();
    await page.locator("#split-left").focus();
    for (let i = 0; i < 5; i++) await page.keyboard.press("ArrowRight");
    assert.equal(await width(), narrow + 80);
    await start(page, server);
    await fact(page, "B", "Residual");
    assert.equal(await width(), narrow + 80);
    assert.ok(await page.locator("#exports").isVisible());
    assert.ok(await page.locator("#expressions").isVisible());
    assert.deepEqual([await name(page, "A"), await name(page, "B")], ["lsts, alpha 0.9", "lsts, alpha 0.3"]);
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("studio workbench: the camera by mouse, wheel and keys, linked and each for itself", { skip: noBrowser, timeout: 600_000 }, async () => {
  const server = await preview([]);
  const browser = await open("webgl2", { viewport: { width: 1280, height: 720 } });
  const { page } = browser;
  try {
    await start(page, server);
    await page.click("#add-panel");
    await fact(page, "B", "Residual");
    await settled(page);
    const front = [await picture(page, "A"), await picture(page, "B")];
    const box = await page.locator('section[aria-label="View A"] .stage').boundingBox();
    const middle = [box.x + box.width / 2, box.y + box.height / 2];
    const drag = async (right, down) => {
      await page.mouse.move(...middle);
      await page.mouse.down();
      await page.mouse.move(middle[0] + right, middle[1] + down, { steps: 4 });
      await page.mouse.up();
      await settled(page);
    };
    await drag(60, 0);
    const turned = [await picture(page, "A"), await picture(page, "B")];
    assert.ok(turned[0] !== front[0] && turned[1] !== front[1], "both turn");
    await page.mouse.wheel(0, -200);
    await settled(page);
    const near = await picture(page, "A");
    assert.notEqual(near, turned[0]);
    await page.keyboard.down("Shift");
    await drag(50, 20);
    await page.keyboard.up("Shift");
    assert.notEqual(await picture(page, "A"), near);
    await page.locator('section[aria-label="View A"] .stage').focus();
    await page.keyboard.press("0");
    await settled(page);
    await blur(page);
    await page.mouse.move(5, 5);
    await page.click("#view-reset");
    await settled(page);
    const view = () => page.evaluate(() => JSON.parse(localStorage.getItem("mimique-studio")).camera);
    assert.deepEqual(await view(), { yaw: 0, pitch: 0, zoom: 1, x: 0, y: 0 });

    // Keys on a face; each for itself once the link is off.
    await page.uncheck("#view-linked");
    const before = [await picture(page, "A"), await picture(page, "B")];
    await page.locator('section[aria-label="View A"] .stage').focus();
    for (let i = 0; i < 4; i++) await page.keyboard.press("ArrowLeft");
    await page.keyboard.press("+");
    await settled(page);
    await blur(page);
    assert.notEqual(await picture(page, "A"), before[0]);
    assert.equal(await picture(page, "B"), before[1], "the other stays");

    // From far too near, fit shows the whole head again, in the middle.
    await page.check("#view-linked");
    await page.click("#view-reset");
    await page.mouse.move(...middle);
    for (let i = 0; i < 4; i++) await page.mouse.wheel(0, -200);
    await settled(page);
    assert.ok((await view()).zoom > 2, JSON.stringify(await view()));
    await page.click("#view-fit");
    await settled(page);
    const fit = await view();
    assert.ok(fit.zoom > 0.7 && fit.zoom < 1.3 && Math.abs(fit.x) < 0.02, JSON.stringify(fit));
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("studio workbench: how far methods are apart; sensitivity; a video of a chosen size", { skip: noBrowser, timeout: 900_000 }, async () => {
  const server = await preview([]);
  const browser = await open("webgl2", { viewport: { width: 1440, height: 900 } });
  const { page, context } = browser;
  try {
    await start(page, server);
    await page.click("#add-panel");
    await fact(page, "B", "Residual");
    await page.getByRole("checkbox", { name: "Difference from A" }).check();
    const table = page.locator(`${PANEL("B")} .studio-difference tbody`);
    await table.locator("tr", { hasText: "Whole face" }).waitFor({ timeout: 120_000 });
    const rows = await table.locator("tr").evaluateAll((all) => all.map((row) => [...row.cells].map((cell) => cell.textContent)));
    assert.ok(rows.length > 4, JSON.stringify(rows));
    const largest = rows.map(([, , mm]) => Number(mm));
    assert.equal(largest.at(-1), Math.max(...largest));
    await page.click(`${PANEL("B")} .studio-difference button:has-text("largest difference")`);
    const [at] = (await page.textContent("#clock")).split(" ");
    assert.ok(Math.abs(Number(at) - Number(rows.at(-1)[3])) < 0.02, `${at} ${rows.at(-1)[3]}`);
    await page.waitForTimeout(2000);
    await page.screenshot({ path: join(screenshotFolder("studio"), "workbench-difference.png") });

    // The slider finds fewer and more expressions while it is moved.
    await unfold(page, "expressions");
    await page.click("#expressions-suggest");
    await page.waitForFunction(() => document.querySelectorAll("#segments tr").length === 18, null, { timeout: 60_000 });
    await page.locator("#expressions-sensitivity").fill("-0.6");
    await page.waitForFunction(() => { const { length } = document.querySelectorAll("#segments tr"); return length > 0 && length < 18; }, null, { timeout: 60_000 });

    // MP4, opened again by the browser: its size and length are those that were asked for.
    await page.locator("#segments tr").first().locator("input[type=number]").nth(1).fill("1.2");
    await page.selectOption("#range", "0");
    await unfold(page, "exports");
    await page.selectOption("#export-size", "1280x720");
    await page.fill("#export-rate", "24");
    await page.locator("#export-mp4").waitFor();
    const [file] = await Promise.all([page.waitForEvent("download", { timeout: 300_000 }), page.click("#export-mp4")]);
    const bytes = await savedBytes(file);
    assert.equal(bytes.subarray(4, 8).toString(), "ftyp");
    const other = await context.newPage();
    const seen = await other.evaluate(async (text) => {
      const video = document.createElement("video");
      video.muted = true;
      video.src = URL.createObjectURL(new Blob([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], { type: "video/mp4" }));
      await new Promise((resolve, reject) => ((video.onloadeddata = resolve), (video.onerror = () => reject(video.error))));
      video.currentTime = video.duration / 2;
      await new Promise((resolve, reject) => ((video.onseeked = resolve), (video.onerror = () => reject(video.error))));
      const canvas = new OffscreenCanvas(64, 36);
      const picture = canvas.getContext("2d");
      picture.drawImage(video, 0, 0, 64, 36);
      const { data } = picture.getImageData(0, 0, 64, 36);
      const colours = new Set(Array.from({ length: 64 * 36 }, (_, i) => `${data[4 * i] >> 4},${data[4 * i + 1] >> 4},${data[4 * i + 2] >> 4}`));
      return { width: video.videoWidth, height: video.videoHeight, duration: video.duration, colours: colours.size };
    }, bytes.toString("base64"));
    await other.close();
    const seconds = (await page.locator("#segments tr td").nth(3).textContent()).split("–").map(Number);
    const count = Math.floor((seconds[1] - seconds[0]) * 24 + 1e-6) + 1;
    assert.deepEqual([seen.width, seen.height], [1280, 720]);
    assert.ok(Math.abs(seen.duration - count / 24) < 0.05, `${seen.duration} s of ${count / 24}`);
    assert.ok(seen.colours > 30, `${seen.colours} colours`);
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("studio workbench: in French, on a tablet, in the dark", { skip: noBrowser, timeout: 600_000 }, async () => {
  const server = await preview([]);
  const browser = await open("undrawn", { viewport: { width: 768, height: 1024 }, colorScheme: "dark", locale: "fr-FR" });
  const { page } = browser;
  try {
    await start(page, server);
    assert.equal(await page.evaluate(() => document.documentElement.lang), "fr");
    assert.equal(await page.textContent("#tab-faces"), "Visages");
    assert.match(await page.textContent(".studio-inspector .preview-clip"), /Résidu.*mm eff\./s);
    await settled(page);
    assert.equal((await overflow(page))[0], 0, "nothing sticks out");
    assert.deepEqual(await violations(page), []);
    await page.screenshot({ path: join(screenshotFolder("studio"), "workbench-tablet-fr-dark.png"), fullPage: true });
    // What the engine says of the solve and refuses of a parameter, and numbers.
    assert.match(await page.textContent(".studio-inspector .notice.warn"), /^les marqueurs de l’acteur sont à \d,\d mm \(eff\.\) de ceux de l’avatar/);
    assert.equal(await page.textContent("#files-brief"), "tête intégrée, acteur intégré");
    await page.evaluate(() => document.querySelectorAll(".studio-inspector details").forEach((details) => (details.open = true)));
    await page.locator(".studio-inspector [name=kappa]").first().fill("-1");
    await page.waitForFunction(() => [...document.querySelectorAll("p.problem:not([hidden])")].some(({ textContent }) => textContent === "vaut -1 ; donnez un nombre au-dessus de 0"));
    // The address goes before the browser.
    await page.goto(`${server.url}?backend=webgl2&lang=en`);
    assert.equal(await page.textContent("#tab-faces"), "Faces");
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});
