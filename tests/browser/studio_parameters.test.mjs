// What a method of the studio takes by name: blendshapes locked and bounded, importance of markers; the
// settings that are saved, and the take that a regression learns from, give `mimique solve` the same
// weights.

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
const take = join(data, "animface/JawMoCap.c3d");
const map = join(data, "animface/markers-ict-facekit.json");
const noBrowser = skip(!executable && "Chromium not found");
const noData = noBrowser || skip(!existsSync(head) && `real data not found: ${head}`);

const PANEL = 'section[aria-label="Method A"]';

/** A folded table of panel A, opened. */
async function table(page, title) {
  const details = page.locator(`${PANEL} details.studio-named`, { has: page.locator("summary", { hasText: title }) });
  if (!(await details.evaluate((each) => each.open))) await details.locator("summary").click();
  await details.locator("tbody tr").first().waitFor();
  return details;
}

const typed = async (page, name, value) => page.locator(PANEL).getByLabel(name, { exact: true }).fill(value);

test("studio: blendshapes locked and bounded, markers weighed; `mimique solve` takes the settings", { skip: noData, timeout: 600_000 }, async () => {
  const server = await preview([head, "--mocap", take, "--markers", map]);
  const browser = await open("undrawn");
  const { page } = browser;
  const shots = screenshotFolder("studio");
  const folder = mkdtempSync(join(tmpdir(), "mimique-studio-"));
  const file = (name) => join(folder, name);
  try {
    await page.goto(`${server.url}?backend=webgl2`);
    await page.waitForFunction(() => document.querySelector("#map-facts").textContent.includes("41 markers"), null, { timeout: 120_000 });
    let hash = await weightsHash(page, "A");
    const csv = async () => {
      await unfold(page, "exports");
      const text = String(await download(page, () => page.click("#export-weights")));
      await unfold(page, "method");
      return text;
    };
    const column = (text, name) => {
      const [header, ...rows] = text.trim().split("\n");
      const at = header.split(",").indexOf(name);
      return rows.map((line) => Number(line.split(",")[at]));
    };

    // The filter leaves the rows asked for, by keyboard.
    const shapes = await table(page, "Blendshapes");
    const rows = () => shapes.locator("tbody tr:visible").evaluateAll((all) => all.map((row) => row.dataset.name));
    const all = await rows();
    assert.equal(all.length, 53);
    await shapes.getByPlaceholder("Filter").fill("jaw");
    assert.deepEqual(await rows(), all.filter((name) => name.includes("jaw")));

    // A lock by the space bar is solved at once.
    await page.getByLabel("jawForward locked at 0", { exact: true }).focus();
    await page.keyboard.press("Space");
    hash = await weightsHash(page, "A", hash);
    assert.ok(await page.getByLabel("lower bound of jawForward", { exact: true }).isDisabled());
    assert.ok(column(await csv(), "jawForward").every((w) => w === 0));
    await typed(page, "upper bound of jawOpen", "0.2");
    hash = await weightsHash(page, "A", hash);
    const opened = column(await csv(), "jawOpen");
    assert.ok(Math.max(...opened) === 0.2 && Math.min(...opened) === 0, `${Math.min(...opened)} ${Math.max(...opened)}`);
    assert.match(await shapes.locator("summary").textContent(), /2 of 53 changed/);

    // What is wrong stands beside its control, and goes when it is corrected.
    await typed(page, "lower bound of jawOpen", "0.5");
    const problem = shapes.locator('tr[data-name="jawOpen"] .problem');
    await problem.waitFor();
    assert.match(await problem.textContent(), /is \[0\.5, 0\.2\]; give two numbers, the lower one first/);
    const lower = page.getByLabel("lower bound of jawOpen", { exact: true });
    assert.equal(await lower.getAttribute("aria-invalid"), "true");
    assert.equal(await lower.getAttribute("aria-describedby"), await problem.getAttribute("id"));
    assert.ok(await page.getByRole("button", { name: "Save settings of method A" }).isDisabled());
    await page.locator(PANEL).screenshot({ path: join(shots, "wrong-bounds.png") });
    await lower.fill("0.05");
    await problem.waitFor({ state: "hidden" });
    assert.equal(await lower.getAttribute("aria-invalid"), null);
    hash = await weightsHash(page, "A", hash);

    // A parameter that the solver refuses is not passed over in silence.
    await page.locator(`${PANEL} summary`, { hasText: "Parameters" }).click();
    await typed(page, "κ, priors against data", "-1");
    const kappa = page.locator(`${PANEL} [data-parameter=kappa] .problem`);
    await kappa.waitFor();
    assert.match(await kappa.textContent(), /is -1; give a number above 0/);
    await typed(page, "κ, priors against data", "0.125");
    await kappa.waitFor({ state: "hidden" });
    hash = await weightsHash(page, "A", hash);

    await table(page, "Importance of markers");
    await typed(page, "Importance of Chin", "0.25");
    hash = await weightsHash(page, "A", hash);

    // Settings and weights go out; the command line solves the same.
    const settings = await download(page, () => page.getByRole("button", { name: "Save settings of method A" }).click());
    const { method, alpha, kappa: k, bounds, locked, importance } = JSON.parse(String(settings));
    assert.deepEqual(
      { method, alpha, k, bounds, locked, importance },
      { method: "lsts", alpha: 0.3, k: 0.125, bounds: { jawOpen: [0.05, 0.2] }, locked: ["jawForward"], importance: { Chin: 0.25 } },
    );
    writeFileSync(file("settings.json"), settings);
    const solve = (more) => {
      mimique(["solve", "--avatar", head, "--mocap", take, "--markers", map, "--out", file("w.csv"), ...more]);
      return readFileSync(file("w.csv"), "utf8");
    };
    const own = await csv();
    assert.equal(solve(["--settings", file("settings.json")]), own, "the same text");
    assert.notEqual(solve([]), own);
    // A study file takes the same JSON as a method.
    const text = readFileSync(join(root, "study-config/animface.json"), "utf8");
    const study = text.replace('"lsts30": { "method": "lsts", "alpha": 0.3 }', `"lsts30": ${settings}`).replaceAll("./schema", join(root, "study-config/schema"));
    assert.ok(study.includes('"jawForward"'));
    writeFileSync(file("study.json"), study);
    assert.match(mimique(["check", file("study.json")], { env: { ...process.env, MIMIQUE_DATA: data } }), /no errors/);

    // Other methods keep what was typed and take what they use; soft bounds stand in the same columns.
    await page.locator(PANEL).getByLabel("Method A", { exact: true }).selectOption("lsts-soft");
    hash = await weightsHash(page, "A", hash);
    await typed(page, "Soft bounds begin, to", "1.5");
    hash = await weightsHash(page, "A", hash);
    assert.equal(await page.getByLabel("upper bound of jawLeft", { exact: true }).getAttribute("placeholder"), "1.5");
    const soft = JSON.parse(String(await download(page, () => page.getByRole("button", { name: "Save settings of method A" }).click())));
    assert.deepEqual([soft.softBounds, soft.bounds], [[-0.1, 1.5], { jawOpen: [0.05, 0.2] }]);
    await page.locator(PANEL).getByLabel("Method A", { exact: true }).selectOption("pseudo-inverse");
    hash = await weightsHash(page, "A", hash);
    assert.equal(await page.getByLabel("upper bound of jawLeft", { exact: true }).count(), 0);

    // Reset forgets it all.
    await page.locator(PANEL).getByLabel("Method A", { exact: true }).selectOption("lsts");
    hash = await weightsHash(page, "A", hash);
    for (const title of ["blendshapes", "importance of markers"]) {
      await page.getByRole("button", { name: `Reset ${title}, method A` }).click();
      hash = await weightsHash(page, "A", hash);
    }
    const plain = JSON.parse(String(await download(page, () => page.getByRole("button", { name: "Save settings of method A" }).click())));
    assert.deepEqual([plain.bounds, plain.importance, plain.locked], [undefined, undefined, undefined]);
    assert.equal((await rows()).length, 53);

    // What was saved comes back: method, numbers and lists.
    await page.locator(PANEL).getByLabel("Method A", { exact: true }).selectOption("box");
    hash = await weightsHash(page, "A", hash);
    const settingsFile = page.locator(PANEL).getByLabel("Open settings… of method A");
    await settingsFile.setInputFiles(file("settings.json"));
    await page.waitForFunction(() => document.querySelector("select[aria-label='Method A']").value === "lsts");
    await weightsHash(page, "A", hash);
    assert.equal(await csv(), own, "the same weights as when it was saved");
    assert.equal(await page.locator(PANEL).getByLabel("κ, priors against data", { exact: true }).inputValue(), "0.125");
    assert.ok(await page.getByLabel("jawForward locked at 0", { exact: true }).isChecked());
    for (const [text, part] of [
      ['{"method": "lasso"}', 'other.json: method "lasso": there is none of that name'],
      ['{"method": "box", "alpha": 0.3}', "other.json: alpha: box takes no such parameter"],
      ['{"method": "box", "locked": ["tail"]}', "other.json: no blendshape tail here"],
      ["{", "other.json: "],
    ]) {
      await settingsFile.setInputFiles({ name: "other.json", mimeType: "application/json", buffer: Buffer.from(text) });
      await page.waitForFunction((part) => document.querySelector("#problem").textContent.includes(part), part);
    }
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("studio: regression is offered once there is a take to learn from, and learns what `mimique solve` learns", { skip: noData, timeout: 600_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-studio-"));
  const file = (name) => join(folder, name);
  const files = ["--avatar", head, "--mocap", take, "--markers", map];
  const server = await preview([head, "--mocap", take, "--markers", map]);
  const browser = await open("undrawn");
  const { page } = browser;
  try {
    // The known weights of a take: those of another method.
    mimique(["solve", ...files, "--method", "box", "--out", file("known.csv")]);
    await page.goto(`${server.url}?backend=webgl2`);
    await page.waitForFunction(() => document.querySelector("#map-facts").textContent.includes("41 markers"), null, { timeout: 120_000 });
    const hash = await weightsHash(page, "A");
    const option = page.locator(`${PANEL} select:not([name=blendWith]) > option[value=regression]`);
    assert.ok(await option.evaluate((each) => each.disabled));
    assert.match(await option.textContent(), /under Files: open a range of motion and its weights/);
    await page.setInputFiles("#training-weights-file", file("known.csv"));
    await page.waitForFunction(() => document.querySelector("#training-facts").textContent.includes("open the capture that these weights belong to"));
    assert.ok(await option.evaluate((each) => each.disabled));
    await page.setInputFiles("#training-file", take);
    await page.waitForFunction(() => !document.querySelector('section[aria-label="Method A"] select:not([name=blendWith]) > option[value=regression]').disabled, null, { timeout: 60_000 });
    assert.match(await page.locator("#training-facts").textContent(), /JawMoCap\.c3d: 41 markers, 1590 frames.*known\.csv: weights, 1590 frames/);
    await unfold(page, "sources");
    await page.locator("#training-end").fill("90");
    await page.locator("#training-end").press("Enter");

    await page.locator(PANEL).getByLabel("Method A", { exact: true }).selectOption("regression");
    const learnt = await weightsHash(page, "A", hash);
    await page.locator(`${PANEL} summary`, { hasText: "Parameters" }).click();
    await typed(page, "Basis vectors, at most", "50");
    await weightsHash(page, "A", learnt);
    await unfold(page, "exports");
    const own = String(await download(page, () => page.click("#export-weights")));
    await unfold(page, "method");
    writeFileSync(file("settings.json"), await download(page, () => page.getByRole("button", { name: "Save settings of method A" }).click()));
    const training = ["--training", take, "--training-weights", file("known.csv"), "--training-neutral", "0:90"];
    mimique(["solve", ...files, "--settings", file("settings.json"), ...training, "--out", file("w.csv")]);
    assert.equal(readFileSync(file("w.csv"), "utf8"), own, "the same text");

    // Weights of another length are refused with both names.
    writeFileSync(file("short.csv"), readFileSync(file("known.csv"), "utf8").split("\n").slice(0, 101).join("\n"));
    await page.setInputFiles("#training-weights-file", file("short.csv"));
    await page.waitForFunction(() => document.querySelector("#training-facts").textContent.includes("JawMoCap.c3d has 1590 frames, short.csv 100; give a row of weights per frame"));
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("studio: an avatar's own locked shapes; the tables wide, narrow, light and dark", { skip: noBrowser, timeout: 600_000 }, async () => {
  const server = await preview([]);
  const browser = await open("undrawn");
  const { page } = browser;
  const shots = screenshotFolder("studio");
  try {
    await builtIn(page, server);
    await unfold(page, "exports");
    const glb = await download(page, () => page.click("#export-glb"));
    const before = await weightsHash(page, "A");

    // The same head again, with its settings beside it.
    await page.setInputFiles("#avatar-file", [
      { name: "mine.glb", mimeType: "model/gltf-binary", buffer: glb },
      { name: "mine.avatar.json", mimeType: "application/json", buffer: Buffer.from('{"locked": ["jawOpen"]}') },
    ]);
    await page.waitForFunction(() => document.querySelector("#avatar-facts").textContent.includes("mine.glb"), null, { timeout: 60_000 });
    await weightsHash(page, "A", before);
    await unfold(page, "method");
    await table(page, "Blendshapes");
    const own = page.getByLabel("jawOpen locked at 0", { exact: true });
    assert.ok((await own.isChecked()) && (await own.isDisabled()));
    assert.match(await page.locator(`${PANEL} tr[data-name="jawOpen"] .note`).textContent(), /locked by the avatar/);
    await unfold(page, "exports");
    const weights = String(await download(page, () => page.click("#export-weights"))).trim().split("\n");
    await unfold(page, "method");
    const at = weights[0].split(",").indexOf("jawOpen");
    assert.ok(weights.slice(1).every((line) => line.split(",")[at] === "0"));

    // Built-in training, from a click.
    await unfold(page, "sources");
    await page.click("#training-built-in");
    await page.waitForFunction(() => !document.querySelector("option[value=regression]").disabled, null, { timeout: 60_000 });

    await page.locator(`${PANEL} summary`, { hasText: "Parameters" }).click();
    await table(page, "Importance of markers");
    for (const colorScheme of ["light", "dark"]) {
      for (const width of [1280, 360]) {
        await page.emulateMedia({ colorScheme });
        await page.setViewportSize({ width, height: 800 });
        await page.waitForTimeout(1000);
        const wider = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
        assert.ok(wider <= 0, `${width} px: ${wider} px wider than the screen`);
        const cut = await page.evaluate(() =>
          [...document.querySelectorAll(".studio-named .studio-table")].filter((region) => region.scrollWidth > region.clientWidth + 1).map((region) => region.ariaLabel),
        );
        assert.deepEqual(cut, [], `${width} px: no table scrolls sideways`);
        await page.screenshot({ path: join(shots, `tables-${width}-${colorScheme}.png`), fullPage: true });
        assert.deepEqual(await violations(page), [], `${width} px, ${colorScheme}`);
      }
    }
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});
