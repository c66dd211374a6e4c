// The studio as a researcher uses it: built-in head and actor, then a real capture that `mimique
// preview` was given; markers, methods, curves, expressions, exports; wide, narrow, dark.

import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { mimique, preview, root } from "./lib/server.mjs";
import { builtIn, download, fact, unfold, violations, weightsHash } from "./lib/studio.mjs";

const data = process.env.MIMIQUE_DATA ?? join(root, "../shared/data");
const head = join(data, "ict-facekit/ict-facekit.glb");
const noBrowser = skip(!executable && "Chromium not found");
const noData = noBrowser || skip(!existsSync(head) && `real data not found: ${head}`);

test("studio: the built-in head and actor, from nothing to every export", { skip: noBrowser, timeout: 900_000 }, async () => {
  const server = await preview([]);
  const browser = await open("webgl2");
  const { page } = browser;
  const shots = screenshotFolder("studio");
  try {
    await builtIn(page, server);
    assert.ok((await fact(page, "A", "Residual")) < 3);
    assert.equal(await page.locator("#problem").isVisible(), false);

    // Eyes that are held turn in the panel; at rest the weights are what they were.
    const resting = await weightsHash(page, "A");
    await unfold(page, "sources");
    await page.selectOption("#gaze-kind", "held");
    await page.fill("#gaze-azimuth", "12");
    await page.press("#gaze-azimuth", "Enter");
    await weightsHash(page, "A", resting);
    await page.locator("main").first().screenshot({ path: join(shots, "gaze.png") });
    await page.fill("#gaze-elevation", "80");
    await page.press("#gaze-elevation", "Enter");
    await page.waitForFunction(() => document.getElementById("problem").textContent.includes("elevation: 80 degrees"));
    const held = await weightsHash(page, "A");
    await page.selectOption("#gaze-kind", "rest");
    assert.equal(await weightsHash(page, "A", held), resting);

    // A parameter changes the weights; a second method stands beside.
    const before = await weightsHash(page, "A");
    await page.locator('section[aria-label="Method A"] summary', { hasText: "Parameters" }).click();
    await page.locator('section[aria-label="Method A"] input[name=alpha]').fill("0.9");
    await weightsHash(page, "A", before);
    await page.click("#add-panel");
    await fact(page, "B", "Residual");
    await page.locator("#scrub").fill("6000");
    await page.getByRole("checkbox", { name: "Difference from A" }).check();
    assert.ok((await fact(page, "B", "Difference from A")) > 0);
    await page.check("#show-markers");
    await page.waitForTimeout(1500);
    await page.screenshot({ path: join(shots, "methods.png"), fullPage: true });

    // Markers: taken off and put back by a click on the head.
    await unfold(page, "matching");
    const row = page.locator('#markers tr[data-label="chin"]');
    await row.getByRole("button", { name: "chin", exact: true }).click();
    await row.getByRole("button", { name: "Take chin off" }).click();
    await page.waitForFunction(() => document.querySelector('#markers tr[data-label="chin"] td.unplaced'));
    await page.waitForTimeout(3000);
    const box = await page.locator("#match-overlay").boundingBox();
    await page.mouse.click(box.x + box.width / 2, box.y + 0.8 * box.height);
    await page.waitForFunction(() => !document.querySelector('#markers tr[data-label="chin"] td.unplaced'), null, { timeout: 30_000 });
    await page.locator("#matching").screenshot({ path: join(shots, "markers.png") });
    const map = JSON.parse(String(await download(page, () => page.click("#map-save"))));
    assert.equal(Object.keys(map.markers).length, 40);

    await unfold(page, "curves");
    await page.waitForTimeout(1500);
    await page.locator("#curves").screenshot({ path: join(shots, "curves.png") });

    // Expressions: eighteen are found; one is renamed and shortened.
    await unfold(page, "expressions");
    await page.click("#expressions-suggest");
    await page.waitForFunction(() => document.querySelectorAll("#segments tr").length === 18, null, { timeout: 60_000 });
    await page.locator("#segments tr").first().locator("input[type=text]").fill("anger one");
    await page.locator("#segments tr").first().locator("input[type=text]").press("Enter");
    await page.waitForFunction(() => document.querySelector("#timeline .segment").textContent === "anger one");
    await page.locator("#expressions").screenshot({ path: join(shots, "expressions.png") });
    const csv = String(await download(page, () => page.click("#save-csv")));
    assert.ok(csv.includes("anger one"), csv.slice(0, 200));
    const eaf = String(await download(page, () => page.click("#save-eaf")));
    assert.ok(eaf.includes("<ANNOTATION_VALUE>anger one</ANNOTATION_VALUE>"));

    // Exports of a short part.
    await page.locator("#scrub").fill("1000");
    await page.locator("#segments tr").first().locator("input[type=number]").nth(1).fill("1.5");
    await page.locator("#segments tr").first().locator("input[type=number]").nth(1).press("Enter");
    await page.selectOption("#range", "0");
    await unfold(page, "exports");
    await page.fill("#export-rate", "25");
    const weights = String(await download(page, () => page.click("#export-weights")));
    assert.ok(weights.startsWith("frame,time,"));
    const glb = await download(page, () => page.click("#export-glb"));
    assert.equal(glb.subarray(0, 4).toString(), "glTF");
    const zip = await download(page, () => page.click("#export-png"));
    assert.equal(zip.subarray(0, 2).toString(), "PK");
    assert.ok(zip.includes("-00003.png"));
    const webm = await download(page, () => page.click("#export-webm"));
    assert.deepEqual([...webm.subarray(0, 4)], [0x1a, 0x45, 0xdf, 0xa3]);
    const sheet = await download(page, () => page.click("#export-sheet"));
    assert.deepEqual([...sheet.subarray(1, 4)], [...Buffer.from("PNG")]);

    assert.deepEqual(await violations(page), []);
    // A phone in the dark.
    await page.emulateMedia({ colorScheme: "dark" });
    await page.setViewportSize({ width: 360, height: 780 });
    await page.waitForTimeout(1500);
    const wider = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
    assert.ok(wider <= 0, `${wider} px wider than the screen`);
    await page.screenshot({ path: join(shots, "phone-dark.png"), fullPage: true });
    assert.deepEqual(await violations(page), []);
    assert.ok(browser.requests.every((url) => url.startsWith(new URL(server.url).origin) || url.startsWith("blob:")));
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("studio: by keyboard; loop, slow motion, and files dropped on the page", { skip: noBrowser, timeout: 600_000 }, async () => {
  const server = await preview([]);
  const browser = await open("webgl2");
  const { page } = browser;
  const value = (id) => page.locator(`#${id}`).evaluate((control) => Number(control.value));
  const checked = (id) => page.locator(`#${id}`).isChecked();
  const key = (name) => page.keyboard.press(name);
  try {
    await builtIn(page, server);

    // The keys of the page, with the focus on no control.
    await page.evaluate(() => document.activeElement?.blur());
    await page.locator("#scrub").fill("5000");
    await page.evaluate(() => document.activeElement?.blur());
    await key(" ");
    await page.waitForFunction(() => document.querySelector("#play").textContent === "Pause");
    await page.waitForFunction(() => Number(document.querySelector("#scrub").value) > 5100);
    await key(" ");
    await page.waitForFunction(() => document.querySelector("#play").textContent === "Play");
    const still = await value("scrub");
    await key(".");
    await key(".");
    const later = await value("scrub");
    assert.ok(later > still && later < still + 100, `${still} ms, two frames on ${later} ms`);
    await key(",");
    await key(",");
    assert.ok(Math.abs((await value("scrub")) - still) <= 1, `${still} ms, there and back ${await value("scrub")} ms`);
    for (const [name, id] of [["l", "loop"], ["m", "show-markers"]]) {
      const before = await checked(id);
      await key(name);
      assert.equal(await checked(id), !before, `${name} turns ${id}`);
      await key(name);
      assert.equal(await checked(id), before, `${name} turns ${id} back`);
    }
    await key("v");
    assert.equal(await page.locator("#view").inputValue(), "0.61,0");
    await key("s");
    assert.equal(await value("speed"), 0.5);

    // Slow motion: the clip's time runs at half the wall's.
    const [began, from] = [Date.now(), await value("scrub")];
    await key(" ");
    await page.waitForTimeout(4000);
    await key(" ");
    await page.waitForFunction(() => document.querySelector("#play").textContent === "Play");
    const pace = ((await value("scrub")) - from) / (Date.now() - began);
    assert.ok(pace > 0.3 && pace < 0.55, `${pace} of the wall's time`);
    await page.selectOption("#speed", "1");
    await page.evaluate(() => document.activeElement?.blur());

    // The end: with the loop from the start again, without it there.
    const end = await page.locator("#scrub").evaluate((scrub) => Number(scrub.max));
    await page.locator("#scrub").fill(String(end - 200));
    await page.evaluate(() => document.activeElement?.blur());
    await key(" ");
    await page.waitForFunction(() => Number(document.querySelector("#scrub").value) < 20_000, null, { timeout: 20_000 });
    assert.equal(await page.locator("#play").textContent(), "Pause");
    await key(" ");
    await key("l");
    await page.locator("#scrub").fill(String(end - 200));
    await page.evaluate(() => document.activeElement?.blur());
    await key(" ");
    await page.waitForFunction(() => document.querySelector("#play").textContent === "Play", null, { timeout: 20_000 });
    assert.ok((await value("scrub")) >= end - 1);

    // A marker placed and moved by keys alone.
    await unfold(page, "matching");
    await page.waitForTimeout(3000);
    const row = page.locator('#markers tr[data-label="chin"]');
    const vertex = () => row.locator("td").nth(1).textContent();
    await row.getByRole("button", { name: "Take chin off" }).focus();
    await key("Enter");
    await page.waitForFunction(() => document.querySelector('#markers tr[data-label="chin"] td.unplaced'));
    await row.getByRole("button", { name: "chin", exact: true }).focus();
    await key("Enter");
    await page.locator("#match-overlay").focus();
    await key("Enter");
    await page.waitForFunction(() => !document.querySelector('#markers tr[data-label="chin"] td.unplaced'), null, { timeout: 30_000 });
    const places = [await vertex()];
    for (const way of ["ArrowDown", "ArrowRight"]) {
      await key(`Shift+${way}`);
      await page.waitForFunction((old) => document.querySelector('#markers tr[data-label="chin"]').cells[1].textContent !== old, places.at(-1), { timeout: 30_000 });
      places.push(await vertex());
    }
    assert.equal(new Set(places).size, 3, places.join(", "));

    // The weights that were saved, dropped on the page, are a take; that the face of the moved marker is still being solved
    // then is no problem to report.
    await unfold(page, "exports");
    const weights = await download(page, () => page.click("#export-weights"));
    const drop = (name, text) =>
      page.evaluate(([name, text]) => {
        const dataTransfer = new DataTransfer();
        dataTransfer.items.add(new File([text], name));
        const event = (type) => new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true });
        document.body.dispatchEvent(event("dragover"));
        document.body.dispatchEvent(event("drop"));
      }, [name, text]);
    await drop("dropped-weights.csv", String(weights));
    await page.waitForFunction(() => document.querySelector("#take-facts").textContent.includes("dropped-weights"), null, { timeout: 60_000 });
    assert.equal(await page.locator("#problem").isVisible(), false);
    await drop("broken.glb", "no head");
    await page.waitForFunction(() => document.querySelector("#problem").textContent.includes("broken.glb"));
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("studio: a real capture is matched and solved; what is broken is said", { skip: noData, timeout: 600_000 }, async () => {
  const take = join(data, "animface/JawMoCap.c3d");
  const server = await preview([head, "--mocap", take, "--markers", join(data, "animface/markers-ict-facekit.json")]);
  const browser = await open("webgl2");
  const { page } = browser;
  const shots = screenshotFolder("studio");
  try {
    await page.goto(`${server.url}?backend=webgl2`);
    assert.ok((await fact(page, "A", "Residual")) < 3);
    await page.waitForFunction(() => document.querySelector("#map-facts").textContent.includes("41 markers"), null, { timeout: 60_000 });
    await unfold(page, "sources");
    await page.click("#map-suggest");
    await page.waitForFunction(() => document.querySelector("#map-facts").textContent.includes("suggested"), null, { timeout: 60_000 });
    await page.waitForTimeout(8000);
    assert.ok((await fact(page, "A", "Residual")) < 3);
    await unfold(page, "matching");
    await page.waitForTimeout(6000);
    await page.screenshot({ path: join(shots, "real.png"), fullPage: true });
    // The map that is saved is the one that `mimique solve` takes.
    const folder = mkdtempSync(join(tmpdir(), "mimique-studio-"));
    const [map, out] = [join(folder, "markers.json"), join(folder, "w.csv")];
    writeFileSync(map, await download(page, () => page.click("#map-save")));
    mimique(["solve", "--avatar", head, "--mocap", take, "--markers", map, "--method", "lsts", "--out", out]);
    const [columns, ...frames] = readFileSync(out, "utf8").trim().split("\n");
    assert.ok(columns.startsWith("frame,time,") && frames.length === 1590, `${frames.length} frames`);
    await page.setInputFiles("#take-file", { name: "take.c3d", mimeType: "application/octet-stream", buffer: Buffer.from("no capture") });
    await page.waitForFunction(() => document.querySelector("#problem").textContent.includes("take.c3d"));
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});
